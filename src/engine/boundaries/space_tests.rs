//! Fields of force act where bodies are.

use std::f64::consts::PI;

use glam::DVec3;

use super::tests::simulation;
use crate::simulation::Simulation;
use crate::world::{BodyId, Position, Velocity};

/// A disc of a fiftieth of its distance from the origin, which attracts it; at rest the orbit would be a
/// circle at speed 1.
fn moon(formulation: &str, place: &str, time: f64) -> Simulation {
    let text = format!(
        r#"(dimension: Two, materials: {{"rock": NeoHookean(density: 1000, young: 2e4, poisson: 0.3)}},
            bodies: [(name: "moon", material: "rock", shape: Sphere(center: (1, 0), radius: 0.02), spacing: 0.01,
                      formulation: {formulation}, velocity: (0, 0.8))],
            conditions: [BodyForce(on: Select(), value: ("-x/(x^2+y^2)^1.5", "-y/(x^2+y^2)^1.5"){place})],
            time: (end: {time:?}))"#
    );
    let mut sim = simulation(&text);
    sim.run(|_| true).expect("the run ends");
    sim
}

/// The mean place and velocity of the particles.
fn mean(sim: &Simulation) -> [DVec3; 2] {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let count = rows.len() as f64;
    let place = view.read::<Position>().expect("positions")[rows.clone()].iter().map(|x| x.0).sum::<DVec3>();
    let velocity = view.read::<Velocity>().expect("velocities")[rows].iter().map(|v| v.0).sum::<DVec3>();
    [place / count, velocity / count]
}

/// Angular momentum about the origin over the mass, m2/s.
fn angular_momentum(sim: &Simulation) -> f64 {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let count = rows.len() as f64;
    let (place, velocity) =
        (view.read::<Position>().expect("positions"), view.read::<Velocity>().expect("velocities"));
    rows.map(|row| place[row].0.cross(velocity[row].0).z).sum::<f64>() / count
}

/// A body that meets a steep field of short range, which pushes it back, has its speed as it leaves, however
/// fast it comes.
#[test]
fn a_body_is_thrown_back_by_a_steep_field_with_its_speed() {
    for speed in [1.0, 20.0] {
        let text = format!(
            r#"(dimension: Two, materials: {{"rock": NeoHookean(density: 1000, young: 2e4, poisson: 0.3)}},
                bodies: [(name: "ball", material: "rock", shape: Sphere(center: (0.9, 0), radius: 0.02), spacing: 0.01,
                          formulation: Rigid, velocity: ({speed:?}, 0))],
                conditions: [BodyForce(on: Select(), value: ("-1e6*max(x - 1, 0)", 0))], time: (end: {:?}))"#,
            0.3 / speed
        );
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("the run ends");
        let [_, velocity] = mean(&sim);
        assert!((velocity.x + speed).abs() < 0.01 * speed, "{speed}: {velocity}");
    }
}

/// Kepler: an orbit with the semi-axis 1 / (2 - v^2) closes after 2 pi a^(3/2). The disc is so small that its
/// own size changes the period by less than 1e-3.
#[test]
fn a_moon_comes_back_after_a_period() {
    let axis = 1.0 / (2.0 - 0.8f64.powi(2));
    let period = 2.0 * PI * axis.powf(1.5);
    for formulation in ["Rigid", "TotalLagrangian"] {
        let sim = moon(formulation, "", period);
        let [place, velocity] = mean(&sim);
        assert!(place.distance(DVec3::X) < 0.02, "{formulation}: {place}");
        assert!(velocity.distance(0.8 * DVec3::Y) < 0.02, "{formulation}: {velocity}");
        // No force on a particle has a moment about the centre of the field.
        let momentum = angular_momentum(&sim);
        assert!((momentum - 0.8).abs() < 1e-3, "{formulation}: {momentum}");
    }
}

/// A load that belongs to the material stays what it was at the start.
#[test]
fn a_load_in_the_reference_goes_with_the_body() {
    let time = 0.5;
    let [place, velocity] = mean(&moon("Rigid", ", place: Reference", time));
    assert!(place.distance(DVec3::new(1.0 - 0.5 * time * time, 0.8 * time, 0.0)) < 1e-3, "{place}");
    assert!(velocity.distance(DVec3::new(-time, 0.8, 0.0)) < 1e-3, "{velocity}");
}

/// A total force depends on the places at the start, which is told of a rigid body.
#[test]
fn a_force_on_a_rigid_body_that_depends_on_place_is_noticed() {
    let told = |formulation: &str, value: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"rock": NeoHookean(density: 1000, young: 2e4, poisson: 0.3)}},
                bodies: [(name: "moon", material: "rock", shape: Sphere(center: (1, 0), radius: 0.02), spacing: 0.01,
                          formulation: {formulation})],
                conditions: [Force(on: Select(), value: ("{value}", 0))], time: (end: 1))"#
        );
        simulation(&text).warnings().iter().any(|text| text.contains("at the start, however far"))
    };
    assert!(told("Rigid", "-2*x"));
    assert!(!told("Rigid", "2*sin(t)"));
    assert!(!told("TotalLagrangian", "-2*x"));
}
