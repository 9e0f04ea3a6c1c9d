//! Rigid bodies that are much lighter than the fluid around them.

use super::simulation;
use crate::rigid::RigidBodies;

/// A disc of a thousandth of the density of the liquid rises in a ring, whose added mass is
/// `rho pi r^2 (R^2 + r^2) / (R^2 - r^2)`. In steps of the flow alone the density fell below zero in the
/// second one: the pressure of the fluid moves such a body faster than sound crosses a particle.
#[test]
fn a_body_of_next_to_no_mass_rises_by_its_added_mass() {
    let (inner, outer, gravity, share, end) = (0.1_f64, 0.3_f64, 0.5, 1e-3, 0.15);
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -{gravity:?}),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "foam": NeoHookean(density: {:?}, young: 1e8, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", spacing: 0.02, lattice: Concentric, shape: Ring(center: (0, 0), inner: {inner:?}, outer: {outer:?}),
                 formulation: Fluid(pressure: "200 - 500*y")),
                (name: "disc", material: "foam", spacing: 0.02, lattice: Concentric, shape: Sphere(center: (0, 0), radius: {inner:?}), formulation: Rigid()),
                (name: "tank", material: "wall", spacing: 0.02, lattice: Concentric, shape: Ring(center: (0, 0), inner: {outer:?}, outer: 0.36),
                 formulation: Wall(suction: true)),
            ],
            time: (end: {end:?}))"#,
        1000.0 * share
    ));
    sim.run(|_| true).expect("a run");
    let way = sim.resources().get::<RigidBodies>().iter().next().expect("a body").state.center.y;
    let added = (outer * outer + inner * inner) / (outer * outer - inner * inner);
    let exact = 0.5 * gravity * (1.0 - share) / (share + added) * end * end;
    assert!((way / exact - 1.0).abs() < 0.02, "{}", way / exact);
    // Sound of the start moves it up and down; nothing holds it.
    assert!(!sim.warnings().iter().any(|text| text.contains("presses it down")), "{:?}", sim.warnings());
}
