//! Shapes of rigid bodies.

use crate::assembly::build;
use crate::plugin::Registry;
use crate::rigid::RigidBodies;
use crate::scene::{SceneError, Source, parse};
use crate::simulation::Simulation;

/// A tee of two boxes that touch, over a strip.
fn tee(contacts: &str) -> Result<Simulation, SceneError> {
    let text = format!(
        r#"(dimension: Two, gravity: (0.0, -10.0), materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
            bodies: [
                (name: "tee", material: "wood", shape: Union([Box(min: (-0.1, 0.1), max: (0.1, 0.14)), Box(min: (-0.02, 0.0), max: (0.02, 0.1))]), spacing: 0.01, formulation: Rigid()),
                (name: "strip", material: "wood", shape: Box(min: (-0.2, -0.3), max: (0.2, -0.25)), spacing: 0.01, formulation: TotalLagrangian),
            ],
            {contacts} time: (end: 0.1))"#
    );
    let (scene, source) = parse(Source::new("tee.ron", text))?;
    build(&scene, &source, &Registry::standard())
}

#[test]
fn a_rigid_body_that_touches_nothing_may_have_any_shape() {
    let mut sim = tee("").unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    let bodies = sim.resources().get::<RigidBodies>();
    let tee = bodies.iter().next().expect("a body");
    // 80 cm2 about 0.12 m and 40 cm2 about 0.05 m, after a fall of g t^2 / 2.
    let height = (80.0 * 0.12 + 40.0 * 0.05) / 120.0 - 0.05;
    assert!((tee.state.center.y - height).abs() < 1e-4, "{}", tee.state.center);
    assert!((tee.mass - 500.0 * 0.012).abs() < 1e-9, "{}", tee.mass);
}

#[test]
fn a_rigid_body_that_touches_needs_a_surface_such_as_a_polygon() {
    let error = tee(r#"contacts: [(between: ("tee", "strip"))],"#).err().expect("an error").to_string();
    assert!(
        error.contains("the parts of the union touch each other") && error.contains("`Polygon`"),
        "{error}"
    );
}
