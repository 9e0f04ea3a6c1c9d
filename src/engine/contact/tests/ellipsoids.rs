//! Rigid bodies that are stretched spheres: they touch like the ellipsoids that they are, however coarse the
//! particles.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::{centre, simulation};

/// Gravity, m/s2, half axes, m, and the tilt of the start, rad.
const G: f64 = 9.81;
const A: f64 = 0.2;
const B: f64 = 0.1;
const TILT: f64 = 0.07;

/// Height of the centre of an ellipse over the floor that it stands on, tilted by an angle, m.
fn height(angle: f64) -> f64 {
    (A * angle.sin()).hypot(B * angle.cos())
}

/// Angular velocity, 1/s, of the ellipse with that second moment over its mass, m2, which has rolled from the
/// tilt to an angle: (k + |arm|^2) w^2 / 2 = g (h(tilt) - h(angle)), with the arm from the centre to the
/// point that touches.
fn turning(angle: f64, k: f64) -> f64 {
    let arm = (A * A * angle.sin()).hypot(B * B * angle.cos()) / height(angle);
    (2.0 * G * (height(TILT) - height(angle)) / (k + arm * arm)).sqrt()
}

/// A quarter of the period, s.
fn quarter(k: f64) -> f64 {
    const PARTS: u32 = 2000;
    let step = FRAC_PI_2 / f64::from(PARTS);
    let phases = (0..PARTS).map(|part| (f64::from(part) + 0.5) * step);
    phases.map(|phase| TILT * phase.cos() / turning(TILT * phase.sin(), k) * step).sum()
}

/// An ellipse, and an ellipsoid with a third half axis, that rock on a floor without slipping: at a quarter
/// of the period the centre has its largest speed, at a half it rests.
#[test]
fn an_ellipse_rocks_on_a_floor_with_its_period() {
    for (dimension, axes, k, spacing) in [
        ("Two", "(0.2, 0.1)", (A * A + B * B) / 4.0, 0.04),
        ("Two", "(0.2, 0.1)", (A * A + B * B) / 4.0, 0.02),
        ("Three", "(0.2, 0.1, 0.12)", (A * A + B * B) / 5.0, 0.04),
    ] {
        let (degrees, floor) = (TILT.to_degrees(), height(TILT));
        let at = |end: f64| {
            let mut sim = simulation(&format!(
                r#"(dimension: {dimension}, gravity: (0, -{G}, 0),
                    materials: {{"steel": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
                    bodies: [
                        (name: "ellipsoid", material: "steel", spacing: {spacing}, formulation: Rigid(),
                         shape: Rotate(shape: Scale(shape: Sphere(center: (0, 0, 0), radius: 1), by: {axes}), angle_degrees: {degrees})),
                        (name: "floor", material: "steel", shape: HalfSpace(point: (0, -{floor}, 0), normal: (0, 1, 0)), spacing: 0.04, formulation: Rigid()),
                    ],
                    conditions: [Fix(on: Select(body: "floor"))],
                    contacts: [Contact(between: ("ellipsoid", "floor"), friction: 0.9, restitution: 0.5)],
                    time: (end: {end}))"#
            ));
            sim.run(|_| true).expect("a run");
            centre(&sim, 0).1.x
        };
        let (time, most) = (quarter(k), B * turning(0.0, k));
        let [middle, end] = [at(time), at(2.0 * time)];
        assert!((middle.abs() / most - 1.0).abs() < 0.02, "{dimension} {spacing}: {middle} {most}");
        assert!(end.abs() < 0.03 * most, "{dimension} {spacing}: {end} {most}");
    }
}

/// Both sides of a groove carry an ellipse that has come to rest in it.
#[test]
fn an_ellipse_comes_to_rest_in_a_groove() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0, -9.81),
            materials: {"steel": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)},
            bodies: [
                (name: "ellipsoid", material: "steel", spacing: 0.02, formulation: Rigid(),
                 shape: Scale(shape: Sphere(center: (0, 0.3), radius: 1), by: (0.2, 0.12), about: (0, 0.3))),
                (name: "groove", material: "steel", spacing: 0.02, formulation: Rigid(),
                 shape: Polygon(points: [(0, 0), (1, 1), (1, -0.3), (-1, -0.3), (-1, 0.5)])),
            ],
            conditions: [Fix(on: Select(body: "groove"))],
            contacts: [Contact(between: ("ellipsoid", "groove"), friction: 0.3, restitution: 0.2)],
            time: (end: 0.3))"#,
    );
    sim.run(|_| true).expect("a run");
    let (place, velocity) = centre(&sim, 0);
    assert!(velocity.length() < 0.02, "{velocity}");
    // Its pedal on each side: where both touch, the normals (-1, 1) and (0.5, 1) have their distances.
    let gap = |normal: DVec3, angle: f64| {
        let turned = DVec3::new(
            0.2 * normal.dot(DVec3::from_array([angle.cos(), angle.sin(), 0.0])),
            0.12 * normal.dot(DVec3::new(-angle.sin(), angle.cos(), 0.0)),
            0.0,
        );
        place.dot(normal) - turned.length()
    };
    let sides = [DVec3::new(-1.0, 1.0, 0.0), DVec3::new(0.5, 1.0, 0.0)].map(glam::DVec3::normalize);
    let worst = |angle: f64| sides.map(|side| gap(side, angle).abs()).into_iter().fold(0.0, f64::max);
    let least = (0..3600).map(|k| worst(f64::from(k) * 1e-3)).fold(f64::INFINITY, f64::min);
    assert!(least < 2e-3, "{place} {least}");
}

/// The middle of a plate that is thinner than the ellipse throws it back.
#[test]
fn an_ellipse_bounces_off_a_thin_plate() {
    let mut sim = simulation(
        r#"(dimension: Two, materials: {"steel": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)},
            bodies: [
                (name: "ellipsoid", material: "steel", spacing: 0.02, velocity: (0, -1), formulation: Rigid(),
                 shape: Scale(shape: Sphere(center: (0, 0.11), radius: 1), by: (0.2, 0.1), about: (0, 0.11))),
                (name: "plate", material: "steel", spacing: 0.02, formulation: Rigid(),
                 shape: Box(min: (-0.3, -0.08), max: (0.3, 0))),
            ],
            conditions: [Fix(on: Select(body: "plate"))],
            contacts: [Contact(between: ("ellipsoid", "plate"))],
            time: (end: 0.03))"#,
    );
    sim.run(|_| true).expect("a run");
    let (_, velocity) = centre(&sim, 0);
    assert!(velocity.distance(DVec3::Y) < 2e-3, "{velocity}");
}
