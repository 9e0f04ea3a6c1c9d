//! Solids and tools that touch each other, by every contact law.

use meshless::scene::Source;

/// In the plane: metal between a floor and a tool that presses and shears it with friction that sticks, a
/// blade thinner than a particle that falls on it, a horseshoe that closes on itself, a disc that jumps.
pub fn touching() -> Source {
    let text = r#"(dimension: Two, gravity: (0.0, -0.1),
        materials: {
            "metal": J2(density: 1, young: 1, poisson: 0.3, hardening: Linear(yield_stress: 0.03, modulus: 0.05), eos: Linear),
            "rubber": DecoupledNeoHookean(density: 1, young: 1, poisson: 0.3),
            "steel": NeoHookean(density: 8, young: 50, poisson: 0.3),
        },
        bodies: [
            (name: "metal", material: "metal", shape: Box(min: (0, 0), max: (0.6, 0.3)), spacing: 0.05, formulation: TotalLagrangian,
             plugins: [hourglass_control(form: Viscous)]),
            (name: "horseshoe", material: "rubber", spacing: 0.05, formulation: TotalLagrangian, plugins: [hourglass_control()],
             shape: Difference(Box(min: (1, 0), max: (1.6, 0.5)), Box(min: (1.2, 0.2), max: (1.7, 0.3)))),
            (name: "floor", material: "steel", shape: Box(min: (-0.5, -0.2), max: (3, 0)), spacing: 0.05, formulation: Rigid()),
            (name: "tool", material: "steel", shape: Box(min: (0.1, 0.3), max: (0.5, 0.5)), spacing: 0.05, formulation: Rigid()),
            (name: "disc", material: "steel", shape: Sphere(center: (2.3, 0.21), radius: 0.2), spacing: 0.05, velocity: (0.3, -0.5),
             formulation: Rigid(spin: (0, 0, 2))),
            (name: "blade", material: "steel", shape: Rotate(shape: Box(min: (0.545, 0.305), max: (0.555, 0.5)), angle_degrees: 3),
             spacing: 0.005, velocity: (0.0, -0.1), formulation: Rigid()),
        ],
        contacts: [
            Contact(between: ("metal", "blade"), law: Penalty(), friction: 0.3, restitution: 0.7),
            Contact(between: ("metal", "floor"), law: Hertz(), friction: 0.8),
            Contact(between: ("metal", "tool"), law: Hertz(plane: Sphere), friction: 0.8, restitution: 0.3),
            Contact(between: ("horseshoe", "horseshoe"), law: Penalty(factor: 2.0), friction: 0.3),
            Contact(between: ("horseshoe", "floor"), law: Penalty(), friction: 0.1),
            Contact(between: ("disc", "floor"), law: Penalty(), friction: 0.3, restitution: 0.5),
        ],
        conditions: [
            Fix(on: Select(body: "floor")),
            Displacement(on: Select(body: "tool"), value: ("0.002*sin(3*t)", "-0.06*smoothstep(t/2)")),
            InitialVelocity(on: Select(body: "horseshoe"), value: (None, "-2*(x - 1.1)*(y - 0.25)*step(x - 1.2)")),
        ],
        time: (end: 10.0))"#;
    Source::new("touching.ron", text.to_owned())
}

/// In space: a block of triangles is driven into a cube of metal that stands on a plate.
pub fn tool_of_triangles() -> Source {
    let text = format!(
        r#"(dimension: Three,
            materials: {{"metal": Copper(density: 9000), "steel": Steel}},
            bodies: [
                (name: "cube", material: "metal", shape: Box(min: (0, 0, 0), max: (3e-3, 3e-3, 3e-3)), spacing: 5e-4,
                 formulation: TotalLagrangian, plugins: [hourglass_control(after_yield: Young)]),
                (name: "plate", material: "steel", shape: Box(min: (-2e-3, -2e-3, -1e-3), max: (5e-3, 5e-3, 0)), spacing: 5e-4,
                 formulation: Rigid()),
                (name: "tool", material: "steel", spacing: 2.5e-4, formulation: Rigid(),
                 shape: Translate(shape: Mesh(file: "{}/tests/scenes/meshes/box.obj", scale: 1e-3), by: (0.5e-3, 0.4e-3, 3.01e-3))),
            ],
            contacts: [Contact(between: ("cube", "tool"), law: Penalty(), friction: 0.4, restitution: 0.7),
                       Contact(between: ("cube", "plate"), law: Hertz(), friction: 0.2)],
            conditions: [Fix(on: Select(body: "plate")),
                         Velocity(on: Select(body: "tool"), value: ("5*sin(2e6*t)", None, -50))],
            plugins: [artificial_viscosity()],
            time: (end: 1e-3))"#,
        env!("CARGO_MANIFEST_DIR")
    );
    Source::new("tool_of_triangles.ron", text)
}

/// In the plane: a strip that comes down on a table, one end first. Nothing touches in the first fifty steps.
pub fn landing() -> Source {
    let text = r#"(dimension: Two,
        materials: {"rubber": DecoupledNeoHookean(density: 1, young: 1, poisson: 0.3)},
        bodies: [
            (name: "strip", material: "rubber", shape: Box(min: (0, 0.06), max: (1, 0.21)), spacing: 0.0125, formulation: TotalLagrangian,
             plugins: [hourglass_control()]),
            (name: "table", material: "rubber", shape: Box(min: (-0.5, -0.2), max: (1.5, 0)), spacing: 0.05, formulation: Rigid()),
        ],
        contacts: [Contact(between: ("strip", "table"), law: Penalty(), friction: 0.2, restitution: 0.5)],
        conditions: [
            Fix(on: Select(body: "table")),
            InitialVelocity(on: Select(body: "strip"), value: ("0.1*y", "-0.05 - 0.1*x")),
        ],
        time: (end: 10.0))"#;
    Source::new("landing.ron", text.to_owned())
}

/// A rigid ball and a rigid block, each of as many particles as the rubber and the water that they fall on:
/// every pass over particles of rigid bodies is as long as those of the others.
pub fn large_rigid_bodies() -> Source {
    let text = r#"(dimension: Two, gravity: (0.0, -9.81),
        materials: {"rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3), "wood": NeoHookean(density: 600, young: 1e9, poisson: 0.3),
                    "water": Fluid(density: 1000.0, sound_speed: 30.0)},
        bodies: [
            (name: "pad", material: "rubber", shape: Box(min: (0, 0), max: (1.0, 0.4)), spacing: 0.05, formulation: TotalLagrangian,
             plugins: [hourglass_control(), heat_conduction(conductivity: 0.2, specific_heat: 1500, temperature: "300 + 50*x")]),
            (name: "ball", material: "wood", shape: Sphere(center: (0.5, 0.72), radius: 0.32), spacing: 0.05, velocity: (0.1, -2.0),
             formulation: Rigid(spin: (0, 0, 3))),
            (name: "water", material: "water", shape: Box(min: (2, 0), max: (3.2, 0.4)), spacing: 0.05, formulation: Fluid,
             plugins: [density_diffusion()]),
            (name: "block", material: "wood", shape: Box(min: (2.2, 0.45), max: (3.0, 0.95)), spacing: 0.05, velocity: (0.0, -1.0),
             formulation: Rigid()),
            (name: "tank", material: "wall", spacing: 0.05, formulation: Wall(slip: No),
             shape: Difference(Box(min: (1.8, -0.2), max: (3.4, 1.2)), Box(min: (2, 0), max: (3.2, 2)))),
        ],
        contacts: [Contact(between: ("pad", "ball"), law: Penalty(), friction: 0.3, restitution: 0.5)],
        conditions: [Fix(on: Select(body: "pad", face: MinY))],
        plugins: [artificial_viscosity(alpha: 0.02, beta: 0.0)],
        time: (end: 10.0))"#;
    Source::new("large_rigid_bodies.ron", text.to_owned())
}
