//! A fingerprint of a state, to compare runs bit by bit.

use std::fmt;

use bytemuck::NoUninit;
use xxhash_rust::xxh3::Xxh3;

/// The 128-bit XXH3 digest of a state; prints as 32 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StateHash(pub u128);

impl fmt::Display for StateHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// Digests named sections in the order in which they come.
///
/// Names and lengths are digested with the bytes, so that values which move from one section to the next, or
/// swap names, change the result. Numbers are compared as bits: `0.0` and `-0.0` differ.
#[derive(Clone, Default)]
pub struct StateHasher {
    digest: Xxh3,
}

impl StateHasher {
    /// A hasher that has seen no section.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the values of the section `name`.
    pub fn section<T: NoUninit>(&mut self, name: &str, values: &[T]) -> &mut Self {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        for part in [name.as_bytes(), bytes] {
            self.digest.update(&(part.len() as u64).to_le_bytes());
            self.digest.update(part);
        }
        self
    }

    /// The hash of the sections so far.
    pub fn finish(&self) -> StateHash {
        StateHash(self.digest.digest128())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use xxhash_rust::xxh3::xxh3_128;

    #[test]
    fn the_hash_is_that_of_the_framed_bytes() {
        let mut framed = Vec::new();
        framed.extend_from_slice(&[1, 0, 0, 0, 0, 0, 0, 0, b'x', 8, 0, 0, 0, 0, 0, 0, 0]);
        framed.extend_from_slice(&1.5_f64.to_le_bytes());
        let hash = StateHasher::new().section("x", &[1.5_f64]).finish();
        assert_eq!(hash.0, xxh3_128(&framed));
        assert_eq!(hash.to_string().len(), 32);
        assert_eq!(StateHash(0xab).to_string(), "000000000000000000000000000000ab");
    }

    #[test]
    fn every_change_of_name_place_and_bit_shows() {
        let of = |sections: &[(&str, &[f64])]| {
            let mut hasher = StateHasher::new();
            for (name, values) in sections {
                hasher.section(name, values);
            }
            hasher.finish()
        };
        let states: [&[(&str, &[f64])]; 7] = [
            &[("x", &[1.0, 2.0]), ("v", &[3.0])],
            &[("x", &[1.0]), ("v", &[2.0, 3.0])],
            &[("v", &[1.0, 2.0]), ("x", &[3.0])],
            &[("v", &[3.0]), ("x", &[1.0, 2.0])],
            &[("x", &[1.0, 2.0]), ("v", &[-3.0])],
            &[("x", &[0.0])],
            &[("x", &[-0.0])],
        ];
        for (i, a) in states.iter().enumerate() {
            for (j, b) in states.iter().enumerate() {
                assert_eq!(of(a) == of(b), i == j, "{a:?} against {b:?}");
            }
        }
    }
}
