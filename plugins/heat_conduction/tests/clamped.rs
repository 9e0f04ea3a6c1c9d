//! Beside supports, too, the heat of plastic work and of friction is a part of that work, and bars conduct as
//! long as they are between their clamps.

use std::f64::consts::PI;

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, ReferencePosition, Temperature};

fn simulation(text: String) -> Simulation {
    let registry = Registry::standard().with(heat_conduction::register);
    let (scene, source) = parse(Source::new("clamped.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &registry).unwrap_or_else(|e| panic!("{e}"))
}

/// A metal block that one side shears, held `within` a part or by a `face`; another one slides on it.
fn sheared(formulation: &str, support: &str) -> Simulation {
    simulation(format!(
        r#"(dimension: Two,
            materials: {{"metal": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Linear(yield_stress: 1e8, modulus: 1e9), heating: (specific_heat: 900, temperature: 300, taylor_quinney: 0.8))}},
            bodies: [
                (name: "block", material: "metal", shape: Box(min: (0, 0), max: (0.008, 0.004)), spacing: 0.0005, formulation: {formulation}),
                (name: "slider", material: "metal", shape: Box(min: (0, 0.004), max: (0.003, 0.006)), spacing: 0.0005, formulation: TotalLagrangian, velocity: (50, 0)),
            ],
            conditions: [
                Fix(on: Select(body: "block", {support})),
                Velocity(on: Select(body: "block", face: MaxX), value: (None, "-50*smoothstep(t/1e-6)")),
                Velocity(on: Select(body: "slider", face: MaxY), value: (50, "-2*smoothstep(t/1e-6)")),
            ],
            contacts: [Contact(between: ("block", "slider"), friction: 0.2, friction_heat: 0.7)],
            plugins: [heat_conduction(conductivity: 200)],
            time: (end: 2e-5))"#
    ))
}

#[test]
fn heat_beside_supports_is_a_part_of_the_work() {
    for formulation in ["TotalLagrangian", "UpdatedLagrangian"] {
        for support in ["within: Box(min: (-1, -1), max: (0.0021, 1))", "face: MinX"] {
            let mut sim = sheared(formulation, support);
            sim.run(|_| true).unwrap();
            let of = |account: &str| sim.ledger().total_named(account);
            let (plastic, friction, heat) = (of("plastic_work"), of("friction"), of("heat"));
            let expected = 0.8 * plastic + friction;
            assert!(friction > 0.02 * plastic && plastic > 0.0, "{friction} J {plastic} J");
            let error = (heat - expected) / expected;
            assert!(error.abs() < 1e-3, "{formulation} {support}: {heat} J, {expected} J");
        }
    }
}

/// A cosine along a bar that is clamped `within` its ends. Particles in the planes
/// of the clamps were a part of the bar, which conducted 16 % too slowly.
#[test]
fn a_bar_between_clamps_conducts_at_the_rate_of_the_closed_form() {
    const LENGTH: f64 = 0.05;
    // Of a diffusivity of 4 m2/s.
    let rate = 4.0 * (PI / LENGTH).powi(2);
    for formulation in ["TotalLagrangian", "UpdatedLagrangian"] {
        let end = 1.0 / rate;
        let mut sim = simulation(format!(
            r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e9, poisson: 0.3)}},
                bodies: [(name: "bar", material: "soft", shape: Box(min: (-0.01, 0), max: (0.06, 0.01)), spacing: 0.0025, formulation: {formulation})],
                conditions: [Fix(on: Select(within: Box(min: (-1, -1), max: (0, 1)))), Fix(on: Select(within: Box(min: (0.05, -1), max: (1, 1))))],
                plugins: [heat_conduction(conductivity: 2e6, specific_heat: 500, temperature: "300 + 10*cos(pi*x/{LENGTH})")],
                time: (end: {end:?}))"#
        ));
        sim.run(|_| true).unwrap();
        let (view, rows) = sim.world().body_view(BodyId(0));
        let (x, now) = (view.read::<ReferencePosition>().unwrap(), view.read::<Temperature>().unwrap());
        let (mut product, mut square) = (0.0, 0.0);
        for row in rows.filter(|&row| (0.001..LENGTH - 0.001).contains(&x[row].0.x)) {
            let shape = (PI * x[row].0.x / LENGTH).cos();
            product += shape * (now[row].0 - 300.0) / 10.0;
            square += shape * shape;
        }
        let found = -(product / square).ln() / sim.clock().time;
        assert!((found / rate - 1.0).abs() < 3e-3, "{formulation}: {found} 1/s, {rate} 1/s");
    }
}
