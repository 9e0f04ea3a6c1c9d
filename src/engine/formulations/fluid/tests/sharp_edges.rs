//! Rigid bodies with sharp edges in a drop: what the fluid does to them is what they do to the fluid.

use glam::DVec3;

use super::{column, double};
use crate::formulations::fluid::FlowCloud;
use crate::rigid::RigidBodies;
use crate::simulation::Simulation;
use crate::world::{Force, Mass, Position, Velocity};

const BOX: &str = "Box(min: (-0.3, -0.2), max: (0.3, 0.2))";
const PLATE: &str = "Box(min: (-0.4, -0.05), max: (0.4, 0.05))";
/// In space.
const BLOCK: &str = "Box(min: (-0.2, -0.1, -0.2), max: (0.2, 0.1, 0.2))";

/// A drop that moves, turns and is stretched, with a body in it that turns faster, its edges ahead.
fn drop_around(shape: &str, viscosity: &str, spacing: f64) -> Simulation {
    let space = shape == BLOCK;
    let (name, spin, start) = if space {
        ("Three", "(1, -1, 2)", "(\"0.3 - y\", \"0.1 + 0.5*x\", \"0.5*y\")")
    } else {
        ("Two", "(0, 0, 2)", "(\"0.3 - y\", \"0.1 + 0.5*x\")")
    };
    let (center, radius) = if space { ("(0, 0, 0)", 0.5) } else { ("(0, 0)", 0.8) };
    double(&format!(
        r#"(dimension: {name}, materials: {{"oil": Fluid(density: 1000.0, sound_speed: 10.0{viscosity}),
                "rubber": NeoHookean(density: 1500.0, young: 2.0e5, poisson: 0.3)}},
            bodies: [
                (name: "oil", material: "oil", spacing: {spacing}, formulation: Fluid(pressure: "0"),
                 shape: Difference(Sphere(center: {center}, radius: {radius}), {shape})),
                (name: "core", material: "rubber", spacing: {spacing}, formulation: Rigid(spin: {spin}), shape: {shape}),
            ],
            conditions: [InitialVelocity(on: Select(body: "oil"), value: {start})],
            time: (end: 0.3, sub_steps: 1))"#
    ))
}

/// Momentum, and angular momentum about a point, of fluid and body.
fn momenta(sim: &Simulation, about: DVec3) -> [DVec3; 2] {
    let (x, v) = (column::<Position>(sim, 0), column::<Velocity>(sim, 0));
    let m = column::<Mass>(sim, 0);
    let mut sums = [DVec3::ZERO; 2];
    for k in 0..x.len() {
        sums[0] += m[k].0 * v[k].0;
        sums[1] += m[k].0 * (x[k].0 - about).cross(v[k].0);
    }
    for body in sim.resources().get::<RigidBodies>().iter() {
        let momentum = body.mass * body.state.velocity;
        sums[0] += momentum;
        sums[1] += (body.state.center - about).cross(momentum) + body.state.angular_momentum;
    }
    sums
}

#[test]
fn bodies_with_sharp_edges_and_the_fluid_around_keep_their_momenta() {
    let about = DVec3::new(0.7, -0.4, 0.0);
    for viscosity in ["", ", viscosity: 30.0"] {
        for shape in [BOX, PLATE] {
            let mut sim = drop_around(shape, viscosity, 0.05);
            sim.start().expect("a start");
            let before = momenta(&sim, about);
            sim.run(|_| true).expect("a run");
            let after = momenta(&sim, about);
            let errors = [0, 1].map(|k| (after[k] - before[k]).length() / before[k].length());
            assert!(errors[0] < 1e-12, "{shape}{viscosity}: {errors:?}");
            // Friction in a fluid without spin is not central; that of this water is nothing.
            assert!(errors[1] < 1e-9, "{shape}{viscosity}: {errors:?}");
            let balance = sim.ledger().relative_error().abs();
            assert!(balance < 1e-3, "{shape}{viscosity}: {balance}");
        }
    }
}

/// In every step, about any point: the moments of the forces on the fluid are the opposite of the torque on
/// the body, edges and all.
#[test]
fn the_torque_on_a_body_with_sharp_edges_is_that_on_the_fluid() {
    for shape in [BOX, PLATE, BLOCK] {
        let spacing = if shape == BLOCK { 0.1 } else { 0.05 };
        let mut sim = drop_around(shape, ", viscosity: 30.0", spacing);
        let mut largest = 0.0_f64;
        sim.run(|sim| {
            let (x, f) = (column::<Position>(sim, 0), column::<Force>(sim, 0));
            let (mut force, mut torque, mut size) = (DVec3::ZERO, DVec3::ZERO, 0.0);
            for (x, f) in x.iter().zip(&f) {
                force += f.0;
                torque += x.0.cross(f.0);
                size += x.0.length() * f.0.length();
            }
            let bodies = sim.resources().get::<RigidBodies>();
            let state = &bodies[0].state;
            force += state.force;
            torque += state.center.cross(state.force) + state.torque;
            largest = largest.max(state.torque.length());
            assert!(force.length() < 1e-11 * size, "{shape}: {force} of {size}");
            assert!(torque.length() < 1e-11 * size, "{shape}: {torque} of {size}");
            sim.clock().step < 40
        })
        .expect("a run");
        assert!(largest > 1.0, "{shape}: {largest} N m");
        assert!(sim.resources().get::<FlowCloud>().builds() > 0);
    }
}
