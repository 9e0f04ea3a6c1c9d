//! Bodies that hit each other face to face and stay elastic, without artificial viscosity.
//!
//! The whole face touches within one step, so that the front behind it is as steep as the lattice allows,
//! however slow the impact: the velocities of particles oscillate behind it and overshoot by a fifth, and
//! nothing dissipates this energy. The contact of round bodies grows gradually, and plastic flow damps the
//! oscillations of harder impacts.

use glam::DVec3;

use super::approach::{Motions, is_known};
use crate::boundaries::DisplacedBodies;
use crate::materials::Law;
use crate::notation::quantity;
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::scene::Scene;
use crate::shapes::Aabb;
use crate::world::{BodyId, BodySet};

/// The plugin that takes the oscillations.
const REMEDY: &str = "artificial_viscosity";
/// Part of a mean layer that the foremost one has to have to be a face: that of a disc of eight particles
/// across has a half.
const FULL: f64 = 0.75;
/// Transits of waves through the bodies for which a front counts where a condition keeps moving one of them.
const LONGEST_FRONT: f64 = 20.0;
/// Minimum spacings that two faces have in common along each of their axes.
const MIN_COMMON: f64 = 4.0;

/// Warns of every pair of bodies that have a contact and will meet face to face. Of bodies that start away
/// from the places of their shapes it is not known.
pub(super) fn warn(sim: &mut SimBuilder<'_>) {
    let motions = Motions::of(sim);
    let displaced =
        BodySet::new(sim.extensions::<DisplacedBodies>().flat_map(|bodies| bodies.0.iter().copied()));
    let at_their_shapes =
        |(_, pair): &(usize, [BodyId; 2])| !pair.iter().any(|&body| displaced.contains(body));
    let pairs = sim.contact_pairs().filter(at_their_shapes);
    let pairs = pairs.map(|(_, pair)| pair.map(|body| sim.body(body)));
    let texts: Vec<String> = pairs.filter_map(|pair| text(pair, &motions, sim)).collect();
    texts.into_iter().for_each(|text| sim.warn(text));
}

fn text([a, b]: [&BodyPlan; 2], motions: &Motions, sim: &SimBuilder<'_>) -> Option<String> {
    let scene = sim.scene();
    let solid = |body: &&BodyPlan| body.kind == BodyKind::Solid;
    let without: Vec<&BodyPlan> =
        [a, b].into_iter().filter(|body| solid(body) && !scene.has_plugin(body.id.0, REMEDY)).collect();
    if a.id == b.id || without.is_empty() || !is_known(a) || !is_known(b) {
        return None;
    }
    let along = motions.direction([a, b], sim);
    if along == DVec3::ZERO {
        return None;
    }
    let faces = faces(a, b, along, scene)?;
    let of = [motions.of_face(a, &faces[0].numbers, sim), motions.of_face(b, &faces[1].numbers, sim)];
    let gap = -faces[0].surface - faces[1].surface;
    let (speed, touch) = motions.speed([a, b], [&of[0], &of[1]], along, gap)?;
    let is_driven = [a, b]
        .iter()
        .zip(&faces)
        .any(|(body, face)| motions.is_driven(body, &face.numbers, along, sim, touch));
    // What goes on pressing soon causes stresses beside which the front is nothing.
    if is_driven && scene.time.end - touch > LONGEST_FRONT * transit([a, b], &faces) {
        return None;
    }
    let flat = [a, b].iter().zip(&faces).all(|(body, face)| motions.is_flat(body, &face.numbers, sim, speed));
    if !flat || [a, b].into_iter().filter(solid).any(|own| yields(own, [a, b], speed)) {
        return None;
    }
    let names: Vec<String> = without.iter().map(|body| format!("`{}`", body.name)).collect();
    Some(format!(
        "`{}` and `{}` meet face to face, at {}, and stay elastic: behind so steep a front velocities and stresses oscillate and overshoot by a fifth; `{REMEDY}()` in the plugins of {} takes this",
        a.name,
        b.name,
        quantity(speed, "m/s"),
        names.join(" and ")
    ))
}

/// How long a wave takes through the thicker one of two bodies that meet, s; rigid ones have none.
fn transit(pair: [&BodyPlan; 2], faces: &[FrontLayer; 2]) -> f64 {
    let of = |(body, face): (&BodyPlan, &FrontLayer)| match body.kind {
        BodyKind::Solid => body.material.sound_speed().map_or(0.0, |sound| face.depth / sound),
        _ => 0.0,
    };
    pair.into_iter().zip(faces).map(of).fold(0.0, f64::max)
}

/// Whether a body yields by the plane wave that the impact sends into it: its stress is that of the
/// impedances, and the elastic limit under uniaxial strain is Y (lambda + 2 mu) / 2 mu.
fn yields(own: &BodyPlan, pair: [&BodyPlan; 2], speed: f64) -> bool {
    let Law::Solid(law) = &own.material.law else { return false };
    let Some(yield_stress) = law.initial_yield_stress() else { return false };
    // A rigid body has no end of impedance.
    let compliance = |body: &BodyPlan| match body.kind {
        BodyKind::Solid => {
            body.material.sound_speed().map_or(0.0, |sound| 1.0 / (sound * body.material.density))
        }
        _ => 0.0,
    };
    let elastic = law.elastic();
    let limit = yield_stress * elastic.longitudinal_modulus() / (2.0 * elastic.shear);
    speed > limit * pair.map(compliance).iter().sum::<f64>()
}

/// The foremost layers of two bodies, of which the first one comes along that direction, if they are faces
/// that meet.
fn faces(a: &BodyPlan, b: &BodyPlan, along: DVec3, scene: &Scene) -> Option<[FrontLayer; 2]> {
    let (of_a, of_b) = (FrontLayer::of(a, along)?, FrontLayer::of(b, -along)?);
    let spacing = a.spacing.max(b.spacing);
    let axes = along.any_orthonormal_pair();
    let across = [axes.0, axes.1].map(|axis| {
        let (a, b) = (of_a.extent(axis), of_b.extent(axis));
        a.1.min(b.1) - a.0.max(b.0)
    });
    // The first layer of the other one lies ahead.
    let ahead = -of_b.at - of_a.at > 0.0;
    let plane = scene.dimension == crate::scene::Dimension::Two;
    let is_wide =
        |(common, axis): (&f64, DVec3)| (plane && axis.z.abs() > 0.5) || *common >= MIN_COMMON * spacing;
    let meet = ahead && across.iter().zip([axes.0, axes.1]).all(is_wide);
    meet.then_some([of_a, of_b])
}

/// The foremost layer of a body.
struct FrontLayer {
    /// How far along the direction it lies, m.
    at: f64,
    /// How far along the direction the surface of the body lies, m: particles on a held side stand on it.
    surface: f64,
    /// How far the body goes behind it, m.
    depth: f64,
    numbers: Vec<u32>,
    places: Vec<DVec3>,
    spacing: f64,
}

impl FrontLayer {
    /// The layer that is foremost along a direction, if it is a face.
    fn of(body: &BodyPlan, along: DVec3) -> Option<Self> {
        let places = || body.sites.iter().map(|site| site.position);
        let far = |sign: f64| places().map(|x| sign * x.dot(along)).fold(f64::NEG_INFINITY, f64::max);
        let (at, spacing) = (far(1.0), body.spacing);
        let is_front = |x: &DVec3| x.dot(along) > at - 0.5 * spacing;
        let front: Vec<DVec3> = places().filter(is_front).collect();
        let numbers = places().zip(0_u32..).filter(|(x, _)| is_front(x)).map(|(_, number)| number);
        let layers = ((at + far(-1.0)) / spacing).round() + 1.0;
        let Aabb { min, max } = body.bounds;
        let surface = (at + 0.5 * spacing).min((min * along).max(max * along).element_sum());
        let is_full = front.len() as f64 >= FULL * body.sites.len() as f64 / layers;
        is_full.then(|| Self {
            at,
            surface,
            depth: layers * spacing,
            numbers: numbers.collect(),
            places: front,
            spacing,
        })
    }

    /// From where to where it goes along an axis, m.
    fn extent(&self, axis: DVec3) -> (f64, f64) {
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) =
            self.places.iter().map(|x| x.dot(axis)).fold(start, |(low, high), s| (low.min(s), high.max(s)));
        (low - 0.5 * self.spacing, high + 0.5 * self.spacing)
    }
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    const ELASTIC: &str = "StVenantKirchhoff(density: 2700, young: 7e10, poisson: 0.33)";
    const BOX: &str = "Box(min: (0, 0), max: (0.005, 0.01))";

    /// Whether a flyer of that shape, material and velocity, with a plate in front of it from x = 5.2 mm on,
    /// is warned of.
    fn warned(flyer: &str, material: &str, velocity: &str) -> bool {
        warned_under("", flyer, material, velocity)
    }

    /// The same under a condition.
    fn warned_under(condition: &str, flyer: &str, material: &str, velocity: &str) -> bool {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": {material}}},
                bodies: [(name: "flyer", material: "m", shape: {flyer}, spacing: 5e-4, formulation: TotalLagrangian, velocity: {velocity}),
                         (name: "target", material: "m", shape: Box(min: (0.0052, 0), max: (0.015, 0.01)), spacing: 5e-4, formulation: TotalLagrangian),
                         (name: "bystander", material: "m", shape: Box(min: (0, 0.1), max: (0.01, 0.11)), spacing: 1e-3, formulation: TotalLagrangian)],
                contacts: [Contact(between: ("flyer", "target"), law: Penalty())],
                conditions: [{condition}],
                time: (end: 1e-3))"#
        );
        let (scene, source) = parse(Source::new("impact.ron", text)).expect("a scene");
        let sim = build(&scene, &source, &Registry::standard()).expect("a simulation");
        sim.warnings().iter().any(|text| text.contains("face to face, at 4"))
    }

    #[test]
    fn plates_that_meet_face_to_face_and_stay_elastic_are_warned_of() {
        assert!(warned(BOX, ELASTIC, "(4, 0)"));
        let metal = |stress: f64| {
            format!(
                "J2(density: 2700, young: 7e10, poisson: 0.33, hardening: Perfect(yield_stress: {stress:?}))"
            )
        };
        // The stress is rho c v / 2 = 33 MPa, and the limit twice the yield stress.
        assert!(warned(BOX, &metal(3e7), "(4, 0)"));
        assert!(!warned(BOX, &metal(1e7), "(4, 0)"));
    }

    #[test]
    fn bodies_that_slide_past_each_other_part_or_are_round_are_not() {
        assert!(!warned(BOX, ELASTIC, "(0, 4)"));
        assert!(!warned(BOX, ELASTIC, "(-4, 0)"));
        assert!(!warned("Sphere(center: (0, 0.005), radius: 0.005)", ELASTIC, "(4, 0)"));
        // At the corner.
        assert!(!warned("Box(min: (0, -0.009), max: (0.005, 0.001))", ELASTIC, "(4, 0)"));
        // It starts a metre above the plate.
        let lifted = r#"InitialDisplacement(on: Select(body: "flyer"), value: (0, 1))"#;
        assert!(!warned_under(lifted, BOX, ELASTIC, "(4, 0)"));
        assert!(warned_under(&lifted.replace("flyer", "bystander"), BOX, ELASTIC, "(4, 0)"));
    }
}
