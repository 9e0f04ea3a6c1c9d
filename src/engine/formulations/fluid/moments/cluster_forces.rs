//! Forces on the particles around one, with a given first moment and zero resultant.
//!
//! A point particle cannot carry a moment. A moment M_w is applied as forces `V_k B_w (x_k - x_mean)` on the
//! particles k of its cluster, with B_w such that they add up to M_w and to no force
//! ([`affine`](crate::formulations::fluid::rotation)). Their power is `M_w : L_w` with the gradient L_w of
//! the motion of the cluster by the same B.
//!
//! A particle alone, or a row of particles about its line, has no couple.

use glam::{DMat3, DVec3};

use crate::formulations::fluid::cloud::{Cluster, FlowCloud, Group, Neighborhood, PARTS};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::formulations::fluid::rotation::{affine, axial};
use crate::neighbors::Periodic;
use crate::parallel::for_each_block;
use crate::world::Force;

/// How N moments of each particle act on its cluster.
#[derive(Debug, Default)]
pub struct ClusterForces<const N: usize> {
    /// Whether clusters that have collapsed carry a share of the moments alone ([`Neighborhood::share`]).
    fade: bool,
    /// Which particles have moments at all: those at the surface.
    acts: Vec<bool>,
    /// The shifts of those.
    shifts: Vec<MomentShift<N>>,
}

/// The clusters of the particles of a body.
#[derive(Clone, Copy)]
pub struct BodyClusters<'a> {
    pub cloud: &'a FlowCloud,
    pub group: &'a Group,
    pub near: &'a Neighborhood,
}

/// Mean place of a cluster, and B_w of each moment.
#[derive(Clone, Copy, Debug)]
struct MomentShift<const N: usize> {
    mean: DVec3,
    maps: [DMat3; N],
    /// Couple of the first moment that the cluster does not carry, N m.
    lost: DVec3,
}

/// Share of a moment below which what is lost of its couple is round-off.
const ROUND_OFF: f64 = 1e-9;

type Rows<'a> = (&'a mut [Force], &'a mut [[DVec3; PARTS]]);
type ShiftRows<'a, const N: usize> = (&'a mut [bool], &'a mut [MomentShift<N>]);

impl<const N: usize> ClusterForces<N> {
    /// Those of moments without a couple, of which clusters that have collapsed carry a share alone.
    pub fn fading() -> Self {
        Self { fade: true, ..Self::default() }
    }

    /// Takes the moments of the particles of a body, N m, of which the first is that of all of the force.
    pub fn set(
        &mut self,
        BodyClusters { cloud, group, near }: BodyClusters<'_>,
        moments: impl Fn(usize) -> [DMat3; N] + Sync,
    ) {
        let (records, periodic) = (&cloud.records[group.cloud.clone()], cloud.pairs.periodic());
        let none = MomentShift { mean: DVec3::ZERO, maps: [DMat3::ZERO; N], lost: DVec3::ZERO };
        self.acts.resize(records.len(), false);
        let fade = self.fade;
        self.shifts.resize(records.len(), none);
        let rows = (&mut self.acts[..], &mut self.shifts[..]);
        for_each_block(rows, &mut Vec::new(), &|begin, (acts, shifts): ShiftRows<'_, N>| {
            for (k, (acts, shift)) in (begin..).zip(acts.iter_mut().zip(shifts)) {
                let moments = moments(k);
                *acts = moments[0] != DMat3::ZERO;
                if *acts {
                    let cluster = near.cluster(records, k, periodic);
                    let share = if fade { near.share(&cluster) } else { 1.0 };
                    let Cluster { mean, moment, .. } = cluster;
                    let map = |first: DMat3| affine(&moment, first * share, cloud.plane);
                    let maps = moments.map(map);
                    *shift =
                        MomentShift { mean, maps, lost: lost(&moments[0], maps[0] * moment.to_matrix()) };
                }
            }
        });
    }

    /// Adds the forces of the first moment to the whole, and those of the last to one of its parts.
    pub fn add(
        &self,
        BodyClusters { cloud, group, near }: BodyClusters<'_>,
        total: &mut [Force],
        parts: &mut [DVec3],
        part: usize,
    ) {
        let (records, periodic) = (&cloud.records[group.cloud.clone()], cloud.pairs.periodic());
        let (parts, _) = parts.as_chunks_mut();
        for_each_block((total, parts), &mut Vec::new(), &|first, (total, parts): Rows<'_>| {
            for (k, (total, parts)) in (first..).zip(total.iter_mut().zip(parts)) {
                let forces = self.on(near, records, k, periodic);
                total.0 += forces[0];
                parts[part] += forces[N - 1];
            }
        });
    }

    /// Sum of the couples that clusters do not carry, N m.
    pub fn lost(&self) -> DVec3 {
        self.acts.iter().zip(&self.shifts).filter(|(acts, _)| **acts).map(|(_, shift)| shift.lost).sum()
    }

    /// The forces on particle `k` of all clusters that it is in.
    fn on(&self, near: &Neighborhood, records: &[FlowParticle], k: usize, periodic: &Periodic) -> [DVec3; N] {
        let (own, shifts) = (&records[k], &self.shifts);
        let mut forces = [DVec3::ZERO; N];
        if self.acts[k] {
            let MomentShift { mean, maps, .. } = &shifts[k];
            forces = maps.map(|map| map * -*mean);
        }
        for &w in near.list.row(k) {
            if !self.acts[w as usize] {
                continue;
            }
            let x = periodic.minimal_image(own.position() - records[w as usize].position());
            if near.are_near(x) {
                let MomentShift { mean, maps, .. } = &shifts[w as usize];
                (0..N).for_each(|n| forces[n] += maps[n] * (x - *mean));
            }
        }
        forces.map(|force| own.volume() * force)
    }
}

/// The couple of a moment less that of what is carried of it.
fn lost(moment: &DMat3, carried: DMat3) -> DVec3 {
    let couple = axial(&(*moment - carried));
    let size = moment.x_axis.length() + moment.y_axis.length() + moment.z_axis.length();
    if couple.length() > ROUND_OFF * size { couple } else { DVec3::ZERO }
}
