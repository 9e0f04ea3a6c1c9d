//! Rigid bodies in a selection: a support or a prescribed motion acts on the whole body.

use glam::DVec3;

use super::field::VectorField;
use crate::notation::{place, quantity};
use crate::plugin::{BodyKind, Selection, SetupError, SimBuilder};
use crate::world::BodyId;

/// The selection without rigid bodies, and the rigid bodies. It is an error to select a part of one.
pub(super) fn split_rigid(
    selection: &Selection,
    sim: &SimBuilder<'_>,
) -> Result<(Selection, Vec<BodyId>), SetupError> {
    let mut particles = Selection::default();
    let mut rigid = Vec::new();
    for (id, rows) in &selection.parts {
        let body = sim.body(*id);
        if body.kind != BodyKind::Rigid {
            particles.parts.push((*id, rows.clone()));
        } else if rows.len() == body.sites.len() {
            rigid.push(*id);
        } else {
            let message = format!(
                "the selection holds {} of the {} particles of rigid body `{}`, which moves as a whole",
                rows.len(),
                body.sites.len(),
                body.name
            );
            return Err(SetupError::parameter("on", message, "select the whole body by its name alone"));
        }
    }
    Ok((particles, rigid))
}

/// Times of a run and places of a body at which a prescribed motion is looked at.
const TIMES: u32 = 64;
const PLACES: usize = 64;
/// Difference of two values, over the larger one, up to which they are the same.
const ROUNDING: f64 = 1e-9;

/// An error where the value of the condition of that name differs between places of a rigid body: all of it
/// moves with the value at its centre.
pub(super) fn require_one_motion(
    name: &str,
    field: &VectorField,
    id: BodyId,
    sim: &SimBuilder<'_>,
) -> Result<(), SetupError> {
    if !field.depends_on_place() {
        return Ok(());
    }
    let (body, end) = (sim.body(id), sim.scene().time.end);
    let Some(first) = body.sites.first().map(|site| site.position) else { return Ok(()) };
    let apart = body.sites.len().div_ceil(PLACES);
    for t in (0..=TIMES).map(|k| end * f64::from(k) / f64::from(TIMES)) {
        let value = field.at(first, t);
        let differs = |other: &DVec3| {
            let other = field.at(*other, t);
            value.distance(other) > ROUNDING * value.length().max(other.length())
        };
        if let Some(other) = body.sites.iter().step_by(apart).map(|site| site.position).find(differs) {
            let message = format!(
                "rigid body `{}` moves as a whole, and the value of `{name}` is one at {} and another at {}, at {}",
                body.name,
                place(first),
                place(other),
                quantity(t, "s")
            );
            let help = "give the motion of its centre as a function of t alone, and its rotation by `RotationRate`: a swing about another point is both";
            return Err(SetupError::parameter("value", message, help));
        }
    }
    Ok(())
}
