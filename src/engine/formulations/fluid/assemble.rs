//! The systems of a flow, once all fluids and walls of the scene are known.

use std::sync::{Arc, Mutex};

use glam::DVec3;

use super::checks;
use super::cloud::{FlowCloud, FluidState, Group, Role, Surface};
use super::density::Continuity;
use super::force::{ACCOUNTS, FLUID_FORCE, FlowForce};
use super::formulation::FluidBody;
use super::kernel::FluidKernel;
use super::neighbors::Neighbors;
use super::pair_rows::FluidPairs;
use super::pairs::FlowPairs;
use super::record::{Periods, Record};
use super::start::{StartPressure, start};
use super::state::EquationOfState;
use super::wall::{PreviousVelocity, WallBody};
use super::wall_state::WallState;
use crate::formulations::total_lagrangian::{INTERNAL_FORCE, TotalLagrangian};
use crate::neighbors::Periodic;
use crate::pair::{BodyTerms, add_pair_systems, add_work_systems};
use crate::plugin::{BodyPlan, Formulation, SetupError, SimBuilder};
use crate::removal::REMOVAL;
use crate::scene::{Dimension, Problem};
use crate::schedule::{Stage, System};
use crate::world::{
    BodyId, Density, DensityRate, Force, Mass, PhaseId, Position, Pressure, ReferenceVolume, Removed,
    Velocity,
};

/// Label of the system that keeps the neighbour lists of fluids.
pub(super) const NEIGHBORS: &str = "fluid_neighbors";
/// Skin of the neighbour lists over the spacing of the fluid.
const SKIN: f64 = 0.4;

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
    one_support(&fluids, support, sim)?;
    let periodic = periodic_of(sim)?;
    for wall in &walls {
        checks::wall_is_thick(sim.body(wall.id), spacing, support, &periodic)?;
    }
    let solids = solids(sim);
    for &id in &solids {
        checks::is_fine(sim.body(id), spacing)?;
        if let Err(SetupError::Problems(problems)) =
            checks::wall_is_thick(sim.body(id), spacing, support, &periodic)
        {
            problems.iter().for_each(|problem| sim.warn(problem.message.clone()));
        }
    }
    let mut groups = Vec::new();
    let mut pressures = Vec::new();
    for FluidBody { id, parameters, .. } in fluids {
        let body = sim.body(id);
        groups.push(group(body, Role::Fluid(fluid_state(body)?), &groups));
        pressures.push(match parameters.pressure {
            Some(expression) => StartPressure::Given(expression),
            None => hydrostatic(body, sim.gravity()),
        });
    }
    let fluid: usize = groups.iter().map(|group| group.rows.len()).sum();
    for WallBody { id, parameters } in &walls {
        let surface = Surface {
            no_slip: parameters.slip == super::Slip::No,
            suction: parameters.suction,
            velocity: parameters.surface_velocity.0,
            moved: false,
        };
        groups.push(group(sim.body(*id), Role::Boundary(surface), &groups));
    }
    for id in solids {
        let surface = Surface { no_slip: true, suction: false, velocity: DVec3::ZERO, moved: true };
        groups.push(group(sim.body(id), Role::Boundary(surface), &groups));
    }
    let dimension = sim.dimension().count();
    let total = groups.last().map_or(0, |group| group.cloud.end);
    let cloud = FlowCloud {
        groups: groups.clone(),
        fluid,
        kernel: FluidKernel::new(support, dimension),
        plane: sim.dimension() == Dimension::Two,
        periods: Periods::new(&periodic),
        positions: vec![DVec3::ZERO; total],
        records: vec![Record::default(); total],
        pairs: FlowPairs::new(support, SKIN * spacing, periodic),
    };
    sim.add_setup(move |setup| {
        start(&cloud, &pressures, setup)?;
        checks::flow_is_slow(&cloud, setup.world)?;
        setup.resources.insert(cloud);
        Ok(())
    });
    add(&groups, sim)
}

fn add(groups: &[Group], sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    let mut phases: Vec<PhaseId> = groups.iter().map(|group| group.phase).collect();
    phases.dedup();
    let bounding = |moved: bool| {
        let of = |group: &&Group| matches!(&group.role, Role::Boundary(surface) if surface.moved == moved);
        groups.iter().find(of).map(|group| group.phase)
    };
    let (fluid, walls, solids) = (groups[0].phase, bounding(false), bounding(true));
    let account = add_pair_systems(sim, fluid, FLUID_FORCE, FluidPairs)?;
    sim.add_system(
        System::new(Stage::Neighbors, NEIGHBORS, Neighbors::default())
            .on_phases(phases)
            .after(REMOVAL)
            .reads::<Position>()
            .reads::<Velocity>()
            .reads::<ReferenceVolume>(),
    );
    let continuity = Continuity { account, compression: Vec::new(), sums: Vec::new() };
    sim.add_system(
        System::new(Stage::Gradients, "fluid_continuity", continuity)
            .on_phases([fluid])
            .reads::<DensityRate>()
            .reads::<Mass>()
            .reads::<Removed>()
            .writes::<Density>(),
    );
    sim.add_system(
        System::new(
            Stage::Constitutive,
            "fluid_pressure",
            EquationOfState { warned: Vec::new(), sums: Vec::new() },
        )
        .on_phases([fluid])
        .reads::<Density>()
        .reads::<Mass>()
        .reads::<Removed>()
        .writes::<Pressure>(),
    );
    let gravity = sim.gravity();
    add_force(sim, groups, fluid, FLUID_FORCE, Some(gravity));
    if walls.is_some() || solids.is_some() {
        sim.add_system(
            System::new(Stage::Boundary, "wall_pressure", WallState { gravity, beside: Vec::new() })
                .on_phases(walls)
                .reads::<Velocity>()
                .writes::<Pressure>()
                .writes::<PreviousVelocity>(),
        );
    }
    if let Some(walls) = walls {
        add_force(sim, groups, walls, "fluid_force_on_walls", Some(gravity));
    }
    if let Some(solids) = solids {
        add_force(sim, groups, solids, "fluid_force_on_solids", None);
    }
    Ok(())
}

fn add_force(
    sim: &mut SimBuilder<'_>,
    groups: &[Group],
    phase: PhaseId,
    label: &'static str,
    gravity: Option<DVec3>,
) {
    let of_phase = groups.iter().filter(|group| group.phase == phase);
    let terms = |group: &Group| BodyTerms {
        id: group.body,
        terms: (0..ACCOUNTS.len()).collect(),
        forces: Vec::new(),
    };
    let parts = Arc::new(Mutex::new(of_phase.map(terms).collect()));
    let force = FlowForce { phase, gravity, parts: Arc::clone(&parts) };
    let system =
        System::new(Stage::Rates, label, force).on_phases([phase]).reads::<Mass>().reads::<Removed>();
    // Solids have got their weight with their internal force.
    sim.add_system(match gravity {
        Some(_) => system.writes::<Force>(),
        None => system.after(INTERNAL_FORCE).adds::<Force>(),
    });
    add_work_systems(sim, phase, ACCOUNTS.map(str::to_owned).to_vec(), parts);
}

/// The bodies that a fluid moves.
fn solids(sim: &SimBuilder<'_>) -> Vec<BodyId> {
    let moved = sim.bodies().iter().filter(|body| body.formulation == TotalLagrangian::NAME);
    moved.map(|body| body.id).collect()
}

fn group(body: &BodyPlan, role: Role, before: &[Group]) -> Group {
    let start = before.last().map_or(0, |group| group.cloud.end);
    Group {
        body: body.id,
        phase: body.phase,
        rows: body.rows.clone(),
        cloud: start..start + body.rows.len(),
        role,
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

fn hydrostatic(body: &BodyPlan, gravity: DVec3) -> StartPressure {
    let (min, max) = (body.bounds.min, body.bounds.max);
    let surface = DVec3::select(gravity.cmplt(DVec3::ZERO), max, min);
    StartPressure::Hydrostatic { gravity, surface }
}

fn one_support(fluids: &[FluidBody], support: f64, sim: &SimBuilder<'_>) -> Result<(), SetupError> {
    let Some(other) = fluids.iter().find(|other| (other.support - support).abs() > 1e-9 * support) else {
        return Ok(());
    };
    let (first, body) = (sim.body(fluids[0].id), sim.body(other.id));
    let message = format!(
        "the fluid `{}` has a support radius of {} m, and `{}` one of {support} m",
        body.name, other.support, first.name
    );
    let problem = Problem::at_path(format!("bodies[{}].spacing", other.id.0), message);
    Err(SetupError::Problems(vec![problem.help("give all fluids of a scene one spacing and one `support`")]))
}

fn periodic_of(sim: &SimBuilder<'_>) -> Result<Periodic, SetupError> {
    let Some(domain) = &sim.scene().domain else { return Ok(Periodic::NONE) };
    let mut axes = [false; 3];
    domain.periodic.iter().for_each(|axis| axes[axis.index()] = true);
    Periodic::new(domain.min.0, domain.max.0, axes).map_err(|error| {
        let problem = Problem::at_path("domain", error.to_string());
        SetupError::Problems(vec![problem])
    })
}
