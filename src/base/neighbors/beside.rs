//! Cells of a grid and their adjacent cells.

use rayon::prelude::*;

/// Cells per task.
const CELLS_OF_TASK: usize = 256;

/// The cells of a grid: their number along each axis, and the periodic axes.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellBlock {
    /// Number of cells along each axis; the first index is the fastest.
    pub counts: [usize; 3],
    /// Periodic axes.
    pub wraps: [bool; 3],
}

impl CellBlock {
    /// Joins the value of every cell with those of its adjacent cells, those across edges and corners
    /// included. `window` is a buffer that the caller keeps.
    pub fn join_beside<T: Copy + Send + Sync>(
        &self,
        values: &mut Vec<T>,
        window: &mut Vec<T>,
        join: &(impl Fn(T, T) -> T + Sync),
    ) {
        for axis in 0..3 {
            let stride: usize = self.counts[..axis].iter().product();
            let (count, wraps) = (self.counts[axis], self.wraps[axis]);
            if count == 1 {
                continue;
            }
            std::mem::swap(values, window);
            values.clear();
            values.extend_from_slice(window);
            let cells = values.par_iter_mut().with_min_len(CELLS_OF_TASK).enumerate();
            cells.for_each(|(cell, value)| {
                let k = cell / stride % count;
                let first = cell - k * stride;
                let before = if k > 0 { Some(k - 1) } else { wraps.then_some(count - 1) };
                let after = if k + 1 < count { Some(k + 1) } else { wraps.then_some(0) };
                for beside in [before, after].into_iter().flatten() {
                    *value = join(*value, window[first + beside * stride]);
                }
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_of_a_cell_and_all_beside_it() {
        for wraps in [[false; 3], [true, false, true]] {
            let block = CellBlock { counts: [4, 3, 5], wraps };
            let number = |x: usize, y: usize, z: usize| x + 4 * (y + 3 * z);
            let values: Vec<u32> = (0..60).map(|k| (k * 37 + 11) % 61).collect();
            let (mut joined, mut window) = (values.clone(), Vec::new());
            block.join_beside(&mut joined, &mut window, &u32::max);
            let along = |k: usize, axis: usize| {
                let count = block.counts[axis];
                (0..count).filter(move |&l| k.abs_diff(l) <= 1 || (wraps[axis] && k.abs_diff(l) == count - 1))
            };
            for (x, y, z) in (0..60).map(|k| (k % 4, k / 4 % 3, k / 12)) {
                let near = along(x, 0).flat_map(|i| along(y, 1).map(move |j| (i, j)));
                let near = near.flat_map(|(i, j)| along(z, 2).map(move |k| (i, j, k)));
                let expected = near.map(|(i, j, k)| values[number(i, j, k)]).max();
                assert_eq!(Some(joined[number(x, y, z)]), expected, "{x} {y} {z} {wraps:?}");
            }
        }
    }
}
