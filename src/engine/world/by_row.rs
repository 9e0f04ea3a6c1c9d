//! Sums of values given for some rows of a body.

use std::ops::Range;

use crate::parallel::{BlockSum, Split, sum_over_blocks};

/// The sum of `count` entries, each of which belongs to a row of a body with so many `rows`; the rows of the
/// entries ascend. The entries of a row are added first, then the rows of a block, then blocks along the tree
/// of all rows of the body. The result does not depend on the number of threads, nor on how many entries
/// other rows have.
pub fn sum_by_row<R: BlockSum>(
    rows: usize,
    count: usize,
    row: &(impl Fn(usize) -> usize + Sync),
    entry: &(impl Fn(usize) -> R + Sync),
) -> R {
    if count == 0 {
        return R::default();
    }
    let entries = RowEntries { rows: 0..rows, numbers: 0..count, row };
    sum_over_blocks(entries, &|_, RowEntries { numbers, .. }: RowEntries<'_, _>| {
        let (mut sum, mut number) = (R::default(), numbers.start);
        while number < numbers.end {
            let (own, mut of_row) = (row(number), entry(number));
            number += 1;
            while number < numbers.end && row(number) == own {
                of_row.add(&entry(number));
                number += 1;
            }
            sum.add(&of_row);
        }
        sum
    })
}

/// Rows of a body and the numbers of their entries.
struct RowEntries<'a, F> {
    rows: Range<usize>,
    numbers: Range<usize>,
    row: &'a F,
}

impl<F: Fn(usize) -> usize + Sync> Split for RowEntries<'_, F> {
    fn rows(&self) -> usize {
        self.rows.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let Self { rows, numbers, row } = self;
        let cut = rows.start + at;
        let (mut low, mut high) = (numbers.start, numbers.end);
        while low < high {
            let middle = low.midpoint(high);
            if row(middle) < cut { low = middle + 1 } else { high = middle }
        }
        (
            Self { rows: rows.start..cut, numbers: numbers.start..low, row },
            Self { rows: cut..rows.end, numbers: low..numbers.end, row },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows far apart and beside each other, with one to four entries.
    fn rows_of_entries() -> Vec<usize> {
        (0..5_000_usize)
            .filter(|row| row % 3 == 1 || row / 100 == 17)
            .flat_map(|row| std::iter::repeat_n(row, 1 + row % 4))
            .collect()
    }

    #[test]
    fn the_sum_is_that_of_all_rows_on_any_number_of_threads() {
        let of = rows_of_entries();
        let entry = |k: usize| (k as f64 * 0.7).sin() * 1e3;
        // Row by row, those without entries included, in blocks along the tree.
        let mut by_row = vec![0.0; 5_000];
        of.iter().enumerate().for_each(|(k, &row)| by_row[row] += entry(k));
        let expected = sum_over_blocks(&by_row[..], &|_, rows: &[f64]| rows.iter().sum::<f64>());
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let sum = pool.install(|| sum_by_row(5_000, of.len(), &|k| of[k], &entry));
            assert_eq!(sum.to_bits(), expected.to_bits());
        }
    }

    #[test]
    fn no_entry_is_lost_where_rows_are_few_or_none_tells_anything() {
        assert_eq!(sum_by_row(100, 0, &|_| 0, &|_| 1.0), 0.0);
        assert_eq!(sum_by_row(1, 3, &|_| 0, &|_| 1.0), 3.0);
        assert_eq!(sum_by_row(200, 2, &|k| 199 * k, &|_| 1.0), 2.0);
    }
}
