//! Damped least squares within bounds, by conjugate gradients.

/// Rows of a sparse matrix.
#[derive(Debug, Default)]
pub(super) struct SparseRows {
    /// Where each row ends.
    ends: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

/// Norm of the gradient over that of the start at which the solution is good enough.
const GOOD: f64 = 1e-7;
/// Maximum number of iterations: cubic lattices take less than 200, those with many shares on their bounds
/// some hundred.
const MAX_ITERATIONS: usize = 1000;
/// Distance from a bound that is none, over the distance of the bounds.
const ON_BOUND: f64 = 1e-12;

impl SparseRows {
    /// Adds to the row that is being assembled.
    pub fn add(&mut self, column: u32, value: f64) {
        self.entries.push((column, value));
    }

    /// Ends the row that is being assembled: what has been added to one column of it is one entry.
    pub fn end(&mut self) {
        let start = self.ends.last().copied().unwrap_or(0);
        let mut row = self.entries.split_off(start);
        row.sort_by_key(|entry| entry.0);
        for (column, value) in row {
            match self.entries[start..].last_mut() {
                Some(last) if last.0 == column => last.1 += value,
                _ => self.entries.push((column, value)),
            }
        }
        self.ends.push(self.entries.len());
    }

    fn rows(&self) -> impl Iterator<Item = &[(u32, f64)]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, end)| &self.entries[start..*end])
    }

    /// A x.
    pub fn mul(&self, x: &[f64]) -> Vec<f64> {
        self.rows().map(|row| row.iter().map(|(column, value)| value * x[*column as usize]).sum()).collect()
    }

    /// A^T y.
    fn transposed_mul(&self, y: &[f64], columns: usize) -> Vec<f64> {
        let mut product = vec![0.0; columns];
        for (row, y) in self.rows().zip(y) {
            row.iter().for_each(|(column, value)| product[*column as usize] += value * y);
        }
        product
    }
}

fn square(x: &[f64]) -> f64 {
    dot(x, x)
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// The sum |A x - b|^2 + sum_k damping_k^2 x_k^2, with the minimum and the maximum value of each unknown.
pub(super) struct LeastSquares<'a> {
    pub a: &'a SparseRows,
    pub b: &'a [f64],
    pub damping: &'a [f64],
    pub bounds: &'a [(f64, f64)],
}

impl LeastSquares<'_> {
    /// The x within the bounds that makes the sum smallest, by conjugate gradients with proportioning and
    /// gradient projections (MPRGP: Dostál & Schöberl, Comput. Optim. Appl. 30 (2005) 23-43).
    pub fn solve(&self) -> Vec<f64> {
        let mut x: Vec<f64> = self.bounds.iter().map(|(least, most)| 0f64.clamp(*least, *most)).collect();
        let goal = self.a.transposed_mul(self.b, x.len());
        let slope = |x: &[f64]| -> Vec<f64> {
            self.product(x).iter().zip(&goal).map(|(product, goal)| product - goal).collect()
        };
        let enough = GOOD * GOOD * square(&goal);
        let short = 1.0 / self.stiffness();
        let mut gradient = slope(&x);
        let mut parts = self.split(&x, &gradient);
        let mut direction = parts.free.clone();
        for _ in 0..MAX_ITERATIONS {
            if square(&parts.free) + square(&parts.inward) <= enough {
                break;
            }
            let releases = square(&parts.inward) > square(&parts.free);
            if releases {
                direction.clone_from(&parts.inward);
            }
            let image = self.product(&direction);
            let curvature = dot(&direction, &image);
            let (step, max_step) = (dot(&gradient, &direction) / curvature, self.max_step(&x, &direction));
            let taken = step.min(max_step);
            x.iter_mut().zip(&direction).for_each(|(x, p)| *x -= taken * p);
            gradient.iter_mut().zip(&image).for_each(|(g, q)| *g -= taken * q);
            self.put_on_bounds(&mut x);
            parts = self.split(&x, &gradient);
            if step > max_step && !releases {
                // Along the slope, others come to their bounds at once.
                x.iter_mut().zip(&parts.free).for_each(|(x, free)| *x -= short * free);
                self.put_on_bounds(&mut x);
                gradient = slope(&x);
                parts = self.split(&x, &gradient);
            }
            if step > max_step || releases {
                direction.clone_from(&parts.free);
            } else {
                let before = dot(&parts.free, &image) / curvature;
                direction.iter_mut().zip(&parts.free).for_each(|(p, free)| *p = free - before * *p);
            }
        }
        x
    }

    /// (A^T A + damping^2) x.
    fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut product = self.a.transposed_mul(&self.a.mul(x), x.len());
        for (own, (damping, x)) in product.iter_mut().zip(self.damping.iter().zip(x)) {
            *own += damping * damping * x;
        }
        product
    }

    /// A bound of the largest eigenvalue of A^T A + damping^2.
    fn stiffness(&self) -> f64 {
        let row = |row: &[(u32, f64)]| row.iter().map(|(_, value)| value.abs()).sum::<f64>();
        let mut columns = vec![0.0; self.damping.len()];
        for (column, value) in self.a.rows().flatten() {
            columns[*column as usize] += value.abs();
        }
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let rows = largest(&mut self.a.rows().map(row));
        rows * largest(&mut columns.into_iter()) + largest(&mut self.damping.iter().map(|d| d * d))
    }

    /// The slopes of the sum, of those unknowns that are free and of those on a bound that would go inside
    /// down the slope.
    fn split(&self, x: &[f64], gradient: &[f64]) -> Slopes {
        let mut slopes = Slopes { free: vec![0.0; x.len()], inward: vec![0.0; x.len()] };
        for (k, ((x, g), (least, most))) in x.iter().zip(gradient).zip(self.bounds).enumerate() {
            if x <= least {
                slopes.inward[k] = g.min(0.0);
            } else if x >= most {
                slopes.inward[k] = g.max(0.0);
            } else {
                slopes.free[k] = *g;
            }
        }
        slopes
    }

    /// The maximum step against a direction that stays within the bounds.
    fn max_step(&self, x: &[f64], direction: &[f64]) -> f64 {
        let of = |((x, p), (least, most)): ((&f64, &f64), &(f64, f64))| {
            if *p > 0.0 {
                (x - least) / p
            } else if *p < 0.0 {
                (x - most) / p
            } else {
                f64::INFINITY
            }
        };
        x.iter().zip(direction).zip(self.bounds).map(of).fold(f64::INFINITY, f64::min)
    }

    /// Puts unknowns on the bounds that they have reached.
    fn put_on_bounds(&self, x: &mut [f64]) {
        for (x, (least, most)) in x.iter_mut().zip(self.bounds) {
            let near = ON_BOUND * (most - least);
            if *x < least + near {
                *x = *least;
            } else if *x > most - near {
                *x = *most;
            }
        }
    }
}

/// Slopes of the sum.
struct Slopes {
    free: Vec<f64>,
    inward: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::{LeastSquares, SparseRows};

    /// Rows (1, 2), (3, -1), (0, 1), the first column of the second one in two parts.
    fn matrix() -> SparseRows {
        let mut a = SparseRows::default();
        for row in [&[(0, 1.0), (1, 2.0)][..], &[(0, 1.0), (1, -1.0), (0, 2.0)], &[(1, 1.0)]] {
            row.iter().for_each(|(column, value)| a.add(*column, *value));
            a.end();
        }
        a
    }

    /// Right-hand side (1, 2, 3), damping 0.5 and 1.
    fn solve(bounds: [(f64, f64); 2]) -> Vec<f64> {
        LeastSquares { a: &matrix(), b: &[1.0, 2.0, 3.0], damping: &[0.5, 1.0], bounds: &bounds }.solve()
    }

    #[test]
    fn the_damped_solution_is_that_of_the_normal_equations() {
        // (A^T A + diag(0.25, 1)) x = A^T b.
        let x = solve([(-10.0, 10.0); 2]);
        // A^T A = (10, -1; -1, 6), A^T b = (7, 3).
        let determinant = 10.25 * 7.0 - 1.0;
        let exact = [(7.0 * 7.0 + 3.0) / determinant, (10.25 * 3.0 + 7.0) / determinant];
        assert!((x[0] - exact[0]).abs() < 1e-6 && (x[1] - exact[1]).abs() < 1e-6, "{x:?} {exact:?}");
    }

    #[test]
    fn what_would_be_beyond_its_bound_is_on_it_and_the_rest_is_best_with_it() {
        // Without bounds x_1 is 0.533: with x_1 = 0.2 the first row of the normal equations is 10.25 x_0 -
        // 0.2 = 7.
        let x = solve([(-10.0, 10.0), (-0.2, 0.2)]);
        assert!(x[1] == 0.2 && (x[0] - 7.2 / 10.25).abs() < 1e-6, "{x:?}");
    }

    /// Where the unknown on a bound is not the one that is beyond without bounds.
    #[test]
    fn the_solution_within_bounds_is_the_best_of_all_points_there() {
        for bounds in [
            [(-1.0, 0.3), (-0.2, 0.6)],
            [(0.8, 1.0), (-1.0, 0.1)],
            [(-2.0, 0.0), (0.0, 2.0)],
            [(0.0, 0.7), (0.5, 0.52)],
        ] {
            let x = solve(bounds);
            let sum = |x: f64, y: f64| {
                let rows = [x + 2.0 * y - 1.0, 3.0 * x - y - 2.0, y - 3.0, 0.5 * x, y];
                rows.iter().map(|row| row * row).sum::<f64>()
            };
            let at =
                |k: usize, part: i32| bounds[k].0 + (bounds[k].1 - bounds[k].0) * f64::from(part) / 200.0;
            let least =
                (0..=200).flat_map(|i| (0..=200).map(move |j| (i, j))).map(|(i, j)| sum(at(0, i), at(1, j)));
            let least = least.fold(f64::INFINITY, f64::min);
            let found = sum(x[0], x[1]);
            let is_within = (0..2).all(|k| (bounds[k].0..=bounds[k].1).contains(&x[k]));
            assert!(
                is_within && found <= least + 1e-9 && found > least - 1e-2,
                "{bounds:?}: {x:?} {found} {least}"
            );
        }
    }
}
