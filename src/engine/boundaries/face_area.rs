//! The area on which a load acts, from the particles that carry it.

use glam::DVec3;

use crate::plugin::{BodyPlan, SetupError, SimBuilder};
use crate::scene::{Face, Select};
use crate::world::BodyId;

/// Volume of the particles over that of the bounding box, less one, up to which a body is a box.
const FILLED: f64 = 1e-6;

/// Largest distance of the feet of the particles of a side from the surface, over the spacing, up to which
/// the side is flat.
const FLAT: f64 = 0.2;

/// Area that the selected rows of a body stand for, m2 (m in two dimensions): that of the face, where it is a
/// whole face of a body that fills its bounding box; else their volume over the thickness of the layer. The
/// thickness of a flat face is twice the mean distance of its particles from the face, which is the distance
/// of the layers for any lattice; without a face it is the spacing.
pub(super) fn loaded_area(select: &Select, body: &BodyPlan, rows: &[u32]) -> f64 {
    if let Some(area) = whole_face(select, body) {
        return area;
    }
    let sites = || rows.iter().map(|&row| &body.sites[row as usize - body.rows.start]);
    let volume: f64 = sites().map(|site| site.volume).sum();
    let thickness = match select.face.map(Face::outward) {
        Some((axis, sign)) => {
            let plane = if sign > 0.0 { body.bounds.max[axis] } else { body.bounds.min[axis] };
            let depth: f64 = sites().map(|site| site.volume * (site.position[axis] - plane).abs()).sum();
            2.0 * depth / volume
        }
        None => body.spacing,
    };
    if thickness > 0.0 { volume / thickness } else { volume / body.spacing }
}

/// The area of the face of a box, if the selection means all of it.
fn whole_face(select: &Select, body: &BodyPlan) -> Option<f64> {
    let (axis, _) = select.face.filter(|_| select.within.is_none() && select.nearest.is_none())?.outward();
    let sides = body.bounds.extent();
    let of_box: f64 = sides.to_array().into_iter().filter(|side| *side > 0.0).product();
    ((body.volume() / of_box - 1.0).abs() < FILLED).then(|| of_box / sides[axis])
}

/// The outward normal of the face that a load needs.
pub(super) fn normal_of(select: &Select) -> Result<DVec3, SetupError> {
    let Some(face) = select.face else {
        return Err(SetupError::parameter(
            "on",
            "the selection must name a face: a pressure acts on a surface",
            "add a face, such as `Select(body: \"plate\", face: MaxY)`",
        ));
    };
    let (axis, sign) = face.outward();
    Ok(sign * DVec3::AXES[axis])
}

/// Refuses a load on a side that is not flat: the outermost layer of a disc is a few particles at its tip.
/// The feet of the particles on the plane of the side are on the surface of the body, where it is flat, and
/// up to a good part of the spacing away, where it is curved. Selections by `within` say themselves what they
/// mean.
pub(super) fn check_is_side(
    select: &Select,
    id: BodyId,
    rows: &[u32],
    sim: &SimBuilder<'_>,
) -> Result<(), SetupError> {
    let Some((axis, sign)) =
        select.face.filter(|_| select.within.is_none() && select.nearest.is_none()).map(Face::outward)
    else {
        return Ok(());
    };
    let body = sim.body(id);
    let Ok(region) = sim.scene().bodies[id.0].shape.region(sim.dimension(), sim.folder(), "shape") else {
        return Ok(());
    };
    let plane = if sign > 0.0 { body.bounds.max[axis] } else { body.bounds.min[axis] };
    let away = |&row: &u32| {
        let mut foot = body.sites[row as usize - body.rows.start].position;
        foot[axis] = plane;
        region.distance(foot).max(0.0)
    };
    let farthest = rows.iter().map(away).fold(0.0, f64::max);
    if farthest <= FLAT * body.spacing {
        return Ok(());
    }
    Err(SetupError::parameter(
        "on",
        format!(
            "body `{}` has no flat side there: its outermost layer is {} particles",
            body.name,
            rows.len()
        ),
        format!(
            "a curved side is selected by `surface`, such as `Select(body: \"{}\", surface: Outer)`, a part of it by `within` beside that, or `surface: Facing(...)`; particles by `within` with the loaded `area`",
            body.name
        ),
    ))
}

/// Checks an area that the scene states.
pub(super) fn check_area(area: Option<f64>) -> Result<(), SetupError> {
    match area {
        Some(area) if !(area > 0.0 && area.is_finite()) => Err(SetupError::parameter(
            "area",
            format!("`area` must be positive, found {area}"),
            "it is the loaded area, in m2; in two dimensions its length, in m",
        )),
        _ => Ok(()),
    }
}
