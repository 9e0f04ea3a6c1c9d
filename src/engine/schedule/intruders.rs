//! Particles of one body inside of another: the deepest of them, and how a warning begins.

use glam::DVec3;

use crate::notation::{place, quantity};
use crate::ranks;

/// The deepest particle of a body inside of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intruders {
    /// Its row in the body.
    pub row: usize,
    /// How far below the surface of the other it is, m.
    pub depth: f64,
    /// How many there are.
    pub count: u32,
}

impl Intruders {
    /// Counts a particle that is inside; the first of equally deep ones is the deepest.
    pub fn add(found: &mut Option<Self>, row: usize, depth: f64) {
        let count = found.map_or(0, |found| found.count) + 1;
        match found {
            Some(found) if found.depth >= depth => found.count = count,
            _ => *found = Some(Self { row, depth, count }),
        }
    }

    /// Those of all ranks, each of which has looked at its own particles.
    pub fn of_ranks(found: Option<Self>) -> Option<Self> {
        let mut words: Vec<[u64; 3]> = found
            .iter()
            .map(|found| [found.row as u64, found.depth.to_bits(), u64::from(found.count)])
            .collect();
        if !ranks::has_several() {
            return found;
        }
        ranks::concatenate(&mut words);
        words.sort_unstable_by_key(|[row, ..]| *row);
        let count = words.iter().map(|[.., count]| *count as u32).sum();
        let all = words.iter().map(|&[row, depth, _]| (row as usize, f64::from_bits(depth)));
        let deepest = all.reduce(|first, next| if first.1 >= next.1 { first } else { next });
        deepest.map(|(row, depth)| Self { row, depth, count })
    }

    /// That particle `id` of the first body, at `x`, m, and `time`, s, is the deepest in the second.
    pub fn text(&self, id: u64, [body, other]: [&str; 2], x: DVec3, time: f64) -> String {
        let others = if self.count > 1 { format!(", and {} others", self.count - 1) } else { String::new() };
        format!(
            "particle {id} of `{body}` is inside of `{other}`, {} below its surface, at {} and {}{others}",
            quantity(self.depth, "m"),
            place(x),
            quantity(time, "s")
        )
    }
}
