//! From the points of a probe to those of them that are at a surface.

use glam::DVec3;

use super::points::{PointBelow, SurfacePoints};
use super::shifts::shifts;
use crate::fields::ChosenField;
use crate::kernels::Kernel;
use crate::plugin::{BodyPlan, Distances, Offer, SimBuilder};
use crate::record::probe::stencil::Stencil;
use crate::shapes::Facets;
use crate::skins::{SelectedFacet, Skin};
use crate::symmetry::{Repeat, maps_of, repeats_of};

/// Distance from a symmetry plane, or the end of a period, over the spacing up to which a facet lies in it.
const ON_PLANE: f64 = 1e-3;
/// Depth over the spacing up to which particles of the outermost layer take part in the value at a point.
const NEAR: f64 = 2.0;
/// Length of facets over the spacing: on curved surfaces their normals are exact at their middles alone.
const LENGTH: [f64; 2] = [0.125, 0.5];
/// Depth of the second layer over the spacing: only the stress of the first one has a traction.
const SECOND: f64 = 1.5;

/// Cosine of the angle to the normal at a point up to which a facet is of the same side of the body: a
/// particle near an edge, or of a thin body, carries others too.
const FACING: f64 = 0.5;

/// Where a point lies, with the point of the surface above it, the outward normal there, and its depth, m.
#[derive(Clone, Copy)]
struct SurfacePlace {
    point: DVec3,
    foot: DVec3,
    normal: DVec3,
    depth: f64,
}

/// Points of a body where a field is measured.
pub(in crate::record::probe) struct MeasuredPoints<'a> {
    pub body: &'a BodyPlan,
    pub field: &'a ChosenField,
    pub sim: &'a SimBuilder<'a>,
}

impl MeasuredPoints<'_> {
    /// Those that are the middles of these parts of facets.
    pub fn on(&self, facets: &Facets, chosen: &[&SelectedFacet]) -> Option<SurfacePoints> {
        self.with(|repeats| {
            let place = |part: &&SelectedFacet| {
                let (center, normal) = middle(facets, part.facet as usize);
                let foot = part.middle(facets);
                let place = SurfacePlace { point: foot, foot, normal, depth: 0.0 };
                (!is_inside(center, repeats, ON_PLANE * self.body.spacing)).then_some(place)
            };
            chosen.iter().map(place).collect()
        })
    }

    /// Those that are at these places of the body.
    pub fn at(&self, points: &[DVec3]) -> Option<SurfacePoints> {
        self.with(|repeats| {
            let shape = &self.sim.scene().bodies[self.body.id.0].shape;
            let (dimension, folder) = (self.sim.dimension(), self.sim.folder());
            let length = LENGTH[dimension.count() - 2] * self.body.spacing;
            let facets = shape.facets(dimension, folder, length);
            let all = |facets: &Facets| (0..facets.corners.len()).map(|k| middle(facets, k)).collect();
            let mut open: Vec<(DVec3, DVec3)> = facets.as_ref().map(all).unwrap_or_default();
            // Beside a plane there are facets that cut the corner.
            open.retain(|(center, _)| !is_inside(*center, repeats, 0.75 * length));
            let place = |point: &DVec3| {
                let distance = |facet: &&(DVec3, DVec3)| facet.0.distance_squared(*point);
                let nearest = open.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
                nearest.map(|&(center, normal)| {
                    let depth = (center - point).dot(normal).max(0.0);
                    SurfacePlace { point: *point, foot: *point + depth * normal, normal, depth }
                })
            };
            points.iter().map(place).collect()
        })
    }

    /// Those at these places; none where the field is not one of the stress, or nothing is known of the
    /// neighbours in the body.
    fn with(&self, places: impl FnOnce(&[Repeat]) -> Vec<Option<SurfacePlace>>) -> Option<SurfacePoints> {
        let Self { body, field, sim } = *self;
        let (law, axes) = (body.solid_law().ok()?, sim.dimension().count());
        let kernel = Kernel::new(body.kernel?, axes)?;
        let support = body.support.filter(|_| field.of_stress(body.id).is_some())?;
        let repeats = repeats_of(body, support, sim).ok()?;
        let is_near = |place: &SurfacePlace| place.depth < NEAR * body.spacing;
        let places: Vec<_> = places(&repeats).into_iter().map(|place| place.filter(is_near)).collect();
        let maps = maps_of(&repeats);
        let stencils = |of: fn(&SurfacePlace) -> DVec3| {
            let points: Vec<DVec3> = places.iter().flatten().map(of).collect();
            Stencil::with_images(&points, body, axes, &maps)
        };
        let (near, feet) = (stencils(|place| place.point), stencils(|place| place.foot));
        let mut particles: Vec<u32> =
            near.iter().chain(&feet).flatten().flat_map(Stencil::particles).collect();
        particles.sort_unstable();
        particles.dedup();
        let shifts = shifts(&particles, body, &kernel, support, &maps).ok()?;
        let shift = |particle: u32| particles.binary_search(&particle).map_or(DVec3::ZERO, |k| shifts[k]);
        let surfaces = self.surfaces(&repeats);
        let mut found = near.into_iter().zip(feet);
        let point = |place: &Option<SurfacePlace>| {
            let (place, (stencil, foot)) = (place.as_ref()?, found.next()?);
            let foot = foot?;
            let carried = |(particle, map): (u32, u32)| {
                let parts = surfaces.get(particle as usize).into_iter().flatten();
                let facing = parts.map(|part| maps[map as usize].vector(*part));
                let facing = facing.filter(|part| part.dot(place.normal) > FACING * part.length());
                (particle, map, facing.sum())
            };
            Some(PointBelow {
                normal: place.normal,
                fade: (1.0 - place.depth / (SECOND * body.spacing)).max(0.0),
                stencil: stencil?.moved(shift, &maps),
                surfaces: foot.images().map(carried).collect(),
                place: foot.clone(),
                foot: foot.moved(shift, &maps),
            })
        };
        let points = places.iter().map(point).collect();
        let elastic = law.elastic();
        let coupling = elastic.lambda / (elastic.lambda + 2.0 * elastic.shear);
        let flows = law.initial_yield_stress().is_some();
        let keeps_layers = body.distances == Distances::Reference;
        let gravity = sim.gravity();
        Some(SurfacePoints { body: body.id, coupling, flows, keeps_layers, gravity, maps, points })
    }

    /// The parts that each particle carries of the surface of the body, m2 (m); none where loads act on
    /// particles.
    fn surfaces(&self, repeats: &[Repeat]) -> Vec<Vec<DVec3>> {
        let Self { body, sim, .. } = *self;
        if !body.offers(Offer::DeformedContact) {
            return Vec::new();
        }
        let shape = &sim.scene().bodies[body.id.0].shape;
        let skin = Skin::of(body, shape, repeats, sim.dimension(), sim.folder());
        skin.map(|skin| skin.surfaces_of_particles(body.sites.len())).unwrap_or_default()
    }
}

/// Whether a middle of a facet lies within that distance, m, from where the body continues.
fn is_inside(center: DVec3, repeats: &[Repeat], within: f64) -> bool {
    let is_on = |repeat: &Repeat| {
        repeat.sides().into_iter().any(|side| (center[repeat.axis()] - side).abs() < within)
    };
    repeats.iter().any(is_on)
}

/// The middle of a facet, m, and its normal.
fn middle(facets: &Facets, facet: usize) -> (DVec3, DVec3) {
    (facets.center(facet), facets.normal_and_measure(facet).0)
}
