//! Damped least squares by conjugate gradients.

/// Rows of a sparse matrix.
#[derive(Debug, Default)]
pub(super) struct SparseRows {
    /// Where each row ends.
    ends: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

/// Norm of the gradient over that of the start at which the solution is good enough.
const GOOD: f64 = 1e-7;
/// Most iterations: bodies with sides of any size take less than 200.
const MOST: usize = 1000;

impl SparseRows {
    /// Adds to the row that is being made.
    pub fn add(&mut self, column: u32, value: f64) {
        self.entries.push((column, value));
    }

    /// Ends the row that is being made.
    pub fn end(&mut self) {
        self.ends.push(self.entries.len());
    }

    fn rows(&self) -> impl Iterator<Item = &[(u32, f64)]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, end)| &self.entries[start..*end])
    }

    /// A x.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        self.rows().map(|row| row.iter().map(|(column, value)| value * x[*column as usize]).sum()).collect()
    }

    /// A^T y.
    fn transposed_times(&self, y: &[f64], columns: usize) -> Vec<f64> {
        let mut product = vec![0.0; columns];
        for (row, y) in self.rows().zip(y) {
            row.iter().for_each(|(column, value)| product[*column as usize] += value * y);
        }
        product
    }
}

fn square(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// The x that makes |A x - b|^2 + sum_k damping_k^2 x_k^2 smallest.
pub(super) fn solve(a: &SparseRows, b: &[f64], damping: &[f64]) -> Vec<f64> {
    let columns = damping.len();
    let mut x = vec![0.0; columns];
    let mut residual = b.to_vec();
    let mut gradient = a.transposed_times(&residual, columns);
    let mut direction = gradient.clone();
    let mut size = square(&gradient);
    let enough = GOOD * GOOD * size;
    for _ in 0..MOST {
        if size <= enough {
            break;
        }
        let image = a.times(&direction);
        let damped: f64 = direction.iter().zip(damping).map(|(p, d)| (d * p) * (d * p)).sum();
        let step = size / (square(&image) + damped);
        x.iter_mut().zip(&direction).for_each(|(x, p)| *x += step * p);
        residual.iter_mut().zip(&image).for_each(|(r, q)| *r -= step * q);
        gradient = a.transposed_times(&residual, columns);
        gradient.iter_mut().zip(x.iter().zip(damping)).for_each(|(s, (x, d))| *s -= d * d * x);
        let next = square(&gradient);
        direction.iter_mut().zip(&gradient).for_each(|(p, s)| *p = s + next / size * *p);
        size = next;
    }
    x
}
