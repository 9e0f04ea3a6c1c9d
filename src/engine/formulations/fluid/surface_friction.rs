//! What friction lacks at a free surface.
//!
//! The sum `2 mu w_ij v_ij` of the second pass is `mu div grad v`. Its natural condition at a free surface is no gradient across it, and a wave loses
//! half of what it should (A. Colagrossi, M. Antuono, A. Souto-Iglesias, D. Le Touze, Phys. Rev. E 84 (2011) 026705). The whole viscous stress has
//! the transposed gradient as well, whose divergence is zero inside an incompressible fluid and frees the surface of stress:
//!
//! `f_i = V_i sum_j V_j w_ij (T_i + T_j) x_ij` over the fluids, `T = mu (grad v)^T` with the renormalised gradient. Swapping i and j turns the sign.

use glam::{DMat3, DVec3};

use super::cloud::{FlowCloud, Group};
use super::near::RowPass;
use super::pair_force::PARTS;
use super::surroundings::SmallestEigenvalue;
use crate::correction::FourMoments;
use crate::parallel::{Arithmetic, Vector};
use crate::world::Force;

/// Smallest eigenvalue of the moment matrix below which a particle is at the surface.
const AT_SURFACE: f64 = 0.75;
/// Least kinematic viscosity, in units of c_0 h, whose friction at a surface is made: below it the flow has other losses.
const LEAST: f64 = 1e-4;

/// Whether a fluid that is viscous enough has a free surface; `smallest` is scratch memory.
pub(super) fn is_needed(cloud: &FlowCloud, smallest: &mut Vec<f64>) -> bool {
    let h = cloud.kernel.smoothing_length();
    let viscous = |group: &Group| {
        group.fluid().is_some_and(|state| state.viscosity > LEAST * state.density * state.sound_speed * h)
    };
    if !cloud.groups.iter().any(viscous) {
        return false;
    }
    smallest.resize(cloud.fluid, 0.0);
    cloud.for_each_row(0, smallest, &SmallestEigenvalue(cloud));
    (0..cloud.fluid).any(|i| cloud.volume(i) > 0.0 && smallest[i] < AT_SURFACE)
}

/// Makes the force.
#[derive(Default)]
pub(super) struct SurfaceFriction {
    /// T of every fluid particle, Pa.
    stress: Vec<DMat3>,
    /// Sums over neighbours of the particles of a body.
    sums: Vec<DVec3>,
}

impl SurfaceFriction {
    /// Makes the stresses of all fluids; none where they are not needed.
    pub fn prepare(&mut self, cloud: &FlowCloud) {
        self.stress.clear();
        if !cloud.free_surface {
            return;
        }
        self.stress.resize(cloud.fluid, DMat3::ZERO);
        for group in &cloud.groups {
            let Some(state) = group.fluid() else { break };
            let pass = TransposedStress { cloud, viscosity: state.viscosity };
            cloud.for_each_row(group.cloud.start, &mut self.stress[group.cloud.clone()], &pass);
        }
    }

    /// Adds the force on the particles of a fluid to the whole and to its viscous part.
    pub fn add(&mut self, cloud: &FlowCloud, group: &Group, total: &mut [Force], parts: &mut [DVec3]) {
        if self.stress.len() < group.cloud.end {
            return;
        }
        self.sums.resize(group.cloud.len(), DVec3::ZERO);
        cloud.for_each_row(group.cloud.start, &mut self.sums, &Divergence { cloud, stress: &self.stress });
        for (k, sum) in self.sums.iter().enumerate() {
            let force = *sum * cloud.volume(group.cloud.start + k);
            total[k].0 += force;
            parts[PARTS * k] += force;
        }
    }
}

/// `mu (grad v)^T`: column k holds the gradient of the velocity along axis k. Zero for a particle with too few neighbours.
struct TransposedStress<'a> {
    cloud: &'a FlowCloud,
    viscosity: f64,
}

impl RowPass for TransposedStress<'_> {
    type Output = DMat3;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> DMat3 {
        let Self { cloud, viscosity } = *self;
        let mut moment = FourMoments::new(a);
        let mut columns = [Vector::zero(a); 3];
        let own = Vector::splat(a, cloud.records[i].velocity());
        for near in cloud.fours(a, i, &(0..cloud.fluid)) {
            let weight = near.volume * near.weight;
            moment.add(weight, near.x_ij);
            let v_ij = near.vector(|j| cloud.records[j].velocity()) - own;
            let weighed = near.x_ij * weight;
            columns[0] = weighed.mul_add(v_ij.x, columns[0]);
            columns[1] = weighed.mul_add(v_ij.y, columns[1]);
            if A::AXES == 3 {
                columns[2] = weighed.mul_add(v_ij.z, columns[2]);
            }
        }
        let Some(inverse) = moment.sum().inverse() else { return DMat3::ZERO };
        let [u, v, w] = columns.map(|column| inverse * column.sum() * viscosity);
        DMat3::from_cols(u, v, w)
    }
}

/// `sum_j V_j w_ij (T_i + T_j) x_ij` over the fluids.
struct Divergence<'a> {
    cloud: &'a FlowCloud,
    stress: &'a [DMat3],
}

impl RowPass for Divergence<'_> {
    type Output = DVec3;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> DVec3 {
        let mut sum = Vector::zero(a);
        for near in self.cloud.fours(a, i, &(0..self.cloud.fluid)) {
            let x = near.x_ij * (near.volume * near.weight);
            let column = |k: usize| near.vector(|j| self.stress[i].col(k) + self.stress[j].col(k));
            sum = column(0).mul_add(x.x, sum);
            sum = column(1).mul_add(x.y, sum);
            if A::AXES == 3 {
                sum = column(2).mul_add(x.z, sum);
            }
        }
        sum.sum()
    }
}
