//! The record that the passes over pairs read per particle: one cache line, packed from the columns in every
//! step.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::neighbors::Periodic;
use crate::parallel::{FourLanes, Lanes4};

/// A particle as its neighbours see it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub struct FlowParticle {
    /// Position x, m, and volume V, m3.
    pub place: Lanes4,
    /// Velocity v, m/s, and pressure p, Pa.
    pub motion: Lanes4,
}

impl FlowParticle {
    /// Position, m.
    #[inline(always)]
    pub fn position(&self) -> DVec3 {
        self.place.xyz()
    }

    /// Volume, m3.
    #[inline(always)]
    pub fn volume(&self) -> f64 {
        self.place.0[3]
    }

    /// Velocity, m/s.
    #[inline(always)]
    pub fn velocity(&self) -> DVec3 {
        self.motion.xyz()
    }

    /// Pressure times the factor of pressures in sums over pairs, Pa (`FlowCloud::pressure` has that of the
    /// particle).
    #[inline(always)]
    pub fn pressure(&self) -> f64 {
        self.motion.0[3]
    }
}

/// Periods of the domain, zero along axes that do not repeat.
#[derive(Clone, Copy, Debug, Default)]
pub struct Periods {
    length: [f64; 3],
    inverse: [f64; 3],
    any: bool,
}

impl Periods {
    /// The periods of a domain.
    pub fn new(periodic: &Periodic) -> Self {
        let length = periodic.lengths().to_array();
        let inverse = length.map(|length| if length > 0.0 { 1.0 / length } else { 0.0 });
        Self { length, inverse, any: periodic.any() }
    }

    /// Whether any axis repeats.
    #[inline(always)]
    pub fn any(&self) -> bool {
        self.any
    }

    /// Differences along an axis to the nearest image.
    #[inline(always)]
    fn nearest<A: FourLanes>(&self, a: A, axis: usize, x: Lanes4) -> Lanes4 {
        let shift = Lanes4::splat(SHIFT);
        let turns = a.sub(a.scale_add(self.inverse[axis], x, shift), shift);
        a.scale_add(-self.length[axis], turns, x)
    }
}

/// Between 2^52 and 2^53 the spacing of doubles is one: adding and taking away rounds to the nearest integer.
const SHIFT: f64 = 6755399441055744.0;

/// A particle in every lane, packed once for all of its neighbours.
#[derive(Clone, Copy)]
pub struct OwnRecord<const D: usize> {
    /// x_i per axis.
    x: [Lanes4; D],
    /// v_i per axis.
    v: [Lanes4; D],
    /// p_i.
    pub pressure: Lanes4,
}

impl<const D: usize> OwnRecord<D> {
    /// The lanes of a particle.
    #[inline(always)]
    pub fn new(record: &FlowParticle) -> Self {
        let (mut x, mut v) = ([Lanes4::ZERO; D], [Lanes4::ZERO; D]);
        for axis in 0..D {
            x[axis] = Lanes4::splat(record.place.0[axis]);
            v[axis] = Lanes4::splat(record.motion.0[axis]);
        }
        Self { x, v, pressure: Lanes4::splat(record.pressure()) }
    }
}

/// Four neighbours of a particle: differences to it.
#[derive(Clone, Copy)]
pub struct Four<const D: usize> {
    /// x_ij per axis.
    pub x: [Lanes4; D],
    /// v_ij per axis.
    pub v: [Lanes4; D],
    /// V_j.
    pub volume: Lanes4,
    /// p_j.
    pub pressure: Lanes4,
}

/// Written out: a closure would be called.
#[inline(always)]
pub fn as_rows([j, k, l, m]: [u32; 4]) -> [usize; 4] {
    [j as usize, k as usize, l as usize, m as usize]
}

/// One to four neighbours as four: the last one fills up. Without a branch, which a processor would guess
/// wrong at every other row.
#[inline(always)]
pub fn filled_up(rest: &[u32]) -> [u32; 4] {
    let last = rest.len() - 1;
    [rest[0], rest[last.min(1)], rest[last.min(2)], rest[last]]
}

/// Beyond the support in the lanes without a neighbour, by the number of those with one.
pub const FILLS: [Lanes4; 5] = [
    Lanes4([4.0, 4.0, 4.0, 4.0]),
    Lanes4([0.0, 4.0, 4.0, 4.0]),
    Lanes4([0.0, 0.0, 4.0, 4.0]),
    Lanes4([0.0, 0.0, 0.0, 4.0]),
    Lanes4([0.0, 0.0, 0.0, 0.0]),
];

/// One in the lanes with a neighbour, zero in the others.
pub const MASKS: [Lanes4; 5] = [
    Lanes4([0.0, 0.0, 0.0, 0.0]),
    Lanes4([1.0, 0.0, 0.0, 0.0]),
    Lanes4([1.0, 1.0, 0.0, 0.0]),
    Lanes4([1.0, 1.0, 1.0, 0.0]),
    Lanes4([1.0, 1.0, 1.0, 1.0]),
];

/// Where four neighbours of a particle are.
#[derive(Clone, Copy)]
pub struct FourPlaces {
    /// x_ij per axis.
    pub x: [Lanes4; 3],
    /// V_j.
    pub volume: Lanes4,
}

impl FourPlaces {
    /// Reads four neighbours.
    #[inline(always)]
    pub fn gather<A: FourLanes>(
        a: A,
        records: &[FlowParticle],
        own: &FlowParticle,
        [j, k, l, m]: [usize; 4],
        periods: &Periods,
    ) -> Self {
        let place = a.transpose([records[j].place, records[k].place, records[l].place, records[m].place]);
        let mut x = [Lanes4::ZERO; 3];
        for axis in 0..A::AXES {
            x[axis] = a.sub(place[axis], Lanes4::splat(own.place.0[axis]));
        }
        if periods.any() {
            for axis in 0..A::AXES {
                x[axis] = periods.nearest(a, axis, x[axis]);
            }
        }
        Self { x, volume: place[3] }
    }
}

impl<const D: usize> Four<D> {
    /// Reads four neighbours.
    #[inline(always)]
    pub fn gather<A: FourLanes, const P: bool>(
        a: A,
        records: &[FlowParticle],
        own: &OwnRecord<D>,
        [j, k, l, m]: [usize; 4],
        periods: &Periods,
    ) -> Self {
        let r = [&records[j], &records[k], &records[l], &records[m]];
        let place = a.transpose([r[0].place, r[1].place, r[2].place, r[3].place]);
        let motion = a.transpose([r[0].motion, r[1].motion, r[2].motion, r[3].motion]);
        let mut x = [Lanes4::ZERO; D];
        let mut v = [Lanes4::ZERO; D];
        for axis in 0..D {
            x[axis] = a.sub(place[axis], own.x[axis]);
            v[axis] = a.sub(motion[axis], own.v[axis]);
            if P {
                x[axis] = periods.nearest(a, axis, x[axis]);
            }
        }
        Self { x, v, volume: place[3], pressure: motion[3] }
    }
}

/// Scalar products of four pairs of vectors.
#[inline(always)]
pub fn dot<A: FourLanes, const D: usize>(a: A, b: &[Lanes4; D], c: &[Lanes4; D]) -> Lanes4 {
    let mut sum = a.mul(b[0], c[0]);
    for k in 1..D {
        sum = a.mul_add(b[k], c[k], sum);
    }
    sum
}

/// The vector of the sums of the lanes of each axis.
#[inline(always)]
pub fn sums<A: FourLanes, const D: usize>(a: A, v: &[Lanes4; D]) -> DVec3 {
    let z = if D == 3 { v[D - 1] } else { Lanes4::ZERO };
    a.sums([v[0], v[1], z, Lanes4::ZERO]).xyz()
}
