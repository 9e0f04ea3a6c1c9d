//! Sides at which a body does not end: those in a symmetry plane, and the two ends of a period.

use glam::DVec3;

use super::field::VectorField;
use super::symmetry::planes_of;
use crate::notation::{number, quantity_to};
use crate::plugin::{BodyKind, BodyPlan, Selection, SetupError, SimBuilder};
use crate::scene::{Face, Select};
use crate::symmetry::{MirrorPlane, Repeat, periods_of};

/// Way across a symmetry plane, over the spacing, from which particles leave it.
const OFF: f64 = 0.05;
/// Times of a run at which it is looked at.
const TIMES: u32 = 64;

/// Refuses a load along the normal of a side beyond which the body goes on: there is no surface, and the
/// image is loaded against it.
pub(super) fn refuse_load(
    select: &Select,
    selection: &Selection,
    sim: &SimBuilder<'_>,
) -> Result<(), SetupError> {
    let Some(face) = select.face else { return Ok(()) };
    let bodies = selection.parts.iter().map(|(id, _)| sim.body(*id));
    let bodies = bodies.filter(|body| body.kind == BodyKind::Solid);
    let mut joined = bodies.filter_map(|body| Some((body, continuation(face, body, sim)?)));
    let Some((BodyPlan { name, .. }, why)) = joined.next() else { return Ok(()) };
    Err(SetupError::parameter(
        "on",
        format!("side {face:?} of body `{name}` is no surface that a load could press on or pull at: {why}"),
        "leave this load out, or name another side; what holds the body there follows from its image",
    ))
}

/// Why a body does not end at a side.
fn continuation(face: Face, body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<String> {
    let (axis, sign) = face.outward();
    let side = if sign > 0.0 { body.bounds.max[axis] } else { body.bounds.min[axis] };
    let planes: Vec<MirrorPlane> = planes_of(body, sim);
    let repeats = planes.iter().map(Repeat::from).chain(periods_of(body, sim));
    let is_there = |repeat: &Repeat| {
        repeat.axis() == axis && repeat.sides().iter().any(|at| (at - side).abs() < body.spacing)
    };
    let name = ["X", "Y", "Z"][axis];
    match repeats.into_iter().find(is_there)? {
        Repeat::Mirror { at, .. } => Some(format!("it lies in the symmetry plane {name} = {}", number(at))),
        Repeat::Period { .. } => Some(format!("the period along {name} joins it to the opposite side")),
    }
}

/// Warns of motion that moves particles off a symmetry plane at which their body ends, or through it: their
/// image moves against them. `way` is the displacement at a place in the reference configuration and a time.
pub(super) fn warn_of_motion(
    name: &str,
    field: &VectorField,
    way: impl Fn(DVec3, f64) -> DVec3,
    selection: &Selection,
    sim: &mut SimBuilder<'_>,
) {
    let end = sim.scene().time.end;
    let mut warnings = Vec::new();
    for (id, rows) in &selection.parts {
        let body = sim.body(*id);
        let planes = planes_of(body, sim);
        for MirrorPlane { axis, at, .. } in planes.into_iter().filter(|plane| field.axes()[plane.axis]) {
            let places = rows.iter().map(|&row| body.sites[row as usize - body.rows.start].position);
            // Of a motion that grows with the distance from the plane, nothing is left in it.
            let Some(mut foot) = places.into_iter().find(|x| (x[axis] - at).abs() < body.spacing) else {
                continue;
            };
            foot[axis] = at;
            let times = (1..=TIMES).map(|k| end * f64::from(k) / f64::from(TIMES));
            let most = times.map(|t| way(foot, t)[axis].abs()).filter(|w| w.is_finite()).fold(0.0, f64::max);
            if most > OFF * body.spacing {
                let (axis, most) = (["X", "Y", "Z"][axis], quantity_to(most, "m", 3));
                warnings.push(format!(
                    "`{name}` moves particles of `{}` in the symmetry plane {axis} = {} by up to {most} along {axis}: the image of the body moves against them, apart or through each other; leave this axis to the plane (`None`), or leave out the plane",
                    body.name,
                    number(at)
                ));
            }
        }
    }
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}
