//! From plans to columns: spawns every phase and fills the columns that all phases have.

use glam::DVec3;

use crate::materials::{Law, StateColumns, StateRows};
use crate::parallel::Split;
use crate::plugin::BodyPlan;
use crate::plugin::SimBuilder;
use crate::scene::Dimension;
use crate::world::{
    Body, ColumnSet, Force, Mass, Mobility, ParticleId, PhaseId, PhaseView, Position, ReferencePosition,
    ReferenceVolume, Removed, Velocity, World,
};

/// Adds the columns that every phase has.
pub(super) fn standard_columns(columns: &mut ColumnSet) {
    columns
        .add::<ParticleId>()
        .add::<Position>()
        .add::<ReferencePosition>()
        .add::<Velocity>()
        .add::<Force>()
        .add::<Mass>()
        .add::<Mobility>()
        .add::<ReferenceVolume>()
        .add::<Removed>();
}

/// The world with all particles in their places.
pub(super) fn spawn(sim: &SimBuilder<'_>) -> World {
    let mut world = World::new(sim.dimension());
    let mut id = 0;
    for (k, (name, columns)) in sim.phases.iter().enumerate() {
        let bodies = || sim.bodies().iter().filter(move |body| body.phase.0 == k);
        let len = bodies().map(|body| body.sites.len()).sum();
        let phase = world.spawn_phase(name, columns.clone(), len);
        fill(sim, &world, phase, &mut id);
    }
    for body in sim.bodies() {
        world.add_body(Body {
            name: body.name.clone(),
            phase: body.phase,
            rows: body.rows.clone(),
            spacing: body.spacing,
            material: body.material_name.clone(),
        });
    }
    world
}

fn fill(sim: &SimBuilder<'_>, world: &World, phase: PhaseId, id: &mut u64) {
    let view = world.phase(phase);
    let columns = || -> Result<_, crate::world::MissingColumn> {
        Ok((
            view.write::<ParticleId>()?,
            view.write::<Position>()?,
            view.write::<ReferencePosition>()?,
            view.write::<Velocity>()?,
            view.write::<Mass>()?,
            view.write::<Mobility>()?,
            view.write::<ReferenceVolume>()?,
        ))
    };
    let Ok((mut ids, mut x, mut reference, mut v, mut mass, mut mobility, mut volume)) = columns() else {
        unreachable!("every phase is declared with the standard columns");
    };
    let plane = sim.dimension() == Dimension::Two;
    for body in sim.bodies().iter().filter(|body| body.phase == phase) {
        let start = body.velocity.map_or(DVec3::ZERO, |velocity| velocity.0);
        for (row, site) in body.rows.clone().zip(&body.sites) {
            ids[row] = ParticleId(*id);
            *id += 1;
            x[row] = Position(site.position);
            reference[row] = ReferencePosition(site.position);
            v[row] = Velocity(start);
            volume[row] = ReferenceVolume(site.volume);
            let m = body.material.density * site.volume;
            mass[row] = Mass(m);
            let held = sim.prescribed.get(&(phase, row as u32)).copied().unwrap_or_default();
            let free = |axis: usize| if held[axis].is_some() { 0.0 } else { 1.0 / m };
            mobility[row] = Mobility(DVec3::new(free(0), free(1), if plane { 0.0 } else { free(2) }));
        }
        start_state(body, &view);
    }
}

/// Lets the law of a body fill its state.
fn start_state(body: &BodyPlan, view: &PhaseView<'_>) {
    let Law::Solid(law) = &body.material.law else { return };
    let mut columns = ColumnSet::default();
    law.state(&mut columns);
    // A law with too many columns is refused where its formulation is assembled.
    let Some(state) = StateColumns::new(&columns) else { return };
    view.write_bytes_of(state.as_slice(), &mut |bytes| {
        let (_, rows) = StateRows::new(&state, bytes).split(body.rows.start);
        law.start(rows.split(body.rows.len()).0);
    });
}
