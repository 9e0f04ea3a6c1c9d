//! The motion of the surface of a deformable body in the rate of compression of the fluid.
//!
//! The pressure on a body acts at the midpoint of each pair ([`pressure`](super::pressure)). There the body
//! moves at `v_w - 1/2 L_w x_iw`, with the gradient L_w of the motion of the cluster, so that the rate of
//! compression of fluid particle i is less by
//!
//! `1/2 sum_w V_w w_iw x_iw . L_w x_iw`:
//!
//! the work of the pressure on the body is the energy that the fluid loses, and the volume change of a body
//! is that of its particles. A rotation of the body has no effect.
//!
//! The pressure of the body acts at the same points, so that the rate of compression at the body, which
//! enters that of the fluid too (`walls::wall_compression`), is reduced likewise: `1/2 sum_f V_f w_wf x_wf .
//! L_w x_wf`.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Group, MIN_SHARE, part};
use crate::formulations::fluid::rotation::affine;
use crate::linalg::Sym3;
use crate::parallel::for_each_block;
use crate::schedule::{Run, Step, StepError};

/// Share of the support up to which neighbours are in the rows of all ranks: those of other ranks hold more
/// than is near now.
const WITHIN: f64 = 1.0 - 1e-6;

/// Changes the rates of compression beside deformable bodies.
#[derive(Default)]
pub struct SurfaceStretching {
    /// That of the boundary particles from the first of a deformable body on.
    rates: Vec<StretchBeside>,
}

/// Stretch of the surface beside a boundary particle.
#[derive(Clone, Copy, Debug)]
struct StretchBeside {
    /// Symmetric part of L_w, 1/s.
    stretch: Sym3,
    /// `sum_f V_f w_wf x_wf . L_w x_wf` over the share of the kernel that fluids fill, where the pressure of
    /// the body acts, 1/s.
    rate: f64,
}

impl StretchBeside {
    const NONE: Self = Self { stretch: Sym3::ZERO, rate: 0.0 };
}

impl Run for SurfaceStretching {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let half = 0.5 * step.clock.dt;
        let Some(among) = self.find_rates(&cloud, half) else { return Ok(()) };
        let mut compression = std::mem::take(&mut cloud.compression);
        let mut of_boundaries = std::mem::take(&mut cloud.boundary_compression);
        let stretched = Stretched { cloud: &cloud, among, rates: &self.rates, half };
        of_boundaries.resize(compression.len(), 0.0);
        type Rows<'a> = (&'a mut [f64], &'a mut [f64]);
        let rows = (&mut compression[..], &mut of_boundaries[..]);
        for_each_block(rows, &mut Vec::new(), &|first, (rates, of_boundaries): Rows<'_>| {
            for (i, (rate, of_boundaries)) in (first..).zip(rates.iter_mut().zip(of_boundaries)) {
                let [own, of_body] = stretched.beside(i);
                *rate -= 0.5 * (own + of_body);
                *of_boundaries -= 0.5 * of_body;
            }
        });
        (cloud.compression, cloud.boundary_compression) = (compression, of_boundaries);
        Ok(())
    }
}

impl SurfaceStretching {
    /// Finds the rates of all deformable bodies half a step before now; gives their rows in the cloud if any
    /// of them moves.
    fn find_rates(&mut self, cloud: &FlowCloud, half: f64) -> Option<Range<usize>> {
        let soft = || cloud.groups.iter().filter_map(|group| Some((group, cloud.soft_neighborhood(group)?)));
        let among = soft().next()?.0.cloud.start..soft().next_back()?.0.cloud.end;
        if cloud.records[among.clone()].iter().all(|record| record.velocity() == DVec3::ZERO) {
            return None;
        }
        self.rates.clear();
        self.rates.resize(among.len(), StretchBeside::NONE);
        let periodic = cloud.pairs.periodic();
        for (group, near) in soft() {
            let (records, lists) = (&cloud.records[group.cloud.clone()], &cloud.pairs.boundary);
            let rows = group.cloud.start - among.start..group.cloud.end - among.start;
            let first_row = group.cloud.start - cloud.fluid;
            for_each_block(&mut self.rates[rows], &mut Vec::new(), &|first, rates: &mut [StretchBeside]| {
                for (k, rate) in (first..).zip(rates) {
                    if !lists.row(first_row + k).is_empty() {
                        let cluster = near.cluster_before(records, k, periodic, half);
                        let stretch = affine(&cluster.moment, cluster.motion, cloud.plane);
                        let stretch = Sym3::symmetric_part(stretch) * near.share(&cluster);
                        *rate = StretchBeside {
                            stretch,
                            rate: cloud.rate_beside(group, first_row + k, &stretch, half),
                        };
                    }
                }
            });
        }
        Some(among)
    }
}

/// Volume, pair vector and distance of a neighbour, half a step before now.
struct NearBefore {
    volume: f64,
    x: DVec3,
    distance: f64,
}

impl FlowCloud {
    /// A neighbour of a particle, if it is within the support half a step before now and now.
    fn before(&self, i: usize, j: u32, half: f64) -> Option<NearBefore> {
        let (own, other) = (&self.records[i], &self.records[j as usize]);
        let now = self.offset(own.position(), other.position());
        let x = now - half * (other.velocity() - own.velocity());
        let (distance, support) = (x.length(), self.kernel.support);
        (now.length() < WITHIN * support && distance < support).then_some(NearBefore {
            volume: other.volume(),
            x,
            distance,
        })
    }

    /// Contribution of the stretching to the rate beside a particle of a group, in that row of the
    /// boundaries.
    fn rate_beside(&self, group: &Group, row: usize, stretch: &Sym3, half: f64) -> f64 {
        if !group.has_suction() {
            return 0.0;
        }
        let (mut total, mut rate) = (0.0, 0.0);
        for &j in self.pairs.boundary.row(row) {
            if let Some(NearBefore { volume, x, distance }) = self.before(self.fluid + row, j, half) {
                total += volume * self.kernel.value(distance);
                rate += volume * self.kernel.weight(distance) * x.dot(*stretch * x);
            }
        }
        if total > MIN_SHARE { rate / total } else { 0.0 }
    }
}

struct Stretched<'a> {
    cloud: &'a FlowCloud,
    /// Rows of deformable bodies.
    among: Range<usize>,
    rates: &'a [StretchBeside],
    /// Half of the step, s.
    half: f64,
}

impl Stretched<'_> {
    /// `sum_w V_w w_iw x_iw . L_w x_iw` at the middle of the step, 1/s, and what follows the rates beside the
    /// bodies.
    fn beside(&self, i: usize) -> [f64; 2] {
        let (cloud, mut sums) = (self.cloud, [0.0; 2]);
        for &w in part(cloud.near_row(i), &self.among) {
            if let Some(NearBefore { volume, x, distance }) = cloud.before(i, w, self.half) {
                let StretchBeside { stretch, rate } = self.rates[w as usize - self.among.start];
                sums[0] += volume * cloud.kernel.weight(distance) * x.dot(stretch * x);
                sums[1] += volume * cloud.kernel.value(distance) * rate;
            }
        }
        sums
    }
}
