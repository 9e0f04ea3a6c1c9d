//! A periodic box of fluid, for the tests of the plugins that act on one.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Column};

/// Vortices that fit the box.
pub const VORTICES: &str = r#"("-cos(2*pi*x)*sin(2*pi*y)", "sin(2*pi*x)*cos(2*pi*y)")"#;

/// The box with the given precision, plugins of the fluid, lattice and initial velocity.
pub fn simulation(
    register: fn(&mut Registry),
    precision: &str,
    plugins: &str,
    (lattice, velocity): (&str, &str),
) -> Simulation {
    let text = format!(
        r#"(precision: {precision}, dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
            materials: {{"m": Fluid(density: 1.0, sound_speed: 10.0, viscosity: 0.01)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1, 1)), spacing: 0.05, lattice: {lattice},
                      formulation: Fluid(pressure: "-0.2"), plugins: [{plugins}])],
            conditions: [InitialVelocity(on: Select(), value: {velocity})],
            time: (end: 1.0))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    build(&scene, &source, &Registry::standard().with(register)).unwrap_or_else(|error| panic!("{error}"))
}

/// A column of the fluid.
pub fn column<C: Column + Copy>(sim: &Simulation) -> Vec<C> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<C>().expect("a column").to_vec()
}
