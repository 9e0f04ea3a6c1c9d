//! S17: impact of rubber rings on a wall and on each other.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::Mass;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, momentum, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S17",
    title: "rubber rings on a wall and against each other",
    resolutions: &[8, 12, 16],
    ci_resolution: 8,
    run: rubber_rings,
};

const REFERENCE: &str = include_str!("../../../tests/validation/rubber_rings/reference.csv");
const SOURCE: &str = "spectral elements, reference.csv";
/// Initial velocity, m/s.
const SPEED: f64 = 0.59;
/// Velocity of the centre of mass after the rebound, over that before it.
const REBOUND: f64 = 0.79382281;

/// Compared formulations and stabilizers.
const RUNS: [(&str, &str, &str); 2] = [
    ("TL", "TotalLagrangian", "hourglass_control()"),
    ("UL", "UpdatedLagrangian(update: Every(3))", "hourglass_control()"),
];

fn scene(across: usize, formulation: &str, plugin: &str) -> Result<Template> {
    Template::new(
        "tests/validation/rubber_rings/scene.ron",
        include_str!("../../../tests/validation/rubber_rings/scene.ron"),
    )
    .set("bodies.ring.spacing", 0.01 / across as f64)?
    .set("bodies.ring.formulation", formulation)?
    .set("bodies.ring.plugins", format!("[{plugin}]"))
}

fn rubber_rings(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for (name, formulation, plugin) in RUNS {
        let wall = scene(across, formulation, plugin)?.build(registry)?;
        checks.extend(self::checks(&format!("{name}, wall"), wall)?);
        let other = format!(
            r#"Body(name: "wall", material: "rubber", shape: Ring(center: (-0.08, 0.0), inner: 0.03, outer: 0.04), spacing: {},
                lattice: Concentric, formulation: {formulation}, velocity: ({SPEED}, 0.0), plugins: [{plugin}])"#,
            0.01 / across as f64
        );
        let pair = scene(across, formulation, plugin)?
            .set("bodies[1]", other)?
            .set("conditions", "[]")?
            .build(registry)?;
        checks.extend(self::checks(&format!("{name}, two"), pair)?);
    }
    Ok(checks)
}

fn checks(case: &str, mut simulation: Simulation) -> Result<Vec<Check>> {
    let ring = body(&simulation, "ring")?;
    let top = MaterialPoint::new(&simulation, ring, DVec3::new(0.0, 0.04, 0.0))?;
    let mass = {
        let (view, rows) = simulation.world().body_view(ring);
        view.read::<Mass>()?[rows].iter().map(|mass| mass.0).sum::<f64>()
    };
    let mut bulge = Record::default();
    let balance = run(&mut simulation, |simulation| {
        bulge.push(simulation.clock().time, top.displacement(simulation)?.y);
        Ok(())
    })?;
    let reference = Record::read(REFERENCE, "t_s", "uy_top")?;
    let ((time, most), (time_reference, most_reference)) = (bulge.maximum()?, reference.maximum()?);
    let speed = momentum(&simulation, [ring])?.x / mass;
    let name = |what: &str| format!("{case}: {what}");
    let near = |what: &str, found, reference, most, unit| {
        Check::new(name(what), found, reference, Tolerance::Relative(most), unit, SOURCE)
    };
    Ok(vec![
        near("bulge of the top", most, most_reference, 0.03, "m"),
        near("time of it", time, time_reference, 0.05, "s"),
        near("rebound", speed / SPEED, REBOUND, 0.05, "v0"),
        balance.check_of(case, Kind::Abrupt),
    ])
}
