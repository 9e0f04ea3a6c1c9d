//! Gaps between a solid and its image at a symmetry plane or a period.
//!
//! A body that ends less than half of a spacing before a plane or a period counts as one that ends at it: it
//! continues in its image. The gap is then filled by what is beside it, and the body too soft there.

use crate::notation::{number, quantity};
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::scene::Axis;
use crate::shapes::Region;
use crate::symmetry::{Repeat, periods_of};

/// Smallest gap over the spacing that is worth a word: of 0.2, a bar of 20 spacings is 1 % longer under a
/// load, of 0.4 a quarter.
const NOTABLE: f64 = 0.25;

/// Warns of the bodies that end notably before such a plane or period, or beyond a period.
pub(super) fn warn(sim: &mut SimBuilder<'_>) {
    let mut texts = Vec::new();
    for body in sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid) {
        texts.extend(at_planes(body, sim));
        let periods = periods_of(body, sim);
        texts.extend(periods.iter().filter_map(|period| at_period(body, period)));
    }
    texts.into_iter().for_each(|text| sim.warn(text));
}

fn at_planes(body: &BodyPlan, sim: &SimBuilder<'_>) -> Vec<String> {
    let planes: Vec<_> =
        sim.mirror_planes().into_iter().filter(|plane| plane.bodies.contains(body.id)).collect();
    // A shape may be a mesh, which is read from its file.
    if planes.is_empty() {
        return Vec::new();
    }
    let shape = &sim.scene().bodies[body.id.0].shape;
    let Ok(region) = shape.region(sim.dimension(), sim.folder(), "shape") else { return Vec::new() };
    let of = |axis: usize, at: f64| {
        let gap = before_plane(body, &*region, axis, at)?;
        Some(format!(
            "body `{}` ends {} before the symmetry plane {:?} = {}, {:.1} of its spacings, and is joined to its mirror image across that gap; let it end at the plane",
            body.name,
            quantity(gap, "m"),
            name(axis),
            number(at),
            gap / body.spacing
        ))
    };
    planes.iter().filter_map(|plane| of(plane.axis, plane.at)).collect()
}

/// The notable gap between most of the outermost particles and a plane, m.
fn before_plane(body: &BodyPlan, region: &dyn Region, axis: usize, at: f64) -> Option<f64> {
    let places = body.sites.iter().map(|site| site.position);
    let beside = places.filter(|x| (x[axis] - at).abs() < body.spacing);
    let mut gaps: Vec<f64> = beside
        .map(|mut x| {
            x[axis] = at;
            region.distance(x)
        })
        .collect();
    gaps.sort_unstable_by(f64::total_cmp);
    gaps.get(gaps.len() / 2).copied().filter(|gap| *gap > NOTABLE * body.spacing)
}

fn at_period(body: &BodyPlan, period: &Repeat) -> Option<String> {
    let Repeat::Period { axis, length, .. } = *period else { return None };
    let gap = length - body.bounds.extent()[axis];
    (gap.abs() > NOTABLE * body.spacing).then(|| {
        format!(
            "body `{}` is {} {} than the period along {:?}, {:.1} of its spacings, and is joined to itself there; make them equally long",
            body.name,
            quantity(gap.abs(), "m"),
            if gap > 0.0 { "shorter" } else { "longer" },
            name(axis),
            gap.abs() / body.spacing
        )
    })
}

fn name(axis: usize) -> Axis {
    [Axis::X, Axis::Y, Axis::Z][axis]
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    /// Warnings of a body with a spacing of 0.1 m.
    fn told(shape: &str, rest: &str) -> usize {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [(name: "b", material: "m", shape: {shape}, spacing: 0.1, formulation: TotalLagrangian)],
                {rest}, time: (end: 1))"#
        );
        let (scene, source) = parse(Source::new("gap.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.warnings().iter().filter(|text| text.contains("is joined to it")).count()
    }

    #[test]
    fn bodies_that_end_before_a_plane_or_a_period_are_warned_of() {
        let bar = |gap: f64| format!("Box(min: ({gap:?}, 0), max: ({:?}, 1))", gap + 2.0);
        let plane = "conditions: [Symmetry(plane: X, at: 0)]";
        assert_eq!([0.0, 0.02, 0.04].map(|gap| told(&bar(gap), plane)), [0, 0, 1]);
        for half in [
            "Difference(Sphere(center: (0, 0), radius: 1), HalfSpace(point: (0, 0), normal: (1, 0)))",
            "Rotate(shape: Box(min: (0, 0), max: (2, 1)), angle_degrees: 90, about: (0.5, 0.5))",
        ] {
            assert_eq!(told(half, plane), 0, "{half}");
        }
        let period = |length: f64| format!("domain: (min: (0, -9), max: ({length:?}, 9), periodic: [X])");
        assert_eq!([2.0, 2.02, 2.04, 2.2].map(|length| told(&bar(0.0), &period(length))), [0, 0, 1, 0]);
    }
}
