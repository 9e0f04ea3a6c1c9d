//! Edges of rigid bodies that cross, against the impulse of two bodies that touch in one point.

use super::rigid::momenta;
use super::{centre, simulation};
use crate::simulation::Simulation;

/// Two cubes with sides of 80 mm, of which the upper one falls at 1 m/s. Its lowest edge, between faces that
/// rise by `tilt` and 90 degrees less, is along z, at that place over the upper edge, along x, of the lower
/// one, and turned against it by `angle`.
fn cubes([x, z]: [f64; 2], angle: f64, tilt: f64) -> Simulation {
    let cube = "Box(min: (-0.04, -0.04, -0.04), max: (0.04, 0.04, 0.04))";
    let turned = |shape: &str, axis: &str, degrees: f64| {
        format!("Rotate(shape: {shape}, axis: {axis}, angle_degrees: {degrees:?}, about: (0, 0, 0))")
    };
    let (upper, lower) = (turned(cube, "(0, 0, 1)", tilt), turned(cube, "(1, 0, 0)", 45.0));
    let lower = turned(&lower, "(0, 1, 0)", angle - 90.0);
    let (sin, cos) = tilt.to_radians().sin_cos();
    // Of the corner that is lowest.
    let low = [-0.04 * (cos - sin), 0.04 * (cos + sin)];
    let mut sim = simulation(&format!(
        r#"(dimension: Three,
            materials: {{"s": NeoHookean(density: 1000, young: 1e9, poisson: 0.3)}},
            bodies: [
                (name: "upper", material: "s", shape: Translate(by: ({:?}, {:?}, {z:?}), shape: {upper}),
                 spacing: 0.01, formulation: Rigid(), velocity: (0, -1, 0)),
                (name: "lower", material: "s", shape: Translate(by: (0, {:?}, 0), shape: {lower}),
                 spacing: 0.01, formulation: Rigid()),
            ],
            contacts: [Contact(between: ("upper", "lower"))],
            time: (end: 0.004))"#,
        x - low[0],
        low[1] + 0.001,
        -0.04 * f64::sqrt(2.0),
    ));
    sim.start().expect("the scene starts");
    sim
}

#[test]
fn cubes_that_meet_edge_on_edge_part_as_an_impulse_says() {
    // At the middle of the edges, where both have a point, and between points.
    for place in [[0.0, 0.0], [0.0031, 0.0042], [0.02, 0.01]] {
        for angle in [90.0, 60.0, 35.0] {
            let mut sim = cubes(place, angle, 45.0);
            let start = momenta(&sim);
            sim.run(|_| true).expect("it runs");
            // J = 2 v / (2/m + (r_1^2 + r_2^2)/I) with the horizontal ways r from the centres to the crossing
            // of the edge along z and that which is turned against x.
            let turn = f64::to_radians(angle - 90.0);
            let [x, z] = place;
            let crossing = [x, -x * turn.tan()];
            let ways = (crossing[1] - z).powi(2) + crossing[0].powi(2) + crossing[1].powi(2);
            let expected = -1.0 + 2.0 / (2.0 + ways * 6.0 / (0.08 * 0.08));
            let velocity = centre(&sim, 0).1;
            assert!((velocity.y - expected).abs() < 2e-3, "{place:?} {angle}: {velocity} {expected}");
            assert!(velocity.x.hypot(velocity.z) < 2e-3, "{place:?} {angle}: {velocity}");
            let end = momenta(&sim);
            assert!((end.0 - start.0).length() < 1e-12 * start.0.length());
            assert!((end.1 - start.1).length() < 1e-12 * start.0.length() * 0.08);
            assert!(sim.ledger().relative_error().abs() < 2e-4, "{}", sim.ledger().relative_error());
        }
    }
}

/// An edge that is almost along a face has a part of its weight, which changes as it turns.
#[test]
fn flat_edges_that_cross_keep_energy_and_angular_momentum() {
    for tilt in [8.0, 15.0, 22.0] {
        let mut sim = cubes([0.0131, 0.0042], 70.0, tilt);
        let start = momenta(&sim);
        sim.run(|_| true).expect("it runs");
        let end = momenta(&sim);
        assert!(centre(&sim, 0).1.y > -0.9, "{tilt}: they touch");
        assert!((end.1 - start.1).length() < 1e-12 * start.0.length() * 0.08);
        assert!(sim.ledger().relative_error().abs() < 1e-3, "{tilt}: {}", sim.ledger().relative_error());
    }
}
