//! Listed rows of a column, distributed over threads.

use super::Split;

/// Mutable access to the rows of a column in an ascending list of row numbers. A split divides the column
/// between two listed rows, so that each thread writes to its own part and no serial scatter is needed.
pub struct Picked<'a, T> {
    numbers: &'a [u32],
    column: &'a mut [T],
    /// Number of the first row in `column`.
    first: usize,
}

impl<'a, T> Picked<'a, T> {
    /// The rows of `column` with the given numbers, which ascend.
    pub fn new(numbers: &'a [u32], column: &'a mut [T]) -> Self {
        Self { numbers, column, first: 0 }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// Numbers of the rows.
    #[must_use]
    pub fn numbers(&self) -> &'a [u32] {
        self.numbers
    }

    /// Number of the `k`-th row.
    #[inline]
    pub fn number(&self, k: usize) -> usize {
        self.numbers[k] as usize
    }

    /// The `k`-th row.
    #[inline]
    pub fn row(&mut self, k: usize) -> &mut T {
        &mut self.column[self.numbers[k] as usize - self.first]
    }
}

impl<T: Send> Split for Picked<'_, T> {
    fn rows(&self) -> usize {
        self.numbers.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let Self { numbers, column, first } = self;
        let cut = numbers.get(at).map_or(first + column.len(), |&number| number as usize);
        let (left, right) = column.split_at_mut(cut - first);
        let (numbers, rest) = numbers.split_at(at);
        (Self { numbers, column: left, first }, Self { numbers: rest, column: right, first: cut })
    }
}

#[cfg(test)]
mod tests {
    use super::super::for_each_block;
    use super::*;

    #[test]
    fn every_row_that_is_named_is_met_once_and_no_other() {
        let is_named = |k: &u32| k % 3 == 1 || k.is_multiple_of(7);
        let numbers: Vec<u32> = (0..5_000).filter(is_named).collect();
        let mut column = vec![0_u32; 5_000];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a pool");
        pool.install(|| {
            let rows = Picked::new(&numbers, &mut column);
            for_each_block(rows, &mut Vec::new(), &|_, mut rows: Picked<'_, u32>| {
                for k in 0..rows.rows() {
                    let number = rows.number(k) as u32;
                    *rows.row(k) += number + 1;
                }
            });
        });
        let expected = |k: u32| if is_named(&k) { k + 1 } else { 0 };
        assert!(column.iter().zip(0..).all(|(&value, k)| value == expected(k)));
    }
}
