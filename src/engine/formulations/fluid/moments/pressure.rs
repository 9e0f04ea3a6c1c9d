//! The point of action of the pressure on deformable bodies.
//!
//! The pressure force of a pair across a surface acts on a particle below it. Taken at the midpoint of the
//! pair, which on average lies on the surface, half of its moment belongs to the fluid; the other half,
//!
//! `M_w = 1/2 sum_f f_wf (x) x_wf = -1/2 V_w sum_f V_f (p_w + p_f) w_wf x_wf (x) x_wf`
//!
//! belongs to the body, and without it a body under the pressure p would be compressed too little. With it
//! the virial of all forces is -p times the volume of its particles, whatever its shape is: where `sum_j V_j
//! w_ij x_ij` is zero and `sum_j V_j w_ij x_ij (x) x_ij` is the unit matrix around every particle of the
//! body, it follows by summation over pairs.
//!
//! The rate of compression of the fluid has the adjoint term ([`stretching`](super::stretching)).

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::cluster_forces::{BodyClusters, ClusterForces};
use crate::correction::{add_moment, moment_of};
use crate::formulations::fluid::cloud::{FlowCloud, Group, NearPairs, Neighborhood, RowPass, RowSums};
use crate::parallel::{Arithmetic, Vector};
use crate::world::Force;

/// Part of the force, as they are booked, that the pressure of a boundary makes.
const OF_BOUNDARY: usize = 1;

/// Finds the moments of pressure on the particles of a body, and the forces that make them.
#[derive(Debug)]
pub struct PressureMoments {
    moments: Vec<PressureMoment>,
    forces: ClusterForces<2>,
    sums: RowSums,
}

impl Default for PressureMoments {
    fn default() -> Self {
        Self { moments: Vec::new(), forces: ClusterForces::fading(), sums: RowSums::default() }
    }
}

/// M_w, N m: of both pressures, and of that of the boundary.
#[derive(Clone, Copy, Debug, Default)]
struct PressureMoment {
    whole: DMat3,
    of_boundary: DMat3,
}

impl PressureMoments {
    /// Adds the forces to the whole and to its part of the pressure of the boundary.
    pub fn add(
        &mut self,
        cloud: &FlowCloud,
        group: &Group,
        near: &Neighborhood,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) {
        self.moments.resize(group.rows.len(), PressureMoment::default());
        let pass = PressureMomentOn { cloud };
        cloud.for_each_row(group.cloud.start, &mut self.moments, &mut self.sums, &pass);
        let moments = &self.moments;
        let clusters = BodyClusters { cloud, group, near };
        self.forces.set(clusters, |k| [moments[k].whole, moments[k].of_boundary]);
        self.forces.add(clusters, total, parts, OF_BOUNDARY);
    }
}

struct PressureMomentOn<'a> {
    cloud: &'a FlowCloud,
}

impl RowPass<1, 6> for PressureMomentOn<'_> {
    type Output = PressureMoment;

    fn among(&self) -> Range<usize> {
        0..self.cloud.fluid
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [DVec3::X * self.cloud.records[row].pressure()]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        _: &[Vector<A>; 1],
        [pressure]: &[Vector<A>; 1],
        [xx, yy, zz, of_xx, of_yy, of_zz]: &mut [Vector<A>; 6],
    ) {
        let weight = near.volume * near.weight;
        add_moment([xx, yy, zz], weight, near.x_ij);
        add_moment([of_xx, of_yy, of_zz], weight * pressure.x, near.x_ij);
    }

    fn output(&self, i: usize, &[xx, yy, zz, of_xx, of_yy, of_zz]: &[DVec3; 6]) -> PressureMoment {
        let half = -0.5 * self.cloud.volume(i);
        let own = half * self.cloud.records[i].pressure();
        let plane = self.cloud.plane;
        let of_boundary = *moment_of([xx, yy, zz], plane).matrix() * own;
        let of_fluid = *moment_of([of_xx, of_yy, of_zz], plane).matrix() * half;
        PressureMoment { whole: (of_boundary + of_fluid).to_matrix(), of_boundary: of_boundary.to_matrix() }
    }
}
