//! Fluid particles past the ends of walls.

use glam::DMat3;

use crate::ranks;

/// A fluid particle beside the end of a wall, with empty space behind that end.
#[derive(Clone, Copy, Debug)]
pub struct WallEnd {
    /// The particle, as a row of the cloud.
    pub i: usize,
    /// Projection of a motion onto the wall, times the share that is lost to empty space.
    pub along: DMat3,
}

/// Numbers of such a particle as ranks exchange them.
const WORDS: usize = 10;

impl WallEnd {
    /// Gets those of all ranks, in the order of rows.
    pub fn share(ends: &mut Vec<Self>) {
        ranks::concatenate_rows(ends, |end| end.to_words(), Self::of_words, |end| end.i);
    }

    fn to_words(self) -> [u64; WORDS] {
        let columns = self.along.to_cols_array();
        std::array::from_fn(|k| k.checked_sub(1).map_or(self.i as u64, |k| columns[k].to_bits()))
    }

    fn of_words(words: &[u64; WORDS]) -> Self {
        let columns = std::array::from_fn(|k| f64::from_bits(words[k + 1]));
        Self { i: words[0] as usize, along: DMat3::from_cols_array(&columns) }
    }
}
