//! The systems of a flow and of its effect on its boundaries.

use crate::formulations::fluid::cloud::{
    ACCOUNTS, COMPRESSION_RATES, EDGES, ENDS, FLOW_LOADS, FLOW_RECORDS, GAP_FORCES, Group, ListPosition,
    NEIGHBORS, Neighbors, PRESSURE_FACTOR, REPELLED, Role, SPINS,
};
use crate::formulations::fluid::coupling::add_force_on_bodies;
use crate::formulations::fluid::density::{
    ApplyState, Continuity, DensityShift, DisplacementAccount, PressureFactor, open_gravity,
};
use crate::formulations::fluid::moments::{SurfaceMoments, SurfaceStretching};
use crate::formulations::fluid::passes::{Compression, FLUID_FORCE, FlowForce, reads_flow};
use crate::formulations::fluid::rotation::Spin;
use crate::formulations::fluid::setup::advice;
use crate::formulations::fluid::walls::{
    BeforeSphere, EdgeForces, EdgeMotion, GapPressure, PreviousVelocity, RangeShortfall, Repulsion,
    SeenMotions, WallCompression, WallEnds, WallShapes, WallState,
};
use crate::formulations::fluid::warnings::watch;
use crate::pair::{BodyTerms, PhaseTerms, add_work_systems};
use crate::plugin::{BodyKind, BodyPlan, SetupError, SimBuilder};
use crate::removal::REMOVAL;
use crate::rigid::RIGID_BODIES;
use crate::schedule::{Access, Mode, Stage, System};
use crate::world::{
    BodySet, Column, Damage, Density, DensityRate, Force, Mass, PhaseId, Pressure, ReferencePosition,
    Removed, Velocity,
};

/// Label of the system that finds who is near, and how fast fluids are compressed.
const COMPRESSION: &str = "fluid_compression";
/// Label of the system that lets fluids follow the compression beside walls with suction.
const WALL_COMPRESSION: &str = "wall_compression";
/// Label of the system that finds how walls move at edges.
const EDGE_MOTION: &str = "motion_at_edges";
/// Label of the system that divides forces at edges among the faces there.
const EDGE_FORCES: &str = "forces_at_edges";
/// Label of the system that lets fluids go on past the ends of walls.
const WALL_ENDS: &str = "wall_ends";
/// Label of the system that gives walls their pressure.
const WALL_PRESSURE: &str = "wall_pressure";

/// The phases of the boundary particles.
fn boundaries(groups: &[Group]) -> Vec<PhaseId> {
    let mut phases: Vec<PhaseId> =
        groups.iter().filter(|group| group.fluid().is_none()).map(|group| group.phase).collect();
    phases.dedup();
    phases
}

/// The phases that take sub-steps: those of bodies which the fluid moves, and that of walls if any of these
/// may touch one.
pub fn short_phases(groups: &[Group], sim: &SimBuilder<'_>) -> Vec<PhaseId> {
    let touching = sim.touching_pairs();
    let touched = |group: &Group| touching.names(group.body);
    let moved = |group: &Group| matches!(&group.role, Role::Boundary(surface) if surface.moved);
    if !groups.iter().any(moved) {
        return Vec::new();
    }
    let walls = |group: &&Group| group.fluid().is_none() && (moved(group) || touched(group));
    let mut phases: Vec<PhaseId> = groups.iter().filter(walls).map(|group| group.phase).collect();
    phases.dedup();
    phases
}

/// Adds the systems of the groups; with `spin`, friction is corrected by it.
pub fn add(
    groups: &[Group],
    spin: bool,
    repulsion: Repulsion,
    sim: &mut SimBuilder<'_>,
) -> Result<(), SetupError> {
    let mut phases: Vec<PhaseId> = groups.iter().map(|group| group.phase).collect();
    phases.dedup();
    let (fluid, boundaries) = (groups[0].phase, boundaries(groups));
    let terms = PhaseTerms::take(sim, fluid)?;
    advice::undamped_density(terms.as_ref(), groups, sim);
    let account = terms.as_ref().and_then(|terms| terms.of_density.clone());
    let bodies = BodySet::new(groups.iter().map(|group| group.body));
    sim.add_column_to::<ListPosition>(&bodies);
    // Sorting permutes all columns.
    let columns: Vec<&'static str> = sim.columns(fluid).iter().map(|column| column.name).collect();
    watch::add(phases.clone(), groups, account.clone(), sim);
    let lists = System::new(Stage::Neighbors, NEIGHBORS, Neighbors::default())
        .on_phases(phases.iter().copied())
        .touches_packed(FLOW_RECORDS, Mode::Writes)
        .touches_packed(FLOW_LOADS, Mode::Writes)
        .reads_own_packed()
        .after(REMOVAL);
    sim.add_system(columns.into_iter().fold(lists, |system, column| system.touches(column, Mode::Writes)));
    add_compression(sim, fluid);
    if !boundaries.is_empty() {
        let system = System::new(Stage::Neighbors, "fluid_repulsion", repulsion)
            .on_phases(phases)
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .touches_packed(REPELLED, Mode::Writes)
            .reads_near::<ReferencePosition>()
            .writes::<RangeShortfall>()
            .writes::<BeforeSphere>()
            .after(COMPRESSION);
        sim.add_system(noticing_failure(system, groups, sim));
    }
    add_boundary_rates(sim, groups, fluid, &boundaries);
    add_state(sim, fluid, account);
    add_force(sim, groups, fluid, FLUID_FORCE, terms);
    if spin {
        let system = System::new(Stage::Boundary, "fluid_spin", Spin::default())
            .on_phases([fluid])
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .touches_packed(SPINS, Mode::Writes);
        sim.add_system(if boundaries.is_empty() { system } else { system.after(WALL_PRESSURE) });
    }
    add_boundaries(sim, groups, boundaries, spin);
    Ok(())
}

/// Adds what finds neighbours within the support and rates of compression, and the factor of pressures.
fn add_compression(sim: &mut SimBuilder<'_>, fluid: PhaseId) {
    sim.add_system(
        System::new(Stage::Neighbors, COMPRESSION, Compression)
            .on_phases([fluid])
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .touches_packed(COMPRESSION_RATES, Mode::Writes)
            .after(NEIGHBORS),
    );
    sim.add_system(
        System::new(Stage::Neighbors, "pressure_factor", PressureFactor::default())
            .on_phases([fluid])
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .touches_packed(PRESSURE_FACTOR, Mode::Writes)
            .after(COMPRESSION),
    );
}

/// The system with access to the damage of bodies that can fail: a body of which particles have failed has
/// another shape.
fn noticing_failure(system: System, groups: &[Group], sim: &SimBuilder<'_>) -> System {
    let can_fail = groups.iter().any(|group| sim.body(group.body).can_fail());
    if can_fail { system.reads::<Damage>() } else { system }
}

/// Adds the contributions of the pressure of boundaries with suction and of the stretching of deformable
/// bodies to the compression of the fluid, where there are any.
fn add_boundary_rates(sim: &mut SimBuilder<'_>, groups: &[Group], fluid: PhaseId, boundaries: &[PhaseId]) {
    let has_suction = groups.iter().any(Group::has_suction);
    let mut before = COMPRESSION;
    if let Some(edges) = EdgeMotion::new(groups, sim) {
        let system = System::new(Stage::Neighbors, EDGE_MOTION, edges)
            .on_phases(boundaries.iter().copied().chain([fluid]))
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .touches_packed(COMPRESSION_RATES, Mode::Writes)
            .touches_packed(EDGES, Mode::Writes)
            .reads_near::<ReferencePosition>()
            .after(COMPRESSION);
        sim.add_system(noticing_failure(system, groups, sim));
        before = EDGE_MOTION;
    }
    if let Some(ends) = WallEnds::new(groups, sim) {
        sim.add_system(
            System::new(Stage::Neighbors, WALL_ENDS, ends)
                .on_phases(boundaries.iter().copied().chain([fluid]))
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads_own_packed()
                .touches_packed(COMPRESSION_RATES, Mode::Writes)
                .touches_packed(ENDS, Mode::Writes)
                .reads_near::<ReferencePosition>()
                .after(before),
        );
        before = WALL_ENDS;
    }
    if has_suction {
        sim.add_system(
            System::new(Stage::Neighbors, WALL_COMPRESSION, WallCompression::default())
                .on_phases([fluid])
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads_own_packed()
                .touches_packed(COMPRESSION_RATES, Mode::Writes)
                .after(before),
        );
    }
    let is_soft = |body: &BodyPlan| body.kind == BodyKind::Solid && boundaries.contains(&body.phase);
    if sim.bodies().iter().any(is_soft) {
        let before = if has_suction { WALL_COMPRESSION } else { before };
        sim.add_system(
            System::new(Stage::Neighbors, "stretching_surfaces", SurfaceStretching::default())
                .on_phases([fluid])
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads_own_packed()
                .touches_packed(COMPRESSION_RATES, Mode::Writes)
                .after(before),
        );
    }
}

/// Adds what turns compression into density, with its energy in an account, and density into pressure.
fn add_state(sim: &mut SimBuilder<'_>, fluid: PhaseId, account: Option<String>) {
    let displacements = sim.take_extensions::<DisplacementAccount>();
    let continuity = Continuity { account, displacements, sums: Vec::new() };
    let is_shifted = sim.columns(fluid).get(DensityShift::NAME).is_some();
    let shift = is_shifted.then_some(Access { column: DensityShift::NAME, mode: Mode::Writes });
    sim.add_system(
        System::new(Stage::Gradients, "fluid_continuity", continuity)
            .on_phases([fluid])
            .touches_packed(COMPRESSION_RATES, Mode::Reads)
            .touches_packed(PRESSURE_FACTOR, Mode::Reads)
            .reads_own_packed()
            .reads::<DensityRate>()
            .reads::<Mass>()
            .reads::<Removed>()
            .touches_all(shift)
            .writes::<Density>(),
    );
    let pressure = ApplyState { gravity: open_gravity(sim), mach: Vec::new(), sums: Vec::new() };
    sim.add_system(
        System::new(Stage::Constitutive, "fluid_pressure", pressure)
            .on_phases([fluid])
            .touches_packed(PRESSURE_FACTOR, Mode::Reads)
            .touches_packed(FLOW_RECORDS, Mode::Writes)
            .reads_own_packed()
            .reads::<Density>()
            .reads::<Mass>()
            .reads::<Removed>()
            .writes::<Pressure>(),
    );
}

/// Adds the pressure of the boundary particles, and the force on them.
fn add_boundaries(sim: &mut SimBuilder<'_>, groups: &[Group], boundaries: Vec<PhaseId>, spin: bool) {
    if !boundaries.is_empty() {
        let state =
            WallState { gravity: sim.gravity(), beside: Vec::new(), motions: SeenMotions::new(groups, sim) };
        sim.add_system(
            System::new(Stage::Boundary, WALL_PRESSURE, state)
                .on_phases(boundaries.iter().copied())
                .in_long_steps()
                .touches_packed(PRESSURE_FACTOR, Mode::Reads)
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads_own_packed()
                .touches_packed(FLOW_RECORDS, Mode::Writes)
                .touches_packed(FLOW_LOADS, Mode::ReadsNear)
                .touches_packed(RIGID_BODIES, Mode::Reads)
                .writes::<Pressure>()
                .writes::<PreviousVelocity>(),
        );
        if WallShapes::are_possible(groups) {
            sim.add_system(
                System::new(Stage::Boundary, EDGE_FORCES, EdgeForces)
                    .on_phases(boundaries.iter().copied())
                    .in_long_steps()
                    .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                    .reads_own_packed()
                    .touches_packed(EDGES, Mode::Writes)
                    .after(WALL_PRESSURE),
            );
        }
    }
    add_gap_pressure(sim, groups, &boundaries);
    for phase in boundaries {
        let of_phase = sim.bodies().iter().find(|body| body.phase == phase);
        let label = match of_phase.map(|body| body.kind) {
            Some(BodyKind::Boundary) => "fluid_force_on_walls",
            Some(BodyKind::Solid) => "fluid_force_on_solids",
            Some(BodyKind::Rigid) => "fluid_force_on_rigid_bodies",
            _ => continue,
        };
        if groups.iter().any(|group| group.phase == phase && group.short) {
            add_force_on_bodies(sim, groups, phase, label, spin);
        } else {
            add_force(sim, groups, phase, label, None);
        }
    }
}

/// Adds the pressure in gaps, where there are bodies beside which there may be some.
fn add_gap_pressure(sim: &mut SimBuilder<'_>, groups: &[Group], boundaries: &[PhaseId]) {
    if !groups.iter().any(|group| matches!(&group.role, Role::Boundary(surface) if surface.moved)) {
        return;
    }
    let gaps = GapPressure::new(sim.gravity(), sim.body(groups[0].body).spacing);
    sim.add_system(
        System::new(Stage::Boundary, "gap_pressure", gaps)
            .on_phases(boundaries.iter().copied())
            .in_long_steps()
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .touches_packed(FLOW_LOADS, Mode::ReadsNear)
            .touches_packed(EDGES, Mode::Reads)
            .touches_packed(PRESSURE_FACTOR, Mode::Reads)
            .touches_packed(GAP_FORCES, Mode::Writes)
            .reads_near::<Velocity>()
            .after(WALL_PRESSURE)
            .after_any(EDGE_FORCES),
    );
}

/// Adds the force on particles that take long steps; those that flow get their weight and their pair terms
/// with it.
fn add_force(
    sim: &mut SimBuilder<'_>,
    groups: &[Group],
    phase: PhaseId,
    label: &'static str,
    terms: Option<PhaseTerms>,
) {
    let of_phase = || groups.iter().filter(|group| group.phase == phase);
    let own = |group: &Group| BodyTerms {
        id: group.body,
        terms: (0..ACCOUNTS.len()).collect(),
        forces: Vec::new(),
    };
    let parts = sim.share(of_phase().map(own).collect::<Vec<_>>());
    let flows = of_phase().any(|group| group.fluid().is_some());
    let gravity = flows.then(|| sim.gravity());
    let access = terms.as_ref().map_or_else(Vec::new, |terms| terms.access(sim, phase));
    let force = FlowForce { phase, gravity, parts, moments: SurfaceMoments::default(), terms };
    let system = System::new(Stage::Rates, label, force).on_phases([phase]).touches_all(access);
    let system = reads_flow(system).reads::<Mass>().reads::<Removed>();
    sim.add_system(if flows { system.writes::<Force>() } else { system.adds::<Force>() });
    add_work_systems(sim, phase, ACCOUNTS.map(str::to_owned).to_vec(), parts);
}
