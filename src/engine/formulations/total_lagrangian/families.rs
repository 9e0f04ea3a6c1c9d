//! Points of the material beside a particle: what moves with them, and what a force on them does.
//!
//! The deformation gradient of a particle is a weighted sum over its neighbours, and so is the motion of the material point at
//! X_i + A, with a short vector A of the reference configuration:
//!
//! ```text
//! v(X_i + A) = v_i + F'_i A = v_i + sum_j c_j (v_j - v_i),      c_j = V_j w_ij X_ij . M_i^-1 A
//! ```
//!
//! A force f on the point acts on the particles with the same weights: then its work is that on the motion of the point, and, because the sum
//! of c_j x_ij is F_i A, its moment that of a force at x_i + F_i A. What it does to the neighbours and takes from the particle is what a stress
//! `P_i = -f (x) A / V_i` in the particle would do: it goes into the pair stress, and the pass of the internal force spreads it.

use glam::{DMat3, DVec3};

use super::formulation::PackedRows;
use super::rows::PairStress;
use crate::parallel::{Arithmetic, HotLoop, Lanes4, Picked, for_each_block, run_hot};
use crate::schedule::Resources;
use crate::world::{Mobility, Velocity};

/// How the points of the material beside a particle move, and how much a force on them moves them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Surroundings {
    /// Of the particle, m/s.
    velocity: DVec3,
    /// F' of the particle, 1/s.
    rate: DMat3,
    /// Of the particle, 1/kg.
    mobility: DVec3,
    /// The weight of the particle in the motion of the point A is 1 - c . A, 1/m.
    own: DVec3,
}

impl Surroundings {
    /// Those of a particle whose neighbours do not count.
    pub fn alone(velocity: Velocity, mobility: Mobility) -> Self {
        Self { velocity: velocity.0, mobility: mobility.0, ..Self::default() }
    }

    /// Velocity of the point `arm` beside the particle in the reference configuration, m/s.
    pub fn velocity(&self, arm: DVec3) -> DVec3 {
        self.velocity + self.rate * arm
    }

    /// Mobility of that point along each axis, 1/kg: how much a force on it speeds it up. What the neighbours add, by the squares of their
    /// weights, is a twentieth of it, and left out.
    pub fn mobility(&self, arm: DVec3) -> DVec3 {
        let own = 1.0 - self.own.dot(arm);
        self.mobility * (own * own)
    }
}

impl PackedRows {
    /// The surroundings of a row, with the velocities of all rows; where velocities beside the particle are not asked for, they are not
    /// worked out.
    pub(crate) fn surroundings(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> Surroundings {
        let inverse = &self.bonds.inverse_moment[row];
        let sum = if moving { run_hot(Gather { packed: self, row, velocity }) } else { DMat3::ZERO };
        Surroundings {
            velocity: velocity[row].0,
            rate: sum * inverse.to_matrix(),
            mobility: mobility.0,
            own: *inverse * self.bonds.reach[row],
        }
    }

    /// Adds the sums of f (x) A, N m, of forces f on points A beside particles, as pair stress. The particles are `nodes`, ascending, of the
    /// body whose first row is `first`.
    pub(crate) fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]) {
        let Self { bonds, sites, pair_stress, own_pull, .. } = self;
        let stresses = Picked::new(nodes, &mut pair_stress[first..]);
        let rows = (stresses, Picked::new(nodes, &mut own_pull[first..]), couples);
        type Rows<'a> = (Picked<'a, PairStress>, Picked<'a, DVec3>, &'a [DMat3]);
        for_each_block(rows, &mut Vec::new(), &|_, (mut pair_stress, mut own_pull, couples): Rows<'_>| {
            for (k, couple) in couples.iter().enumerate().filter(|(_, couple)| **couple != DMat3::ZERO) {
                let row = first + own_pull.number(k);
                let site = &sites[row].reference;
                let stress = *couple * bonds.inverse_moment[row].to_matrix() * (-1.0 / site.0[3]);
                pair_stress.row(k).add(&stress, site.xyz());
                *own_pull.row(k) += stress * bonds.reach[row];
            }
        });
    }

    /// Hands pair stress that was added on to the images.
    pub(crate) fn renew_images(&mut self) {
        let Self { images, frames, sites, pair_stress, .. } = self;
        images.fill_pair_stress(frames, sites, pair_stress);
    }
}

/// The rows of total-Lagrangian bodies, if there are any.
pub(crate) fn packed_rows(resources: &Resources) -> Option<std::cell::Ref<'_, PackedRows>> {
    resources.try_get()
}

/// The sum of V_j w_ij v_ij (x) X_ij over the neighbours of a particle.
struct Gather<'a> {
    packed: &'a PackedRows,
    row: usize,
    velocity: &'a [Velocity],
}

impl HotLoop for Gather<'_> {
    type Output = DMat3;

    #[inline(always)]
    fn run<A: Arithmetic>(self, a: A) -> DMat3 {
        let Self { packed, row, velocity } = self;
        let (bonds, sites, images) = (&packed.bonds, &packed.sites, &packed.images);
        let (own, v) = (sites[row].reference, Lanes4::new(velocity[row].0, 0.0));
        let mut sum = [Lanes4::ZERO; 3];
        for k in bonds.offsets[row] as usize..bonds.offsets[row + 1] as usize {
            let j = bonds.neighbors[k] as usize;
            let other = sites[j].reference;
            let there = match velocity.get(j) {
                Some(there) if images.is_empty() => there.0,
                _ => velocity[images.source(j)].0 * images.mirror(j).unwrap_or(DVec3::ONE),
            };
            let v_ij = a.minus(Lanes4::new(there, 0.0), v);
            let weighted = a.scale(f64::from(bonds.weights[k]) * other.0[3], v_ij);
            let x_ij = a.minus(other, own);
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum = a.scale_add(x_ij.0[axis], weighted, *sum);
            }
        }
        DMat3::from_cols(sum[0].xyz(), sum[1].xyz(), sum[2].xyz())
    }
}
