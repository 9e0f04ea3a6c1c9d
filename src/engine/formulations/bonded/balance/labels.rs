//! Labels: numbers that are the same where lengths and volumes are.

/// Difference of lengths from which on they are not the same, over the spacing; no common part of the lengths
/// of a lattice.
pub(super) const LENGTH: f64 = 1.7e-4;

/// A number that is spread over all 64 bits: the last step of `SplitMix64` (Steele, Lea, Flood 2014).
pub(super) fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A length as a number that is the same for lengths that are, if a spacing is the unit of both.
pub(super) fn length_label(length: f64, spacing: f64) -> u64 {
    mix((length / (LENGTH * spacing)).round() as i64 as u64)
}
