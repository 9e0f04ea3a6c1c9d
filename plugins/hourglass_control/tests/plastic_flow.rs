//! The control under plastic flow: viscous form against a naive sum, balance of the energy that softening
//! releases, the switch.

use glam::{DMat2, DVec2, DVec3};
use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{
    BodyId, Column, DeformationGradient, Force, HourglassModulus, PlasticStrain, Position, ReferencePosition,
    ReferenceVolume, Velocity, YieldStress,
};

const SUPPORT: f64 = 0.241;

/// A block of metal with E 1 Pa, nu 0.3, density 1 kg/m3, yield stress 0.01 Pa.
fn simulation(plugins: &str, rest: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"m": J2(density: 1, young: 1, poisson: 0.3, hardening: Linear(yield_stress: 0.01, modulus: 0.02))}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.0, 0.6)), spacing: 0.1,
                      formulation: TotalLagrangian, plugins: [{plugins}])],
            {rest} time: (end: 10, step: Adaptive(factor: 0.25)))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(hourglass_control::register);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

fn column<C: Column>(sim: &Simulation) -> Vec<C> {
    sim.world().body_view(BodyId(0)).0.read::<C>().expect("a column").to_vec()
}

/// A start with rough displacements and velocities.
fn rough(plugins: &str) -> Simulation {
    let mut sim = simulation(plugins, "");
    {
        let (view, _) = sim.world().body_view(BodyId(0));
        for x in view.write::<Position>().expect("places").iter_mut() {
            x.0 += DVec3::new((31.0 * x.0.x + 7.0 * x.0.y).sin(), (13.0 * x.0.y - 29.0 * x.0.x).cos(), 0.0)
                * 0.02;
        }
        for (k, v) in view.write::<Velocity>().expect("velocities").iter_mut().enumerate() {
            v.0 = DVec3::new((5.0 * k as f64).sin(), (11.0 * k as f64).cos(), 0.0);
        }
    }
    sim.start().expect("a start");
    sim
}

#[test]
fn the_viscous_force_is_that_of_eq_33() {
    let zeta = 3.0;
    let with = rough("hourglass_control(form: Viscous, zeta: 3)");
    let without = column::<Force>(&rough(""));
    let vectors = |column: Vec<DVec3>| -> Vec<DVec2> { column.iter().map(|v| v.truncate()).collect() };
    let reference = vectors(column::<ReferencePosition>(&with).iter().map(|row| row.0).collect());
    let x = vectors(column::<Position>(&with).iter().map(|row| row.0).collect());
    let v = vectors(column::<Velocity>(&with).iter().map(|row| row.0).collect());
    let volume: Vec<f64> = column::<ReferenceVolume>(&with).iter().map(|row| row.0).collect();
    let gradient: Vec<DMat2> =
        column::<DeformationGradient>(&with).iter().map(|row| DMat2::from_mat3(row.0)).collect();
    // Spiky kernel in two dimensions: W' = -30 / (pi H^5) (H - r)^2. Bulk modulus of E 1, nu 0.3: 1/1.2.
    let slope = |r: f64| 30.0 / (std::f64::consts::PI * SUPPORT.powi(5)) * (SUPPORT - r).powi(2);
    let (c, h) = ((1.0_f64 / 1.2).sqrt(), 0.5 * SUPPORT);
    let mut forces = 0;
    let mut net = DVec2::ZERO;
    for i in 0..x.len() {
        let mut wanted = DVec2::ZERO;
        for j in (0..x.len()).filter(|&j| j != i && reference[i].distance(reference[j]) < SUPPORT) {
            // In the convention of the paper: vectors from j to i.
            let (x_ij, v_ij, big) = (x[i] - x[j], v[i] - v[j], reference[i] - reference[j]);
            let error = (gradient[i] + gradient[j]) * 0.5 * big - x_ij;
            if v_ij.dot(x_ij) * error.dot(x_ij) < 0.0 {
                let grad_w = x_ij / x_ij.length() * -slope(big.length());
                let share = error.length() / big.length();
                let strength = zeta * volume[i] * volume[j] * share * c * h;
                wanted += grad_w * (strength * v_ij.dot(x_ij) / x_ij.length_squared());
                forces += 1;
            }
        }
        let found = (column::<Force>(&with)[i].0 - without[i].0).truncate();
        assert!(
            (found - wanted).length() < 1e-6 * (wanted.length() + 1e-4),
            "{i}: {found} instead of {wanted}"
        );
        net += found;
    }
    assert!(forces > 100 && net.length() < 1e-15, "{forces} {net}");
}

/// A bar that hits a wall, and the balance error over the largest energy at the end.
fn impact(plugins: &str) -> Simulation {
    let conditions = r#"conditions: [InitialVelocity(on: Select(body: "b"), value: ("-0.06", "0.01*x")),
        Symmetry(plane: X, at: 0.0, side: Above)],"#;
    let mut sim = simulation(plugins, conditions);
    sim.run(|sim| sim.clock().time < 3.0).expect("a run");
    let yielded = column::<PlasticStrain>(&sim).iter().filter(|row| row.0 > 0.0).count();
    assert!(yielded > 10, "{yielded} particles have yielded");
    sim
}

#[test]
fn what_softening_releases_is_booked() {
    let sim = impact("hourglass_control()");
    let released = sim.ledger().total_named("hourglass_released");
    let error = sim.ledger().balance_error();
    assert!(released > 0.0 && error.abs() < 0.2 * released, "released {released}, error {error}");
    assert!(sim.ledger().relative_error().abs() < 2e-3);
}

#[test]
fn yielded_particles_resist_with_their_yield_stress_if_wanted() {
    let sim = impact("hourglass_control()");
    let rows = column::<HourglassModulus>(&sim).into_iter().zip(column::<PlasticStrain>(&sim));
    for ((modulus, strain), strength) in rows.zip(column::<YieldStress>(&sim)) {
        assert_eq!(modulus.0, if strain.0 > 0.0 { strength.0 } else { 1.0 });
    }
    let stiff = impact("hourglass_control(after_yield: Young)");
    assert!(column::<HourglassModulus>(&stiff).iter().all(|row| row.0 == 1.0));
    assert_eq!(stiff.ledger().total_named("hourglass_released"), 0.0);
    let most = |sim: &Simulation| column::<PlasticStrain>(sim).iter().fold(0.0, |most, row| row.0.max(most));
    let (flowing, held) = (most(&sim), most(&stiff));
    assert!(held < 0.9 * flowing, "an elastic control suppresses the flow: {held} against {flowing}");
}

#[test]
fn viscous_forms_only_take_energy() {
    for form in ["Viscous", "Combined"] {
        let sim = impact(&format!("hourglass_control(form: {form})"));
        let taken = sim.ledger().total_named("hourglass_viscosity");
        assert!(taken > 0.0, "{form}");
        assert!(sim.ledger().relative_error().abs() < 2e-3, "{form}: {}", sim.ledger().relative_error());
    }
    let stored = impact("hourglass_control(form: Viscous)").ledger().total_named("hourglass");
    assert_eq!(stored, 0.0);
}
