//! Fluid, solid and rigid bodies that act on each other in long and sub-steps.

use meshless::scene::Source;

/// A wave hits a stiff plate and carries a box, which hits plate and walls; the tank is shaken.
pub fn coupled() -> Source {
    let text = r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (-0.2, -0.2), max: (0.72, 0.55), outside: Remove),
        materials: {"water": Fluid(density: 1000.0, viscosity: 0.5),
                    "rubber": NeoHookean(density: 1100, young: 2e6, poisson: 0.3),
                    "wood": NeoHookean(density: 500, young: 1e9, poisson: 0.3)},
        bodies: [
            (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02, formulation: Fluid,
             velocity: (1.0, 0.5), plugins: [density_diffusion(), particle_shifting(), xsph(), local_damping(rate: 0.1)]),
            (name: "plate", material: "rubber", shape: Box(min: (0.5, 0.0), max: (0.56, 0.2)), spacing: 0.02,
             formulation: TotalLagrangian, plugins: [hourglass_control(), local_damping(rate: 0.1)]),
            (name: "box", material: "wood", shape: Box(min: (0.3, 0.21), max: (0.42, 0.33)), spacing: 0.02, formulation: Rigid(),
             velocity: (2.0, 0.0)),
            (name: "tank", material: "wall", shape: Difference(Box(min: (-0.1, -0.1), max: (0.7, 0.5)), Box(min: (0, 0), max: (0.6, 1))),
             spacing: 0.02, formulation: Wall(slip: No)),
        ],
        contacts: [Contact(between: ("plate", "box"), law: Penalty(), friction: 0.2, restitution: 0.6),
                   Contact(between: ("tank", "box"), law: Penalty(), friction: 0.1)],
        conditions: [Fix(on: Select(body: "plate", face: MinY)),
                     BodyForce(on: Select(), value: ("2*cos(30*t)", None)),
                     Velocity(on: Select(body: "tank"), value: ("0.2*sin(20*t)", None))],
        plugins: [artificial_viscosity(alpha: 0.02, beta: 0.0)],
        time: (end: 10.0))"#;
    Source::new("coupled.ron", text)
}
