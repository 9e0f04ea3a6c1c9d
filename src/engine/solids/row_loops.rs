//! Short loops over rows, on all threads.

use crate::parallel::{for_each_block, sum_over_blocks};

/// Sets the values of the rows from `first` on to what `value` gives for each.
pub fn fill_rows<T: Send>(values: &mut [T], first: usize, value: impl Fn(usize) -> T + Sync) {
    for_each_block(values, &mut Vec::new(), &|start, values: &mut [T]| {
        values.iter_mut().zip(first + start..).for_each(|(own, row)| *own = value(row));
    });
}

/// Number of rows that count.
pub fn count_rows<T: Sync>(rows: &[T], counts: impl Fn(&T) -> bool + Sync) -> usize {
    let count = sum_over_blocks(rows, &|_, rows: &[T]| rows.iter().filter(|row| counts(row)).count() as f64);
    count as usize
}
