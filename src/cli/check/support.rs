//! Notes on flows that need a larger kernel support than the default.

use meshless_engine::formulations::fluid::{FlowCloud, FluidState, Group};
use meshless_engine::glam::DVec3;
use meshless_engine::notation::number;
use meshless_engine::scene::Scene;
use meshless_engine::shapes::Lattice;
use meshless_engine::simulation::Simulation;

/// Smoothing length over spacing below which a cubic lattice at rest rearranges, in three dimensions: that of
/// a support of 2.8 spacings.
const OF_STILL_WATER: f64 = 1.399;
/// Mean acceleration over gravity below which a fluid is at rest.
const AT_REST: f64 = 0.1;
/// Kinematic viscosity over speed of sound and smoothing length above which the lattice stays.
const VISCOUS: f64 = 0.01;

/// Notes on the support of fluids; the simulation has done some steps.
pub fn notes(scene: &Scene, sim: &Simulation) -> Vec<String> {
    let Some(cloud) = FlowCloud::whole(sim.resources()) else { return Vec::new() };
    let fluids: Vec<(&Group, &FluidState)> =
        cloud.groups.iter().filter_map(|group| Some((group, group.fluid()?))).collect();
    let Some((first, _)) = fluids.first() else { return Vec::new() };
    let h = cloud.kernel.smoothing_length();
    let share = h / sim.world().body(first.body).spacing;
    let gravity = scene.gravity.0;
    if gravity == DVec3::ZERO || cloud.plane() {
        return Vec::new();
    }
    let rearranges = |(group, state): &&(&Group, &FluidState)| {
        let rests = mean_speed(&cloud, group) < AT_REST * gravity.length() * sim.clock().time;
        let is_cubic = matches!(scene.bodies[group.body.0].lattice, Lattice::Automatic | Lattice::Regular);
        is_cubic && rests && state.viscosity < VISCOUS * state.density * state.sound_speed * h
    };
    let still = fluids.iter().filter(|_| share < OF_STILL_WATER).filter(rearranges);
    let note = |(group, _): &(&Group, &FluidState)| {
        format!(
            "fluid `{}` is at rest: in three dimensions its particles rearrange under their own pressure with a support of {} spacings, at some 3 % of the speed of a fall through its depth; \
             `Fluid(support: 3.0)` keeps them at rest, and a step takes a quarter longer",
            sim.world().body(group.body).name,
            number((20.0 * share).round() / 10.0)
        )
    };
    still.map(note).collect()
}

/// Root mean square of the speeds of a fluid, m/s.
fn mean_speed(cloud: &FlowCloud, group: &Group) -> f64 {
    let records = &cloud.records()[group.cloud.clone()];
    let sum: f64 = records.iter().map(|record| record.velocity().length_squared()).sum();
    (sum / records.len().max(1) as f64).sqrt()
}
