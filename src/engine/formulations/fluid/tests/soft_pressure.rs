//! Deformable bodies in still water at a pressure: they feel it at their surface.

use glam::{DMat3, DVec3};

use super::{column, double};
use crate::formulations::fluid::FlowCloud;
use crate::linalg::dyad;
use crate::simulation::Simulation;
use crate::world::{BodyId, Position, ReferenceVolume};

/// A body in a periodic box full of water at 1 kPa.
fn immersed(
    dimension: &str,
    (low, high): (&str, &str),
    shape: &str,
    formulation: &str,
    more: &str,
) -> String {
    let axes = if dimension == "Two" { "[X, Y]" } else { "[X, Y, Z]" };
    format!(
        r#"(dimension: {dimension}, domain: (min: {low}, max: {high}, periodic: {axes}),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 10.0),
                         "rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", spacing: 0.1, lattice: Regular, formulation: Fluid(pressure: "1000"),
                 shape: Difference(Box(min: {low}, max: {high}), {shape})),
                (name: "body", material: "rubber", spacing: 0.1, lattice: Regular, formulation: {formulation}, shape: {shape}),
            ], {more})"#
    )
}

/// `sum f (x) x` of the force of the water on the body over the volume of its particles, Pa: its mean stress
/// in equilibrium.
fn virial(sim: &Simulation) -> DMat3 {
    let forces = sim.resources().get::<FlowCloud>().forces_on(BodyId(1)).expect("a flow");
    let places = column::<Position>(sim, 1);
    let volume: f64 = column::<ReferenceVolume>(sim, 1).iter().map(|volume| volume.0).sum();
    let moments = forces.iter().zip(&places).map(|((force, _), x)| dyad(*force, x.0));
    moments.fold(DMat3::ZERO, |sum, moment| sum + moment) * (1.0 / volume)
}

const PLANE: (&str, &str) = ("(-1.0, -1.0)", "(1.0, 1.0)");
const SPACE: (&str, &str) = ("(-0.9, -0.9, -0.9)", "(0.9, 0.9, 0.9)");

#[test]
fn the_virial_of_pressure_is_that_of_the_volume_of_any_body() {
    for (dimension, domain, shape) in [
        ("Two", PLANE, "Sphere(center: (0, 0), radius: 0.3)"),
        ("Two", PLANE, "Sphere(center: (0, 0), radius: 0.6)"),
        ("Two", PLANE, "Box(min: (-0.3, -0.3), max: (0.3, 0.3))"),
        ("Two", PLANE, "Box(min: (-0.6, -0.1), max: (0.6, 0.1))"),
        ("Three", SPACE, "Sphere(center: (0, 0, 0), radius: 0.4)"),
        ("Three", SPACE, "Box(min: (-0.3, -0.3, -0.2), max: (0.3, 0.3, 0.2))"),
    ] {
        // On a cubic lattice sum V w x (x) x is 0.98 of the unit matrix.
        let (axes, tolerance) = if dimension == "Two" { (2, 0.02) } else { (3, 0.03) };
        for formulation in ["TotalLagrangian", "UpdatedLagrangian", "Eulerian"] {
            let mut sim = double(&immersed(dimension, domain, shape, formulation, "time: (end: 1.0)"));
            sim.start().expect("a start");
            let stress = virial(&sim) * 1e-3;
            for (k, axis) in DVec3::AXES.iter().enumerate().take(axes) {
                let along = axis.dot(stress * *axis);
                assert!((along + 1.0).abs() < tolerance, "{shape}, {formulation}: {along} along axis {k}");
            }
        }
    }
}

#[test]
fn what_the_water_does_to_a_soft_body_it_loses() {
    let disc = "Sphere(center: (0, 0), radius: 0.5)";
    for formulation in ["TotalLagrangian", "UpdatedLagrangian", "Eulerian"] {
        let time = "time: (end: 0.3, step: Adaptive(factor: 0.25))";
        let mut sim = double(&immersed("Two", PLANE, disc, formulation, time));
        sim.run(|_| true).expect("a run");
        // The body takes 4 % of the energy.
        let error = sim.ledger().relative_error();
        assert!(error.abs() < 1e-3, "{formulation}: {error}");
    }
}
