//! The faces of walls in front of fluid particles near edges.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::fluid::cloud::{BoundaryEdges, FlowCloud, Front, Group, part};
use crate::formulations::fluid::lists::SideMotion;
use crate::formulations::fluid::walls::surface_distance::{BoundaryShape, BoundaryView, FaceBefore};
use crate::plugin::SimBuilder;
use crate::scene::{Probe, Quantity};
use crate::schedule::{Step, StepError};

/// The shapes of the walls and bodies of a flow.
pub struct WallShapes {
    shapes: Vec<BoundaryShape>,
    /// Their rows.
    rows: Vec<Range<usize>>,
    /// For each of them, the fluid particles that have it and another one within the support.
    beside: Vec<Vec<usize>>,
    /// Whether a probe asks for forces on walls or bodies, so that edges count where nothing moves.
    are_asked: bool,
}

impl WallShapes {
    /// Those of a flow with at least two known shapes.
    pub fn new(groups: &[Group], sim: &SimBuilder<'_>) -> Option<Self> {
        let shape = |group| BoundaryShape::of(group, 2.0 * sim.body(group.body).spacing, sim);
        let shapes: Vec<BoundaryShape> = Self::candidates(groups).filter_map(shape).collect();
        let rows = shapes.iter().map(|shape| shape.group.cloud.clone()).collect();
        let beside = vec![Vec::new(); shapes.len()];
        let are_asked = Self::are_asked_for(groups, sim);
        (Self::are_possible(groups) && shapes.len() > 1).then_some(Self { shapes, rows, beside, are_asked })
    }

    /// Whether there may be edges: where there are several walls or bodies.
    pub fn are_possible(groups: &[Group]) -> bool {
        let mut bodies = Self::candidates(groups).map(|group| group.body);
        let first = bodies.next();
        bodies.any(|body| Some(body) != first)
    }

    /// All but the fluids.
    fn candidates(groups: &[Group]) -> impl Iterator<Item = &Group> {
        groups.iter().filter(|group| group.fluid().is_none())
    }

    /// Whether there are several walls or bodies, and a probe asks for forces on any.
    pub fn are_asked_for(groups: &[Group], sim: &SimBuilder<'_>) -> bool {
        let asks = |probe: &Probe| {
            let of_force = matches!(
                probe.quantity,
                Quantity::FluidForce
                    | Quantity::FluidTorque { .. }
                    | Quantity::Force
                    | Quantity::Torque
                    | Quantity::Moment { .. }
            );
            let on = probe.on.as_ref().filter(|_| of_force);
            on.is_some_and(|on| Self::candidates(groups).any(|group| on.means(&sim.body(group.body).name)))
        };
        Self::are_possible(groups) && sim.scene().probes.iter().any(asks)
    }

    /// Whether any two of these boundaries may move against each other.
    fn part(&self, cloud: &FlowCloud) -> bool {
        let is_free = |rows: &Range<usize>| cloud.pairs.gaps.side_of(rows.start).moves == SideMotion::Free;
        let mut records = self.rows.iter().flat_map(|rows| &cloud.records[rows.clone()]);
        let first = records.next().map(|record| record.velocity());
        self.rows.iter().any(is_free) || records.any(|record| Some(record.velocity()) != first)
    }

    /// Writes down the faces before all fluid particles that have several of these boundaries within the
    /// support, and the rows of the boundaries, if there may be edges.
    pub fn find(
        &mut self,
        cloud: &FlowCloud,
        step: &Step<'_>,
        out: &mut BoundaryEdges,
    ) -> Result<(), StepError> {
        out.fronts.clear();
        out.rows.clear();
        if !self.are_asked && !self.part(cloud) {
            self.shapes.iter_mut().for_each(BoundaryShape::forget_motion);
            return Ok(());
        }
        out.rows.extend_from_slice(&self.rows);
        self.find_beside(cloud);
        let Self { shapes, rows, beside, .. } = self;
        for (shape, beside) in shapes.iter_mut().zip(beside) {
            shape.notice_failure(step)?;
            if beside.is_empty() {
                shape.forget_motion();
                continue;
            }
            shape.look(cloud, step, |seen| find_before(seen, cloud, (rows, beside), &mut out.fronts))?;
        }
        Ok(())
    }

    /// Finds the fluid particles beside several boundaries.
    fn find_beside(&mut self, cloud: &FlowCloud) {
        let Self { rows, beside, .. } = self;
        beside.iter_mut().for_each(Vec::clear);
        for i in (0..cloud.fluid).filter(|&i| cloud.is_close[i] != 0) {
            let mut first = None;
            for_each_of(rows, cloud.near_row(i), |k| match first {
                None => first = Some((k, false)),
                Some((before, is_written)) => {
                    if !is_written {
                        beside[before].push(i);
                    }
                    beside[k].push(i);
                    first = Some((before, true));
                }
            });
        }
    }
}

/// Calls `f` with the number of each of the boundaries, which have these rows of the cloud, that a row of
/// neighbours has particles of.
fn for_each_of(rows: &[Range<usize>], mut near: &[u32], mut f: impl FnMut(usize)) {
    for k in 0..rows.len() {
        near = &near[near.partition_point(|&j| (j as usize) < rows[k].start)..];
        let Some(&j) = near.first() else { return };
        if (j as usize) < rows[k].end {
            f(k);
        }
    }
}

/// Writes down the faces of a boundary before those of these fluid particles that have another one of the
/// boundaries with these rows within the support.
fn find_before(
    seen: &BoundaryView<'_>,
    cloud: &FlowCloud,
    (rows, beside): (&[Range<usize>], &[usize]),
    out: &mut Vec<Front>,
) {
    let shape = seen.shape;
    let own_rows = &shape.group.cloud;
    for &i in beside {
        let own = part(cloud.near_row(i), own_rows);
        let is_beside = |w: &u32| cloud.value_between(i, *w as usize) > 0.0;
        let joins = |rows: &&Range<usize>| cloud.pairs.gaps.have_edges(rows.start, own_rows.start);
        let mut others = rows.iter().filter(|rows| **rows != *own_rows).filter(joins);
        if !others.any(|rows| part(cloud.near_row(i), rows).iter().any(is_beside)) {
            continue;
        }
        if seen.is_beyond(shape.before(), cloud, i) {
            continue;
        }
        let Some(FaceBefore { place, nearness, normal }) = seen.face(cloud, i) else { continue };
        let share = |j: &u32| place.shares.of(cloud, i, *j as usize) * cloud.records[*j as usize].velocity();
        out.push(Front {
            i,
            boundary: own_rows.start,
            normal,
            weight: nearness,
            distance: place.distance,
            spacing: shape.spacing,
            velocity: own.iter().map(share).sum::<DVec3>(),
            shares: place.shares,
            force: [DVec3::ZERO; 2],
        });
    }
}
