//! Steps of rigid bodies that lie, slide or roll: they need not be those of an impact.

use super::{centre, simulation};

/// A block of 0.2 x 0.1 m and 20 kg on a floor, at this angle, until `end`, s.
fn block(angle: f64, speed: f64, restitution: f64, end: f64) -> crate::simulation::Simulation {
    let (sin, cos) = angle.to_radians().sin_cos();
    simulation(&format!(
        r#"(dimension: Two, gravity: ({}, {}), materials: {{"s": NeoHookean(density: 1000.0, young: 1.0e8, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "s", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.02, velocity: ({speed}, 0), formulation: Rigid()),
                (name: "floor", material: "s", shape: Box(min: (-0.1, -0.1), max: (1.1, 0)), spacing: 0.02, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("block", "floor"), friction: 0.5, restitution: {restitution})],
            time: (end: {end:?}))"#,
        9.81 * sin,
        -9.81 * cos
    ))
}

#[test]
fn a_block_that_lies_on_a_floor_takes_longer_steps_than_one_that_lands() {
    let mut sim = block(0.0, 0.0, 0.2, 0.1);
    sim.run(|_| true).unwrap();
    // The springs hold the weight at the depth m g / k, and the block would swing on them at the root of k /
    // m = g / depth. An impact has some sixty steps in half a period.
    let depth = 0.05 - centre(&sim, 0).0.y;
    let per_swing = (depth / 9.81).sqrt() / sim.clock().dt;
    assert!(per_swing < 8.0, "{per_swing} steps a radian");
    assert!(per_swing > 2.0, "{per_swing} steps a radian");
    // It lies still: half of m g times the depth is in the springs, and nothing moves.
    let held = sim.ledger().total_named("contact");
    assert!((held / (0.5 * 20.0 * 9.81 * depth) - 1.0).abs() < 1e-3, "{held}");
    assert!(sim.ledger().total_named("kinetic") < 1e-6 * held, "{}", sim.ledger().total_named("kinetic"));
}

#[test]
fn a_block_that_slides_to_rest_takes_some_thousand_steps_and_stops_where_coulomb_says() {
    // Down a slope of 20 degrees at 1 m/s: v^2 / (2 g (0.5 cos - sin)).
    let mut sim = block(20.0, 1.0, 0.2, 1.0);
    sim.run(|_| true).unwrap();
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let way = centre(&sim, 0).0.x - 0.1;
    let expected = 0.5 / (9.81 * (0.5 * cos - sin));
    assert!((way / expected - 1.0).abs() < 2e-3, "{way} {expected}");
    assert!(sim.clock().step < 60_000, "{} steps", sim.clock().step);
}

#[test]
fn a_block_that_swings_on_its_springs_keeps_its_swing() {
    // It starts where the springs begin, and nothing damps it: some 290 swings between there and twice the
    // depth of balance.
    let mut sim = block(0.0, 0.0, 1.0, 0.2);
    let mut highest: f64 = 0.0;
    sim.run(|sim| {
        let is_late = sim.clock().time > 0.19;
        highest = highest.max(if is_late { sim.ledger().total_named("kinetic") } else { 0.0 });
        true
    })
    .unwrap();
    let error = sim.ledger().balance_error();
    assert!(highest > 0.0 && error.abs() < 2e-3 * highest, "{error} {highest}");
}

#[test]
fn a_floor_that_is_moved_along_x_and_y_has_no_mass_that_counts() {
    // The block falls on a floor of 10 g, held or moved at no speed: contacts cannot move either.
    let steps = |condition: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"s": NeoHookean(density: 1000.0, young: 1.0e8, poisson: 0.3)}},
                bodies: [
                    (name: "block", material: "s", shape: Box(min: (0, 0.001), max: (0.2, 0.101)), spacing: 0.02, velocity: (0, -1), formulation: Rigid()),
                    (name: "floor", material: "s", shape: Box(min: (-0.1, -0.1), max: (0.3, 0)), spacing: 0.02, formulation: Rigid(mass: 0.01)),
                ],
                conditions: [{condition}],
                contacts: [Contact(between: ("block", "floor"), restitution: 0.5)],
                time: (end: 0.01))"#
        ));
        sim.run(|_| true).unwrap();
        (sim.clock().step, centre(&sim, 0).1.y)
    };
    let held = steps(r#"Fix(on: Select(body: "floor"))"#);
    assert_eq!(steps(r#"Velocity(on: Select(body: "floor"), value: (0.0, 0.0))"#), held);
    assert!((held.1 - 0.5).abs() < 0.02, "{held:?}");
}
