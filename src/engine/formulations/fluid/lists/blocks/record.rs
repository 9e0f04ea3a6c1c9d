//! The record that the passes in blocks read per particle: 32 bytes, packed from the records in every step.
//!
//! Positions are whole multiples of a unit of at most 2^-24 spacings, with wrap-around arithmetic:
//! differences are exact, and x_ij is exactly -x_ji. A period is a whole multiple of 2^32 units, so that
//! differences are those of the nearest images.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::table::Rows;
use crate::formulations::fluid::lanes::FlowParticle;
use crate::neighbors::Periodic;
use crate::parallel::{EIGHT, EightLanes, Lanes8, for_each_block};

/// A particle as blocks see it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(32))]
pub struct Packed {
    /// Position, in units.
    pub place: [i32; 3],
    /// Volume, m3.
    pub volume: f32,
    /// Velocity, m/s.
    pub velocity: [f32; 3],
    /// Pressure, Pa.
    pub pressure: f32,
}

/// The unit of places.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// Its length along each axis, m.
    pub length: DVec3,
    inverse: DVec3,
}

/// Two to the powers of 24 and 32.
const FINE: f64 = 16_777_216.0;
const RANGE: f64 = 4_294_967_296.0;

impl Units {
    /// That of a spacing, m.
    pub fn new(spacing: f64, periodic: &Periodic) -> Self {
        let length = periodic.lengths().to_array().map(|length| {
            let rounds = (length * FINE / (RANGE * spacing)).ceil();
            if length > 0.0 { length / (RANGE * rounds) } else { spacing / FINE }
        });
        let length = DVec3::from_array(length);
        Self { length, inverse: 1.0 / length }
    }

    /// A place, m, in units: the lowest bits, as places go round.
    #[inline(always)]
    fn place(&self, x: DVec3) -> [i32; 3] {
        let x = x * self.inverse;
        [x.x as i64 as i32, x.y as i64 as i32, x.z as i64 as i32]
    }
}

type Slices<'a> = (&'a mut [Packed], &'a [FlowParticle]);

/// Packs places alone.
pub fn pack_places(packed: &mut [Packed], positions: &[DVec3], units: &Units) {
    type Rows<'a> = (&'a mut [Packed], &'a [DVec3]);
    for_each_block((packed, positions), &mut Vec::new(), &|_, (packed, positions): Rows<'_>| {
        packed.iter_mut().zip(positions).for_each(|(packed, x)| packed.place = units.place(*x));
    });
}

/// Packs volumes, velocities and pressures again.
pub fn pack_states(packed: &mut [Packed], records: &[FlowParticle]) {
    for_each_block((packed, records), &mut Vec::new(), &|_, (packed, records): Slices<'_>| {
        for (packed, record) in packed.iter_mut().zip(records) {
            packed.take_state(record);
        }
    });
}

impl Packed {
    /// Takes place, volume, velocity and pressure.
    #[inline(always)]
    pub fn take(&mut self, record: &FlowParticle, units: &Units) {
        self.place = units.place(record.position());
        self.take_state(record);
    }

    /// Updates volume, velocity and pressure.
    #[inline(always)]
    pub fn take_state(&mut self, record: &FlowParticle) {
        self.volume = record.volume() as f32;
        let [x, y, z, pressure] = record.motion.0;
        self.velocity = [x as f32, y as f32, z as f32];
        self.pressure = pressure as f32;
    }
}

/// The particles of a block, one a lane.
#[derive(Clone, Copy)]
pub struct OwnBlock {
    place: [[i32; EIGHT]; 3],
    velocity: [Lanes8; 3],
    pub volume: Lanes8,
    pub pressure: Lanes8,
}

/// A neighbour of a block: differences to its particles.
#[derive(Clone, Copy)]
pub struct Other {
    /// x_ij, m.
    pub x: [Lanes8; 3],
    /// v_ij, m/s.
    pub v: [Lanes8; 3],
}

impl OwnBlock {
    #[inline(always)]
    pub fn new(packed: &[Packed], rows: &Rows) -> Self {
        let mut own = Self {
            place: [[0; EIGHT]; 3],
            velocity: [Lanes8::ZERO; 3],
            volume: Lanes8::ZERO,
            pressure: Lanes8::ZERO,
        };
        for lane in 0..EIGHT {
            let particle = &packed[rows[lane] as usize];
            for axis in 0..3 {
                own.place[axis][lane] = particle.place[axis];
                own.velocity[axis].0[lane] = particle.velocity[axis];
            }
            own.volume.0[lane] = particle.volume;
            own.pressure.0[lane] = particle.pressure;
        }
        own
    }

    /// Differences of a neighbour to all particles of the block.
    #[inline(always)]
    pub fn to<A: EightLanes>(&self, a: A, other: &Packed, unit: &[Lanes8; 3]) -> Other {
        let (mut x, mut v) = ([Lanes8::ZERO; 3], [Lanes8::ZERO; 3]);
        for axis in 0..A::AXES {
            x[axis] = a.mul(a.apart(other.place[axis], self.place[axis]), unit[axis]);
            v[axis] = a.sub(a.same(other.velocity[axis]), self.velocity[axis]);
        }
        Other { x, v }
    }
}

/// Scalar products of the vectors of all lanes.
#[inline(always)]
pub fn dot<A: EightLanes>(a: A, u: &[Lanes8; 3], v: &[Lanes8; 3]) -> Lanes8 {
    let plane = a.mul_add(u[1], v[1], a.mul(u[0], v[0]));
    if A::AXES == 3 { a.mul_add(u[2], v[2], plane) } else { plane }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::{BlockLoop, Lanes4, run_blocks_on};

    struct Differences<'a>(&'a [Packed], &'a Units);

    impl BlockLoop for Differences<'_> {
        type Output = Vec<[Lanes8; 3]>;

        #[inline(always)]
        fn run<A: EightLanes>(self, a: A) -> Self::Output {
            let Self(packed, units) = self;
            let own = OwnBlock::new(packed, &std::array::from_fn(|lane| lane as u32));
            let unit = units.length.to_array().map(|length| a.splat(length));
            packed.iter().map(|other| own.to(a, other, &unit).x).collect()
        }
    }

    /// Differences are those of the nearest images, to single precision, and exactly opposite from the other
    /// side.
    #[test]
    fn differences_are_exact_and_antisymmetric_across_periods() {
        let domain = |length| {
            Periodic::new(DVec3::new(-0.3, 0.0, 0.0), DVec3::splat(length - 0.3), [true, false, false])
        };
        for length in [0.7, 90.0] {
            let periodic = domain(length).expect("a domain");
            let units = Units::new(0.1, &periodic);
            let place = |k: u32| {
                let t = f64::from(k);
                // Some are whole periods away.
                let turns = length * (t % 3.0 - 1.0);
                DVec3::new(turns - 0.3 + 0.01 * t.sin(), 5.0 + 0.2 * (1.7 * t).sin(), 0.1 * (2.3 * t).cos())
            };
            let record =
                |k: u32| FlowParticle { place: Lanes4::new(place(k), 1e-3), ..FlowParticle::default() };
            let records: Vec<FlowParticle> = (0..8).map(record).collect();
            let mut packed = [Packed::default(); 8];
            packed.iter_mut().zip(&records).for_each(|(packed, record)| packed.take(record, &units));
            let x = run_blocks_on(false, Differences(&packed, &units));
            for j in 0..8 {
                for i in 0..8 {
                    let exact = periodic.minimal_image(place(j as u32) - place(i as u32));
                    for axis in 0..3 {
                        let found = x[j][axis].0[i];
                        assert!(
                            (f64::from(found) - exact[axis]).abs() < 1e-7 * (1.0 + exact.length()),
                            "{length} {i} {j}"
                        );
                        assert_eq!(found, -x[i][axis].0[j]);
                    }
                }
            }
        }
    }
}
