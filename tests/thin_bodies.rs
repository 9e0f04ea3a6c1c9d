//! Deformable bodies that are two particles thick, alone and in a fluid, whose lattice need not fit theirs.

mod common;

use common::{momentum, simulation};
use meshless::scene::Source;
use meshless::simulation::Simulation;

/// A body that fills `shape` in a fluid around it, in a square that is periodic along both axes; formulation
/// and stabilizers in `body`.
fn in_fluid(shape: &str, lattice: &str, body: &str, end: f64) -> String {
    format!(
        r#"Scene(dimension: Two, domain: (min: (-1, -1), max: (1, 1), periodic: [X, Y]),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "m": NeoHookean(density: 2000.0, young: 1e8, poisson: 0.3)}},
            bodies: [
                Body(name: "water", material: "water", spacing: 0.05, formulation: Fluid(pressure: "500+300*sin(pi*x)*cos(pi*y)"), lattice: {lattice},
                     plugins: [density_diffusion(), artificial_viscosity(alpha: 0.02, beta: 0.0)],
                     shape: Difference(Box(min: (-1, -1), max: (1, 1)), {shape})),
                Body(name: "body", material: "m", spacing: 0.05, {body}, shape: {shape}),
            ],
            time: (end: {end:?}))"#
    )
}

/// The lattice of the plate is stepped, that of the water follows its faces: particles start half a spacing
/// from the particles at its two ends. As soon as the plate had deformed, these repelled them as spheres,
/// with an energy that nothing had supplied, a hundred times that of the flow.
#[test]
fn water_beside_the_ends_of_a_stepped_plate_is_not_repelled_by_what_it_starts_in() {
    let (c, s) = (20f64.to_radians().cos(), 20f64.to_radians().sin());
    let corners = [(-0.6, -0.05), (0.6, -0.05), (0.6, 0.05), (-0.6, 0.05)];
    let corners = corners.map(|(x, y)| format!("({:.6}, {:.6})", x * c - y * s, x * s + y * c));
    let plate = format!("Polygon(points: [{}])", corners.join(", "));
    for formulation in ["TotalLagrangian", "UpdatedLagrangian", "Eulerian"] {
        let body = format!("formulation: {formulation}, plugins: [hourglass_control()]");
        let scene = in_fluid(&plate, "BodyFitted(iterations: 10)", &body, 0.01);
        let mut sim = simulation(&Source::new("plate.ron", scene));
        sim.start().expect("a start");
        let start = sim.ledger().total_named("compression");
        sim.run(|_| true).expect("a run");
        let (ledger, error) = (sim.ledger(), sim.ledger().relative_error());
        let given = ledger.total_named("wall_pressure");
        assert!(
            given.abs() < 5e-3 * start && error.abs() < 5e-3,
            "{formulation}: {given} of {start} J, {error}"
        );
        let (sum, size) = momentum(&sim);
        assert!(sum.length() < 1e-7 * size, "{formulation}: {sum} of {size}");
    }
}

/// Blocks of two by two particles and a ring that is two thick, whose lattice is stepped, had sub-steps that
/// were too long with the damping of sub-steps: they gained a thousand times the energy of the flow.
#[test]
fn small_and_stepped_bodies_in_a_fluid_take_stable_sub_steps() {
    let ring = "Difference(Sphere(center: (0, 0), radius: 0.6), Sphere(center: (0, 0), radius: 0.5))";
    for (shape, formulation) in [
        ("Box(min: (0, 0), max: (0.1, 0.1))", "TotalLagrangian"),
        ("Box(min: (0, 0), max: (0.1, 0.1))", "Eulerian"),
        (ring, "TotalLagrangian"),
    ] {
        let scene = in_fluid(shape, "Regular", &format!("formulation: {formulation}"), 0.03);
        let mut sim = simulation(&Source::new("block.ron", scene));
        sim.start().expect("a start");
        let start = sim.ledger().total_named("compression");
        sim.run(|_| true).expect("a run");
        let (error, damped) = (sim.ledger().relative_error(), sim.ledger().total_named("coupling_damping"));
        assert!(error.abs() < 0.02 && damped < 0.1 * start, "{shape}, {formulation}: {error}, {damped} J");
        let (sum, size) = momentum(&sim);
        assert!(sum.length() < 1e-7 * size, "{shape}, {formulation}: {sum} of {size}");
    }
}

/// The breathing of a square of four and of a cube of eight particles has more than twice the stiffness that
/// steps of thick bodies allow for: nearly incompressible ones ended the run in the fourth step.
#[test]
fn small_nearly_incompressible_bodies_vibrate() {
    for (dimension, size) in [("Two", "(0.1, 0.1)"), ("Three", "(0.1, 0.1, 0.1)")] {
        for formulation in ["TotalLagrangian", "UpdatedLagrangian", "Eulerian"] {
            for plugins in ["", "hourglass_control()"] {
                let (zero, velocity) = match dimension {
                    "Two" => ("(0, 0)", r#"("0.01*x", "0.013*y")"#),
                    _ => ("(0, 0, 0)", r#"("0.01*x", "0.013*y", "0.02*z")"#),
                };
                let scene = format!(
                    r#"Scene(dimension: {dimension}, materials: {{"m": NeoHookean(density: 2000.0, young: 1e8, poisson: 0.45)}},
                        bodies: [Body(name: "b", material: "m", spacing: 0.05, formulation: {formulation}, plugins: [{plugins}],
                                      shape: Box(min: {zero}, max: {size}))],
                        conditions: [InitialVelocity(on: Select(), value: {velocity})],
                        time: (end: 0.03))"#
                );
                let mut sim = simulation(&Source::new("grain.ron", scene));
                sim.start().expect("a start");
                let stored = |sim: &Simulation| {
                    ["kinetic", "strain"].iter().map(|name| sim.ledger().total_named(name)).sum::<f64>()
                };
                let start = stored(&sim);
                sim.run(|_| true).expect("a run");
                let end = stored(&sim);
                // The leapfrog conserves less, by up to a quarter of the squared phase of a step.
                assert!(end < 2.0 * start, "{dimension}, {formulation}, {plugins}: {end} of {start} J");
            }
        }
    }
}
