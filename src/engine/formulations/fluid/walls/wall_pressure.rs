//! Pass over the particles of boundaries: pressure and mean velocity of the fluid beside them.
//!
//! `p_w = (sum_f p_f W - (g - a_w) . sum_f rho_f x_wf W) / sum_f W` (Adami, Hu, Adams 2012, eq. 27, with
//! x_wf = x_f - x_w and W for the kernel times the volume V_f, so that removed particles have no part in it).
//! Loads b_f on the fluid act as gravity does, with the value that each particle feels: `- sum_f b_f . rho_f
//! x_wf W` beside the pressures.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, FluidState, MIN_SHARE, take_until};
use crate::formulations::fluid::lanes::{
    FlowParticle, Four, FourPlaces, MASKS, OwnRecord, as_rows, dot, filled_up, sums,
};
use crate::formulations::fluid::lists::{NearRow, NearRows, NearWriter};
use crate::parallel::{
    FourLanes, Lanes4, PlaneOrSpace, Split, for_each_block, for_each_own_block, run_hot_in, share_picked,
};
use crate::ranks;

/// The fluid beside a particle of a boundary.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct FluidBeside {
    /// Mean pressure, with what loads on the fluid add on the way from it, Pa.
    pub pressure: f64,
    /// Mean of rho_f x_wf, kg/m2.
    pub moment: DVec3,
    /// Mean velocity, less that of the particle, m/s; zero beside a boundary to which the fluid does not
    /// stick.
    pub velocity: DVec3,
    /// Mean place, less that of the particle, m; zero likewise.
    pub offset: DVec3,
}

/// The pass over all particles that are no fluid.
pub struct WallPressure<'a> {
    pub cloud: &'a FlowCloud,
}

impl WallPressure<'_> {
    /// Writes the sums beside every particle of a boundary, and its neighbours within the support.
    pub fn run(&self, out: &mut [FluidBeside], near: &mut NearRows) {
        let cloud = self.cloud;
        // The pass over gaps needs the neighbours of every particle beside one.
        let looks_at_all = !cloud.pairs.gaps.particles.is_empty();
        let bodies = cloud.groups.iter().filter(|group| group.fluid().is_none());
        let mut rest = (&mut *out, near.writer());
        for group in bodies {
            let Range { start, end } = group.cloud;
            let (rows, behind) = rest.split(end - start);
            rest = behind;
            let sticks = group.sticks();
            let body = |first, (out, near): (&mut [FluidBeside], NearWriter<'_>)| {
                let first = start - cloud.fluid + first;
                run_hot_in(cloud.plane, WallPressureRows { cloud, sticks, first, out, near });
            };
            match looks_at_all {
                true => for_each_block(rows, &mut Vec::new(), &body),
                false => for_each_own_block(rows, &mut Vec::new(), &body),
            }
        }
        if !looks_at_all {
            share_wetted(cloud, out);
        }
    }
}

/// Gives all ranks what was found beside the particles of boundaries that have fluid in their lists; beside
/// the others there is nothing.
pub fn share_wetted<T: Pod + Default>(cloud: &FlowCloud, out: &mut [T]) {
    if !ranks::has_several() {
        return;
    }
    let lists = &cloud.pairs.boundary;
    for Range { start, end } in
        cloud.groups.iter().filter(|group| group.fluid().is_none()).map(|group| group.cloud.clone())
    {
        let rows = start - cloud.fluid..end - cloud.fluid;
        let wetted: Vec<u32> =
            rows.clone().filter(|&row| !lists.row(row).is_empty()).map(|row| row as u32).collect();
        let mut beside: Vec<T> = wetted.iter().map(|&row| out[row as usize]).collect();
        share_picked(&mut beside, &wetted, &rows);
        out[rows].fill(T::default());
        wetted.iter().zip(beside).for_each(|(&row, beside)| out[row as usize] = beside);
    }
}

struct WallPressureRows<'a> {
    cloud: &'a FlowCloud,
    /// Whether the fluid sticks to the body.
    sticks: bool,
    first: usize,
    out: &'a mut [FluidBeside],
    near: NearWriter<'a>,
}

impl PlaneOrSpace for WallPressureRows<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        match (self.cloud.periods.any(), self.sticks) {
            (false, false) => self.rows::<A, D, false, false>(a),
            (false, true) => self.rows::<A, D, false, true>(a),
            (true, false) => self.rows::<A, D, true, false>(a),
            (true, true) => self.rows::<A, D, true, true>(a),
        }
    }
}

impl WallPressureRows<'_> {
    /// `P`: with periods. `STICKS`: with the velocity of the fluid.
    #[inline(always)]
    fn rows<A: FourLanes, const D: usize, const P: bool, const STICKS: bool>(mut self, a: A) {
        let Self { cloud, first, .. } = self;
        for (k, out) in self.out.iter_mut().enumerate() {
            let (i, list) = (cloud.fluid + first + k, cloud.pairs.boundary.row(first + k));
            let mut rest = take_near(a, cloud, &cloud.records[i], list, self.near.row(k));
            *out = FluidBeside::default();
            let own = OwnRecord::<D>::new(&cloud.records[i]);
            let mut sums = SumsBeside::<D>::ZERO;
            // By number: zipped iterators would be called.
            for n in 0..cloud.groups.len() {
                let Some(state) = cloud.groups[n].fluid().filter(|_| !rest.is_empty()) else { break };
                for chunk in take_until(&mut rest, cloud.groups[n].cloud.end).chunks(4) {
                    sums.add::<A, P, STICKS>(a, cloud, &own, state, chunk);
                }
            }
            if !list.is_empty() {
                sums.mean::<A, STICKS>(a, out);
            }
        }
    }
}

/// Writes down those of a list that are within the support of a particle. Half of the lists of boundaries,
/// along which fluids slide, is skin.
#[inline(always)]
fn take_near<'a, A: FourLanes>(
    a: A,
    cloud: &FlowCloud,
    own: &FlowParticle,
    list: &[u32],
    mut near: NearRow<'a>,
) -> &'a [u32] {
    let limit = Lanes4::splat(cloud.kernel.support * cloud.kernel.support);
    for chunk in list.chunks(4) {
        let rows = filled_up(chunk);
        let FourPlaces { x, .. } = FourPlaces::gather(a, &cloud.records, own, as_rows(rows), &cloud.periods);
        near.push(a, rows, a.below(dot(a, &x, &x), limit) & ((1 << chunk.len()) - 1));
    }
    near.close()
}

/// Sums over the fluid beside a particle, in the lanes of the fours.
struct SumsBeside<const D: usize> {
    total: Lanes4,
    pressure: Lanes4,
    moment: [Lanes4; D],
    velocity: [Lanes4; D],
    offset: [Lanes4; D],
}

impl<const D: usize> SumsBeside<D> {
    const ZERO: Self = Self {
        total: Lanes4::ZERO,
        pressure: Lanes4::ZERO,
        moment: [Lanes4::ZERO; D],
        velocity: [Lanes4::ZERO; D],
        offset: [Lanes4::ZERO; D],
    };

    /// Adds up to four particles of a fluid.
    #[inline(always)]
    fn add<A: FourLanes, const P: bool, const STICKS: bool>(
        &mut self,
        a: A,
        cloud: &FlowCloud,
        own: &OwnRecord<D>,
        state: &FluidState,
        chunk: &[u32],
    ) {
        let rows = filled_up(chunk);
        let four = Four::<D>::gather::<A, P>(a, &cloud.records, own, as_rows(rows), &cloud.periods);
        let distance = a.sqrt(dot(a, &four.x, &four.x));
        let volume = a.mul(four.volume, MASKS[chunk.len()]);
        let value = a.mul(cloud.kernel.values(a, distance), volume);
        // rho = rho_0 + p / c_0^2 to first order in the compression.
        let factor = cloud.pressure_factor;
        let per_pressure = 1.0 / (factor * state.sound_speed * state.sound_speed);
        let density = a.scale_add(per_pressure, four.pressure, Lanes4::splat(state.density));
        self.total = a.add(self.total, value);
        self.pressure = a.mul_add(value, four.pressure, self.pressure);
        let weighed = a.mul(value, density);
        if !cloud.loads.is_empty() {
            let along = along_loads::<A, D>(a, cloud, rows, &four.x);
            self.pressure = a.sub(self.pressure, a.scale(factor, a.mul(weighed, along)));
        }
        for axis in 0..D {
            self.moment[axis] = a.mul_add(weighed, four.x[axis], self.moment[axis]);
            if STICKS {
                self.offset[axis] = a.mul_add(value, four.x[axis], self.offset[axis]);
                self.velocity[axis] = a.mul_add(value, four.v[axis], self.velocity[axis]);
            }
        }
    }

    /// Writes the means, where there is fluid.
    #[inline(always)]
    fn mean<A: FourLanes, const STICKS: bool>(&self, a: A, out: &mut FluidBeside) {
        let total = self.total.sum();
        if total > MIN_SHARE {
            let mean = 1.0 / total;
            out.pressure = self.pressure.sum() * mean;
            out.moment = sums(a, &self.moment) * mean;
            if STICKS {
                out.velocity = sums(a, &self.velocity) * mean;
                out.offset = sums(a, &self.offset) * mean;
            }
        }
    }
}

/// b_f . x_wf of four particles of the fluid.
#[inline(always)]
fn along_loads<A: FourLanes, const D: usize>(
    a: A,
    cloud: &FlowCloud,
    rows: [u32; 4],
    x: &[Lanes4; D],
) -> Lanes4 {
    let loads = rows.map(|j| cloud.loads[j as usize]);
    let mut sum = Lanes4::ZERO;
    for axis in 0..D {
        sum = a.mul_add(Lanes4(loads.map(|load| load[axis])), x[axis], sum);
    }
    sum
}
