//! Points of the material beside a particle: their motion, and the effect of a force on them.
//!
//! The deformation gradient of a particle is a weighted sum over its neighbours, and so is the motion of the
//! material point at X_i + A, with a short vector A of the reference configuration:
//!
//! ```text
//! v(X_i + A) = v_i + F'_i A = v_i + sum_j c_j (v_j - v_i),      c_j = V_j w_ij X_ij . M_i^-1 A
//! ```
//!
//! A force f on the point acts on the particles with the same weights. Its power is then that on the motion
//! of the point and, because the sum of c_j x_ij is F_i A, its moment is that of a force at x_i + F_i A. Its
//! effect on the neighbours and on the particle equals that of a stress `P_i = -f (x) A / V_i` in the
//! particle: it is added to the stress that the pass of the internal force reads.

use glam::{DMat3, DVec3};

use crate::linalg::Sym3;
use crate::parallel::{FourLanes, HotLoop, Lanes4};
use crate::symmetry::Ghosts;
use crate::world::{Mobility, Velocity};

/// Motion of the material points beside a particle, and their response to a force.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalMotion {
    /// Of the particle, m/s.
    pub velocity: DVec3,
    /// F' of the particle, 1/s.
    pub rate: DMat3,
    /// Of the particle, 1/kg.
    pub mobility: DVec3,
    /// The weight of the particle in the motion of the point A is 1 - c . A, 1/m: c is M^-1 times the first
    /// moment of the weights.
    pub own: DVec3,
}

impl LocalMotion {
    /// Those of a particle whose neighbours do not count.
    pub fn alone(velocity: Velocity, mobility: Mobility) -> Self {
        Self { velocity: velocity.0, mobility: mobility.0, ..Self::default() }
    }

    /// Velocity of the point `arm` beside the particle in the reference configuration, m/s.
    pub fn velocity(&self, arm: DVec3) -> DVec3 {
        self.velocity + self.rate * arm
    }

    /// Mobility of that point along each axis, 1/kg: its inverse mass for a force. The contribution of the
    /// neighbours, by the squares of their weights, is a twentieth of it, and left out.
    pub fn mobility(&self, arm: DVec3) -> DVec3 {
        let own = 1.0 - self.own.dot(arm);
        self.mobility * (own * own)
    }
}

/// The fit of the motion of a particle to that of its neighbours, in the configuration of their weights.
#[derive(Clone, Copy, Debug)]
pub struct LocalFit {
    /// M^-1.
    pub inverse: Sym3,
    /// `sum_j V_j w_ij x_ij`.
    pub first_moment: DVec3,
    /// From the reference configuration to that of the weights, where they differ.
    pub gradient: Option<DMat3>,
}

impl LocalFit {
    /// The motion with this sum of V_j w_ij v_ij (x) x_ij over the neighbours.
    pub fn motion(&self, sum: DMat3, velocity: Velocity, mobility: Mobility) -> LocalMotion {
        let (rate, own) = (sum * self.inverse.to_matrix(), self.inverse * self.first_moment);
        // A point A of the reference configuration lies at F A beside the particle.
        let (rate, own) = self.gradient.map_or((rate, own), |f| (rate * f, f.transpose() * own));
        LocalMotion { velocity: velocity.0, rate, mobility: mobility.0, own }
    }

    /// The matrix B, without the volume, for which the forces `V_j w_ij B x_ij` on the neighbours have the
    /// effect of a `couple` f (x) A.
    pub fn corrected(&self, couple: &DMat3) -> DMat3 {
        let pulled = self.gradient.map_or(*couple, |f| *couple * f.transpose());
        pulled * self.inverse.to_matrix()
    }
}

/// A packed row with a place.
pub trait HasPlace {
    /// Place in the configuration of the weights, m, and volume, m3.
    fn place(&self) -> Lanes4;
}

/// The sum of V_j w_ij v_ij (x) x_ij over the neighbours of a particle.
pub struct RateSum<'a, W, P> {
    /// The particle.
    pub row: usize,
    /// Its neighbours, of which some may be ghosts.
    pub neighbors: &'a [u32],
    /// Their weights.
    pub weights: &'a [W],
    /// All rows, those of ghosts last.
    pub points: &'a [P],
    /// The ghosts.
    pub ghosts: &'a Ghosts,
    /// Velocities of the particles.
    pub velocity: &'a [Velocity],
}

impl<W: Copy + Into<f64>, P: HasPlace> HotLoop for RateSum<'_, W, P> {
    type Output = DMat3;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> DMat3 {
        let Self { row, neighbors, weights, points, ghosts, velocity } = self;
        let (own, v) = (points[row].place(), Lanes4::new(velocity[row].0, 0.0));
        let mut sum = [Lanes4::ZERO; 3];
        for (&j, &weight) in neighbors.iter().zip(weights) {
            let j = j as usize;
            let other = points[j].place();
            let there = match velocity.get(j) {
                Some(there) if ghosts.is_empty() => there.0,
                _ => velocity[ghosts.source(j)].0 * ghosts.mirror(j).unwrap_or(DVec3::ONE),
            };
            let v_ij = a.sub(Lanes4::new(there, 0.0), v);
            let weight: f64 = weight.into();
            let weighted = a.scale(weight * other.0[3], v_ij);
            let x_ij = a.sub(other, own);
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum = a.scale_add(x_ij.0[axis], weighted, *sum);
            }
        }
        DMat3::from_cols(sum[0].xyz(), sum[1].xyz(), sum[2].xyz())
    }
}
