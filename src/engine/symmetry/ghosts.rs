//! Ghost particles: mirrored across symmetry planes, shifted along periodic axes.

use std::ops::Range;

use glam::DVec3;

use super::map::Map;
use super::repeats::Repeat;
use crate::parallel::for_each_block;

/// A ghost particle.
#[derive(Clone, Copy, Debug)]
pub struct Ghost<'a> {
    /// Its packed row.
    pub row: usize,
    /// The real row that it is an image of.
    pub source: usize,
    /// The map to it from its source.
    pub map: &'a Map,
}

/// The ghosts of all bodies of a phase; ghost k is row `rows + k` of packed rows.
#[derive(Debug, Default)]
pub struct Ghosts {
    /// Number of real rows.
    rows: usize,
    sources: Vec<u32>,
    /// Index of the map of each ghost.
    which: Vec<u32>,
    maps: Vec<Map>,
}

impl Ghosts {
    /// No ghosts yet of a phase of that many rows.
    pub fn new(rows: usize) -> Self {
        Self { rows, ..Self::default() }
    }

    /// Number of ghosts.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// The real row behind a row.
    #[inline]
    pub fn source(&self, row: usize) -> usize {
        if row < self.rows { row } else { self.sources[row - self.rows] as usize }
    }

    /// Signs of the axes of a row that is a mirror image: its vectors are those of its source times the
    /// signs. `None` for all other rows.
    #[inline]
    pub fn mirror(&self, row: usize) -> Option<DVec3> {
        let signs = (row >= self.rows).then(|| self.map(row).signs)?;
        (signs != DVec3::ONE).then_some(signs)
    }

    #[inline]
    fn map(&self, row: usize) -> &Map {
        &self.maps[self.which[row - self.rows] as usize]
    }

    /// x_ij from a real row to any row, from the positions of the real rows. Seen from the other end of the
    /// bond it is the same to the last bit, but for signs: the weight is rounded to single precision and must
    /// not differ.
    #[inline(always)]
    pub fn pair(&self, position: &[DVec3], i: usize, j: usize) -> DVec3 {
        if j < self.rows {
            return position[j] - position[i];
        }
        let map = self.map(j);
        (map.signs * position[self.source(j)] - position[i]) + map.shift
    }

    /// Place of a ghost, m, from the positions of the real rows.
    pub fn place(&self, position: &[DVec3], row: usize) -> DVec3 {
        self.map(row).place(position[self.source(row)])
    }

    /// Adds the ghosts of a body whose sources are closer than `reach`, m, to the planes across which they
    /// repeat; returns their rows. Bodies come in the order of their rows.
    pub fn add(
        &mut self,
        rows: Range<usize>,
        position: &[DVec3],
        reach: f64,
        repeats: &[Repeat],
    ) -> Range<usize> {
        let first = self.rows + self.len();
        // What the repeats so far have made of the body: those that follow repeat it, too, which fills the
        // corners.
        let mut all: Vec<(u32, u32)> = Vec::new();
        for repeat in repeats {
            let real = self.intern(Map::IDENTITY);
            let own = rows.clone().map(|row| (u32::try_from(row).unwrap_or(u32::MAX), real));
            let before: Vec<(u32, u32)> = own.chain(all.iter().copied()).collect();
            for (row, which) in before {
                let map = self.maps[which as usize];
                let place = map.place(position[row as usize]);
                for next in repeat.near(place, reach).into_iter().flatten() {
                    let which = self.intern(next.after(map));
                    all.push((row, which));
                }
            }
        }
        self.sources.extend(all.iter().map(|(row, _)| row));
        self.which.extend(all.iter().map(|(_, which)| which));
        first..self.rows + self.len()
    }

    fn intern(&mut self, map: Map) -> u32 {
        let k = self.maps.iter().position(|known| *known == map).unwrap_or_else(|| {
            self.maps.push(map);
            self.maps.len() - 1
        });
        u32::try_from(k).unwrap_or(u32::MAX)
    }

    /// Makes the packed rows of all ghosts, which stand behind the real ones, from those of their sources.
    pub fn fill<T: Send + Sync>(&self, rows: &mut [T], make: impl Fn(Ghost<'_>, &T) -> T + Sync) {
        let (real, ghosts) = rows.split_at_mut(self.rows);
        let rows = (ghosts, &self.sources[..], &self.which[..]);
        type Rows<'a, T> = (&'a mut [T], &'a [u32], &'a [u32]);
        for_each_block(rows, &mut Vec::new(), &|first, (ghosts, sources, which): Rows<'_, T>| {
            for (k, (ghost, (&source, &which))) in
                ghosts.iter_mut().zip(sources.iter().zip(which)).enumerate()
            {
                let (row, source) = (self.rows + first + k, source as usize);
                *ghost = make(Ghost { row, source, map: &self.maps[which as usize] }, &real[source]);
            }
        });
    }
}
