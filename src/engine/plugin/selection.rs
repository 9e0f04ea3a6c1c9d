//! Selections: the rows on which a condition or a probe acts.

use std::path::Path;

use glam::DVec3;

use super::error::SetupError;
use super::offers::BodyKind;
use super::plan::BodyPlan;
use crate::notation::{place, quantity_to};
use crate::scene::{Dimension, Face, Select, unknown};
use crate::shapes::Aabb;
use crate::world::BodyId;

/// Distance from the point of a selection, over the spacing, from which its particle is not there: particles
/// fill a body, so that a point inside of it, or on its surface, has one within a spacing, at the tip of a
/// tooth within two.
const REMOTE: f64 = 3.0;

/// The rows that a [`Select`] means, body by body in scene order; rows are rows of the body's phase.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Bodies with their selected rows, ascending; no entry is empty.
    pub parts: Vec<(BodyId, Vec<u32>)>,
}

impl Selection {
    /// Number of selected particles.
    pub fn len(&self) -> usize {
        self.parts.iter().map(|(_, rows)| rows.len()).sum()
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// A warning of a particle that is selected as the one nearest to a point, and is nowhere near it. What
    /// acts on a rigid body acts at the point itself.
    pub(super) fn remote(&self, select: &Select, bodies: &[BodyPlan]) -> Option<String> {
        let (point, (id, rows)) = (select.nearest.as_ref()?.0, self.parts.first()?);
        let body = &bodies[id.0];
        let site = body.sites[*rows.first()? as usize - body.rows.start].position;
        let way = site.distance(point);
        (body.kind != BodyKind::Rigid && way > REMOTE * body.spacing).then(|| {
            format!(
                "`nearest: {}` selects the particle of `{}` at {}, {} or {} from that point: is the point where you mean it to be?",
                place(point),
                body.name,
                place(site),
                quantity_to(way, "m", 3),
                quantity_to(way / body.spacing, "spacings", 2)
            )
        })
    }
}

/// Resolves a selection; `field` is its path in the item that contains it, for errors.
pub(super) fn resolve(
    select: &Select,
    field: &str,
    bodies: &[BodyPlan],
    dimension: Dimension,
    folder: &Path,
) -> Result<Selection, SetupError> {
    let path = |name: &str| if field.is_empty() { name.to_owned() } else { format!("{field}.{name}") };
    check(select, &path, bodies, dimension)?;
    let within = match &select.within {
        Some(shape) => Some(shape.region(dimension, folder, &path("within")).map_err(|error| {
            SetupError::parameter(
                error.path.clone(),
                error.message(),
                "give a shape of the scene's dimension",
            )
        })?),
        None => None,
    };
    let mut parts = Vec::new();
    for body in bodies.iter().filter(|body| select.means(&body.name)) {
        let chosen = |p: DVec3| {
            within.as_ref().is_none_or(|region| region.contains(p))
                && select.face.is_none_or(|face| on_face(face, body, p))
        };
        let rows: Vec<u32> = (body.rows.start..)
            .zip(&body.sites)
            .filter(|(_, site)| chosen(site.position))
            .map(|(row, _)| row as u32)
            .collect();
        if !rows.is_empty() {
            parts.push((body.id, rows));
        }
    }
    if let Some(point) = &select.nearest {
        parts = nearest(parts, bodies, point.0);
    }
    if parts.is_empty() {
        let mut help: Vec<String> =
            bodies.iter().filter(|body| select.means(&body.name)).map(|body| extent(body, place)).collect();
        if select.face.is_some() {
            help.push(
                "`face` is a side of that box: select the particles of another one by `within`".to_owned(),
            );
        }
        return Err(SetupError::parameter(field, "the selection is empty", help.join("; ")));
    }
    Ok(Selection { parts })
}

/// Extents of a body, in words, and of its particles, where these differ: the box of a combination of shapes
/// may be larger than the combination.
fn extent(body: &BodyPlan, place: impl Fn(DVec3) -> String) -> String {
    let Aabb { min, max } = body.bounds;
    let positions = || body.sites.iter().map(|site| site.position);
    let low = positions().fold(DVec3::INFINITY, DVec3::min);
    let high = positions().fold(DVec3::NEG_INFINITY, DVec3::max);
    let text = format!("`{}` extends from {} to {}", body.name, place(min), place(max));
    if body.sites.is_empty() || (low - min).max(max - high).max_element() < body.spacing {
        return text;
    }
    format!("the box around the shape of {text}, its particles from {} to {}", place(low), place(high))
}

/// Whether a selection can mean particles at all; `path` gives the path of one of its fields.
fn check(
    select: &Select,
    path: &impl Fn(&str) -> String,
    bodies: &[BodyPlan],
    dimension: Dimension,
) -> Result<(), SetupError> {
    if let Some(name) = &select.body
        && !bodies.iter().any(|body| select.means(&body.name))
    {
        let known: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
        let (message, helps) = unknown("body", name, &known);
        return Err(SetupError::parameter(path("body"), message, helps.join("; ")));
    }
    if dimension == Dimension::Two && matches!(select.face, Some(Face::MinZ | Face::MaxZ)) {
        let help = "the faces are MinX, MaxX, MinY and MaxY";
        return Err(SetupError::parameter(path("face"), "a two-dimensional body has no face along z", help));
    }
    if select.surface.is_some() {
        let help = "select particles by `within`, `face` or `nearest`; `surface` is for `Traction`, `Pressure` and probes of fields";
        return Err(SetupError::parameter(path("surface"), "a surface has no particles of its own", help));
    }
    Ok(())
}

/// Whether a particle belongs to the outermost layer: closer to the face of the body's box than one spacing.
fn on_face(face: Face, body: &BodyPlan, p: DVec3) -> bool {
    let layer = body.spacing * (1.0 - 1e-6);
    let (min, max) = (body.bounds.min, body.bounds.max);
    match face {
        Face::MinX => p.x - min.x < layer,
        Face::MaxX => max.x - p.x < layer,
        Face::MinY => p.y - min.y < layer,
        Face::MaxY => max.y - p.y < layer,
        Face::MinZ => p.z - min.z < layer,
        Face::MaxZ => max.z - p.z < layer,
    }
}

/// The one particle nearest to a point; of equally near ones the first.
fn nearest(parts: Vec<(BodyId, Vec<u32>)>, bodies: &[BodyPlan], point: DVec3) -> Vec<(BodyId, Vec<u32>)> {
    let mut best: Option<(f64, BodyId, u32)> = None;
    for (id, rows) in &parts {
        let body = &bodies[id.0];
        for &row in rows {
            let distance = body.sites[row as usize - body.rows.start].position.distance_squared(point);
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, *id, row));
            }
        }
    }
    best.map(|(_, id, row)| vec![(id, vec![row])]).unwrap_or_default()
}
