//! Loads on a flow beside gravity: the pressure of walls includes them.

use glam::DVec3;

use super::{column, simulation};
use crate::formulations::fluid::FlowCloud;
use crate::kernels::{Kernel, KernelName};
use crate::simulation::Simulation;
use crate::world::{Density, Force, Mass, Position, Pressure, Velocity};

/// A tank with water that is 0.2 m high, with what acts on it, in single precision.
fn tank(gravity: &str, wall: &str, conditions: &str) -> Simulation {
    tank_in("Mixed", gravity, wall, conditions)
}

fn tank_in(precision: &str, gravity: &str, wall: &str, conditions: &str) -> Simulation {
    simulation(&format!(
        r#"(precision: {precision}, dimension: Two, gravity: {gravity}, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02,
                 formulation: Fluid(pressure: "9810*(0.2 - y)")),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall({wall}),
                 shape: Difference(Box(min: (-0.06, -0.06), max: (0.46, 0.4)), Box(min: (0, 0), max: (0.4, 1)))),
            ],
            conditions: [{conditions}], time: (end: 1.0))"#
    ))
}

fn farthest(a: &[Position], b: &[Position], shift: DVec3) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.0.distance(b.0 + shift)).fold(0.0, f64::max)
}

#[test]
fn gravity_as_a_load_is_gravity() {
    // In single precision a millionth of what gravity does in the 0.18 s of the run.
    for (precision, most) in [("Double", [1e-9, 1e-6]), ("Mixed", [1.6e-7, 1e-5])] {
        gravity_as_a_load(precision, most);
    }
}

/// `most` are the largest differences of places, m, and of pressures over the largest one.
fn gravity_as_a_load(precision: &str, most: [f64; 2]) {
    let none = r#"Force(on: Select(body: "water"), value: (0.0, 0.0))"#;
    let load = r#"BodyForce(on: Select(body: "water"), value: (0.0, "-9.81 + 0*t"))"#;
    let mut by_gravity = tank_in(precision, "(0.0, -9.81)", "", none);
    let mut by_load = tank_in(precision, "(0.0, 0.0)", "", load);
    for sim in [&mut by_gravity, &mut by_load] {
        sim.run(|sim| sim.clock().step < 300).expect("a run");
    }
    let apart = farthest(&column(&by_gravity, 0), &column(&by_load, 0), DVec3::ZERO);
    assert!(apart < most[0], "{precision}: {apart}");
    let (a, b) = (column::<Pressure>(&by_gravity, 1), column::<Pressure>(&by_load, 1));
    let differ = a.iter().zip(&b).map(|(a, b)| (a.0 - b.0).abs()).fold(0.0, f64::max);
    let largest = a.iter().map(|p| p.0).fold(0.0, f64::max);
    assert!(differ < most[1] * largest && largest > 1900.0, "{differ} {largest}");
}

#[test]
fn water_in_a_frame_that_shakes_moves_as_water_in_a_tank_that_shakes() {
    // The tank moves by 0.01 (1 - cos 12 t) from rest; in its frame the water feels minus its acceleration.
    let mut shaken = tank(
        "(0.0, -9.81)",
        "",
        r#"Velocity(on: Select(body: "tank"), value: ("0.12*sin(12*t)", 0.0)), Force(on: Select(body: "water"), value: (0.0, 0.0))"#,
    );
    let mut frame =
        tank("(0.0, -9.81)", "", r#"BodyForce(on: Select(body: "water"), value: ("-1.44*cos(12*t)", 0.0))"#);
    for sim in [&mut shaken, &mut frame] {
        sim.run(|sim| sim.clock().time < 0.2).expect("a run");
    }
    let t = shaken.clock().time;
    let shift = DVec3::X * 0.01 * (1.0 - (12.0 * t).cos());
    let apart = farthest(&column(&shaken, 0), &column(&frame, 0), shift);
    assert!(apart < 2e-4, "{apart}");
}

#[test]
fn walls_feel_a_load_that_varies_in_place() {
    for (precision, most) in [("Double", 1e-9), ("Mixed", 1e-6)] {
        a_load_that_varies(precision, most);
    }
}

fn a_load_that_varies(precision: &str, most: f64) {
    let load = |x: DVec3| DVec3::new(3.0 * x.y, -9.81 - 20.0 * x.x, 0.0);
    let mut sim = tank_in(
        precision,
        "(0.0, 0.0)",
        "suction: true",
        r#"BodyForce(on: Select(body: "water"), value: ("3*y", "-9.81 - 20*x"))"#,
    );
    sim.start().expect("a start");
    let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
    let state = sim.resources().get::<FlowCloud>().groups[0].fluid().copied().expect("a fluid");
    let (x, p) = (column::<Position>(&sim, 0), column::<Pressure>(&sim, 0));
    let (rho, m) = (column::<Density>(&sim, 0), column::<Mass>(&sim, 0));
    for (wall, found) in column::<Position>(&sim, 1).iter().zip(column::<Pressure>(&sim, 1)) {
        let (mut total, mut sum) = (0.0, 0.0);
        for k in 0..x.len() {
            let to = x[k].0 - wall.0;
            let weight = m[k].0 / rho[k].0 * kernel.w(to.length(), 0.03);
            let density = state.density + p[k].0 / state.sound_speed.powi(2);
            total += weight;
            sum += weight * (p[k].0 - density * load(x[k].0).dot(to));
        }
        let wanted = if total > 1e-10 { sum / total } else { 0.0 };
        assert!((found.0 - wanted).abs() < most * 2000.0, "{precision}: {} {wanted}", found.0);
    }
}

/// A liquid drifts through its period at 1 m/s while a force per mass `x - 1/2` across acts in the domain: on
/// its way from x_0 to x a particle gains the difference of `(x - 1/2)^2 / 2`, x within the period.
#[test]
fn a_load_acts_where_a_fluid_is_now() {
    for precision in ["Double", "Mixed"] {
        let mut sim = simulation(&format!(
            r#"(precision: {precision}, dimension: Two, domain: (min: (0, 0), max: (1, 0.4), periodic: [X, Y]),
                materials: {{"oil": Fluid(density: 1000.0, sound_speed: 10.0)}},
                bodies: [(name: "oil", material: "oil", shape: Box(min: (0, 0), max: (1, 0.4)), spacing: 0.04, velocity: (1, 0), formulation: Fluid)],
                conditions: [BodyForce(on: Select(body: "oil"), value: (0.0, "x - 0.5"))], time: (end: 2.0))"#
        ));
        let gained = |x: f64| 0.5 * (x.rem_euclid(1.0) - 0.5).powi(2);
        for end in [0.5, 1.0, 1.3] {
            sim.run(|sim| sim.clock().time < end).expect("a run");
            let t = sim.clock().time;
            let now = column::<Position>(&sim, 0);
            let wanted = now.iter().map(|x| gained(x.0.x) - gained(x.0.x - t));
            let found = column::<Velocity>(&sim, 0);
            let off = found.iter().zip(wanted).map(|(v, y)| (v.0.y - y).abs()).fold(0.0, f64::max);
            assert!(off < 0.02 * 0.125, "{precision}, {t}: {off}");
        }
    }
}

#[test]
fn a_wall_has_its_velocity_before_the_first_force() {
    let motions = [
        r#"Velocity(on: Select(body: "tank"), value: ("1.0 - 2*t", 0.0))"#,
        r#"Displacement(on: Select(body: "tank"), value: ("t - t^2", 0.0))"#,
    ];
    for motion in motions {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"oil": Fluid(density: 1000.0, sound_speed: 0.5, viscosity: 10.0)}},
                bodies: [
                    (name: "oil", material: "oil", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02, formulation: Fluid(pressure: 0.0)),
                    (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(slip: No),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (0.46, 0.26)), Box(min: (0, 0), max: (0.4, 0.2)))),
                ],
                conditions: [InitialVelocity(on: Select(body: "oil"), value: (1.0, 0.0)), {motion}], time: (end: 1.0))"#
        ));
        // Faster than its sound, but not against the tank; the friction of a wall at rest would be mu v = 10
        // N on each particle.
        sim.start().expect("a start");
        let viscous = column::<Force>(&sim, 0).iter().map(|force| force.0.length()).fold(0.0, f64::max);
        assert!(viscous < 1e-4 * 10.0, "{motion}: {viscous}");
    }
}

/// Heavier than what is below them, the particles of the surface sank into the water, which took 38 J.
/// A force on the particles in a region goes with them.
#[test]
fn a_load_on_a_part_of_a_fluid_is_warned_of() {
    let warns = |condition: &str| {
        let sim = tank("(0, -9.81)", "", condition);
        let told = "loads those particles of the fluid `water` that it selects at the start";
        sim.warnings().iter().any(|warning| warning.contains(told))
    };
    assert!(warns(r#"Traction(on: Select(body: "water", face: MaxY), value: (0, -2000))"#));
    assert!(warns(r#"Force(on: Select(body: "water", face: MaxY), value: (0, -200))"#));
    assert!(warns(
        r#"BodyForce(on: Select(body: "water", within: Box(min: (0, 0), max: (0.1, 1))), value: (1, 0))"#
    ));
    assert!(!warns(r#"Force(on: Select(body: "water"), value: (100, 0))"#));
    assert!(!warns(r#"BodyForce(on: Select(), value: ("step(0.1 - x)", 0))"#));
}

/// A velocity at the start, or an inlet, is what users mean by it.
#[test]
fn a_velocity_of_a_fluid_is_warned_of() {
    let warns = |condition: &str| {
        let sim = tank("(0, -9.81)", "", condition);
        sim.warnings().iter().any(|warning| warning.contains("drives those particles of the fluid `water`"))
    };
    assert!(warns(r#"Velocity(on: Select(body: "water", face: MinX), value: (0.1, 0))"#));
    assert!(warns(r#"Displacement(on: Select(), value: ("0.1*t*t", 0))"#));
    assert!(!warns(
        r#"Velocity(on: Select(body: "tank"), value: (0.1, 0)), InitialVelocity(on: Select(body: "water"), value: (0.1, 0))"#
    ));
}
