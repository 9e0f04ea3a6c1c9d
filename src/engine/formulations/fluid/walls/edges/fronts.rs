//! The faces of walls in front of fluid particles near edges.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Front, Group, part};
use crate::formulations::fluid::lists::SideMotion;
use crate::formulations::fluid::walls::surface_distance::{BoundaryShape, BoundaryView, FaceBefore};
use crate::plugin::{BodyKind, SimBuilder};
use crate::scene::{Probe, Quantity};
use crate::schedule::{Step, StepError};

/// The shapes of the walls, and of the rigid bodies whose motion is prescribed.
pub struct WallShapes {
    shapes: Vec<BoundaryShape>,
    /// Their rows, without those of bodies that forces move, once that is known.
    rows: Option<Vec<Range<usize>>>,
    /// Whether a probe asks for forces on walls, so that edges count where nothing moves.
    are_asked: bool,
}

impl WallShapes {
    /// Those of a flow with at least two.
    pub fn new(groups: &[Group], sim: &SimBuilder<'_>) -> Option<Self> {
        // Nothing is repelled here.
        let shape = |group| BoundaryShape::of(group, Vec::new(), 2.0 * sim.body(group.body).spacing, sim);
        let shapes: Vec<BoundaryShape> = Self::candidates(groups, sim).filter_map(shape).collect();
        let are_asked = Self::are_asked_for(groups, sim);
        (shapes.len() > 1).then_some(Self { shapes, rows: None, are_asked })
    }

    /// Whether there may be edges.
    pub fn are_possible(groups: &[Group], sim: &SimBuilder<'_>) -> bool {
        Self::candidates(groups, sim).count() > 1
    }

    /// The walls and the rigid bodies.
    fn candidates<'a>(groups: &'a [Group], sim: &'a SimBuilder<'_>) -> impl Iterator<Item = &'a Group> {
        groups.iter().filter(|group| group.is_wall() || sim.body(group.body).kind == BodyKind::Rigid)
    }

    /// Leaves out the bodies that forces move, and those without suction: ahead of a body that slides far
    /// along a wall without suction the pressure would rise.
    fn find_prescribed(&mut self, cloud: &FlowCloud) {
        if self.rows.is_none() {
            let motion = |group: &Group| cloud.pairs.gaps.side_of(group.cloud.start).moves;
            let counts = |group: &Group| {
                group.is_wall() || group.has_suction() && motion(group) == SideMotion::Prescribed
            };
            self.shapes.retain(|shape| counts(&shape.group));
            self.rows = Some(self.shapes.iter().map(|shape| shape.group.cloud.clone()).collect());
        }
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

    /// The rows of these boundaries.
    pub fn rows(&self) -> &[Range<usize>] {
        self.rows.as_deref().unwrap_or_default()
    }

    /// Writes down the faces before all fluid particles that have several walls within the support, and
    /// says whether there may be edges of bodies.
    pub fn find(
        &mut self,
        cloud: &FlowCloud,
        step: &Step<'_>,
        out: &mut Vec<Front>,
    ) -> Result<bool, StepError> {
        out.clear();
        self.find_prescribed(cloud);
        if self.shapes.len() < 2 || !self.are_asked && !self.part(cloud) {
            self.shapes.iter_mut().for_each(BoundaryShape::forget_motion);
            return Ok(false);
        }
        let Self { shapes, rows, .. } = self;
        let rows = rows.as_deref().unwrap_or_default();
        for shape in shapes {
            shape.look(cloud, step, |seen| find_before(seen, cloud, rows, out))?;
        }
        Ok(self.shapes.iter().any(|shape| !shape.group.is_wall()))
    }
}

/// Writes down the faces of a wall before fluid particles that have another one of the walls of these `rows`
/// within the support.
fn find_before(seen: &BoundaryView<'_>, cloud: &FlowCloud, rows: &[Range<usize>], out: &mut Vec<Front>) {
    let shape = seen.shape;
    for i in (0..cloud.fluid).filter(|&i| cloud.is_close[i] != 0) {
        let own = part(cloud.near_row(i), &shape.group.cloud);
        let is_beside = |w: &u32| cloud.value_between(i, *w as usize) > 0.0;
        let mut others = rows.iter().filter(|rows| **rows != shape.group.cloud);
        if own.is_empty() || !others.any(|rows| part(cloud.near_row(i), rows).iter().any(is_beside)) {
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
