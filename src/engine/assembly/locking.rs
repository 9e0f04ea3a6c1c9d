//! Nearly incompressible solids that are too few particles thick.
//!
//! Where such a body bends, the volume at each particle can be kept only by a motion that its neighbours
//! allow: with few particles across it is too stiff. Short cantilevers, 4, 8 and 16 across, are 14, 3 and 1 %
//! stiffer with nu = 0.49 than with 0.3, 43, 6 and 1 % with 0.499, and 69, 26 and 3 % with 0.4999.

use rayon::prelude::*;

use crate::materials::{ElasticConstants, Law};
use crate::notation::quantity_to;
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};

/// Bulk over shear modulus from which on bodies count as nearly incompressible: nu = 0.49.
const NEARLY: f64 = 49.0;
/// Particles across for an error of some 5 % in bending at that ratio, and the exponent with which they grow
/// with it: 6.5, 10 and 15 for nu = 0.49, 0.499 and 0.4999.
const ACROSS: f64 = 6.5;
const EXPONENT: f64 = 0.18;

/// Warns of them.
pub(super) fn warn(sim: &mut SimBuilder<'_>) {
    let solids = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let texts: Vec<String> = solids.filter_map(|body| of_body(body, sim)).collect();
    texts.into_iter().for_each(|text| sim.warn(text));
}

fn of_body(body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<String> {
    let Law::Solid(law) = &body.material.law else { return None };
    let ElasticConstants { bulk, shear, poisson, .. } = *law.elastic();
    if bulk < NEARLY * shear {
        return None;
    }
    let needed = (ACROSS * (bulk / (NEARLY * shear)).powf(EXPONENT)).ceil();
    let across = particles_across(body, sim)?;
    (across < needed).then(|| {
        let other = if needed > ACROSS.ceil() {
            format!(", or state a ratio of 0.49, which needs {:.0}", ACROSS.ceil())
        } else {
            String::new()
        };
        format!(
            "body `{}` is nearly incompressible (Poisson's ratio {}) and some {across:.0} particles thick: where it bends it is too stiff, as thin bodies then lock; give it {needed:.0} or more{other}",
            body.name,
            quantity_to(poisson, "1", 5),
        )
    })
}

/// Twice the largest depth below the surface over the spacing.
fn particles_across(body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<f64> {
    let shape = &sim.scene().bodies[body.id.0].shape;
    let region = shape.region(sim.dimension(), sim.folder(), "shape").ok()?;
    let depth = body.sites.par_iter().map(|site| -region.distance(site.position));
    let deepest = depth.max_by(f64::total_cmp)?;
    // Seven layers and eight have their deepest particles at the same depth.
    Some((2.0 * deepest / body.spacing + 0.5).ceil())
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    fn warnings(poisson: f64, across: f64) -> Vec<String> {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: {poisson:?})}},
                bodies: [(name: "b", material: "m", shape: Rotate(shape: Box(min: (0, 0), max: (3, {:?})), angle_degrees: 30),
                          spacing: 0.1, formulation: TotalLagrangian)],
                time: (end: 1))"#,
            0.1 * across
        );
        let (scene, source) = parse(Source::new("rubber.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.warnings().to_vec()
    }

    fn told(poisson: f64, across: f64) -> bool {
        warnings(poisson, across).iter().any(|text| text.contains("nearly incompressible"))
    }

    /// A body of that ratio was told to state it.
    #[test]
    fn a_ratio_is_advised_where_another_one_is_stated() {
        for (poisson, advised) in [(0.49, false), (0.499, true)] {
            let texts = warnings(poisson, 4.0);
            let text = texts.iter().find(|text| text.contains("nearly incompressible")).expect("a warning");
            assert_eq!(text.contains("a ratio of 0.49,"), advised, "{text}");
        }
    }

    #[test]
    fn thin_bodies_that_are_nearly_incompressible_are_warned_of() {
        for (poisson, [few, enough]) in [(0.491, [4.0, 8.0]), (0.499, [8.0, 12.0]), (0.4999, [12.0, 16.0])] {
            assert!(told(poisson, few), "{poisson}");
            assert!(!told(poisson, enough), "{poisson}");
        }
        assert!(!told(0.48, 2.0));
    }
}
