//! Bodies with initial overlap.

use crate::contact::bodies::{ContactSides, SideNodes};
use crate::contact::system::Touching;
use crate::notation;
use crate::plugin::{Setup, SetupError, SimBuilder};
use crate::rigid::RigidBodies;

/// Adds the check that no body starts inside a rigid one; `numbers` are those of the contacts in the scene.
pub(super) fn refuse_bodies_within_others(
    sim: &mut SimBuilder<'_>,
    touching: &[Touching],
    numbers: Vec<usize>,
) {
    let mut checks = Vec::new();
    for (pair, number) in touching.iter().zip(numbers) {
        match pair {
            Touching::Surface(contact) => checks.push((contact.sides.clone(), number)),
            Touching::SkinOnTool(contact) => checks.push((contact.sides.clone(), number)),
            Touching::Particles(_) | Touching::Skins(_) => {}
        }
    }
    sim.add_setup(move |setup| checks.iter().try_for_each(|(sides, number)| check(sides, *number, setup)));
}

fn check(sides: &ContactSides, number: usize, setup: &mut Setup<'_>) -> Result<(), SetupError> {
    let bodies = setup.resources.get::<RigidBodies>();
    let found = sides.with(setup.world, setup.resources, &bodies, |nodes, tool| sides.inside(nodes, tool));
    let Some(place) = found.map_err(|error| SetupError::internal(&error))? else { return Ok(()) };
    let name = |id| &setup.world.body(id).name;
    let (first, second) = (name(sides.first), name(sides.second));
    let what = if matches!(sides.nodes, SideNodes::Rigid) { "a point" } else { "a particle" };
    Err(SetupError::parameter(
        format!("contacts[{number}].between"),
        format!("{what} of `{first}` starts inside rigid body `{second}`, at {}", notation::place(place)),
        "move the bodies apart; they may touch",
    ))
}
