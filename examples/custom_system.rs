//! A system of one's own: a field of force that pulls every particle towards a point.
//!
//! `cargo run --release --example custom_system` runs the scene below and compares with the closed form. With
//! arguments it is the whole `meshless` program, and its scenes may say `central_field(center: (0, 0),
//! frequency: 5)`.

use std::error::Error;
use std::f64::consts::TAU;
use std::process::ExitCode;

use meshless::prelude::*;

/// Pulls every particle towards a point as a spring does, f = -m omega^2 (x - center).
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct CentralField {
    /// The point \[m\].
    center: Vec3,
    /// Frequency \[Hz\] at which bodies swing through the point.
    frequency: f64,
}

impl Plugin for CentralField {
    const NAME: &'static str = "central_field";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        ParameterError::require_positive("frequency", self.frequency)?;
        let (center, omega) = (self.center.0, TAU * self.frequency);
        sim.limit_step(1.0 / omega, Self::NAME);
        sim.add_system(System::each_with_energy::<(Adds<Force>, &Mass, &Position)>(
            Stage::External,
            Self::NAME,
            sim.scope().clone(),
            EnergyAccount { name: Self::NAME, kind: AccountKind::Stored },
            move |_, (force, mass, position)| {
                let stretch = position.0 - center;
                force.0 -= mass.0 * omega * omega * stretch;
                0.5 * mass.0 * omega * omega * stretch.length_squared()
            },
        ));
        Ok(())
    }
}

fn register(registry: &mut Registry) {
    registry.plugin::<CentralField>();
}

/// A block of rubber starts at rest, 0.5 m beside the point; 0.1 s are half a period.
const SCENE: &str = r#"Scene(
    title: "Block in a central field",
    dimension: Two,
    materials: { "rubber": NeoHookean(density: 1000.0, young: 1.0e6, poisson: 0.4) },
    bodies: [
        Body(name: "block", material: "rubber", shape: Box(min: (0.45, -0.05), max: (0.55, 0.05)), spacing: 0.01,
             formulation: TotalLagrangian, plugins: [hourglass_control()]),
    ],
    plugins: [central_field(center: (0.0, 0.0), frequency: 5.0)],
    time: (end: 0.1),
)"#;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let registry = standard_plugins().with(register);
    if std::env::args().len() > 1 {
        return Ok(meshless::cli::run(registry));
    }
    let (scene, source) = parse(Source::new("central_field.ron", SCENE))?;
    let mut sim = build(&scene, &source, &registry)?;
    sim.run(|_| true)?;
    // All particles have the same mass: the mean position is the centre of mass, and it swings like one
    // particle.
    let (block, rows) = sim.world().body_view(BodyId(0));
    let position = block.read::<Position>()?;
    let mean = position[rows].iter().map(|x| x.0).sum::<DVec3>() / position.len() as f64;
    println!("centre of mass after half a period: {:.5} m, expected -0.5 m", mean.x);
    println!("energy balance: {:.1e} of the largest energy", sim.ledger().relative_error());
    assert!((mean.x + 0.5).abs() < 1e-4 && mean.y.abs() < 1e-9, "the block is at {mean}");
    assert!(sim.ledger().relative_error().abs() < 1e-3, "the energy balance does not close");
    Ok(ExitCode::SUCCESS)
}
