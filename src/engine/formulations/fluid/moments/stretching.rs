//! How a fluid sees the surface of a deformable body move.
//!
//! The pressure on a body acts in the middle of each pair ([`pressure`](super::pressure)). There the body moves at `v_w - 1/2 L_w x_iw`, with the gradient L_w of the motion of the cluster, so that the rate of
//! compression of fluid particle i is less by
//!
//! `1/2 sum_w V_w w_iw x_iw . L_w x_iw`:
//!
//! what the pressure of the fluid does to the body is what the fluid loses, and the volume that a body gives up is that of its particles. A body that turns changes nothing.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, part};
use crate::formulations::fluid::rotation::affine;
use crate::linalg::Sym3;
use crate::parallel::for_each_block;
use crate::schedule::{Run, Step, StepError};

/// Share of the support up to which neighbours are in the rows of all ranks: those of other ranks hold more than is near now.
const WITHIN: f64 = 1.0 - 1e-6;

/// Changes the rates of compression beside deformable bodies.
#[derive(Default)]
pub struct SurfaceStretching {
    /// Symmetric part of L_w of the boundary particles from the first of a deformable body on, 1/s.
    rates: Vec<Sym3>,
}

impl Run for SurfaceStretching {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let half = 0.5 * step.clock.dt;
        let Some(among) = self.find_rates(&cloud, half) else { return Ok(()) };
        let mut compression = std::mem::take(&mut cloud.compression);
        let stretched = Stretched { cloud: &cloud, among, rates: &self.rates, half };
        for_each_block(&mut compression[..], &mut Vec::new(), &|first, rates: &mut [f64]| {
            for (i, rate) in (first..).zip(rates) {
                *rate -= 0.5 * stretched.beside(i);
            }
        });
        cloud.compression = compression;
        Ok(())
    }
}

impl SurfaceStretching {
    /// Finds the rates of all deformable bodies half a step before now; gives their rows in the cloud if any of them moves.
    fn find_rates(&mut self, cloud: &FlowCloud, half: f64) -> Option<Range<usize>> {
        let soft = || cloud.groups.iter().filter_map(|group| Some((group, cloud.soft_neighborhood(group)?)));
        let among = soft().next()?.0.cloud.start..soft().next_back()?.0.cloud.end;
        if cloud.records[among.clone()].iter().all(|record| record.velocity() == DVec3::ZERO) {
            return None;
        }
        self.rates.clear();
        self.rates.resize(among.len(), Sym3::ZERO);
        let periodic = cloud.pairs.periodic();
        for (group, near) in soft() {
            let (records, lists) = (&cloud.records[group.cloud.clone()], &cloud.pairs.boundary);
            let rows = group.cloud.start - among.start..group.cloud.end - among.start;
            for_each_block(&mut self.rates[rows], &mut Vec::new(), &|first, rates: &mut [Sym3]| {
                for (k, rate) in (first..).zip(rates) {
                    if !lists.row(group.cloud.start - cloud.fluid + k).is_empty() {
                        let cluster = near.cluster_before(records, k, periodic, half);
                        *rate = Sym3::symmetric_part(affine(&cluster.moment, cluster.motion, cloud.plane));
                    }
                }
            });
        }
        Some(among)
    }
}

struct Stretched<'a> {
    cloud: &'a FlowCloud,
    /// Rows of deformable bodies.
    among: Range<usize>,
    rates: &'a [Sym3],
    /// Half of the step, s.
    half: f64,
}

impl Stretched<'_> {
    /// `sum_w V_w w_iw x_iw . L_w x_iw` at the middle of the step, 1/s.
    fn beside(&self, i: usize) -> f64 {
        let FlowCloud { records, kernel, .. } = self.cloud;
        let (own, mut sum) = (&records[i], 0.0);
        for &w in part(self.cloud.near_row(i), &self.among) {
            let other = &records[w as usize];
            let now = self.cloud.offset(own.position(), other.position());
            let x = now - self.half * (other.velocity() - own.velocity());
            let distance = x.length();
            if now.length() < WITHIN * kernel.support && distance < kernel.support {
                let rate = self.rates[w as usize - self.among.start];
                sum += other.volume() * kernel.weight(distance) * x.dot(rate * x);
            }
        }
        sum
    }
}
