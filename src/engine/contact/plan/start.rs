//! Bodies with initial overlap.

use std::sync::Arc;

use glam::DVec3;

use crate::contact::bodies::{ContactSides, NodeView, SideNodes};
use crate::contact::system::Touching;
use crate::notation;
use crate::plugin::{Setup, SetupError, SimBuilder};
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::StepError;
use crate::skins::{Skin, SkinColumns};

/// A body that must not start inside a rigid one, and the parts of it that are checked.
enum ContactStart {
    /// Its nodes.
    Nodes(ContactSides),
    /// Its skin, and the centres of its particles.
    Skin(Arc<Skin>, ContactSides),
}

/// Depth of a vertex of the skin, or of the centre of a particle, inside the rigid body from which on the
/// start is refused, over the spacing: as deep as half of a radius, the limit of contact by particles.
const SKIN_SHARE: f64 = 0.25;

/// Adds the check that no body starts inside a rigid one; `numbers` are those of the contacts in the scene.
pub(super) fn refuse_bodies_within_others(
    sim: &mut SimBuilder<'_>,
    touching: &[Touching],
    numbers: Vec<usize>,
) {
    let mut checks = Vec::new();
    for (pair, number) in touching.iter().zip(numbers) {
        match pair {
            Touching::Surface(contact) => checks.push((ContactStart::Nodes(contact.sides.clone()), number)),
            Touching::SkinOnTool(contact) => {
                checks.push((
                    ContactStart::Skin(Arc::clone(&contact.patch.skin), contact.sides.clone()),
                    number,
                ));
            }
            Touching::Particles(_) | Touching::Skins(_) => {}
        }
    }
    sim.add_setup(move |setup| checks.iter().try_for_each(|(start, number)| check(start, *number, setup)));
}

impl ContactStart {
    fn sides(&self) -> &ContactSides {
        match self {
            Self::Nodes(sides) | Self::Skin(_, sides) => sides,
        }
    }

    /// The part of the body that is inside the rigid one, by name, and its place, m; none if there is none.
    fn inside(&self, setup: &Setup<'_>) -> Result<Option<(&'static str, DVec3)>, StepError> {
        let bodies = setup.resources.get::<RigidBodies>();
        let sides = self.sides();
        let what = if matches!(sides.nodes, SideNodes::Rigid) { "a point" } else { "a particle" };
        let nodes = |deep: &dyn Fn(&NodeView<'_>, &RigidBody) -> Option<DVec3>| {
            let place = sides.with(setup.world, setup.resources, &bodies, deep)?;
            Ok(place.map(|place| (what, place)))
        };
        let Self::Skin(skin, _) = self else {
            // Of many bodies nearly all are apart.
            return nodes(&|nodes, tool| {
                if sides.gap(nodes, tool) > 0.0 { None } else { sides.inside(nodes, tool) }
            });
        };
        let deepest = -SKIN_SHARE * skin.spacing;
        let is_deep = |x: DVec3, tool: &RigidBody| sides.closest(x, tool).signed_distance < deepest;
        let columns = SkinColumns::new(skin, setup.world)?;
        let vertices: Vec<u32> = (0..skin.vertices() as u32).collect();
        let surface = nodes(&|_, tool| {
            let mut found = None;
            columns.view().places(&vertices, &mut |_, x, _| {
                found = found.or_else(|| is_deep(x, tool).then_some(x));
            });
            found
        })?;
        if let Some((_, place)) = surface {
            return Ok(Some(("the surface", place)));
        }
        nodes(&|nodes, tool| (0..nodes.len()).map(|i| nodes.position(i)).find(|x| is_deep(*x, tool)))
    }
}

fn check(start: &ContactStart, number: usize, setup: &mut Setup<'_>) -> Result<(), SetupError> {
    let found = start.inside(setup).map_err(|error| SetupError::internal(&error))?;
    let Some((what, place)) = found else { return Ok(()) };
    let sides = start.sides();
    let name = |id| &setup.world.body(id).name;
    let (first, second) = (name(sides.first), name(sides.second));
    Err(SetupError::parameter(
        format!("contacts[{number}].between"),
        format!("{what} of `{first}` starts inside rigid body `{second}`, at {}", notation::place(place)),
        "move the bodies apart; they may touch",
    ))
}
