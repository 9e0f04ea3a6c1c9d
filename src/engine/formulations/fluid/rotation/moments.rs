//! Where the friction on boundary particles acts.
//!
//! The force of a pair across a surface acts in the middle of the pair: there, half of the couple `x_ij x f_ij` is that of the fluid, whose spin has it
//! in its balance. On the boundary it acts on a particle below the surface, so that its first moment `M_w = 1/2 sum_f f_wf (x) x_wf` is missing: the couple would turn the boundary too
//! little, and a soft body would be sheared from below its surface. A particle has no moment of its own; M_w is made of forces on its cluster,
//!
//! `V_k B_w (x_k - x_mean)`, with B_w such that they add up to M_w and to no force ([`affine`](super::affine)).
//!
//! The velocity of the surface in the middle of a pair follows from the motion of the cluster by the same B: the work of these forces is that of friction there.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::affine::affine;
use crate::formulations::fluid::cloud::{
    Cluster, FlowCloud, Group, NearPairs, Neighborhood, PARTS, RowPass, RowSums,
};
use crate::formulations::fluid::lanes::{Axial, FlowParticle, pack_axial};
use crate::neighbors::Periodic;
use crate::parallel::{Arithmetic, Vector, for_each_block};
use crate::world::Force;

/// Finds the moments of friction on the particles of a boundary, and the forces that make them.
#[derive(Debug, Default)]
pub struct FrictionMoments {
    moments: Vec<Moment>,
    shifts: Vec<MomentShift>,
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

/// How the moment of a particle acts on its cluster: mean place of that, and B_w.
#[derive(Clone, Copy, Debug)]
struct MomentShift {
    mean: DVec3,
    map: DMat3,
}

impl MomentShift {
    const NONE: Self = Self { mean: DVec3::ZERO, map: DMat3::ZERO };
}

type Rows<'a> = (&'a mut [Force], &'a mut [[DVec3; PARTS]]);

impl FrictionMoments {
    /// Adds the forces to the whole and to its viscous part.
    pub fn add(&mut self, cloud: &FlowCloud, group: &Group, total: &mut [Force], parts: &mut [DVec3]) {
        self.moments.clear();
        let Some(near) = cloud.neighborhood(group) else { return };
        let (records, periodic) = (&cloud.records[group.cloud.clone()], cloud.pairs.periodic());
        self.moments.resize(records.len(), Moment::NONE);
        self.shifts.resize(records.len(), MomentShift::NONE);
        let pass = MomentOn { cloud, viscosities: cloud.viscosities.of(group) };
        cloud.for_each_row(group.cloud.start, &mut self.moments, &mut self.sums, &pass);
        let moments = &self.moments;
        for_each_block(&mut self.shifts[..], &mut Vec::new(), &|begin, shifts: &mut [MomentShift]| {
            for (k, shift) in (begin..).zip(shifts) {
                *shift = MomentShift::NONE;
                let first = moments[k].first;
                if first != DMat3::ZERO {
                    let Cluster { mean, moment, .. } = near.cluster(records, k, periodic);
                    *shift = MomentShift { mean, map: affine(&moment, first, cloud.plane) };
                }
            }
        });
        let shifts = &self.shifts;
        let (parts, _) = parts.as_chunks_mut();
        for_each_block((total, parts), &mut Vec::new(), &|first, (total, parts): Rows<'_>| {
            for (k, (total, parts)) in (first..).zip(total.iter_mut().zip(parts)) {
                let force = force_on(near, records, shifts, k, periodic);
                total.0 += force;
                parts[0] += force;
            }
        });
    }
}

impl FrictionMoments {
    /// Adds to `drag` how fast the friction on each particle grows with its velocity, kg/s: the fluid sees twice the velocity of a boundary, less its own.
    pub fn add_drag(&self, drag: &mut [f64]) {
        drag.iter_mut().zip(&self.moments).for_each(|(drag, moment)| *drag += moment.drag);
    }
}

/// The force on particle `k` of all clusters that it is in.
fn force_on(
    near: &Neighborhood,
    records: &[FlowParticle],
    shifts: &[MomentShift],
    k: usize,
    periodic: &Periodic,
) -> DVec3 {
    let own = &records[k];
    let mut force = shifts[k].map * -shifts[k].mean;
    for &w in near.list.row(k) {
        let MomentShift { mean, map } = shifts[w as usize];
        if map != DMat3::ZERO {
            let x = periodic.minimal_image(own.position() - records[w as usize].position());
            force += map * (x - mean);
        }
    }
    own.volume() * force
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
