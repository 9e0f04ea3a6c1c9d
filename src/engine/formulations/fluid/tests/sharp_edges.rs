//! Rigid bodies with sharp edges in a drop: what the fluid does to them is what they do to the fluid.

use glam::DVec3;

use super::{column, double};
use crate::formulations::fluid::FlowCloud;
use crate::rigid::RigidBodies;
use crate::simulation::Simulation;
use crate::world::{Force, Mass, Position, Velocity};

const BOX: &str = "Box(min: (-0.3, -0.2), max: (0.3, 0.2))";
const PLATE: &str = "Box(min: (-0.4, -0.05), max: (0.4, 0.05))";
/// Wedges, whose inclined sides are stairs of the square lattice: single particles come within the range of
/// their repulsion, at edges where no shares of the particles nearby have their centre at the place of the
/// force.
const WEDGE: &str = "Polygon(points: [(-0.35, -0.2), (0.35, -0.2), (0.0, 0.2)])";
const ACUTE: &str = "Polygon(points: [(-0.4, -0.1), (0.4, -0.1), (0.4, 0.1)])";
/// Bodies with the lattice of theirs and of the drop: in a fitted one a particle of the acute edge is alone.
const BODIES: [(&str, &str); 6] = [
    (BOX, "Regular"),
    (PLATE, "Regular"),
    (WEDGE, "Regular"),
    (ACUTE, "Regular"),
    (ACUTE, "BodyFitted()"),
    (BLOCK, "Regular"),
];
/// In space.
const BLOCK: &str = "Box(min: (-0.2, -0.1, -0.2), max: (0.2, 0.1, 0.2))";

/// A drop that moves, turns and is stretched, with a body in it that turns faster, its edges ahead.
fn drop_around(body: (&str, &str), viscosity: &str) -> Simulation {
    drop_in(body, viscosity, "time: (end: 0.3, sub_steps: 1)")
}

/// The same in steps of the `time` of a scene.
fn drop_in((shape, lattice): (&str, &str), viscosity: &str, time: &str) -> Simulation {
    let space = shape == BLOCK;
    let spacing = if space { 0.1 } else { 0.05 };
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
                (name: "oil", material: "oil", spacing: {spacing}, lattice: {lattice}, formulation: Fluid(pressure: "0"),
                 shape: Difference(Sphere(center: {center}, radius: {radius}), {shape})),
                (name: "core", material: "rubber", spacing: {spacing}, lattice: {lattice}, formulation: Rigid(spin: {spin}), shape: {shape}),
            ],
            conditions: [InitialVelocity(on: Select(body: "oil"), value: {start})],
            {time})"#
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

/// Where no shares of the particles nearby fitted it, the opposite of the repulsion acted beside the particle
/// that is repelled: the angular momentum changed by 6e-4 of it around the wedge, 2e-4 around the block.
#[test]
fn bodies_with_sharp_edges_and_the_fluid_around_keep_their_momenta() {
    let about = DVec3::new(0.7, -0.4, 0.0);
    for viscosity in ["", ", viscosity: 30.0"] {
        for (shape, lattice) in BODIES {
            let mut sim = drop_around((shape, lattice), viscosity);
            sim.start().expect("a start");
            let before = momenta(&sim, about);
            sim.run(|_| true).expect("a run");
            let after = momenta(&sim, about);
            let errors = [0, 1].map(|k| (after[k] - before[k]).length() / before[k].length());
            assert!(errors[0] < 1e-12, "{shape}{viscosity}: {errors:?}");
            // Friction in a fluid without spin is not central; that of this water is nothing.
            assert!(errors[1] < 1e-12, "{shape}{viscosity}: {errors:?}");
            let balance = sim.ledger().relative_error().abs();
            assert!(balance < 1e-3, "{shape}{viscosity}: {balance}");
        }
    }
}

/// In every step, about any point: the moments of the forces on the fluid are the opposite of the torque on
/// the body, edges and all.
#[test]
fn the_torque_on_a_body_with_sharp_edges_is_that_on_the_fluid() {
    for viscosity in ["", ", viscosity: 30.0"] {
        for (shape, lattice) in BODIES {
            let mut sim = drop_around((shape, lattice), viscosity);
            let (mut largest, mut repelled) = (0.0_f64, 0);
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
                repelled += sim.resources().get::<FlowCloud>().repelled.len();
                assert!(force.length() <= 1e-11 * size, "{shape}: {force} of {size}");
                assert!(torque.length() <= 1e-11 * size, "{shape}: {torque} of {size}");
                true
            })
            .expect("a run");
            assert!(largest > 1.0, "{shape}{viscosity}: {largest} N m");
            let comes_near = viscosity.is_empty() && lattice == "Regular" && ![BOX, PLATE].contains(&shape);
            assert!(repelled > 0 || !comes_near, "{shape}: nothing is repelled");
            assert!(sim.resources().get::<FlowCloud>().builds() > 0);
        }
    }
}

/// The force of the flow is frozen in the sub-steps, while the body turns: the torque that the fluid has lost
/// and that the body has received differ, by an error of second order in the long step.
#[test]
fn in_sub_steps_the_error_of_the_angular_momentum_falls_with_the_square_of_the_step() {
    let about = DVec3::new(0.7, -0.4, 0.0);
    for viscosity in ["", ", viscosity: 30.0"] {
        let error = |factor: f64| {
            let time = format!("time: (end: 0.1, step: Adaptive(factor: {factor}))");
            let mut sim = drop_in(BODIES[0], viscosity, &time);
            sim.start().expect("a start");
            let before = momenta(&sim, about)[1];
            sim.run(|_| true).expect("a run");
            assert!(sim.sub_steps().is_some_and(|(last, _)| last > 1));
            (momenta(&sim, about)[1] - before).length() / before.length()
        };
        let errors = [1.0, 0.5, 0.25].map(error);
        assert!(errors[0] < 1e-5, "{viscosity}: {errors:?}");
        for pair in errors.windows(2) {
            assert!((3.5..4.5).contains(&(pair[0] / pair[1])), "{viscosity}: {errors:?}");
        }
    }
}
