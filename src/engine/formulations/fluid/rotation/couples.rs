//! The couples of friction on boundary particles.
//!
//! The force of a pair across a surface acts in the middle of the pair: there, half of the couple `x_ij x f_ij` is that of the fluid, whose spin has it
//! in its balance, and half of it turns the boundary. A particle has no attitude; the couple on it is made of forces on its cluster,
//!
//! `V_k alpha_w x (x_k - x_mean)`, with alpha_w such that they add up to the couple and to no force.
//!
//! The sum is that of the spin of the cluster, read from the other side: the work of these forces is that of the couple at the spin.

use std::ops::Range;

use glam::DVec3;

use super::spin::rotation;
use crate::formulations::fluid::cloud::{
    Cluster, FlowCloud, Group, NearPairs, Neighborhood, PARTS, RowPass, RowSums,
};
use crate::formulations::fluid::lanes::{Axial, FlowParticle, pack_axial, unpack_axial};
use crate::neighbors::Periodic;
use crate::parallel::{Arithmetic, Lanes4, Vector, for_each_block};
use crate::world::Force;

/// Finds the couples on the particles of a boundary, and the forces that make them.
#[derive(Debug, Default)]
pub struct Couples {
    /// Couple on every particle, N m, and how fast friction on it grows with its velocity, kg/s.
    couples: Vec<Lanes4>,
    turned: Vec<Turned>,
    sums: RowSums,
}

/// How the couple on a particle acts on its cluster: mean place of that, and alpha_w.
#[derive(Clone, Copy, Debug, Default)]
struct Turned {
    mean: DVec3,
    alpha: DVec3,
}

type Rows<'a> = (&'a mut [Force], &'a mut [[DVec3; PARTS]]);

impl Couples {
    /// Adds the forces to the whole and to its viscous part.
    pub fn add(&mut self, cloud: &FlowCloud, group: &Group, total: &mut [Force], parts: &mut [DVec3]) {
        self.couples.clear();
        let Some(near) = cloud.neighborhood(group) else { return };
        let (records, periodic) = (&cloud.records[group.cloud.clone()], cloud.pairs.periodic());
        self.couples.resize(records.len(), Lanes4::ZERO);
        self.turned.resize(records.len(), Turned::default());
        let pass = CoupleOn { cloud, viscosities: cloud.viscosities.of(group) };
        cloud.for_each_row(group.cloud.start, &mut self.couples, &mut self.sums, &pass);
        let couples = &self.couples;
        for_each_block(&mut self.turned[..], &mut Vec::new(), &|first, turned: &mut [Turned]| {
            for (k, turned) in (first..).zip(turned) {
                *turned = Turned::default();
                let couple = couples[k].xyz();
                if couple != DVec3::ZERO {
                    let Cluster { mean, moment, .. } = near.cluster(records, k, periodic);
                    *turned = Turned { mean, alpha: rotation(&moment, couple, cloud.plane) };
                }
            }
        });
        let turned = &self.turned;
        let (parts, _) = parts.as_chunks_mut();
        for_each_block((total, parts), &mut Vec::new(), &|first, (total, parts): Rows<'_>| {
            for (k, (total, parts)) in (first..).zip(total.iter_mut().zip(parts)) {
                let force = force_on(near, records, turned, k, periodic);
                total.0 += force;
                parts[0] += force;
            }
        });
    }
}

impl Couples {
    /// Adds to `drag` how fast the friction on each particle grows with its velocity, kg/s: the fluid sees twice the velocity of a boundary, less its own.
    pub fn add_drag(&self, drag: &mut [f64]) {
        drag.iter_mut().zip(&self.couples).for_each(|(drag, row)| *drag += row.0[3]);
    }
}

/// The force on particle `k` of all clusters that it is in.
fn force_on(
    near: &Neighborhood,
    records: &[FlowParticle],
    turned: &[Turned],
    k: usize,
    periodic: &Periodic,
) -> DVec3 {
    let own = &records[k];
    let mut force = turned[k].alpha.cross(-turned[k].mean);
    for &w in near.list.row(k) {
        let Turned { mean, alpha } = turned[w as usize];
        if alpha != DVec3::ZERO {
            let x = periodic.minimal_image(own.position() - records[w as usize].position());
            force += alpha.cross(x - mean);
        }
    }
    own.volume() * force
}

/// `1/2 sum_f x_wf x f_wf` with the friction f_wf of a pair, and `2 sum_f V_w V_f 4 mu w_wf`.
struct CoupleOn<'a> {
    cloud: &'a FlowCloud,
    /// Viscosities between the boundary and all groups, Pa s.
    viscosities: &'a [f64],
}

impl RowPass<2, 2> for CoupleOn<'_> {
    type Output = Lanes4;

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
        [couple, drag]: &mut [Vector<A>; 2],
    ) {
        let friction = *other - *own - Axial::of(*spin).turn(near.x_ij);
        let weight = near.volume * near.weight * self.viscosities[near.group];
        *couple = Axial::product(near.x_ij, friction).mul_add(weight, Axial::of(*couple)).into_row();
        drag.x += weight;
    }

    fn output(&self, i: usize, &[couple, drag]: &[DVec3; 2]) -> Lanes4 {
        let half = 0.5 * self.cloud.viscosities.factor() * self.cloud.volume(i);
        Lanes4::new(half * unpack_axial(couple, self.cloud.plane), 4.0 * half * drag.x)
    }
}
