//! A stabilizer as a third party would write it: a pair term with its parameter, registered under a name.
//!
//! `cargo run --release --example custom_stabilizer` runs the scene below and compares with the closed form.
//! With arguments it is the whole `meshless` program, and its scenes may say `bond_viscosity(viscosity: 10)`.

use std::error::Error;
use std::f64::consts::PI;
use std::process::ExitCode;

use meshless::prelude::*;

/// Resists every change of length of a bond in proportion to its rate, compression and shear alike; turning
/// as a whole costs nothing. f_i = 2 (d + 2) eta V_i V_j w_ij (v_ij . e) e with e = x_ij / |x_ij|: to a
/// uniform rate of strain D it does the work of a viscous stress 2 eta D + eta tr(D) I.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct BondViscosity {
    /// Dynamic viscosity eta \[Pa s\].
    viscosity: f64,
}

impl Plugin for BondViscosity {
    const NAME: &'static str = "bond_viscosity";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        ParameterError::require_not_negative("viscosity", self.viscosity)?;
        let factor = 2.0 * (sim.dimension().count() as f64 + 2.0) * self.viscosity;
        for id in sim.scope_offering(Offer::PairTerms)?.iter() {
            let term = Dashpots { factor, density: sim.body(id).material.density };
            sim.add_pair_term(BodySet::new([id]), Self::NAME, term);
        }
        Ok(())
    }
}

struct Dashpots {
    factor: f64,
    density: f64,
}

impl PairTerm for Dashpots {
    type ReadI = ();
    type ReadJ = ();

    #[inline(always)]
    fn pair<A: Arithmetic>(&self, pair: &Pair<A>, (): (), (): (), rates: &mut Rates<A>) {
        let strength = self.factor * pair.volume_j * pair.weight;
        let e = pair.x_ij / pair.distance();
        rates.force += e * (strength * pair.volume_i * pair.v_ij.dot(e));
        rates.damping += strength / self.density;
    }
}

fn register(registry: &mut Registry) {
    registry.plugin::<BondViscosity>();
}

/// A free bar in its first longitudinal mode, for one period T = 2 L / sqrt(E / rho).
const SCENE: &str = r#"Scene(
    title: "Viscous bar",
    dimension: Two,
    materials: { "plastic": StVenantKirchhoff(density: 1000.0, young: 1.0e7, poisson: 0.0) },
    bodies: [
        Body(name: "bar", material: "plastic", shape: Box(min: (0.0, 0.0), max: (1.0, 0.4)), spacing: 0.02,
             formulation: TotalLagrangian, plugins: [hourglass_control()]),
    ],
    conditions: [InitialVelocity(on: Select(), value: ("0.01*cos(pi*x)", 0.0))],
    plugins: [bond_viscosity(viscosity: 1000.0)],
    time: (end: 0.02),
)"#;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let registry = standard_plugins().with(register);
    if std::env::args().len() > 1 {
        return Ok(meshless::cli::run(registry));
    }
    let (scene, source) = parse(Source::new("viscous_bar.ron", SCENE))?;
    let mut sim = build(&scene, &source, &registry)?;
    sim.start()?;
    let before = sim.ledger().stored();
    sim.run(|_| true)?;
    let left = sim.ledger().stored() / before;
    // Viscous stress 3 eta in the direction of the strain rate: the energy decays as exp(-3 eta k^2 t / rho).
    let expected = (-3.0 * 1000.0 * PI.powi(2) * 0.02 / 1000.0_f64).exp();
    println!("energy left after a period: {left:.4}, expected {expected:.4}");
    println!("booked as dissipated: {:.4} of the start", sim.ledger().total_named("bond_viscosity") / before);
    assert!((left / expected - 1.0).abs() < 0.1, "the bar is damped too much or too little");
    assert!(sim.ledger().relative_error().abs() < 1e-3, "the energy balance does not close");
    Ok(ExitCode::SUCCESS)
}
