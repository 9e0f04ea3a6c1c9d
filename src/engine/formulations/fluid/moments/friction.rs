//! The point of action of friction on boundary particles.
//!
//! The force of a pair across a surface acts at the midpoint of the pair: half of the couple `x_ij x f_ij`
//! then acts on the fluid, where the spin balances it. On the boundary the force acts on a particle below the
//! surface, so that its first moment `M_w = 1/2 sum_f f_wf (x) x_wf` is missing: the torque on the boundary
//! would be too small, and a soft body would be sheared from below its surface. [`ClusterForces`] apply it,
//! and forces on all of a rigid body where one of its particles is alone, in an acute edge.
//!
//! The velocity of the surface at the midpoint of a pair follows from the motion of the cluster: the work of
//! these forces is that of friction there.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::cluster_forces::{BodyClusters, ClusterForces};
use super::whole_body::WholeBody;
use crate::formulations::fluid::cloud::{FlowCloud, Group, NearPairs, PARTS, RowPass, RowSums};
use crate::formulations::fluid::lanes::{Axial, pack_axial};
use crate::parallel::{Arithmetic, Vector};
use crate::world::Force;

/// Finds the moments of friction on the particles of a boundary, and the forces that make them.
#[derive(Debug, Default)]
pub struct FrictionMoments {
    moments: Vec<Moment>,
    forces: ClusterForces<1>,
    sums: RowSums,
}

/// Of the friction on a particle.
#[derive(Clone, Copy, Debug)]
struct Moment {
    /// M_w, N m.
    first: DMat3,
    /// How fast friction grows with the velocity of the particle, kg/s.
    drag: f64,
}

impl Moment {
    const NONE: Self = Self { first: DMat3::ZERO, drag: 0.0 };
}

/// Part of the force, as they are booked, that is friction.
const FRICTION: usize = 0;

impl FrictionMoments {
    /// Adds the forces to the whole and to its viscous part.
    pub fn add(&mut self, cloud: &FlowCloud, group: &Group, total: &mut [Force], parts: &mut [DVec3]) {
        self.moments.clear();
        let Some(near) = cloud.neighborhood(group) else { return };
        self.moments.resize(group.rows.len(), Moment::NONE);
        let pass = MomentOn { cloud, viscosities: cloud.viscosities.of(group) };
        cloud.for_each_row(group.cloud.start, &mut self.moments, &mut self.sums, &pass);
        let moments = &self.moments;
        let clusters = BodyClusters { cloud, group, near };
        self.forces.set(clusters, |k| [moments[k].first]);
        self.forces.add(clusters, total, parts, FRICTION);
        if near.is_soft {
            return;
        }
        let lost = self.forces.lost();
        if lost != DVec3::ZERO {
            let mut body = WholeBody::new(cloud, group);
            body.turn(lost);
            body.for_each_force(cloud, group, |k, force| {
                total[k].0 += force;
                parts[PARTS * k + FRICTION] += force;
            });
        }
    }

    /// Adds to `drag` how fast the friction on each particle grows with its velocity, kg/s: the fluid sees
    /// twice the velocity of a boundary, less its own.
    pub fn add_drag(&self, drag: &mut [f64]) {
        drag.iter_mut().zip(&self.moments).for_each(|(drag, moment)| *drag += moment.drag);
    }
}

/// `1/2 sum_f f_wf (x) x_wf` with the friction f_wf of a pair, and `2 sum_f V_w V_f 4 mu w_wf`.
struct MomentOn<'a> {
    cloud: &'a FlowCloud,
    /// Viscosities between the boundary and all groups, Pa s.
    viscosities: &'a [f64],
}

impl RowPass<2, 4> for MomentOn<'_> {
    type Output = Moment;

    fn among(&self) -> Range<usize> {
        0..self.cloud.fluid
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 2] {
        let cloud = self.cloud;
        [cloud.records[row].velocity(), pack_axial(cloud.spins[row].xyz(), cloud.plane)]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own, _]: &[Vector<A>; 2],
        [other, spin]: &[Vector<A>; 2],
        [along_x, along_y, along_z, drag]: &mut [Vector<A>; 4],
    ) {
        let weight = near.volume * near.weight * self.viscosities[near.group];
        let friction = (*other - *own - Axial::of(*spin).turn(near.x_ij)) * weight;
        *along_x = friction.mul_add(near.x_ij.x, *along_x);
        *along_y = friction.mul_add(near.x_ij.y, *along_y);
        if A::AXES == 3 {
            *along_z = friction.mul_add(near.x_ij.z, *along_z);
        }
        drag.x += weight;
    }

    fn output(&self, i: usize, &[along_x, along_y, along_z, drag]: &[DVec3; 4]) -> Moment {
        let half = 0.5 * self.cloud.viscosities.factor() * self.cloud.volume(i);
        Moment { first: DMat3::from_cols(along_x, along_y, along_z) * half, drag: 4.0 * half * drag.x }
    }
}
