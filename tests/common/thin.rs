//! Water on both sides of a sheet that is thinner than the support of its kernel.

use meshless::scene::Source;

/// A sheet that bends between two waters, and a thin rigid one that floats in one of them.
pub fn thin() -> Source {
    Source::new("thin.ron", TEXT)
}

/// The same with a sheet that tears, so that the waters meet through its holes.
pub fn torn() -> Source {
    let tears = "plugins: [hourglass_control(), failure(criterion: MaximumPrincipalStrain(limit: 0.004), then: Removed)]";
    Source::new("torn.ron", TEXT.replace("plugins: [hourglass_control()]", tears))
}

const TEXT: &str = r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (-0.2, -0.2), max: (0.72, 0.55), outside: Remove),
        materials: {"water": Fluid(density: 1000.0, viscosity: 0.5),
                    "rubber": NeoHookean(density: 1100, young: 2e6, poisson: 0.3)},
        bodies: [
            (name: "left", material: "water", shape: Box(min: (0, 0), max: (0.28, 0.3)), spacing: 0.02, formulation: Fluid,
             plugins: [density_diffusion()]),
            (name: "right", material: "water", shape: Box(min: (0.3, 0), max: (0.6, 0.14)), spacing: 0.02, formulation: Fluid),
            (name: "sheet", material: "rubber", shape: Box(min: (0.28, 0.0), max: (0.3, 0.36)), spacing: 0.01,
             formulation: TotalLagrangian, plugins: [hourglass_control()]),
            (name: "raft", material: "rubber", shape: Box(min: (0.36, 0.16), max: (0.52, 0.2)), spacing: 0.02,
             formulation: Rigid(mass: 2.0)),
            (name: "tank", material: "wall", shape: Difference(Box(min: (-0.1, -0.1), max: (0.7, 0.5)), Box(min: (0, 0), max: (0.6, 1))),
             spacing: 0.02, formulation: Wall(slip: No)),
        ],
        conditions: [Fix(on: Select(body: "sheet", face: MinY))],
        plugins: [artificial_viscosity(alpha: 0.02, beta: 0.0)],
        time: (end: 10.0))"#;
