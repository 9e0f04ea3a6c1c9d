//! Round bodies in steps that turn in a liquid with hardly any friction.
//!
//! Pressure has no moment about the axis of a round body. The steps of a regular lattice mesh with the
//! particles of the liquid like a gear: they stir it, and stop the body. That hardly depends on the spacing.

use glam::DVec3;

use crate::formulations::fluid::cloud::FlowCloud;
use crate::plugin::Setup;
use crate::rigid::{RigidBodies, RigidBody};
use crate::world::{Body, ReferencePosition};

/// Root mean square deviation of the depths of the outermost particles below the round outline that is a
/// stair, over the spacing: they are evenly spread from 0 to 1 in a regular lattice, 0.29, and half a spacing
/// in lattices that follow the outline.
const STEPS: f64 = 0.2;
/// Minimum number of these particles.
const MIN_COUNT: usize = 4;

/// Warns of rigid bodies with a round outline in steps that nothing holds from turning.
pub fn warn(cloud: &FlowCloud, setup: &mut Setup<'_>) {
    let Some(bodies) = setup.resources.try_get::<RigidBodies>() else { return };
    if cloud.viscosities.is_viscous {
        return;
    }
    for body in bodies.iter().filter(|body| body.may_turn() && body.nodes.turns_in_itself()) {
        let (view, rows) = setup.world.body_view(body.id);
        let Ok(places) = view.read::<ReferencePosition>() else { continue };
        let Body { name, spacing, .. } = setup.world.body(body.id);
        let depths =
            places[rows].iter().filter_map(|place| depth(body, place.0)).map(|depth| depth / spacing);
        let outermost: Vec<f64> = depths.filter(|depth| *depth < 1.0).collect();
        if outermost.len() >= MIN_COUNT && deviation(&outermost) > STEPS {
            setup.warnings.push(format!(
                "the round surface of `{name}`, which nothing holds from turning, is in the steps of its lattice: they stir the liquid, which has hardly any friction, and stop the body \
                 (a disc that spins loses a third and a fifth of its spin in a radian, 8 and 24 particles per radius, a floating log a third of its roll in half a period); give it \
                 `lattice: Concentric`, or it and the liquid `lattice: BodyFitted()`"
            ));
        }
    }
}

/// Depth of a particle below the round outline, if that is the nearest part of the surface, m.
fn depth(body: &RigidBody, place: DVec3) -> Option<f64> {
    let nearest = body.surface.closest(place);
    body.nodes.is_round(nearest.point).then_some(-nearest.signed_distance)
}

/// Root mean square deviation from the mean.
fn deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

#[cfg(test)]
mod tests {
    use crate::formulations::fluid::tests::simulation;

    /// Whether steps are told of a body in water.
    fn told(body: &str, formulation: &str, viscosity: f64) -> bool {
        let text = format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000, sound_speed: 10, viscosity: {viscosity:?}), "wood": NeoHookean(density: 500, young: 1.0e6, poisson: 0.3)}},
                domain: (min: (-0.4, -0.4), max: (0.4, 0.4), periodic: [X, Y]),
                bodies: [
                    (name: "water", material: "water", shape: Difference(Box(min: (-0.4, -0.4), max: (0.4, 0.4)), Sphere(center: (0, 0), radius: 0.15)), spacing: 0.02, formulation: Fluid),
                    (name: "log", material: "wood", {body}, spacing: 0.02, formulation: {formulation}),
                ],
                time: (end: 1.0))"#
        );
        simulation(&text).warnings().iter().any(|text| text.contains("is in the steps of its lattice"))
    }

    #[test]
    fn a_round_body_in_steps_that_may_turn_in_a_liquid_without_friction_is_warned_of() {
        let disc = "shape: Sphere(center: (0, 0), radius: 0.1)";
        let hollow = "shape: Difference(Sphere(center: (0, 0), radius: 0.1), Sphere(center: (0.02, 0.01), radius: 0.05))";
        let with = |shape: &str, lattice: &str| format!("{shape}, lattice: {lattice}");
        assert!(told(&with(disc, "Regular"), "Rigid", 0.0));
        assert!(told(&with(hollow, "Regular"), "Rigid", 0.0));
        assert!(told(&with(disc, "Hexagonal"), "Rigid", 0.0));
        for lattice in ["Concentric", "BodyFitted()", "Relaxed(seed: 1, iterations: 30)"] {
            assert!(!told(&with(disc, lattice), "Rigid", 0.0), "{lattice}");
        }
        assert!(!told(disc, "Rigid", 0.0));
        let stepped = with(disc, "Regular");
        assert!(!told(&stepped, "Rigid(rotation: Held)", 0.0));
        assert!(!told(&stepped, "Rigid", 1.0), "friction turns it");
        assert!(!told("shape: Box(min: (-0.1, -0.1), max: (0.1, 0.1))", "Rigid", 0.0));
    }
}
