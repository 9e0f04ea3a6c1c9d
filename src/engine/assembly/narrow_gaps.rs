//! Gaps in solids that are narrower than their kernels reach.
//!
//! Neighbours are found by distance alone. Particles on both sides of a slot, a notch or a slit that is
//! narrower than that are neighbours, and the body hangs together there as if nothing had been cut out of
//! it: a square with a slit through half of its width, one spacing wide, is as stiff as one without.

use glam::DVec3;
use rayon::prelude::*;

use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::notation::{number, quantity};
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::shapes::Region;

/// Depth of the particles on the sides of a gap, over the spacing.
const OUTERMOST: f64 = 1.0;
/// Cosine of the largest angle between two sides that count as those of a gap: those of a wide notch are
/// close to each other at its root alone.
const PARALLEL: f64 = 0.9;
/// Smallest step along the way between two particles, over the spacing: slits may be thin.
const SMALLEST_STEP: f64 = 1e-5;
/// Length of the sides of a gap over the support radius, in space its area over the square of that, from
/// which on it matters.
const MIN_SIDES: f64 = 2.0;

/// What lies between two neighbours on both sides of a gap.
#[derive(Clone, Copy)]
struct NarrowGap {
    /// Its middle, m.
    middle: DVec3,
    /// Distance of its sides, m.
    width: f64,
}

/// Warns of the bodies with such gaps.
pub(super) fn warn(sim: &mut SimBuilder<'_>) {
    let solids = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let texts: Vec<String> = solids.filter_map(|body| of_body(body, sim)).collect();
    texts.into_iter().for_each(|text| sim.warn(text));
}

fn of_body(body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<String> {
    let support = body.support?;
    let shape = &sim.scene().bodies[body.id.0].shape;
    let region = shape.region(sim.dimension(), sim.folder(), "shape").ok()?;
    let gaps = gaps(body, support, &*region);
    let axes = sim.dimension().count();
    if (gaps.len() as f64) < MIN_SIDES * (support / body.spacing).powi(axes as i32 - 1) {
        return None;
    }
    let widest = gaps.iter().max_by(|a, b| a.width.total_cmp(&b.width))?;
    // With so many layers left out, the two sides are farther from each other than the support wherever the
    // lattice lies.
    let layers = (support / body.spacing).floor().max(1.0);
    let at =
        widest.middle.to_array().map(|x| number((x / body.spacing * 100.0).round() * 0.01 * body.spacing));
    Some(format!(
        "body `{}` has a gap {} wide at ({}), and its particles have neighbours up to {} away: those on both sides of the gap are neighbours, and the body hangs together there as if it were filled; use a spacing of {} or less, or make the gap {} wide",
        body.name,
        quantity(widest.width, "m"),
        at[..axes].join(", "),
        quantity(support, "m"),
        quantity(widest.width / layers, "m"),
        quantity(layers * body.spacing, "m")
    ))
}

/// For every particle on the side of a gap with a neighbour on its other side, the narrowest such gap.
fn gaps(body: &BodyPlan, support: f64, region: &dyn Region) -> Vec<NarrowGap> {
    let smallest = SMALLEST_STEP * body.spacing;
    let outward = |x: DVec3| {
        let slope = |axis: DVec3| region.distance(x + smallest * axis) - region.distance(x - smallest * axis);
        DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)).normalize_or_zero()
    };
    let is_outermost = |x: &DVec3| region.distance(*x) > -OUTERMOST * body.spacing;
    let outermost = body.sites.par_iter().map(|site| site.position).filter(is_outermost);
    let (places, normals): (Vec<DVec3>, Vec<DVec3>) = outermost.map(|x| (x, outward(x))).unzip();
    let mut list = NeighborList::default();
    // A fault of the search is reported where the neighbours of the body are listed.
    let cloud = Cloud::uniform(&places, support);
    if NeighborSearch::default().within(cloud, 0.0, &Periodic::NONE, &mut list).is_err() {
        return Vec::new();
    }
    // The way between two particles is looked at where their sides face each other, which those of most
    // bodies never do.
    let between = |k: usize, j: usize| {
        let (from, to, normal) = (places[k], places[j], normals[k]);
        let face = normal.dot(normals[j]) < -PARALLEL && normal.dot(to - from) > 0.0;
        face.then(|| gap(region, from, to, normal, smallest)).flatten()
    };
    let of = |k: usize| {
        let gaps = list.row(k).iter().filter_map(|&j| between(k, j as usize));
        gaps.min_by(|a, b| a.width.total_cmp(&b.width))
    };
    (0..places.len()).into_par_iter().filter_map(of).collect()
}

/// The gap between two points of a region, beside a side with that outward normal. `smallest` is the smallest
/// step on the way, m.
fn gap(region: &dyn Region, from: DVec3, to: DVec3, normal: DVec3, smallest: f64) -> Option<NarrowGap> {
    let (length, along) = (from.distance(to), (to - from).normalize_or_zero());
    // The way on from there to the next point on the other side of the surface.
    let leave = |start: f64, outside: bool| {
        let mut way = start;
        while way < length {
            let distance = region.distance(from + way * along);
            if (distance > 0.0) == outside && distance != 0.0 {
                return Some(way);
            }
            way += distance.abs().max(smallest);
        }
        None
    };
    let out = leave(0.0, true)?;
    let back = leave(out, false)?;
    Some(NarrowGap { middle: from + 0.5 * (out + back) * along, width: (back - out) * along.dot(normal) })
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    /// Warnings of gaps in a shape with a spacing of 0.1 m.
    fn told(dimension: &str, shape: &str, formulation: &str) -> usize {
        let text = format!(
            r#"(dimension: {dimension}, materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [(name: "b", material: "m", shape: {shape}, spacing: 0.1, formulation: {formulation})],
                time: (end: 1))"#
        );
        let (scene, source) = parse(Source::new("gap.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.warnings().iter().filter(|text| text.contains("as if it were filled")).count()
    }

    fn slit(width: f64) -> String {
        let (low, high) = (1.0 - 0.5 * width, 1.0 + 0.5 * width);
        format!("Difference(Box(min: (0, 0), max: (2, 2)), Box(min: (-1, {low:?}), max: (1, {high:?})))")
    }

    /// A slit between two rows. Where it takes out the rows beside it, those left are three spacings apart.
    #[test]
    fn gaps_that_kernels_reach_across_are_warned_of() {
        for formulation in ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()"] {
            let of = [1e-5, 0.01, 0.099].map(|width| told("Two", &slit(width), formulation));
            assert_eq!(of, [1; 3], "{formulation}");
            assert_eq!([0.11, 0.2, 0.4].map(|width| told("Two", &slit(width), formulation)), [0; 3]);
        }
        let apart = |gap: f64| {
            format!("Union([Box(min: (0, 0), max: (1, 1)), Box(min: ({:?}, 0), max: (2, 1))])", 1.0 + gap)
        };
        assert_eq!([0.1, 0.2].map(|gap| told("Two", &apart(gap), "TotalLagrangian")), [1, 0]);
        let bar = "Box(min: (0, 0, 0), max: (1, 1, 1))";
        let cut = |width: f64| {
            format!("Difference({bar}, Box(min: (-1, 0.5, -1), max: (0.6, {:?}, 2)))", 0.5 + width)
        };
        assert_eq!([0.01, 0.2].map(|width| told("Three", &cut(width), "TotalLagrangian")), [1, 0]);
    }

    /// Sides that touch, holes, corners and the roots of notches are no gaps.
    #[test]
    fn other_concave_shapes_are_not_warned_of() {
        for shape in [
            "Union([Box(min: (0, 0), max: (1, 1)), Box(min: (1, 0), max: (2, 2))])",
            "Difference(Box(min: (0, 0), max: (2, 2)), Sphere(center: (1, 1), radius: 0.15))",
            "Ring(center: (0, 0), inner: 0.2, outer: 1.0)",
            "Polygon(points: [(0, 0), (2, 0), (2, 2), (1.3, 2), (1, 1), (0.7, 2), (0, 2)])",
        ] {
            assert_eq!(told("Two", shape, "TotalLagrangian"), 0, "{shape}");
        }
        for shape in [
            "Tube(from: (0, 0, 0), to: (0, 0, 1), inner: 0.2, outer: 0.6)",
            "Difference(Box(min: (0, 0, 0), max: (1, 1, 1)), Sphere(center: (0.5, 0.5, 1), radius: 0.3))",
        ] {
            assert_eq!(told("Three", shape, "TotalLagrangian"), 0, "{shape}");
        }
    }
}
