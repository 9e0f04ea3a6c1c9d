//! The system that gives bodies the pressure of gaps that no particle of the fluid fits into.

use glam::DVec3;

use super::fill::Fill;
use super::gap::{BoundaryMotion, Gap, GapRemainder};
use super::moments::{GapPair, Surrounding, of_surface};
use super::share::give;
use crate::formulations::fluid::cloud::{FlowCloud, Group, PARTS};
use crate::parallel::{for_each_block, for_each_heavy_block, sum_over_blocks};
use crate::schedule::{Run, Step, StepError};
use crate::world::{Force, Velocity};

/// Finds the forces of the pressure in gaps.
#[derive(Default)]
pub struct GapPressure {
    /// Acceleration of gravity, m/s2.
    gravity: DVec3,
    /// Spacing of the fluid, m.
    spacing: f64,
    gaps: Vec<Gap>,
    fill: Fill,
    across: Vec<GapPair>,
    /// Velocity of every boundary particle, m/s; that in the cloud is the one that friction sees.
    velocities: Vec<DVec3>,
    /// Work of the forces since the start of the run, J.
    work: f64,
}

type Rows<'a> = (&'a mut [Gap], &'a [[u32; 2]]);

impl GapPressure {
    /// Under this gravity, m/s2, beside a fluid of this spacing, m.
    pub fn new(gravity: DVec3, spacing: f64) -> Self {
        Self { gravity, spacing, ..Self::default() }
    }

    /// Finds the fluid and the other particles around those beside gaps; says whether there is any pressure.
    fn measure(&mut self, cloud: &FlowCloud) -> bool {
        let Self { gravity, spacing, gaps, fill, velocities, .. } = self;
        let particles = &cloud.pairs.gaps.particles[..];
        gaps.resize(particles.len(), Gap::default());
        let rows = (&mut gaps[..], particles);
        for_each_block(rows, &mut Vec::new(), &|_, (gaps, particles): Rows<'_>| {
            for (gap, &particle) in gaps.iter_mut().zip(particles) {
                *gap = Gap { particle, ..Gap::default() };
                gap.fluid = GapRemainder::of_wet(cloud, *gravity, particle[0]);
            }
        });
        if gaps.iter().all(|gap| gap.fluid.is_none_or(|fluid| fluid.pressure == 0.0)) {
            return false;
        }
        let surface = of_surface(cloud, *spacing);
        for_each_heavy_block(&mut gaps[..], &mut Vec::new(), &|_, gaps: &mut [Gap]| {
            for gap in gaps {
                gap.around = Surrounding::of(cloud, gap.particle);
                gap.closed = gap.around.closed(surface);
                gap.look_into(cloud);
            }
        });
        let motion = BoundaryMotion { velocities, spacing: *spacing };
        fill.run(cloud, gaps, &motion);
        true
    }

    /// Reads how boundaries move.
    fn look_at_motion(&mut self, cloud: &FlowCloud, step: &Step<'_>) -> Result<(), StepError> {
        self.velocities.clear();
        for group in cloud.groups.iter().filter(|group| group.fluid().is_none()) {
            let view = step.world.phase(group.phase);
            let velocities = view.read_near::<Velocity>()?;
            self.velocities.extend(velocities[group.rows.clone()].iter().map(|velocity| velocity.0));
        }
        Ok(())
    }

    /// Finds the forces on all boundary particles beside gaps.
    fn press(&mut self, cloud: &FlowCloud, forces: &mut [DVec3]) {
        let Self { gaps, fill, across, .. } = self;
        for gap in gaps {
            let Some(GapRemainder { pressure, slope, .. }) = gap.filled() else { continue };
            let row = gap.particle[0] as usize;
            across.clear();
            across.extend(cloud.across_gap(gap.particle));
            let of_pair = |pair: &GapPair| {
                let there = fill.beyond(cloud, pair.row, gap).unwrap_or(pressure);
                (pressure + there) * pair.weight * pair.x
            };
            let mut force = -across.iter().map(of_pair).sum::<DVec3>();
            if pressure != 0.0 {
                force += gap.closed * gap.around.force(pressure, slope);
            }
            // Along the gap, `EdgeForces` gives the force on the faces at its ends.
            let has_edge = |j| cloud.edges.may_be_of(j) && cloud.pairs.gaps.have_edges(row, j);
            if cloud.edges.may_be_of(row) && across.iter().all(|pair| has_edge(pair.row)) {
                let toward = gap.around.toward();
                force = force.dot(toward) * toward;
            }
            let force = cloud.pressure_factor * cloud.records[row].volume() * force;
            give(cloud, row, force, across, forces);
        }
    }
}

impl Run for GapPressure {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let mut forces = std::mem::take(&mut cloud.gap_forces);
        forces.clear();
        if !cloud.pairs.gaps.particles.is_empty() {
            self.look_at_motion(&cloud, step)?;
            if self.measure(&cloud) {
                forces.resize(cloud.records.len() - cloud.fluid, DVec3::ZERO);
                self.press(&cloud, &mut forces);
                let pushed = (&forces[..], &self.velocities[..]);
                let power = sum_over_blocks(pushed, &|_, (forces, velocities): (&[DVec3], &[DVec3])| {
                    forces.iter().zip(velocities).map(|(force, velocity)| force.dot(*velocity)).sum::<f64>()
                });
                self.work += step.clock.dt * power;
            }
        }
        (cloud.gap_forces, cloud.gap_work) = (forces, self.work);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        self.work.to_le_bytes().to_vec()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let work = state.try_into().map(f64::from_le_bytes);
        work.map(|work| self.work = work).is_ok()
    }
}

impl FlowCloud {
    /// Adds the pressure of gaps to the forces on the particles of a group, and to the part of them that is
    /// due to boundaries.
    pub(in crate::formulations::fluid) fn press_gaps(
        &self,
        group: &Group,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) {
        if group.fluid().is_some() || self.gap_forces.is_empty() {
            return;
        }
        let forces = &self.gap_forces[group.cloud.start - self.fluid..group.cloud.end - self.fluid];
        for (k, &force) in forces.iter().enumerate() {
            total[k].0 += force;
            parts[PARTS * k + 1] += force;
        }
    }
}
