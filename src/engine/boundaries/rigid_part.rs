//! Rigid bodies in a selection: a support or a prescribed motion acts on the whole body.

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
