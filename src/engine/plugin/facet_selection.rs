//! Selections of surfaces: the facets of a body on which a load acts or a probe measures.

use glam::DVec3;

use super::builder::SimBuilder;
use super::error::SetupError;
use super::selected_facet::SelectedFacet;
use crate::scene::{Select, SurfacePart};
use crate::shapes::{Facets, Region, Shape};
use crate::world::BodyId;

/// How far a facet may be from a plane or a surface that it is on, over the spacing.
const ON: f64 = 0.02;
/// The same of a facet of a flat side: that at the tip of a circle is parallel to it, but not on it.
const EXACT: f64 = 1e-6;
/// Steps of a ray on its way out of the box around a body.
const STEPS: usize = 200;

/// The facets of a body that a selection means, those of its `surface` or its `face`, each with the part that
/// is `within`: a load ends where the scene says, not at the next facet.
pub(crate) fn selected_facets(
    select: &Select,
    id: BodyId,
    facets: &Facets,
    sim: &SimBuilder<'_>,
) -> Result<Vec<SelectedFacet>, SetupError> {
    let chosen = facets_on(select, id, facets, sim)?;
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
    sim: &SimBuilder<'_>,
) -> Result<Vec<u32>, SetupError> {
    let of = match &select.surface {
        Some(SurfacePart::Of(shape)) => Some(region_of(shape, "on.surface[0]", sim)?),
        _ => None,
    };
    let body = sim.body(id);
    let own = region_of(&sim.scene().bodies[id.0].shape, "shape", sim)?;
    let tolerance = ON * body.spacing;
    let chosen = |facet: &u32| {
        let center = facets.center(*facet as usize);
        let (normal, _) = facets.normal_and_measure(*facet as usize);
        let on_surface = match &select.surface {
            None | Some(SurfacePart::All) => true,
            Some(SurfacePart::Inner) => looks_at_body(&*own, center, normal, body.spacing),
            Some(SurfacePart::Outer) => !looks_at_body(&*own, center, normal, body.spacing),
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

/// Whether a ray from a surface outward meets the body again: then it is that of a hole, a bore or a notch.
fn looks_at_body(region: &dyn Region, from: DVec3, along: DVec3, spacing: f64) -> bool {
    let bounds = region.bounds();
    let mut way = 0.25 * spacing;
    for _ in 0..STEPS {
        let x = from + way * along;
        if x.cmplt(bounds.min - spacing).any() || x.cmpgt(bounds.max + spacing).any() {
            return false;
        }
        let distance = region.distance(x);
        if distance < 0.0 {
            return true;
        }
        way += distance.max(0.1 * spacing);
    }
    false
}
