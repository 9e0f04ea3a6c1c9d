//! Fluid particles that boundaries repel.

use glam::DVec3;

use crate::ranks;

/// The repulsion of one fluid particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Repelled {
    /// The particle, as a row of the cloud.
    pub i: usize,
    /// First row of the boundary in the cloud.
    pub boundary: usize,
    /// Distance from its shape, or from the sphere of a particle of it, m.
    pub distance: f64,
    /// Whether it is that from a sphere; not exchanged.
    pub is_before_sphere: bool,
    /// The other one of the two, infinite where it is not known, m; not exchanged.
    pub other_distance: f64,
    /// Force on the particle, N; before that is known, over `l_i - d`, N/m.
    pub force: DVec3,
    /// Distribution of the opposite force to the particles of the boundary.
    pub shares: Shares,
}

/// Shares of particles near a point in what acts there, `V_w W (1 + (x_w - x_i - mean) . slope) / total`:
/// they add up to one, and their centre is the point, if these particles carry it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shares {
    pub total: f64,
    pub mean: DVec3,
    pub slope: DVec3,
    /// What carries it.
    pub carrier: LoadCarrier,
}

/// What carries a force at a point beside a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoadCarrier {
    /// The particles near the point, by their shares.
    #[default]
    Near,
    /// One particle, as a row of the cloud, on the line of the force.
    Particle(u32),
    /// The whole of a rigid body, of which this is the nearest particle.
    Body(u32),
}

impl LoadCarrier {
    fn to_words(self) -> [u64; 2] {
        match self {
            Self::Near => [0, 0],
            Self::Particle(row) => [1, u64::from(row)],
            Self::Body(row) => [2, u64::from(row)],
        }
    }

    fn of_words([kind, row]: [u64; 2]) -> Self {
        match kind {
            0 => Self::Near,
            1 => Self::Particle(row as u32),
            _ => Self::Body(row as u32),
        }
    }
}

/// Numbers of a repelled particle as ranks exchange them.
const WORDS: usize = 15;

impl Repelled {
    /// Gets those of all ranks, in the order of rows.
    pub fn share(repelled: &mut Vec<Self>) {
        let key = |repelled: &Self| repelled.i;
        ranks::concatenate_rows(repelled, |repelled| repelled.to_words(), Self::of_words, key);
    }

    fn to_words(self) -> [u64; WORDS] {
        let Self { i, boundary, distance, force, shares, .. } = self;
        let Shares { total, mean, slope, carrier } = shares;
        let numbers =
            [distance, total].into_iter().chain([force, mean, slope].into_iter().flat_map(|v| v.to_array()));
        let [kind, row] = carrier.to_words();
        let mut words = [i as u64, boundary as u64, kind, row].into_iter().chain(numbers.map(f64::to_bits));
        std::array::from_fn(|_| words.next().unwrap_or_default())
    }

    fn of_words(words: &[u64; WORDS]) -> Self {
        let number = |k: usize| f64::from_bits(words[k]);
        let vector = |k: usize| DVec3::new(number(k), number(k + 1), number(k + 2));
        let shares = Shares {
            total: number(5),
            mean: vector(9),
            slope: vector(12),
            carrier: LoadCarrier::of_words([words[2], words[3]]),
        };
        Self {
            i: words[0] as usize,
            boundary: words[1] as usize,
            distance: number(4),
            force: vector(6),
            shares,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_exchanged_is_what_was_there() {
        for carrier in [LoadCarrier::Near, LoadCarrier::Particle(7), LoadCarrier::Body(u32::MAX)] {
            let shares = Shares {
                total: 0.3,
                mean: DVec3::new(1.0, -2.0, 3.0),
                slope: DVec3::new(-0.0, 5.0, 6.0),
                carrier,
            };
            let repelled = Repelled {
                i: 3,
                boundary: 90,
                distance: 1e-3,
                force: DVec3::new(7.0, 8.0, 9.0),
                shares,
                ..Repelled::default()
            };
            let back = Repelled::of_words(&repelled.to_words());
            assert_eq!(format!("{back:?}"), format!("{repelled:?}"));
        }
    }
}
