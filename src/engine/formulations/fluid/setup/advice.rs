//! Notes before a run: properties of a flow that are most likely not intended.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Group};
use crate::formulations::fluid::walls::{Slip, WallBody};
use crate::notation::quantity;
use crate::pair::PhaseTerms;
use crate::plugin::{BodyKind, Setup, SimBuilder, TouchingPairs};
use crate::rigid::RigidBodies;
use crate::world::{BodyId, ReferenceVolume};

/// Warns of fluids whose density nothing diffuses.
pub fn undamped_density(terms: Option<&PhaseTerms>, groups: &[Group], sim: &mut SimBuilder<'_>) {
    for group in groups.iter().filter(|group| group.fluid().is_some()) {
        if terms.is_some_and(|terms| terms.change_density_of(group.body)) {
            continue;
        }
        let name = sim.body(group.body).name.clone();
        sim.warn(format!(
            "nothing diffuses the density of `{name}`: its pressure becomes noise, which can drive particles through walls; give it \
             `plugins: [density_diffusion()]`"
        ));
    }
}

/// Warns of walls along which a viscous fluid slides though nobody has said so, and of moving surfaces that
/// no fluid sticks to.
pub fn unfelt_walls(walls: &[WallBody], viscous: bool, sim: &mut SimBuilder<'_>) {
    let name = |wall: &WallBody| sim.body(wall.id).name.clone();
    let unstated = walls.iter().filter(|wall| viscous && wall.parameters.slip.is_none()).map(|wall| {
        format!(
            "a viscous fluid slides along the wall `{}`, whose `slip` is not stated: give it `Wall(slip: No)` if the fluid sticks to it, \
             `Wall(slip: Free)` if it slides",
            name(wall)
        )
    });
    let moves = |wall: &&WallBody| {
        wall.parameters.surface_velocity.0 != DVec3::ZERO && wall.parameters.slip != Some(Slip::No)
    };
    let unfelt = walls.iter().filter(moves).map(|wall| {
        format!(
            "the `surface_velocity` of the wall `{}` has no effect on a fluid that slides along it: give it `slip: No`",
            name(wall)
        )
    });
    let warnings: Vec<String> = unstated.chain(unfelt).collect();
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}

/// Spacing of a wall over that of the fluid below which the fluid sticks to it too early.
const FINE: f64 = 0.95;

/// Warns of walls that are finer than the viscous fluid that sticks to them. The velocity of their particles
/// is extrapolated as if it were in the lattice of the fluid: friction beside the surface is too large.
pub fn finer_walls(walls: &[WallBody], viscous: bool, spacing: f64, sim: &mut SimBuilder<'_>) {
    for wall in walls.iter().filter(|wall| viscous && wall.parameters.slip == Some(Slip::No)) {
        let body = sim.body(wall.id);
        if body.spacing < FINE * spacing {
            let text = format!(
                "the wall `{}` is finer than the viscous fluid that sticks to it, with a spacing of {} beside {}: the fluid sticks an eighth of its spacing before the surface \
                 (the flux of a channel is 7 % too small where it is 10 particles wide, 5 % at 20), and shifting presses it off the wall; give the wall the spacing of the fluid",
                body.name,
                quantity(body.spacing, "m"),
                quantity(spacing, "m"),
            );
            sim.warn(text);
        }
    }
}

/// Smoothing length over spacing below which waves on an interface of two liquids are slow to grow and quick
/// to return, in two dimensions: that of a support of 3.3 spacings, less round-off.
const OF_TWO_LIQUIDS: f64 = 1.649;

/// Warns of two liquids under gravity in the plane whose support makes rows of particles stiff: the pressure
/// gives them a shear modulus, and only the difference of two weights acts against it.
pub fn stiff_interface(cloud: &FlowCloud, gravity: DVec3, sim: &mut SimBuilder<'_>) {
    let mut fluids = cloud.groups.iter().filter_map(|group| Some((group, group.fluid()?)));
    let Some((first, one)) = fluids.next() else { return };
    let Some((second, _)) = fluids.find(|(_, state)| state.density != one.density) else { return };
    let share = cloud.kernel.smoothing_length() / sim.body(first.body).spacing;
    if cloud.plane && gravity != DVec3::ZERO && share < OF_TWO_LIQUIDS {
        let names = [first, second].map(|group| sim.body(group.body).name.clone());
        sim.warn(format!(
            "waves on the interface of `{}` and `{}` have a period 2 to 10 % too short, and grow too slowly: rows of particles under pressure are stiff with the support of \
             these fluids; `Fluid(support: 3.3)`, with walls of four layers, has a fifth to a half of these errors",
            names[0], names[1]
        ));
    }
}

/// Warns of rigid bodies that sink to walls which do not hold them.
pub fn sinking(
    cloud: &FlowCloud,
    walls: &[BodyId],
    touching: &TouchingPairs,
    gravity: DVec3,
    setup: &mut Setup<'_>,
) {
    let Some(bodies) = setup.resources.try_get::<RigidBodies>() else { return };
    let fluids = cloud.groups.iter().filter_map(|group| group.fluid());
    // What is lighter than one of them floats on it.
    let densest = fluids.map(|state| state.density).fold(0.0, f64::max);
    for body in bodies.iter() {
        let falls = (0..3).any(|axis| gravity[axis] != 0.0 && !body.is_driven_along(axis));
        let (view, rows) = setup.world.body_view(body.id);
        let Ok(volume) = view.read::<ReferenceVolume>() else { continue };
        let density = body.mass / volume[rows].iter().map(|volume| volume.0).sum::<f64>();
        let name = &setup.world.body(body.id).name;
        let name_of = |wall: &BodyId| &setup.world.body(*wall).name;
        let is_free = |other: BodyId| bodies.of(other).is_some_and(|body| !body.is_driven());
        // A solid, a tool or a wall may hold it; another loose body does not.
        let rests = touching.partners(body.id).iter().any(|&other| other != body.id && !is_free(other));
        let held = walls.is_empty() || rests;
        if falls && density > densest && !held {
            let wall = name_of(&walls[0]);
            setup.warnings.push(format!(
                "the rigid body `{name}` is denser than the fluid, and no contact holds it off a wall: unless it is hollow and floats, it will \
                 fall through; add \
                 `contacts: [Contact(between: (\"{name}\", \"{wall}\"), law: Penalty())]`"
            ));
        }
    }
}

/// The walls of a scene.
pub fn walls(sim: &SimBuilder<'_>) -> Vec<BodyId> {
    sim.bodies().iter().filter(|body| body.kind == BodyKind::Boundary).map(|body| body.id).collect()
}
