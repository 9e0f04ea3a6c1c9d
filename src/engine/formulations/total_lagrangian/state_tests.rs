//! A law with state sees every accepted step once, in all circumstances.

use glam::DMat3;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::assembly::build;
use crate::materials::{
    ElasticConstants, Material, MaterialModel, ParameterError, SolidLaw, StateRows, StressRows, Stretches,
};
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::{Checkpoint, Simulation};
use crate::world::{BodyId, Column, ColumnSet, PlasticStrain, Temperature};

/// Counts the steps that it sees and adds up their lengths; as stiff as it needs to be for a time step.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Witness {
    density: f64,
}

struct WitnessLaw(ElasticConstants);

impl MaterialModel for Witness {
    const NAME: &'static str = "Witness";
    const REFERENCE: &'static str = "";

    fn build(self) -> Result<Material, ParameterError> {
        let law = WitnessLaw(ElasticConstants::from_young_poisson(1.0e6, 0.3));
        Ok(Material::solid(self.density, law))
    }
}

impl SolidLaw for WitnessLaw {
    fn elastic(&self) -> &ElasticConstants {
        &self.0
    }

    fn needs_positive_volume(&self) -> bool {
        false
    }

    fn stable_step_factor(&self, _: &Stretches) -> f64 {
        1.0
    }

    fn state(&self, columns: &mut ColumnSet) {
        columns.add::<PlasticStrain>().add::<Temperature>();
    }

    fn start(&self, mut state: StateRows<'_>) {
        state.take::<Temperature>().fill(Temperature(300.0));
    }

    fn stress(&self, rows: &mut StressRows<'_>) {
        let mut state = rows.state.reborrow();
        let (count, time) = (state.take::<PlasticStrain>(), state.take::<Temperature>());
        assert_eq!(count.len(), rows.deformation.len());
        for k in 0..count.len() {
            if rows.dt > 0.0 {
                count[k].0 += 1.0;
                time[k].0 += rows.dt;
                rows.plastic_work[k] = 3.0 * rows.dt;
            }
            rows.stress[k] = (rows.deformation[k] - DMat3::IDENTITY) * self.0.young;
        }
    }
}

const SCENE: &str = r#"Scene(dimension: Two,
    materials: {"witness": Witness(density: 1000.0), "rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)},
    bodies: [
        Body(name: "other", material: "rubber", shape: Box(min: (-2, 0), max: (-1, 1)), spacing: 0.1, formulation: TotalLagrangian),
        Body(name: "block", material: "witness", shape: Box(min: (0, 0), max: (2, 1)), spacing: 0.1, formulation: TotalLagrangian),
    ],
    time: (end: 1.0))"#;

fn simulation() -> Simulation {
    let mut registry = Registry::standard();
    registry.material::<Witness>();
    let built =
        parse(Source::new("test.ron", SCENE)).and_then(|(scene, source)| build(&scene, &source, &registry));
    built.unwrap_or_else(|error| panic!("{error}"))
}

fn column<C: Column>(simulation: &Simulation, body: usize) -> Vec<C> {
    let (view, rows) = simulation.world().body_view(BodyId(body));
    view.read::<C>().expect("a column")[rows].to_vec()
}

fn sees(simulation: &Simulation, steps: f64) {
    assert!(column::<PlasticStrain>(simulation, 1).iter().all(|count| count.0 == steps));
    let time = 300.0 + simulation.clock().time;
    assert!(column::<Temperature>(simulation, 1).iter().all(|row| (row.0 - time).abs() < 1e-9));
    assert!(column::<Temperature>(simulation, 0).iter().all(|row| row.0 == 0.0), "of another body");
    let work = simulation.ledger().total_named("plastic_work");
    let wanted = 2.0 * 3.0 * simulation.clock().time;
    assert!((work - wanted).abs() < 1e-9 * wanted.max(1.0), "{work} instead of {wanted}");
}

#[test]
fn state_advances_once_in_every_step_also_after_a_restart() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("state.mlc");
    let mut first = simulation();
    sees(&first, 0.0);
    first.start().expect("a start");
    sees(&first, 0.0);
    first.run(|sim| sim.clock().step < 7).expect("a run");
    sees(&first, 7.0);
    first.save(&path, &Source::new("test.ron", SCENE)).expect("a checkpoint");
    let mut second = simulation();
    second.restore(&Checkpoint::read(&path).expect("a checkpoint")).expect("a restart");
    sees(&second, 7.0);
    second.run(|sim| sim.clock().step < 12).expect("a run");
    sees(&second, 12.0);
}

#[test]
fn a_phase_without_such_a_material_has_no_state_columns() {
    let text =
        SCENE.replace("Witness(density: 1000.0)", "NeoHookean(density: 1000, young: 1e6, poisson: 0.3)");
    let (scene, source) = parse(Source::new("test.ron", text)).expect("a scene");
    let simulation = build(&scene, &source, &Registry::standard()).expect("a simulation");
    let (view, _) = simulation.world().body_view(BodyId(1));
    assert!(!view.has::<PlasticStrain>() && !view.has::<Temperature>());
}
