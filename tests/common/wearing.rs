//! Grains in a flow that wear the floor of their channel: fluid, rigid bodies, an Eulerian solid that fails,
//! removal, contact in a period.

use meshless::scene::Source;

/// A channel of 40 x 28 micrometres with a step on its floor, against which a disc and a square are carried.
#[allow(dead_code, reason = "tests share this file, each takes what it needs")]
pub fn wearing() -> Source {
    let disc = "Sphere(center: (6e-6, 14e-6), radius: 4e-6)";
    let square = "Rotate(shape: Box(min: (2.4e-5, 1.4e-5), max: (3.2e-5, 2.2e-5)), angle_degrees: 25, about: (2.8e-5, 1.8e-5))";
    let (floor, step) =
        ("Box(min: (0, -4e-6), max: (4e-5, 8e-6))", "Box(min: (1.2e-5, 8e-6), max: (2.4e-5, 1.4e-5))");
    let text = format!(
        r#"(dimension: Two, domain: (min: (0, -1e-4), max: (4e-5, 1e-4), periodic: [X]),
            materials: {{"carrier": Fluid(density: 1000, viscosity: 2e-3, sound_speed: 1500), "acrylic": PMMA(), "iron": Steel(density: 7870)}},
            bodies: [
                (name: "fluid", material: "carrier", spacing: 2e-6, velocity: (100, 0), formulation: Fluid(pressure: 4e7),
                 shape: Difference(Box(min: (0, 8e-6), max: (4e-5, 2.8e-5)), Union([{step}, {disc}, {square}])),
                 plugins: [density_diffusion(), particle_shifting()]),
                (name: "floor", material: "acrylic", spacing: 2e-6, shape: Union([{floor}, {step}]), formulation: Eulerian(),
                 plugins: [hourglass_control(),
                           failure(criterion: JohnsonCook(d1: -1.751, d2: 2.32, d3: -0.773, d4: -0.0491, reference_rate: 1e-3), then: RemovedAtSurface)]),
                (name: "top", material: "none", spacing: 2e-6, shape: Box(min: (0, 2.8e-5), max: (4e-5, 3.6e-5)), formulation: Wall(slip: No, suction: true)),
                (name: "grain 1", material: "iron", spacing: 2e-6, shape: {disc}, formulation: Rigid(), velocity: (100, 0)),
                (name: "grain 2", material: "iron", spacing: 2e-6, shape: {square}, formulation: Rigid(), velocity: (100, 0)),
            ],
            contacts: [Contact(between: ("grain*", "floor"), law: Penalty(), restitution: 0.5, surface: Particles),
                       Contact(between: ("grain*", "top"), law: Penalty(), restitution: 0.5, friction: 0.1, surface: Particles),
                       Contact(between: ("grain*", "grain*"), law: Penalty(factor: 0.05), restitution: 0.5)],
            conditions: [Fix(on: Select(body: "floor", within: Box(min: (-1, -1), max: (1, 2e-6)))),
                         MeanVelocity(bodies: ["fluid", "grain*"], value: (100.0, None))],
            time: (end: 1e-6))"#
    );
    Source::new("wearing.ron", text)
}
