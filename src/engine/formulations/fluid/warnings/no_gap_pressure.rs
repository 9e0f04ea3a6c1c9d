//! Deformable and thin bodies that lie on other bodies or walls in a fluid: it has no pressure in the gap.
//!
//! Under a container that stands in the dry with its fluid inside there is no fluid to have one.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Group, Role};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch};
use crate::notation::place;
use crate::rigid::RigidBodies;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, Mobility};

/// Distance of two particles that touch, over the mean of their spacings.
const TOUCH: f64 = 1.25;
/// Width of a dry part in contact, over the spacing of the fluid, from which on a body is reported.
const MIN_WIDTH: f64 = 3.0;
/// Distance, over the spacing of the fluid, by which the fluid beside a body may be farther from what the
/// body touches than the body itself: half a spacing where its lattice is shifted against that of the body;
/// in a container of two layers, half as wide as those of the fluid, it is one and a quarter.
const REACH: f64 = 0.75;

/// Warns, once, of the first body that lies on something and is wet elsewhere; `spacing` is that of the
/// fluid, m.
pub fn look(
    is_told: &mut bool,
    cloud: &FlowCloud,
    spacing: f64,
    step: &mut Step<'_>,
) -> Result<(), StepError> {
    if *is_told {
        return Ok(());
    }
    for group in cloud.groups.iter().filter(|group| group.fluid().is_none()) {
        let Role::Boundary(surface) = &group.role else { continue };
        let is_wet = |row: usize| cloud.is_wet(row);
        if !surface.moved || !cloud.pairs.gaps.side_of(group.cloud.start).is_closed {
            continue;
        }
        let view = step.world.phase(group.phase);
        let mobility = &view.read::<Mobility>()?[group.rows.clone()];
        let copies = || cloud.groups.iter().filter(|other| other.body == group.body);
        let is_dry = |k: usize| copies().any(|copy| !is_wet(copy.cloud.start + k));
        let rows = 0..group.rows.len();
        // The particles of rigid bodies move with these.
        let is_rigid = step.resources.try_get::<RigidBodies>();
        let is_rigid = is_rigid.is_some_and(|bodies| bodies.iter().any(|body| body.id == group.body));
        let is_free = |k: usize| is_rigid || mobility[k].0 != DVec3::ZERO;
        let free: Vec<usize> = rows.filter(|&k| is_free(k) && is_dry(k)).collect();
        if free.len() == group.rows.len() && copies().all(|copy| !copy.cloud.clone().any(is_wet)) {
            continue;
        }
        let place_of = |row: usize| cloud.records[row].position();
        let targets: Vec<DVec3> = free.iter().map(|&k| place_of(group.cloud.start + k)).collect();
        let first = first_above_gap(cloud, group, &targets, spacing).map_err(|error| StepError::System {
            system: "fluid_watch".to_owned(),
            message: error.to_string(),
        })?;
        let Some(first) = first else { continue };
        step.warnings.push(format!(
            "`{}` lies on another body or a wall at {}, and the fluid has no pressure in the gap between the two: what acts on it there is missing, and the rest presses it on; leave two \
             spacings of the fluid between them, or make it `Rigid` and thicker than the support of the fluid",
            step.world.body(group.body).name,
            place(targets[first])
        ));
        *is_told = true;
        return Ok(());
    }
    Ok(())
}

/// Number of the first of these places, of particles of a body without fluid, that touch another boundary
/// over some width beside fluid.
fn first_above_gap(
    cloud: &FlowCloud,
    group: &Group,
    targets: &[DVec3],
    spacing: f64,
) -> Result<Option<usize>, NeighborError> {
    let own = width(cloud, &cloud.records[group.cloud.start]);
    let apart = |other: f64| 0.5 * (own + other);
    let across = if cloud.plane { 1 } else { 2 };
    let is_wide = |found: &[(usize, BodyId)]| found.len() as f64 >= (MIN_WIDTH * spacing / own).powi(across);
    let mut touching = near_others(cloud, group, targets, &|other| TOUCH * apart(other), spacing)?;
    if !is_wide(&touching) {
        return Ok(None);
    }
    // Fluid that could get into the gap is beside both.
    let beside = fluid_beside(cloud, group.body);
    let wetted = near_others(cloud, group, &beside, &|other| REACH * spacing + apart(other), spacing)?;
    touching.retain(|(_, body)| wetted.iter().any(|(_, wet)| wet == body));
    Ok(touching.first().filter(|_| is_wide(&touching)).map(|(first, _)| *first))
}

/// Width of a particle, m.
fn width(cloud: &FlowCloud, record: &FlowParticle) -> f64 {
    record.volume().powf(if cloud.plane { 0.5 } else { 1.0 / 3.0 })
}

/// Places of the fluid in the support of the particles of a body, m.
fn fluid_beside(cloud: &FlowCloud, body: BodyId) -> Vec<DVec3> {
    let rows = cloud.groups.iter().filter(|group| group.body == body).flat_map(|group| group.cloud.clone());
    let mut beside: Vec<u32> = rows.flat_map(|row| cloud.near_row(row).iter().copied()).collect();
    beside.sort_unstable();
    beside.dedup();
    beside.iter().map(|&j| cloud.records[j as usize].position()).collect()
}

/// Numbers of the places that are near particles of other boundaries than `group`, with the bodies of the
/// nearest ones; `reach` is the distance that counts as near, m, of a particle of that width, m, none of
/// which is wider than `spacing`, m.
fn near_others(
    cloud: &FlowCloud,
    group: &Group,
    places: &[DVec3],
    reach: &dyn Fn(f64) -> f64,
    spacing: f64,
) -> Result<Vec<(usize, BodyId)>, NeighborError> {
    let others = cloud.groups.iter().filter(|other| other.fluid().is_none() && other.body != group.body);
    let others = others
        .flat_map(|other| cloud.records[other.cloud.clone()].iter().map(move |record| (other.body, record)));
    let others: Vec<(BodyId, &FlowParticle)> = others.filter(|(_, record)| record.volume() > 0.0).collect();
    let sources: Vec<DVec3> = others.iter().map(|(_, record)| record.position()).collect();
    let mut list = NeighborList::default();
    let farthest = reach(spacing);
    let (from, to) = (Cloud::uniform(places, farthest), Cloud::uniform(&sources, farthest));
    NeighborSearch::default().between(from, to, 0.0, cloud.pairs.periodic(), &mut list)?;
    let nearest = |k: usize| {
        let near = list.row(k).iter().filter_map(|&j| {
            let (body, record) = others[j as usize];
            let distance = cloud.offset(places[k], sources[j as usize]).length();
            (distance < reach(width(cloud, record))).then_some((distance, body))
        });
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, body)| (k, body))
    };
    Ok((0..places.len()).filter_map(nearest).collect())
}
