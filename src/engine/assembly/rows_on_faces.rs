//! Rows of particles that lie on the face between a fluid and what bounds it.
//!
//! The particles of a lattice stand for cells, whose faces are those of the shape as a rule. Where a face
//! runs through the centres of cells, as an oblique one may, the whole row on it belongs to one of the two,
//! and the flow sees the face half a row off: a channel of ten particles has a flux that is 17 % too large.

use glam::DVec3;
use rayon::prelude::*;

use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::shapes::Region;

/// Distance from a face below which a particle is on it, over the spacing.
const ON_FACE: f64 = 1e-3;
/// Distance from a face below which a particle is beside it.
const BESIDE: f64 = 0.75;
/// Particles on a face from which on they are a row.
const MIN_COUNT: usize = 8;
/// Part of the particles beside a face that are on it in a row: the curved faces of regular lattices have a
/// few by chance.
const MIN_PART: f64 = 0.2;

/// Warns of fluids with such a row beside a boundary, and of boundaries with one beside a fluid.
pub(super) fn warn(sim: &mut SimBuilder<'_>) {
    let region = |body: &BodyPlan| {
        let shape = &sim.scene().bodies[body.id.0].shape;
        shape.region(sim.dimension(), sim.folder(), "shape").ok()
    };
    let is_fluid = |body: &BodyPlan| body.kind == BodyKind::Fluid;
    if !sim.bodies().iter().any(is_fluid) {
        return;
    }
    let known: Vec<(&BodyPlan, Box<dyn Region>)> =
        sim.bodies().iter().filter_map(|body| Some((body, region(body)?))).collect();
    let mut texts = Vec::new();
    for (body, own) in &known {
        let near = near_face(body, own.as_ref());
        let beside = known.iter().filter(|(other, _)| is_fluid(body) != is_fluid(other));
        let on_face = beside.map(|(other, region)| (other, rows(&near, body.spacing, region.as_ref())));
        let found =
            on_face.filter(|(_, [on, beside])| *on >= MIN_COUNT && *on as f64 > MIN_PART * *beside as f64);
        texts.extend(found.map(|(other, [on, _])| {
            format!(
                "{on} particles of `{}` lie on its face towards `{}`, which runs through the centres of their cells: the flow sees it up to half of a spacing off; move the face by a quarter of a spacing, or use `lattice: BodyFitted()`",
                body.name, other.name
            )
        }));
    }
    texts.into_iter().for_each(|text| sim.warn(text));
}

/// Places of the particles beside the faces of a body, and whether each is on one.
fn near_face(body: &BodyPlan, own: &dyn Region) -> Vec<(DVec3, bool)> {
    let of = |x: DVec3| {
        let depth = own.distance(x).abs() / body.spacing;
        (depth < BESIDE).then_some((x, depth < ON_FACE))
    };
    body.sites.par_iter().filter_map(|site| of(site.position)).collect()
}

/// Numbers of those on a face towards another region, and of all beside such a face.
fn rows(near: &[(DVec3, bool)], spacing: f64, other: &dyn Region) -> [usize; 2] {
    let within = BESIDE * spacing;
    // First, as a flow may surround many bodies.
    let bounds = other.bounds().grown(within);
    let is_before =
        |x: DVec3| x.cmpge(bounds.min).all() && x.cmple(bounds.max).all() && other.distance(x) < within;
    let before = near.par_iter().filter(|(x, _)| is_before(*x));
    let sums = before.map(|(_, is_on)| [usize::from(*is_on), 1]);
    sums.reduce(|| [0; 2], |[a, b], [c, d]| [a + c, b + d])
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    /// Warnings of water in cells of 0.05 m, whose centres have whole multiples of that as y - x, above the
    /// line y = x + `face`.
    fn told(face: f64, lattice: &str) -> usize {
        let line = |x: f64, below: f64| format!("({x:?}, {:?})", x + face - below);
        let polygon = |below: f64, depth: f64| {
            let [a, b, c, d] = [line(-2.0, below), line(2.0, below), line(2.0, depth), line(-2.0, depth)];
            format!("Polygon(points: [{a}, {b}, {c}, {d}])")
        };
        let text = format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"w": Fluid(density: 1000, sound_speed: 30)}},
                bodies: [
                    (name: "water", material: "w", shape: Difference(Box(min: (-1, -1), max: (1, 1)), {}), spacing: 0.05, lattice: {lattice}, formulation: Fluid),
                    (name: "floor", material: "wall", shape: {}, spacing: 0.05, lattice: BodyFitted(), formulation: Wall),
                ],
                time: (end: 1))"#,
            polygon(0.0, 5.0),
            polygon(0.01, 0.4)
        );
        let (scene, source) = parse(Source::new("oblique.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.warnings().iter().filter(|text| text.contains("lie on its face towards `floor`")).count()
    }

    #[test]
    fn a_row_on_an_oblique_face_is_warned_of_and_one_beside_it_is_not() {
        assert_eq!([0.0, 0.0125, 0.025].map(|face| told(face, "Regular")), [1, 0, 0]);
        assert_eq!(told(0.0, "BodyFitted()"), 0);
    }
}
