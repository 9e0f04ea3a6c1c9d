//! Invariances of whole scenes: another unit of length and time changes no bit, and a moving frame nothing
//! but rounding.
//!
//! With lengths and times scaled by one power of two, and densities, moduli and velocities as they are, every
//! quantity of a scene is scaled by a power of two, which is exact in floating-point numbers. A threshold
//! with a hidden unit, or a sum of quantities of different dimension, would change the bits.

mod common;

use std::collections::BTreeMap;

use common::simulation;
use meshless::glam::DVec3;
use meshless::scene::Source;
use meshless::simulation::Simulation;
use meshless::world::{BodyId, ParticleId, Position, Velocity};

/// Water that breaks over an elastic gate and a rigid box: shifting, diffusion, friction, sub-steps, contact.
/// `scale` is that of lengths and times, `frame` the velocity of the frame, m/s.
fn flow(precision: &str, scale: f64, frame: [f64; 2]) -> Simulation {
    let [u, w] = frame;
    let text = format!(
        r#"Scene(dimension: Two, precision: {precision}, gravity: (0.0, "-9.81/s"), parameters: {{"s": {scale:e}}},
        materials: {{
            "water": Fluid(density: 1000.0, sound_speed: 30.0, viscosity: "s*0.5"),
            "rubber": NeoHookean(density: 1100.0, young: 1.0e6, poisson: 0.4),
            "wood": NeoHookean(density: 500.0, young: 1.0e7, poisson: 0.3),
        }},
        bodies: [
            Body(name: "water", material: "water", velocity: ({u:?}, {w:?}), shape: Box(min: (0.0, 0.0), max: ("s*0.5", "s*0.5")), spacing: "s*0.025",
                 formulation: Fluid, plugins: [density_diffusion(), particle_shifting()]),
            Body(name: "box", material: "wood", velocity: ({u:?}, {w:?}), shape: Box(min: ("s*0.52", "s*0.3"), max: ("s*0.62", "s*0.4")), spacing: "s*0.025",
                 formulation: Rigid),
            Body(name: "gate", material: "rubber", velocity: ({u:?}, {w:?}), shape: Box(min: ("s*0.6", 0.0), max: ("s*0.7", "s*0.2")), spacing: "s*0.025",
                 formulation: TotalLagrangian, plugins: [hourglass_control(), artificial_viscosity()]),
            Body(name: "tank", material: "wall", spacing: "s*0.025", formulation: Wall(slip: No),
                 shape: Difference(Box(min: ("-s*0.1", "-s*0.1"), max: ("s*1.1", "s*0.7")), Box(min: (0.0, 0.0), max: ("s*1.0", "s*1.0")))),
        ],
        conditions: [
            Velocity(on: Select(body: "gate", within: Box(min: ("s*0.6", 0.0), max: ("s*0.7", "s*0.05"))), value: ({u:?}, {w:?})),
            Velocity(on: Select(body: "tank"), value: ({u:?}, {w:?})),
        ],
        contacts: [
            Contact(between: ("box", "gate"), law: Penalty(), friction: 0.2, restitution: 0.5),
            Contact(between: ("box", "tank"), law: Penalty()),
            Contact(between: ("gate", "tank"), law: Penalty()),
        ],
        time: (end: "s*0.15"))"#
    );
    simulation(&Source::new("flow.ron", text))
}

/// Three bodies in the three formulations, one of them elastic and two of metal, that hit each other and a
/// floor.
fn solids(scale: f64) -> Simulation {
    let text = format!(
        r#"Scene(dimension: Two, gravity: (0.0, "-9.81/s"), parameters: {{"s": {scale:e}}},
        materials: {{
            "rubber": NeoHookean(density: 1000.0, young: 1.0e6, poisson: 0.3),
            "metal": J2(density: 1000.0, young: 1.0e6, poisson: 0.3, hardening: Linear(yield_stress: 2.0e4, modulus: 1.0e5)),
        }},
        bodies: [
            Body(name: "a", material: "rubber", velocity: (10.0, -2.0), shape: Ring(center: (0.0, "s*0.95"), inner: "s*0.6", outer: "s*0.9"),
                 spacing: "s*0.1", formulation: TotalLagrangian),
            Body(name: "b", material: "metal", velocity: (-10.0, 0.0), shape: Ring(center: ("s*1.9", "s*1.0"), inner: "s*0.6", outer: "s*0.9"),
                 spacing: "s*0.1", formulation: UpdatedLagrangian(update: Every(10))),
            Body(name: "c", material: "metal", velocity: (0.0, -10.0), shape: Box(min: ("-s*1.0", "s*2.0"), max: ("s*1.0", "s*2.4")),
                 spacing: "s*0.1", formulation: Eulerian()),
            Body(name: "floor", material: "rubber", shape: Box(min: ("-s*2.0", "-s*0.2"), max: ("s*4.0", 0.0)), spacing: "s*0.1", formulation: Rigid),
        ],
        conditions: [Fix(on: Select(body: "floor"))],
        plugins: [hourglass_control(), artificial_viscosity()],
        contacts: [
            Contact(between: ("a", "b"), law: Penalty(), friction: 0.2, restitution: 0.5),
            Contact(between: ("a", "c"), law: Penalty(), friction: 0.2),
            Contact(between: ("a", "floor"), law: Penalty(), friction: 0.3),
            Contact(between: ("b", "floor"), law: Penalty(), friction: 0.3),
        ],
        time: (end: "s*1.0"))"#
    );
    simulation(&Source::new("solids.ron", text))
}

/// Positions and velocities of all bodies.
fn motion(sim: &Simulation) -> Vec<(DVec3, DVec3)> {
    let mut all = Vec::new();
    for body in (0..sim.world().bodies().len()).map(BodyId) {
        let (view, rows) = sim.world().body_view(body);
        let (x, v) = (view.read::<Position>().expect("places"), view.read::<Velocity>().expect("velocities"));
        all.extend(rows.map(|row| (x[row].0, v[row].0)));
    }
    all
}

fn run(sim: &mut Simulation, steps: u64) {
    sim.run(|sim| sim.clock().step < steps).unwrap_or_else(|error| panic!("{error:#}"));
}

/// Runs the scene in both units; that of the second is `scale` times as long.
fn assert_same_bits(build: impl Fn(f64) -> Simulation, scale: f64, steps: u64) {
    let (mut meters, mut scaled) = (build(1.0), build(scale));
    run(&mut meters, steps);
    run(&mut scaled, steps);
    assert_eq!(meters.clock().time * scale, scaled.clock().time);
    for (one, other) in motion(&meters).iter().zip(motion(&scaled)) {
        assert_eq!((one.0 * scale, one.1), other);
    }
}

#[test]
fn another_unit_changes_no_bit_of_a_flow() {
    for scale in [(2.0_f64).powi(12), (2.0_f64).powi(-12)] {
        assert_same_bits(|scale| flow("Mixed", scale, [0.0; 2]), scale, 250);
        assert_same_bits(|scale| flow("Double", scale, [0.0; 2]), scale, 250);
    }
}

#[test]
fn another_unit_changes_no_bit_of_solids_in_contact() {
    for scale in [(2.0_f64).powi(20), (2.0_f64).powi(-20)] {
        assert_same_bits(solids, scale, 250);
    }
}

#[test]
fn a_flow_is_the_same_in_a_moving_frame() {
    // Particles by their number: those of a fluid are sorted by their places.
    let positions = |frame: [f64; 2]| {
        let mut sim = flow("Mixed", 1.0, frame);
        sim.run(|_| true).unwrap_or_else(|error| panic!("{error:#}"));
        let moved = sim.clock().time * DVec3::new(frame[0], frame[1], 0.0);
        let (view, rows) = sim.world().body_view(BodyId(0));
        let (x, id) = (view.read::<Position>().expect("places"), view.read::<ParticleId>().expect("numbers"));
        rows.map(|row| (id[row].0, x[row].0 - moved)).collect::<BTreeMap<_, _>>()
    };
    let (rest, moving) = (positions([0.0, 0.0]), positions([8.0, -3.0]));
    let furthest = rest.iter().map(|(id, x)| x.distance(moving[id])).fold(0.0, f64::max);
    assert!(furthest < 0.02 * 0.025, "{furthest}");
}
