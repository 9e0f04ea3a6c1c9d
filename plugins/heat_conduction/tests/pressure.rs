//! Heat that comes by conduction adds to the pressure of an equation of state, as that of plastic work does.

use std::f64::consts::PI;

use meshless_engine::assembly::build;
use meshless_engine::glam::DMat3;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, DeformationGradient, PiolaStress, ReferencePosition, Temperature};

/// Density, kg/m3, specific heat, J/(kg K), Grueneisen parameter.
const DENSITY: f64 = 2700.0;
const SPECIFIC_HEAT: f64 = 900.0;
const GAMMA: f64 = 2.0;

/// A bar with a temperature that is a cosine along it, all of which is held.
fn held(law: &str, formulation: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"metal": {law}(density: {DENSITY:?}, young: 70e9, poisson: 0.33, hardening: Perfect(yield_stress: 1e9),
                heating: (specific_heat: {SPECIFIC_HEAT:?}, temperature: 300), eos: MieGrueneisen(slope: 1.34, gamma: {GAMMA:?}))}},
            bodies: [(name: "bar", material: "metal", shape: Box(min: (0, 0), max: (0.01, 0.004)), spacing: 0.0005, formulation: {formulation})],
            conditions: [Fix(on: Select(body: "bar"))],
            plugins: [heat_conduction(conductivity: 2e8, temperature: "300 + 50*cos(pi*x/0.01)")],
            time: (end: 1e-7))"#
    );
    let registry = Registry::standard().with(heat_conduction::register);
    let (scene, source) = parse(Source::new("held.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &registry).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn heat_that_is_conducted_takes_its_pressure_along() {
    for law in ["J2", "Hypoelastic"] {
        for formulation in ["TotalLagrangian()", "UpdatedLagrangian()", "Eulerian()"] {
            let mut sim = held(law, formulation);
            sim.run(|_| true).unwrap();
            let (view, rows) = sim.world().body_view(BodyId(0));
            let (stress, f) =
                (view.read::<PiolaStress>().unwrap(), view.read::<DeformationGradient>().unwrap());
            let (x, temperature) =
                (view.read::<ReferencePosition>().unwrap(), view.read::<Temperature>().unwrap());
            let mut largest = 0.0_f64;
            for row in rows {
                let rise = temperature[row].0 - (300.0 + 50.0 * (PI * x[row].0.x / 0.01).cos());
                let expected = GAMMA * DENSITY * SPECIFIC_HEAT * rise;
                assert!(f[row].0.abs_diff_eq(DMat3::IDENTITY, 1e-12));
                let p = -(stress[row].0.x_axis.x + stress[row].0.y_axis.y + stress[row].0.z_axis.z) / 3.0;
                // The last step has conducted after its stress.
                assert!((p - expected).abs() < 2e6, "{law} {formulation}: {p} {expected}");
                largest = largest.max(expected);
            }
            assert!(largest > 5e7, "{largest}");
        }
    }
}
