//! The faces of walls in front of fluid particles near edges.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Front, Group, part};
use crate::formulations::fluid::walls::surface_distance::{BoundaryShape, BoundaryView, FaceBefore};
use crate::plugin::SimBuilder;
use crate::scene::{Probe, Quantity};
use crate::schedule::{Step, StepError};

/// The shapes of the walls.
pub struct WallShapes {
    shapes: Vec<BoundaryShape>,
    /// Whether a probe asks for forces on walls, so that edges count where nothing moves.
    are_asked: bool,
}

impl WallShapes {
    /// Those of a flow with at least two.
    pub fn new(groups: &[Group], sim: &SimBuilder<'_>) -> Option<Self> {
        let walls = groups.iter().filter(|group| group.is_wall());
        // Nothing is repelled here.
        let shape = |group| BoundaryShape::of(group, Vec::new(), 2.0 * sim.body(group.body).spacing, sim);
        let shapes: Vec<BoundaryShape> = walls.filter_map(shape).collect();
        let are_asked = Self::are_asked_for(groups, sim);
        (shapes.len() > 1).then_some(Self { shapes, are_asked })
    }

    /// Whether there are several walls, and a probe asks for forces on any.
    pub fn are_asked_for(groups: &[Group], sim: &SimBuilder<'_>) -> bool {
        let walls = || groups.iter().filter(|group| group.is_wall());
        let asks = |probe: &Probe| {
            let of_force = matches!(
                probe.quantity,
                Quantity::FluidForce
                    | Quantity::FluidTorque { .. }
                    | Quantity::Force
                    | Quantity::Moment { .. }
            );
            let on = probe.on.as_ref().filter(|_| of_force);
            on.is_some_and(|on| walls().any(|group| on.means(&sim.body(group.body).name)))
        };
        walls().count() > 1 && sim.scene().probes.iter().any(asks)
    }

    /// Whether any two of these walls move against each other.
    fn part(&self, cloud: &FlowCloud) -> bool {
        let mut records = self.shapes.iter().flat_map(|shape| &cloud.records[shape.group.cloud.clone()]);
        let first = records.next().map(|record| record.velocity());
        records.any(|record| Some(record.velocity()) != first)
    }

    /// The rows of these walls.
    pub fn rows(&self) -> Range<usize> {
        let (first, last) = (&self.shapes[0].group.cloud, &self.shapes[self.shapes.len() - 1].group.cloud);
        first.start..last.end
    }

    /// Writes down the faces before all fluid particles that have several walls within the support.
    pub fn find(
        &mut self,
        cloud: &FlowCloud,
        step: &Step<'_>,
        out: &mut Vec<Front>,
    ) -> Result<(), StepError> {
        out.clear();
        if !self.are_asked && !self.part(cloud) {
            self.shapes.iter_mut().for_each(BoundaryShape::forget_motion);
            return Ok(());
        }
        let rows = self.rows();
        for shape in &mut self.shapes {
            shape.look(cloud, step, |seen| find_before(seen, cloud, &rows, out))?;
        }
        Ok(())
    }
}

/// Writes down the faces of a wall before fluid particles that have another one of the walls of these `rows`
/// within the support.
fn find_before(seen: &BoundaryView<'_>, cloud: &FlowCloud, rows: &Range<usize>, out: &mut Vec<Front>) {
    let shape = seen.shape;
    for i in (0..cloud.fluid).filter(|&i| cloud.is_close[i] != 0) {
        let walls = part(cloud.near_row(i), rows);
        let own = part(walls, &shape.group.cloud);
        let is_other = |w: &u32| {
            !shape.group.cloud.contains(&(*w as usize)) && cloud.value_between(i, *w as usize) > 0.0
        };
        if own.is_empty() || !walls.iter().any(is_other) {
            continue;
        }
        if seen.is_beyond(shape.before(), cloud, i) {
            continue;
        }
        let Some(FaceBefore { place, nearness, normal }) = seen.face(cloud, i) else { continue };
        let share = |j: &u32| place.shares.of(cloud, i, *j as usize) * cloud.records[*j as usize].velocity();
        out.push(Front {
            i,
            boundary: shape.group.cloud.start,
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
