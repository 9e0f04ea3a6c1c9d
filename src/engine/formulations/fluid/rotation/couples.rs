//! The couples of friction on boundary particles.
//!
//! The force of a pair across a surface acts in the middle of the pair: there, half of the couple `x_ij x f_ij` is that of the fluid, whose spin has it
//! in its balance, and half of it turns the boundary. A particle has no attitude; the couple on it is made of forces on its cluster,
//!
//! `V_k alpha_w x (x_k - x_mean)`, with alpha_w such that they add up to the couple and to no force.
//!
//! The sum is that of the spin of the cluster, read from the other side: the work of these forces is that of the couple at the spin.

use glam::DVec3;

use super::spin::rotation;
use crate::formulations::fluid::cloud::{Cluster, FlowCloud, Group, Neighborhood, PARTS, RowPass};
use crate::formulations::fluid::lanes::{Axial, Record};
use crate::neighbors::Periodic;
use crate::parallel::{FourLanes, Lanes4, Number, Vector, for_each_block};
use crate::world::Force;

/// Finds the couples on the particles of a boundary, and the forces that make them.
#[derive(Debug, Default)]
pub struct Couples {
    /// Couple on every particle, N m, and how fast friction on it grows with its velocity, kg/s.
    couples: Vec<Lanes4>,
    turned: Vec<Turned>,
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
        cloud.for_each_row(group.cloud.start, &mut self.couples, &CoupleOn { cloud, group });
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
    records: &[Record],
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
    group: &'a Group,
}

impl RowPass for CoupleOn<'_> {
    type Output = Lanes4;

    #[inline(always)]
    fn row<A: FourLanes>(&self, a: A, i: usize) -> Lanes4 {
        let Self { cloud, group } = *self;
        let (mut sum, mut drag) = (Axial::zero(a), Number::zero(a));
        let own = Vector::splat(a, cloud.records[i].velocity());
        for (fluid, viscosity) in cloud.groups.iter().zip(cloud.viscosities.of(group)) {
            if *viscosity == 0.0 {
                continue;
            }
            let half = 0.5 * cloud.viscosities.factor() * viscosity * cloud.volume(i);
            for near in cloud.fours(a, i, &fluid.cloud) {
                let v_ij = near.vector(|j| cloud.records[j].velocity()) - own;
                let spin = Axial::from_rows(a, near.rows.map(|j| &cloud.spins[j]));
                let friction = v_ij - spin.turn(near.x_ij);
                let weight = near.volume * near.weight * half;
                sum = Axial::product(near.x_ij, friction).mul_add(weight, sum);
                drag += weight;
            }
        }
        Lanes4::new(sum.sum(), 4.0 * drag.sum())
    }
}
