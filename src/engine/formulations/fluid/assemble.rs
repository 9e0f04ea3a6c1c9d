//! The systems of a flow, once all fluids and walls of the scene are known.

use std::ops::Range;

use glam::DVec3;

use super::formulation::FluidBody;
use super::systems;
use crate::formulations::fluid::cloud::{
    BoundaryEdges, BoundarySurface, FlowCloud, FluidState, Group, Neighborhood, OtherParticles, Role,
    Viscosities,
};
use crate::formulations::fluid::lanes::{FlowParticle, FluidKernel, Periods};
use crate::formulations::fluid::lists::{
    FlowPairs, GapPairs, GapSide, NearRows, SideMotion, Skins, Thickness, ThinBody,
};
use crate::formulations::fluid::passes::blocks;
use crate::formulations::fluid::setup::{advice, checks, rest, start, stepped, torn_walls};
use crate::formulations::fluid::walls::{Repulsion, Slip, WallBody, WallShapes, has_suction};
use crate::neighbors::Periodic;
use crate::parallel::Lanes4;
use crate::plugin::{BodyKind, BodyPlan, SetupError, SimBuilder};
use crate::rigid::RigidBodies;
use crate::scene::{Dimension, Problem, Quantity};
use crate::world::BodyId;

/// Properties common to all fluids of a scene.
struct Common {
    kernel: FluidKernel,
    /// Support radius, m.
    support: f64,
    /// Spacing of the particles, m.
    spacing: f64,
    periodic: Periodic,
    plane: bool,
}

/// The bodies of a flow, in the order of the cloud.
#[derive(Default)]
struct Bodies {
    groups: Vec<Group>,
    /// Number of fluid particles.
    fluid: usize,
    /// Those that the flow does not see across.
    thin: Vec<ThinBody>,
}

/// Adds the systems of all fluids and walls of the scene; nothing where there are none.
///
/// # Errors
/// Fluids and walls that do not go together.
pub fn add_systems(sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    let fluids: Vec<FluidBody> = sim.take_extensions();
    let walls: Vec<WallBody> = sim.take_extensions();
    if fluids.is_empty() {
        return checks::walls_have_fluid(&walls, sim);
    }
    let common = in_common(&fluids, sim)?;
    let moved = moved_bodies(sim);
    check_boundaries(&walls, &moved, &common, sim)?;
    let mut bodies = Bodies::default();
    for fluid in &fluids {
        let body = sim.body(fluid.id);
        bodies.add(body, Role::Fluid(fluid_state(body)?));
    }
    let given = fluids.into_iter().map(|fluid| (fluid.id, fluid.parameters.pressure));
    let pressures = rest::pressures(given.collect(), common.support, sim)?;
    bodies.fluid = bodies.groups.iter().map(|group| group.rows.len()).sum();
    bodies.add_walls(&walls, sim);
    let suction = has_suction(sim);
    bodies.add_moved(&moved, suction, &common, sim)?;
    let short = systems::short_phases(&bodies.groups, sim);
    bodies.groups.iter_mut().for_each(|group| group.short = short.contains(&group.phase));
    sim.sub_cycle(short);
    let (repulsion, repulsion_range) = Repulsion::new(&bodies.groups, common.kernel.smoothing_length(), sim);
    let groups = bodies.groups.clone();
    let mut cloud = cloud(bodies, common, repulsion_range, sim)?;
    cloud.decide_what_others_know(WallShapes::are_asked_for(&groups, sim));
    let (spin, is_viscous) = (cloud.viscosities.spin, cloud.viscosities.is_viscous);
    advice::unfelt_walls(&walls, is_viscous, sim);
    advice::finer_walls(&walls, is_viscous, sim.body(groups[0].body).spacing, sim);
    torn_walls::warn(&walls, sim);
    let (walls, touching, gravity) = (advice::walls(sim), sim.touching_pairs(), sim.gravity());
    advice::stiff_interface(&cloud, gravity, sim);
    sim.add_setup(move |setup| {
        start(&cloud, &pressures, setup)?;
        cloud.groups.iter_mut().for_each(|group| group.held = setup.held.contains(group.body));
        if let Some(bodies) = setup.resources.try_get::<RigidBodies>() {
            let driven = bodies.iter().filter(|body| body.is_driven());
            driven.for_each(|body| cloud.pairs.gaps.hold(body.id));
        }
        checks::flow_is_slow(&mut cloud, setup.world)?;
        advice::sinking(&cloud, &walls, &touching, gravity, setup);
        stepped::warn(&cloud, setup);
        setup.resources.insert(cloud);
        setup.resources.complete_packed_by(FlowCloud::complete);
        Ok(())
    });
    systems::add(&groups, spin, repulsion, sim)
}

/// Properties common to the fluids.
fn in_common(fluids: &[FluidBody], sim: &SimBuilder<'_>) -> Result<Common, SetupError> {
    let first = &fluids[0];
    let (support, spacing) = (first.support, sim.body(first.id).spacing);
    one_support(fluids, support, sim)?;
    let Some(kernel) = FluidKernel::new(first.parameters.kernel, support, sim.dimension().count()) else {
        unreachable!("the formulation has refused other kernels");
    };
    let periodic = sim.periodic();
    checks::periods_are_long(&periodic, support)?;
    Ok(Common { kernel, support, spacing, periodic, plane: sim.dimension() == Dimension::Two })
}

/// An error or a warning where a fluid would interact through its boundary.
fn check_boundaries(
    walls: &[WallBody],
    moved: &[BodyId],
    common: &Common,
    sim: &mut SimBuilder<'_>,
) -> Result<(), SetupError> {
    let Common { support, spacing, periodic, .. } = common;
    for wall in walls {
        if let Some(warning) = checks::wall_is_thick(sim.body(wall.id), *spacing, *support, periodic)? {
            sim.warn(warning);
        }
    }
    moved.iter().try_for_each(|&id| checks::is_fine(sim.body(id), *spacing))
}

impl Bodies {
    /// Adds the particles of a body behind those of the others, and gives their rows in the cloud.
    fn add(&mut self, body: &BodyPlan, role: Role) -> Range<usize> {
        let start = self.groups.last().map_or(0, |group| group.cloud.end);
        let cloud = start..start + body.rows.len();
        self.groups.push(Group {
            body: body.id,
            phase: body.phase,
            rows: body.rows.clone(),
            cloud: cloud.clone(),
            role,
            held: true,
            short: false,
        });
        cloud
    }

    /// Adds the walls.
    fn add_walls(&mut self, walls: &[WallBody], sim: &SimBuilder<'_>) {
        for WallBody { id, parameters } in walls {
            let surface = BoundarySurface {
                no_slip: parameters.slip == Some(Slip::No),
                suction: parameters.suction,
                velocity: parameters.surface_velocity.0,
                moved: false,
                falls: false,
            };
            self.add(sim.body(*id), Role::Boundary(surface));
        }
    }

    /// Adds the bodies that the fluid moves, thin ones twice.
    fn add_moved(
        &mut self,
        moved: &[BodyId],
        suction: bool,
        common: &Common,
        sim: &mut SimBuilder<'_>,
    ) -> Result<(), SetupError> {
        let velocity = DVec3::ZERO;
        for &id in moved {
            let body = sim.body(id);
            let falls = body.kind == BodyKind::Rigid && !is_prescribed(body, sim);
            let role =
                Role::Boundary(BoundarySurface { no_slip: true, suction, velocity, moved: true, falls });
            let first = self.add(body, role);
            let thickness = Thickness::of(body, common.support, &common.periodic)?;
            if let Some(thin) = thickness.sheet() {
                let stirs = checks::thin_part_stirs(body, &thin, common.spacing);
                let copies = [first, self.add(body, role)];
                let thickness = if common.periodic.any() {
                    Thickness::of(body, common.support, &Periodic::NONE)?
                } else {
                    thickness
                };
                self.thin.push(ThinBody::new(body, copies, thickness, common.plane));
                stirs.into_iter().for_each(|warning| sim.warn(warning));
            }
        }
        Ok(())
    }
}

/// The cloud of the particles of all bodies, before the first step; `repulsion_range` is that of the
/// repulsion of boundaries, m.
fn cloud(
    bodies: Bodies,
    common: Common,
    repulsion_range: f64,
    sim: &mut SimBuilder<'_>,
) -> Result<FlowCloud, SetupError> {
    let Bodies { groups, fluid, thin } = bodies;
    let Common { kernel, support, spacing, periodic, plane } = common;
    let turns = groups.iter().any(|group| group.sticks() && may_turn(sim.body(group.body), sim));
    let viscosities = Viscosities::new(&groups, kernel.smoothing_length(), turns);
    let spin = viscosities.spin;
    let skins = Skins::new(support, spacing, &periodic);
    let ends = groups.iter().map(|group| group.cloud.end as u32).collect();
    let total = groups.last().map_or(0, |group| group.cloud.end);
    let blocks = blocks::choose(total, spacing, !thin.is_empty(), sim)?;
    let gaps = GapPairs::new(sides(&groups, sim));
    let neighborhoods = neighborhoods(&groups, spin, spacing, sim)?;
    Ok(FlowCloud {
        groups,
        fluid,
        kernel,
        pressure_factor: 1.0,
        viscosities,
        plane,
        periods: Periods::new(&periodic),
        before: Vec::new(),
        records: vec![FlowParticle::default(); total],
        is_still: Vec::new(),
        others: OtherParticles::default(),
        blocks,
        pairs: FlowPairs::new(skins, periodic, ends, thin, plane).with_gaps(gaps),
        near: NearRows::default(),
        near_boundary: NearRows::default(),
        compression: Vec::new(),
        boundary_compression: Vec::new(),
        is_close: Vec::new(),
        repulsion_range,
        repelled: Vec::new(),
        edges: BoundaryEdges::default(),
        ends: Vec::new(),
        gap_forces: Vec::new(),
        gap_work: 0.0,
        loads: Vec::new(),
        spins: if spin { vec![Lanes4::ZERO; total] } else { Vec::new() },
        neighborhoods,
    })
}

/// The boundaries as the search for gaps sees them. The pressure of a gap does not answer to its volume, as
/// that of a fluid would, and would feed vibrations of deformable bodies.
fn sides(groups: &[Group], sim: &SimBuilder<'_>) -> Vec<GapSide> {
    let copies = |body: BodyId| groups.iter().filter(|group| group.body == body).count();
    let side = |group: &Group| {
        let Role::Boundary(surface) = &group.role else { return None };
        Some(GapSide {
            body: group.body,
            rows: group.cloud.clone(),
            moves: if surface.moved { SideMotion::Free } else { SideMotion::Wall },
            is_closed: copies(group.body) > 1 || sim.body(group.body).kind == BodyKind::Solid,
        })
    };
    groups.iter().filter_map(side).collect()
}

/// Whether a boundary may turn as a whole: a rigid body, or a wall that a condition moves.
fn may_turn(body: &BodyPlan, sim: &SimBuilder<'_>) -> bool {
    body.kind == BodyKind::Rigid || body.kind == BodyKind::Boundary && is_prescribed(body, sim)
}

/// Whether a condition prescribes the motion of any particle of a body.
fn is_prescribed(body: &BodyPlan, sim: &SimBuilder<'_>) -> bool {
    let rows = (body.phase, body.rows.start as u32)..(body.phase, body.rows.end as u32);
    sim.prescribed.range(rows).next().is_some()
}

/// Neighbourhoods within the bodies that deform, with spin within those to which fluids stick, and within
/// those on a part of which a probe measures the force.
fn neighborhoods(
    groups: &[Group],
    spin: bool,
    spacing: f64,
    sim: &SimBuilder<'_>,
) -> Result<Vec<Neighborhood>, SetupError> {
    let is_soft = |group: &Group| sim.body(group.body).kind == BodyKind::Solid;
    let mut all: Vec<Neighborhood> = Vec::new();
    for group in groups.iter().filter(|group| group.fluid().is_none()) {
        let is_soft = is_soft(group);
        let has_friction = spin && (is_soft || group.sticks());
        let asks = is_soft || has_friction || is_measured_in_part(group.body, sim);
        if asks && all.last().is_none_or(|near| near.body != group.body) {
            let near = Neighborhood::new(sim.body(group.body), spacing, &sim.periodic());
            let mut near = near.map_err(|error| SetupError::internal(&error))?;
            (near.is_soft, near.has_friction) = (is_soft, has_friction);
            all.push(near);
        }
    }
    Ok(all)
}

/// Whether a probe measures force or torque of the fluids on a part of that body.
fn is_measured_in_part(body: BodyId, sim: &SimBuilder<'_>) -> bool {
    sim.scene().probes.iter().any(|probe| {
        let of_flow = matches!(probe.quantity, Quantity::FluidForce | Quantity::FluidTorque { .. });
        let on = probe.on.as_ref().filter(|_| of_flow);
        on.is_some_and(|on| {
            let is_part = on.within.is_some() || on.face.is_some() || on.nearest.is_some();
            is_part && on.means(&sim.body(body).name)
        })
    })
}

/// The bodies that a fluid moves, those of a phase together: solids, then rigid bodies.
fn moved_bodies(sim: &SimBuilder<'_>) -> Vec<BodyId> {
    let of = |kind| sim.bodies().iter().filter(move |body| body.kind == kind);
    let mut solids: Vec<&BodyPlan> = of(BodyKind::Solid).collect();
    solids.sort_by_key(|body| body.phase);
    solids.into_iter().chain(of(BodyKind::Rigid)).map(|body| body.id).collect()
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
