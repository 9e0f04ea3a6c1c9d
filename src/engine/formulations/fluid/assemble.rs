//! The systems of a flow, once all fluids and walls of the scene are known.

use glam::DVec3;

use super::formulation::FluidBody;
use super::systems;
use crate::formulations::fluid::cloud::{
    FlowCloud, FluidState, Group, Neighborhood, Role, Surface, Viscosities,
};
use crate::formulations::fluid::lanes::{FluidKernel, Periods, Record};
use crate::formulations::fluid::lists::{FlowPairs, NearRows, Skins, Thickness, ThinBody};
use crate::formulations::fluid::passes::blocks;
use crate::formulations::fluid::setup::{advice, checks, rest, start};
use crate::formulations::fluid::walls::{Repulsion, Slip, WallBody};
use crate::parallel::Lanes4;
use crate::plugin::{BodyKind, BodyPlan, SetupError, SimBuilder};
use crate::scene::{Dimension, Problem};
use crate::world::BodyId;

/// Adds the systems of all fluids and walls of the scene; nothing where there are none.
///
/// # Errors
/// Fluids and walls that do not go together.
pub fn add_systems(sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    let fluids: Vec<FluidBody> = sim.take_extensions();
    let walls: Vec<WallBody> = sim.take_extensions();
    let Some(first) = fluids.first() else {
        return checks::walls_have_fluid(&walls, sim);
    };
    let (support, spacing) = (first.support, sim.body(first.id).spacing);
    let dimension = sim.dimension().count();
    one_support(&fluids, support, sim)?;
    let Some(kernel) = FluidKernel::new(first.parameters.kernel, support, dimension) else {
        unreachable!("the formulation has refused other kernels");
    };
    let periodic = sim.periodic();
    checks::periods_are_long(&periodic, support)?;
    for wall in &walls {
        if let Some(warning) = checks::wall_is_thick(sim.body(wall.id), spacing, support, &periodic)? {
            sim.warn(warning);
        }
    }
    let moved = moved_bodies(sim);
    for &id in &moved {
        checks::is_fine(sim.body(id), spacing)?;
    }
    let mut groups = Vec::new();
    for fluid in &fluids {
        let body = sim.body(fluid.id);
        groups.push(group(body, Role::Fluid(fluid_state(body)?), &groups));
    }
    let given = fluids.into_iter().map(|fluid| (fluid.id, fluid.parameters.pressure));
    let pressures = rest::pressures(given.collect(), support, sim)?;
    let fluid: usize = groups.iter().map(|group| group.rows.len()).sum();
    for WallBody { id, parameters } in &walls {
        let surface = Surface {
            no_slip: parameters.slip == Slip::No,
            suction: parameters.suction,
            velocity: parameters.surface_velocity.0,
            moved: false,
        };
        groups.push(group(sim.body(*id), Role::Boundary(surface), &groups));
    }
    let (mut thin, plane) = (Vec::new(), sim.dimension() == Dimension::Two);
    let suction = is_confined(&walls, sim);
    for id in moved {
        let surface = Surface { no_slip: true, suction, velocity: DVec3::ZERO, moved: true };
        let body = sim.body(id);
        groups.push(group(body, Role::Boundary(surface), &groups));
        if Thickness::of(body, support, &periodic)?.thin(1).is_some() {
            let other = group(body, Role::Boundary(surface), &groups);
            let first = other.cloud.start - body.rows.len()..other.cloud.start;
            thin.push(ThinBody::new(body, [first, other.cloud.clone()], support, plane)?);
            groups.push(other);
        }
    }
    let short = systems::short_phases(&groups, sim);
    groups.iter_mut().for_each(|group| group.short = short.contains(&group.phase));
    sim.sub_cycle(short);
    let viscosities = Viscosities::new(&groups, kernel.smoothing_length());
    let spin = viscosities.spin;
    let is_thin = |group: &&Group| thin.iter().any(|thin| thin.copies[0] == group.cloud);
    let blocks = blocks::choose(spacing, groups.iter().find(is_thin), spin, sim)?;
    let skins = Skins::new(support, spacing, &periodic);
    let ends = groups.iter().map(|group| group.cloud.end as u32).collect();
    let total = groups.last().map_or(0, |group| group.cloud.end);
    let (repulsion, reach) = Repulsion::new(&groups, kernel.smoothing_length(), sim);
    let neighborhoods = if spin { sticky(&groups, spacing, sim)? } else { Vec::new() };
    let mut cloud = FlowCloud {
        groups: groups.clone(),
        fluid,
        kernel,
        viscosities,
        plane,
        periods: Periods::new(&periodic),
        before: Vec::new(),
        records: vec![Record::default(); total],
        blocks,
        pairs: FlowPairs::new(skins, periodic, ends, thin, plane),
        near: NearRows::default(),
        near_boundary: NearRows::default(),
        compression: Vec::new(),
        is_close: Vec::new(),
        reach,
        repelled: Vec::new(),
        loads: Vec::new(),
        spins: if spin { vec![Lanes4::ZERO; total] } else { Vec::new() },
        neighborhoods,
    };
    let (walls, contacts, gravity) = (advice::walls(sim), advice::contacts(sim), sim.gravity());
    sim.add_setup(move |setup| {
        start(&cloud, &pressures, setup)?;
        cloud.groups.iter_mut().for_each(|group| group.held = setup.held.contains(group.body));
        checks::flow_is_slow(&mut cloud, setup.world)?;
        advice::sinking(&cloud, &walls, &contacts, gravity, setup);
        setup.resources.insert(cloud);
        Ok(())
    });
    systems::add(&groups, spin, repulsion, sim)
}

/// Who is beside whom in the bodies to which fluids stick.
fn sticky(groups: &[Group], spacing: f64, sim: &SimBuilder<'_>) -> Result<Vec<Neighborhood>, SetupError> {
    let is_sticky = |group: &&Group| matches!(&group.role, Role::Boundary(surface) if surface.no_slip);
    let mut bodies: Vec<BodyId> = groups.iter().filter(is_sticky).map(|group| group.body).collect();
    bodies.dedup();
    let of = |id: BodyId| Neighborhood::new(sim.body(id), spacing, &sim.periodic());
    bodies.into_iter().map(|id| of(id).map_err(|error| SetupError::internal(&error))).collect()
}

/// Whether the flow has no free surface, so that bodies in it can pull at it: where walls do, or where the domain has no end.
fn is_confined(walls: &[WallBody], sim: &SimBuilder<'_>) -> bool {
    let endless = sim.periodic().axes().iter().take(sim.dimension().count()).all(|&repeats| repeats);
    endless || walls.iter().any(|wall| wall.parameters.suction)
}

/// The bodies that a fluid moves, those of a phase together: solids, then rigid bodies.
fn moved_bodies(sim: &SimBuilder<'_>) -> Vec<BodyId> {
    let of = |kind| sim.bodies().iter().filter(move |body| body.kind == kind);
    let mut solids: Vec<&BodyPlan> = of(BodyKind::Solid).collect();
    solids.sort_by_key(|body| body.phase);
    solids.into_iter().chain(of(BodyKind::Rigid)).map(|body| body.id).collect()
}

fn group(body: &BodyPlan, role: Role, before: &[Group]) -> Group {
    let start = before.last().map_or(0, |group| group.cloud.end);
    Group {
        body: body.id,
        phase: body.phase,
        rows: body.rows.clone(),
        cloud: start..start + body.rows.len(),
        role,
        held: true,
        short: false,
    }
}

fn fluid_state(body: &BodyPlan) -> Result<FluidState, SetupError> {
    let law = body.fluid_law()?;
    Ok(FluidState {
        density: body.material.density,
        sound_speed: law.sound_speed.unwrap_or(f64::NAN),
        viscosity: law.viscosity,
        eos: law.eos,
    })
}

fn one_support(fluids: &[FluidBody], support: f64, sim: &SimBuilder<'_>) -> Result<(), SetupError> {
    let first = sim.body(fluids[0].id);
    let differs = |a: f64, b: f64| (a - b).abs() > 1e-9 * b;
    let spacing = |fluid: &FluidBody| sim.body(fluid.id).spacing;
    let kernel = fluids[0].parameters.kernel;
    let other = |other: &&FluidBody| {
        differs(other.support, support)
            || differs(spacing(other), first.spacing)
            || other.parameters.kernel != kernel
    };
    let Some(other) = fluids.iter().find(other) else { return Ok(()) };
    let body = sim.body(other.id);
    let message = format!(
        "the fluid `{}` has the kernel `{}` with a support radius of {} m and a spacing of {} m, and `{}` has `{kernel}` with {support} m and {} m",
        body.name, other.parameters.kernel, other.support, body.spacing, first.name, first.spacing
    );
    let problem = Problem::at_path(format!("bodies[{}].spacing", other.id.0), message);
    Err(SetupError::Problems(vec![
        problem.help("give all fluids of a scene one spacing, one `kernel` and one `support`"),
    ]))
}
