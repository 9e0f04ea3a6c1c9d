//! Selections of surfaces: the facets of a body on which a load acts or a probe measures.

use glam::DVec3;

use super::selected_facet::SelectedFacet;
use crate::plugin::{SetupError, SimBuilder};
use crate::scene::{Select, SurfacePart};
use crate::shapes::{Facets, Region, Shape};
use crate::symmetry::Repeat;
use crate::world::BodyId;

/// How far a facet may be from a plane or a surface that it is on, over the spacing.
const ON: f64 = 0.02;
/// The same of a facet of a flat side: that at the tip of a circle is parallel to it, but not on it.
const EXACT: f64 = 1e-6;
/// Steps of a ray on its way out of the box around a body.
const STEPS: usize = 200;

/// The facets of a body that a selection means, those of its `surface` or its `face`, each with the part that
/// is `within`: a load ends where the scene says, not at the next facet. Beyond `repeats` the body continues.
pub(crate) fn selected_facets(
    select: &Select,
    id: BodyId,
    facets: &Facets,
    repeats: &[Repeat],
    sim: &SimBuilder<'_>,
) -> Result<Vec<SelectedFacet>, SetupError> {
    let chosen = facets_on(select, id, facets, repeats, sim)?;
    let within = within(select, sim)?;
    let part = |facet| SelectedFacet::new(facet, facets, within.as_deref());
    Ok(chosen.into_iter().filter_map(part).collect())
}

fn within(select: &Select, sim: &SimBuilder<'_>) -> Result<Option<Box<dyn Region>>, SetupError> {
    select.within.as_ref().map(|shape| region_of(shape, "on.within", sim)).transpose()
}

fn region_of(shape: &Shape, path: &str, sim: &SimBuilder<'_>) -> Result<Box<dyn Region>, SetupError> {
    shape.region(sim.dimension(), sim.folder(), path).map_err(|error| {
        SetupError::parameter(error.path.clone(), error.message(), "give a shape of the scene's dimension")
    })
}

/// The facets of the `surface` or the `face` of a selection.
fn facets_on(
    select: &Select,
    id: BodyId,
    facets: &Facets,
    repeats: &[Repeat],
    sim: &SimBuilder<'_>,
) -> Result<Vec<u32>, SetupError> {
    let of = match &select.surface {
        Some(SurfacePart::Of(shape)) => Some(region_of(shape, "on.surface[0]", sim)?),
        _ => None,
    };
    let body = sim.body(id);
    let own = region_of(&sim.scene().bodies[id.0].shape, "shape", sim)?;
    let seen = BodyInSight { region: &*own, repeats, middle: body.bounds.center(), spacing: body.spacing };
    let tolerance = ON * body.spacing;
    let chosen = |facet: &u32| {
        let center = facets.center(*facet as usize);
        let (normal, _) = facets.normal_and_measure(*facet as usize);
        let on_surface = match &select.surface {
            Some(_) if seen.is_joined(center, normal) => false,
            None | Some(SurfacePart::All) => true,
            Some(SurfacePart::Inner) => seen.is_met(center, normal),
            Some(SurfacePart::Outer) => !seen.is_met(center, normal),
            Some(SurfacePart::Facing(direction)) => normal.dot(direction.0.normalize_or_zero()) > FACING,
            // Centres of facets of curved surfaces are behind them.
            Some(SurfacePart::Of(_)) => {
                of.as_ref().is_some_and(|region| region.distance(center).abs() < 5.0 * tolerance)
            }
        };
        let on_face = select.face.is_none_or(|face| {
            let (axis, sign) = face.outward();
            let plane = if sign > 0.0 { body.bounds.max[axis] } else { body.bounds.min[axis] };
            (center[axis] - plane).abs() < EXACT * body.spacing && sign * normal[axis] > 1.0 - EXACT
        });
        on_surface && on_face
    };
    Ok((0..facets.corners.len() as u32).filter(chosen).collect())
}

/// Cosine of the largest angle between a normal and the direction that it is to face.
const FACING: f64 = 0.7;

/// A body as it is seen from its surface, with its images.
struct BodyInSight<'a> {
    region: &'a dyn Region,
    repeats: &'a [Repeat],
    /// Middle of the body, m.
    middle: DVec3,
    spacing: f64,
}

impl BodyInSight<'_> {
    /// Whether a ray from its surface outward meets it again: then that is the surface of a hole, a bore or a
    /// notch.
    fn is_met(&self, from: DVec3, along: DVec3) -> bool {
        let bounds = self.region.bounds();
        let mut way = 0.25 * self.spacing;
        for _ in 0..STEPS {
            let x = from + way * along;
            let x = self.repeats.iter().fold(x, |x, repeat| repeat.place_seen(x, self.middle));
            if x.cmplt(bounds.min - self.spacing).any() || x.cmpgt(bounds.max + self.spacing).any() {
                return false;
            }
            let distance = self.region.distance(x);
            if distance < 0.0 {
                return true;
            }
            way += distance.max(0.1 * self.spacing);
        }
        false
    }

    /// Whether it is a side beyond which the body continues.
    fn is_joined(&self, center: DVec3, normal: DVec3) -> bool {
        self.repeats.iter().any(|repeat| {
            let axis = repeat.axis();
            let is_near = |side: f64| (center[axis] - side).abs() < self.spacing;
            normal[axis].abs() > 1.0 - EXACT
                && normal[axis] * (center[axis] - self.middle[axis]) > 0.0
                && repeat.sides().into_iter().any(is_near)
        })
    }
}
