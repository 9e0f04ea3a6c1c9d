//! All particles of a flow as one cloud: the fluids first, then the boundary particles.

use std::ops::Range;

use glam::DVec3;

use super::edges::BoundaryEdges;
use super::group::{FluidState, Group};
use super::neighborhood::Neighborhood;
use super::other_particles::OtherParticles;
use super::repelled::Repelled;
use super::viscosities::Viscosities;
use super::wall_end::WallEnd;
use crate::formulations::fluid::lanes::{FlowParticle, FluidKernel, Periods};
use crate::formulations::fluid::lists::blocks::Blocks;
use crate::formulations::fluid::lists::{FlowPairs, NearRows};
use crate::neighbors::Periodic;
use crate::parallel::{EIGHT, Lanes4};
use crate::scene::Precision;
use crate::world::BodyId;

/// Minimum sum of V_f W for which there is fluid beside a boundary.
pub const MIN_SHARE: f64 = 1e-10;

/// A neighbour of a fluid particle.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// Row of a fluid particle in its phase; beyond the number of fluid particles, something that bounds the
    /// fluid.
    pub row: usize,
    /// x_ij = x_j - x_i, m.
    pub x_ij: DVec3,
    /// Its length, m.
    pub distance: f64,
    /// Pair weight w_ij = |W'(r)| / r, so that grad_i W = w_ij x_ij.
    pub weight: f64,
    /// Kernel value W_ij.
    pub kernel: f64,
    /// Volume V_j, m3; zero for a removed particle.
    pub volume: f64,
}

/// The cloud: the shared data of the systems of a flow. It is derived from the columns.
pub struct FlowCloud {
    /// One group for every body: fluids first, each in the order of the scene.
    pub groups: Vec<Group>,
    /// Number of fluid particles.
    pub fluid: usize,
    /// Kernel.
    pub kernel: FluidKernel,
    /// What multiplies pressures in sums over pairs, and rates of compression
    /// (`density::pressure_factor`).
    pub(in crate::formulations::fluid) pressure_factor: f64,
    pub(in crate::formulations::fluid) viscosities: Viscosities,
    pub(in crate::formulations::fluid) plane: bool,
    pub(in crate::formulations::fluid) periods: Periods,
    /// Positions of boundary particles at the start of the step, of bodies that take sub-steps alone.
    pub(in crate::formulations::fluid) before: Vec<DVec3>,
    pub(in crate::formulations::fluid) records: Vec<FlowParticle>,
    /// Of every group: whether the places and volumes of its rows are those of the step before.
    pub(in crate::formulations::fluid) is_still: Vec<bool>,
    /// Validity of the particles of other ranks.
    pub(in crate::formulations::fluid) others: OtherParticles,
    pub(in crate::formulations::fluid) pairs: FlowPairs,
    /// The blocks of passes in single precision; none in double precision.
    pub(in crate::formulations::fluid) blocks: Option<Box<Blocks>>,
    /// Neighbours of fluid particles within the support; of those of other ranks, all of their lists.
    pub(in crate::formulations::fluid) near: NearRows,
    /// Fluid neighbours within the support of every particle that is no fluid.
    pub(in crate::formulations::fluid) near_boundary: NearRows,
    /// Rate of compression D of every fluid particle at the middle of the step, 1/s.
    pub(in crate::formulations::fluid) compression: Vec<f64>,
    /// The part of D that the pressure of boundaries answers for, 1/s; zero or empty where none has suction.
    pub(in crate::formulations::fluid) boundary_compression: Vec<f64>,
    /// Whether every fluid particle is within `repulsion_range` of a boundary particle, 1 if so.
    pub(in crate::formulations::fluid) is_close: Vec<u8>,
    /// Distance within which a fluid particle that a boundary repels has a particle of it, m.
    pub(in crate::formulations::fluid) repulsion_range: f64,
    /// Fluid particles that boundaries repel, in the order of rows.
    pub(in crate::formulations::fluid) repelled: Vec<Repelled>,
    /// Edges between walls that move against each other.
    pub(in crate::formulations::fluid) edges: BoundaryEdges,
    /// Fluid particles past the ends of walls, in the order of rows.
    pub(in crate::formulations::fluid) ends: Vec<WallEnd>,
    /// Force on every boundary particle beside a gap, N; empty where there is none.
    pub(in crate::formulations::fluid) gap_forces: Vec<DVec3>,
    /// Work of these forces since the start of the run, J.
    pub gap_work: f64,
    /// Acceleration of every fluid particle by loads; empty where nothing loads a fluid.
    pub(in crate::formulations::fluid) loads: Vec<DVec3>,
    /// Spins of all particles, 1/s; zero for boundaries, and none at all where friction goes without.
    pub(in crate::formulations::fluid) spins: Vec<Lanes4>,
    /// Bodies that deform, and those to which viscous fluids stick.
    pub(in crate::formulations::fluid) neighborhoods: Vec<Neighborhood>,
}

impl FlowCloud {
    /// Rows of each fluid.
    pub(in crate::formulations::fluid) fn fluids(&self) -> impl Iterator<Item = Range<usize>> + Clone {
        self.groups.iter().map(|group| group.cloud.clone()).take_while(|rows| rows.end <= self.fluid)
    }

    /// Pressure of the particle in that row, Pa.
    pub fn pressure(&self, row: usize) -> f64 {
        self.records[row].pressure() / self.pressure_factor
    }

    /// Arithmetic of the sums over neighbours.
    pub fn precision(&self) -> Precision {
        if self.blocks.is_some() { Precision::Mixed } else { Precision::Double }
    }

    /// Whether all particles lie in a plane.
    pub fn plane(&self) -> bool {
        self.plane
    }

    /// Whether walls or bodies may have suction, as those of a flow without a free surface do.
    pub fn is_confined(&self) -> bool {
        self.groups.iter().any(Group::has_suction)
    }

    /// Calls `f` with every neighbour of a fluid particle within the support, walls included, in the order of
    /// its list. `i` is its row in the phase of fluids. On several ranks ask for the [whole
    /// cloud](FlowCloud::whole) before.
    #[inline]
    pub fn for_each_neighbor(&self, i: usize, mut f: impl FnMut(&Near)) {
        let own = self.records[i].position();
        let limit = self.kernel.support * self.kernel.support;
        for &j in self.near_row(i) {
            let row = j as usize;
            let other = &self.records[row];
            let x_ij = self.pairs.periodic().minimal_image(other.position() - own);
            let square = x_ij.length_squared();
            if square < limit {
                let (distance, volume) = (square.sqrt(), other.volume());
                let (weight, kernel) = (self.kernel.weight(distance), self.kernel.value(distance));
                f(&Near { row, x_ij, distance, weight, kernel, volume });
            }
        }
    }

    /// All particles as the last passes over pairs have seen them, fluids first; on several ranks ask for the
    /// [whole cloud](FlowCloud::whole) before.
    pub fn records(&self) -> &[FlowParticle] {
        &self.records
    }

    /// Rows of all that bounds the fluids, every particle once: a thin body is there twice.
    pub fn boundaries_once(&self) -> impl Iterator<Item = usize> + '_ {
        let bodies = self.groups.iter().map(|group| Some(group.body));
        let before = std::iter::once(None).chain(bodies);
        let first = self.groups.iter().zip(before).filter(|(group, before)| *before != Some(group.body));
        first.filter(|(group, _)| group.fluid().is_none()).flat_map(|(group, _)| group.cloud.clone())
    }

    /// The row of a particle that bounds the fluids whose pressure is that on the side to which a direction
    /// points: of a thin body that in the copy of this side.
    pub fn row_facing(&self, row: usize, direction: DVec3) -> usize {
        let mut thin = self.pairs.thin.iter();
        let found = thin.find_map(|body| {
            let k = body.particle(row)?;
            Some(body.copy_seen(k, direction, |row| self.records[row].position()))
        });
        found.unwrap_or(row)
    }

    /// The periodic axes of the domain.
    pub fn periodic(&self) -> &Periodic {
        self.pairs.periodic()
    }

    /// The vector from one place to another, the shortest of its periodic images, m.
    pub fn offset(&self, from: DVec3, to: DVec3) -> DVec3 {
        self.pairs.periodic().minimal_image(to - from)
    }

    /// Volume of a fluid particle, m3; `i` is its row in the phase of fluids.
    pub fn volume(&self, i: usize) -> f64 {
        self.records[i].volume()
    }

    /// The state of a fluid body; none of another one.
    pub fn state(&self, body: BodyId) -> Option<&FluidState> {
        self.groups.iter().find(|group| group.body == body).and_then(Group::fluid)
    }

    /// Number of neighbours within the support of every particle of a fluid body, boundary particles
    /// included.
    pub fn neighbor_counts(&self, body: BodyId) -> Option<Vec<usize>> {
        let group = self.groups.iter().find(|group| group.body == body && group.fluid().is_some())?;
        let count = |i: usize| {
            let mut count = 0;
            self.for_each_neighbor(i, |_| count += 1);
            count
        };
        Some(group.cloud.clone().map(count).collect())
    }

    /// Number of directed pairs in the lists.
    pub fn pairs(&self) -> usize {
        let FlowPairs { fluid, walls, boundary, .. } = &self.pairs;
        let of_blocks = self.blocks.as_ref().map_or(0, |blocks| EIGHT * blocks.lists.fluid.pairs());
        of_blocks + fluid.pairs() + walls.pairs() + boundary.pairs()
    }

    /// Number of builds of the lists.
    pub fn builds(&self) -> u64 {
        self.pairs.builds
    }
}
