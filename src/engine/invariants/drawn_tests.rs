//! Balances of a bar that is held or drawn by its sides along their normal, where particles carry shares of
//! their stress.

use super::Momenta;
use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, Force, PlasticStrain, Position, ReferencePosition};

const FORMULATIONS: [&str; 3] = ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()"];

/// Length and thickness of the bar, m.
const BAR: (f64, f64) = (0.02, 0.01);
/// Young's modulus, Pa; Poisson's ratio; yield stress, Pa; hardening modulus, Pa.
const METAL: (f64, f64, f64, f64) = (2e11, 0.3, 4e8, 1e9);
/// Speed of each end, m/s.
const PULL: f64 = 1.0;

/// A bar along x of that material, four particles thick, with those conditions.
fn bar(formulation: &str, material: &str, conditions: &str, end: f64) -> Simulation {
    let (length, thickness) = BAR;
    let text = format!(
        r#"(dimension: Three, materials: {{"m": {material}}}, conditions: [{conditions}], time: (end: {end:?}),
            bodies: [(name: "bar", material: "m", shape: Box(min: (0, 0, 0), max: ({length}, {thickness}, {thickness})), spacing: 0.0025,
                formulation: {formulation})])"#
    );
    let (scene, source) = parse(Source::new("drawn.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"))
}

fn elastic() -> String {
    format!("NeoHookean(density: 7850, young: {:?}, poisson: {:?})", METAL.0, METAL.1)
}

fn metal() -> String {
    let (young, poisson, yield_stress, modulus) = METAL;
    format!(
        "J2(density: 7850, young: {young:?}, poisson: {poisson}, hardening: Linear(yield_stress: {yield_stress:?}, modulus: {modulus:?}))"
    )
}

/// Sums of forces along x, N, and of their powers at the speed of the ends, W, on the particles of both
/// sides.
fn on_sides(sim: &Simulation) -> ([f64; 2], f64) {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (x, force) = (view.read::<ReferencePosition>().unwrap(), view.read::<Force>().unwrap());
    let sums = [0.0, BAR.0].map(|at| {
        let side = rows.clone().filter(|&row| (x[row].0.x - at).abs() < 1e-4 * BAR.0);
        side.map(|row| force[row].0.x).sum::<f64>()
    });
    (sums, PULL * (sums[0] - sums[1]))
}

/// In a uniaxial stress state the reaction is E A strain, at both ends.
#[test]
fn the_reaction_of_a_drawn_bar_is_that_of_its_elastic_strain() {
    let (strain, (young, poisson, ..)) = (1e-5, METAL);
    let narrow = |axis: &str| format!("\"{:?}*({axis} - 0.005)\"", -poisson * strain);
    // Up to the side at the right, whose particles the condition leaves where they are.
    let conditions = format!(
        "Fix(on: Select(face: MinX), axes: [X]), Fix(on: Select(face: MaxX), axes: [X]),
        InitialDisplacement(on: Select(), value: (\"{strain:?}*x\", {}, {}))",
        narrow("y"),
        narrow("z")
    );
    let expected = young * BAR.1 * BAR.1 * strain;
    for formulation in FORMULATIONS {
        let mut sim = bar(formulation, &elastic(), &conditions, 4e-5);
        let mut furthest = 0.0f64;
        while sim.clock().time < 4e-5 {
            sim.step().unwrap();
            let ([left, right], _) = on_sides(&sim);
            furthest = furthest.max((left / expected - 1.0).abs()).max((right / expected + 1.0).abs());
        }
        // Over two periods of the bar; what is out of balance would make it swing.
        assert!(furthest < 3e-3, "{formulation}: {furthest}");
    }
}

/// A bar that is drawn: plastic strain, work of the ends.
#[test]
fn the_work_of_the_ends_is_what_a_drawn_bar_stores_and_dissipates() {
    let (young, _, yield_stress, modulus) = METAL;
    let end = 4e-4;
    let conditions = format!(
        "Velocity(on: Select(face: MinX), value: (\"-{PULL:?}\", None, None)), Velocity(on: Select(face: MaxX), value: (\"{PULL:?}\", None, None)),
        InitialVelocity(on: Select(), value: (\"100*(x - 0.01)\", None, None))"
    );
    for (formulation, tolerance) in
        [("TotalLagrangian", 1e-3), ("UpdatedLagrangian()", 1e-3), ("Eulerian()", 5e-3)]
    {
        let mut sim = bar(formulation, &metal(), &conditions, end);
        sim.step().unwrap();
        let (mut work, mut before, mut time) = (0.0, on_sides(&sim).1, sim.clock().time);
        let held = |sim: &Simulation| sim.ledger().stored() + sim.ledger().total_named("plastic_work");
        let start = held(&sim);
        while sim.clock().time < end {
            sim.step().unwrap();
            let power = on_sides(&sim).1;
            work += 0.5 * (power + before) * (sim.clock().time - time);
            (before, time) = (power, sim.clock().time);
        }
        let error = (held(&sim) - start) / work - 1.0;
        assert!(error.abs() < tolerance, "{formulation}: {error}");
        // The stress is uniaxial: strain is that of the stress over E, and plastic.
        let strain = (1.0 + 2.0 * PULL * end / BAR.0).ln();
        let expected = (strain - yield_stress / young) / (1.0 + modulus / young);
        let (view, rows) = sim.world().body_view(BodyId(0));
        let plastic = view.read::<PlasticStrain>().unwrap();
        let mean = rows.clone().map(|row| plastic[row].0).sum::<f64>() / rows.len() as f64;
        assert!((mean / expected - 1.0).abs() < 0.02, "{formulation}: {mean} {expected}");
    }
}

/// Forces along x alone are held: momentum across and angular momentum about x are kept, whatever shares the
/// particles carry.
#[test]
fn a_bar_that_spins_while_its_sides_are_drawn_keeps_its_other_momenta() {
    let conditions = "Fix(on: Select(face: MinX), axes: [X]), Velocity(on: Select(face: MaxX), value: (\"1\", None, None)),
        InitialVelocity(on: Select(), value: (\"0\", \"3 + 2000*sin(200*x)*(z - 0.005)\", \"-2 - 2000*sin(200*x)*(y - 0.005)\"))";
    for formulation in FORMULATIONS {
        let mut sim = bar(formulation, &elastic(), conditions, 1e-4);
        sim.start().unwrap();
        let before = Momenta::of(&sim).unwrap();
        sim.run(|_| true).unwrap();
        let after = Momenta::of(&sim).unwrap();
        let linear = after.linear - before.linear;
        assert!(linear.y.hypot(linear.z) < 1e-12 * before.linear_size, "{formulation}: {linear}");
        let turned = (after.angular - before.angular).x.abs() / before.angular_size;
        assert!(
            turned < 1e-10 && linear.x.abs() > 1e-3 * before.linear_size,
            "{formulation}: {turned} {linear}"
        );
        let (view, rows) = sim.world().body_view(BodyId(0));
        let x = view.read::<Position>().unwrap();
        assert!(rows.clone().all(|row| x[row].0.is_finite()));
    }
}
