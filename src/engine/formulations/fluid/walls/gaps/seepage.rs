//! The pressure in gaps between their ends.
//!
//! What seeps through a gap of one width loses its head evenly on the way: the pressure less that at rest is
//! harmonic along the gap, and falls linearly from one end to the other. The sums over neighbours are those
//! by which pressures are continued, in equations of conjugate gradients.

use super::gap::Gap;
use crate::formulations::fluid::cloud::FlowCloud;

/// Error of the pressures over their root mean square at which they are good enough.
const TOLERANCE: f64 = 1e-4;
/// Largest number of improvements; a gap of a thousand supports needs as many.
const MOST: usize = 1000;

/// A neighbour in a gap.
#[derive(Clone, Copy, Debug)]
struct GapLink {
    /// Its number among the unknown ones; none of one whose pressure is known.
    unknown: Option<u32>,
    /// `V_i V_j W_ij`.
    weight: f64,
}

/// The equations `sum_j weight_ij (p_i - p_j) = right_i` of the unknown pressures.
#[derive(Debug, Default)]
pub struct Seepage {
    /// Where the neighbours of each end.
    ends: Vec<usize>,
    neighbors: Vec<GapLink>,
    diagonal: Vec<f64>,
    /// What is left of the right sides.
    residual: Vec<f64>,
    pressure: Vec<f64>,
    direction: Vec<f64>,
    product: Vec<f64>,
}

impl Seepage {
    /// Sets the pressures of the gaps in `unknown`, which have been continued from the nearest end, to those
    /// between all ends; `numbers` are those of the boundary particles among the gaps.
    pub fn run(&mut self, cloud: &FlowCloud, gaps: &mut [Gap], numbers: &[u32], unknown: &[u32]) {
        self.set_up(cloud, gaps, numbers, unknown);
        self.solve();
        for (&k, pressure) in unknown.iter().zip(&self.pressure) {
            if let Some(fluid) = &mut gaps[k as usize].fluid {
                fluid.pressure = pressure.max(0.0);
            }
        }
    }

    fn set_up(&mut self, cloud: &FlowCloud, gaps: &[Gap], numbers: &[u32], unknown: &[u32]) {
        let Self { ends, neighbors, diagonal, residual, pressure, .. } = self;
        ends.clear();
        neighbors.clear();
        diagonal.clear();
        residual.clear();
        pressure.clear();
        for &k in unknown {
            let gap = &gaps[k as usize];
            let [row, list] = gap.particle;
            let volume = cloud.records[row as usize].volume();
            let own = gap.fluid.unwrap_or_default();
            let (mut total, mut right) = (0.0, 0.0);
            for &j in cloud.pairs.gaps.list.row(list as usize) {
                let number = numbers[j as usize - cloud.fluid];
                let Some(there) = gaps.get(number as usize).and_then(|gap| gap.fluid) else { continue };
                let Some(pair) = cloud.gap_pair(row as usize, j).filter(|_| number != k) else { continue };
                let weight = volume * pair.value;
                let at_rest = 0.5 * (own.slope + there.slope).dot(pair.x);
                total += weight;
                right += weight * (there.pressure - own.pressure - at_rest);
                let unknown = unknown.binary_search(&number).ok().map(|number| number as u32);
                neighbors.push(GapLink { unknown, weight });
            }
            ends.push(neighbors.len());
            diagonal.push(total);
            residual.push(right);
            pressure.push(own.pressure);
        }
    }

    fn solve(&mut self) {
        let size = |values: &[f64], diagonal: &[f64]| -> f64 {
            values.iter().zip(diagonal).map(|(value, diagonal)| diagonal * value * value).sum()
        };
        let left = |residual: &[f64], diagonal: &[f64]| -> f64 {
            let of = |(r, d): (&f64, &f64)| if *d > 0.0 { r * r / d } else { 0.0 };
            residual.iter().zip(diagonal).map(of).sum()
        };
        let enough = TOLERANCE * TOLERANCE * size(&self.pressure, &self.diagonal);
        let mut before = f64::INFINITY;
        self.direction.clear();
        self.direction.resize(self.pressure.len(), 0.0);
        for _ in 0..MOST {
            let now = left(&self.residual, &self.diagonal);
            if now <= enough {
                break;
            }
            for k in 0..self.pressure.len() {
                let ahead = if self.diagonal[k] > 0.0 { self.residual[k] / self.diagonal[k] } else { 0.0 };
                self.direction[k] = ahead + now / before * self.direction[k];
            }
            self.multiply();
            let curvature: f64 = self.direction.iter().zip(&self.product).map(|(d, p)| d * p).sum();
            if curvature <= 0.0 {
                break;
            }
            for k in 0..self.pressure.len() {
                self.pressure[k] += now / curvature * self.direction[k];
                self.residual[k] -= now / curvature * self.product[k];
            }
            before = now;
        }
    }

    /// The left sides for the direction.
    fn multiply(&mut self) {
        self.product.clear();
        let mut start = 0;
        for (k, &end) in self.ends.iter().enumerate() {
            let along =
                |near: &GapLink| near.unknown.map_or(0.0, |j| near.weight * self.direction[j as usize]);
            let others: f64 = self.neighbors[start..end].iter().map(along).sum();
            self.product.push(self.diagonal[k] * self.direction[k] - others);
            start = end;
        }
    }
}
