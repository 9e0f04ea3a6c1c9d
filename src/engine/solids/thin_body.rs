//! Bodies so thin that none of their particles lies inside: stiffer than the estimate of the stable step.
//!
//! That estimate ([`stable_step`](super::stable_step)) has its constant from blocks of three and more
//! particles. Where all particles around one lie at the surface, as in sheets of two layers, in bars and
//! grains of two by two particles or at the steps of a thin inclined plate, the fastest mode is a breathing
//! across the body, along all thin axes at once: `omega^2` is 4 c_l^2 / dx^2 in a sheet, 8 in a nearly
//! incompressible square of four particles, 12 in a cube of eight, where the estimate has 2.6, 2.7 and 3.7.
//! For such bodies the largest eigenvalue of the linear operator of the stress,
//!
//! `H_i = sum_j V_j w_ij (u_j - u_i) (x) M_i^-1 x_ij`,
//! `rho u_i'' = sum_j V_j w_ij (S_i M_i^-1 + S_j M_j^-1) x_ij`, `S = lambda tr H I + mu (H + H^T)`,
//!
//! is found by power iteration once before the first step. Bodies that are thick everywhere are told by the
//! cells of a grid, which needs no search for neighbours.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::stable_step::StepEstimate;
use crate::correction::MomentMatrix;
use crate::kernels::Kernel;
use crate::linalg::{Sym3, dyad};
use crate::materials::ElasticConstants;
use crate::neighbors::{Cloud, NeighborList, Periodic};
use crate::plugin::BodyPlan;

/// `|M^-1 sum_j V_j w_ij x_ij|` times the spacing from which on a particle lies at a surface: there it is
/// 0.55 to 1, within irregular particles below 0.2.
const AT_SURFACE: f64 = 0.35;
/// Most steps of the power iteration, and the relative change of the eigenvalue at which it ends.
const STEPS: usize = 30;
const CHANGE: f64 = 1e-4;

/// Side of the cells by which thick bodies are told, over the spacing: no lattice of particles leaves one
/// empty.
const CELL: f64 = 1.5;
/// Share of the cells around one that are filled within a thick body: 8 of 9, 23 of 27. In sheets of two
/// layers, however inclined, it is at most 6 of 9 and 19 of 27.
const FILLED: f64 = 23.0 / 27.0;
/// Most cells per particle of the box around a body.
const MOST_CELLS: f64 = 16.0;

/// The body as its formulation sees it.
struct Operator<'a> {
    sites: Vec<(DVec3, f64)>,
    list: NeighborList,
    /// `V_j w_ij` of the pairs of the list.
    weights: Vec<f64>,
    periodic: &'a Periodic,
    /// M^-1, zero of a particle without stress.
    inverse: Vec<Sym3>,
    /// lambda and mu over the longitudinal modulus.
    moduli: [f64; 2],
}

/// Square of the frequency of the fastest mode over the estimate, of a body that is too thin for that; one of
/// all others. What lies beyond a symmetry plane is not seen.
pub(super) fn stiffness_of_thin(
    body: &BodyPlan,
    elastic: &ElasticConstants,
    dimension: usize,
    periodic: &Periodic,
) -> f64 {
    let (Some(kernel), Some(support)) = (body.kernel, body.support) else { return 1.0 };
    let Some(kernel) = Kernel::new(kernel, dimension) else { return 1.0 };
    let positions: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
    if is_thick(&positions, body.spacing, dimension) {
        return 1.0;
    }
    let Ok(list) = NeighborList::reference(Cloud::uniform(&positions, support), periodic) else { return 1.0 };
    let sites = body.sites.iter().map(|site| (site.position, site.volume)).collect();
    let mut operator = Operator::new(sites, list, periodic, elastic);
    operator.weigh(&kernel, support);
    let estimate = operator.correct(dimension, body.spacing);
    estimate.map_or(1.0, |estimate| (operator.largest(dimension) / estimate).max(1.0))
}

/// Whether the particles fill a body that is thick everywhere, told by the cells of a grid, without a search:
/// every cell is within two of one whose surroundings are filled. Rather false than true.
fn is_thick(positions: &[DVec3], spacing: f64, dimension: usize) -> bool {
    let cell = CELL * spacing;
    let lowest = positions.iter().fold(DVec3::INFINITY, |low, x| low.min(*x));
    let highest = positions.iter().fold(DVec3::NEG_INFINITY, |high, x| high.max(*x));
    // With a margin of two empty cells.
    let counts = ((highest - lowest) / cell).floor() + DVec3::splat(5.0);
    if !counts.is_finite() || counts.element_product() > MOST_CELLS * positions.len() as f64 {
        return false;
    }
    let [a, b, c] = counts.to_array().map(|count| count as usize);
    let strides = [1, a, a * b];
    let index =
        |ijk: [usize; 3]| ijk.iter().zip(strides).map(|(index, stride)| index * stride).sum::<usize>();
    let mut is_filled = vec![false; a * b * c];
    for x in positions {
        is_filled[index(((*x - lowest) / cell).to_array().map(|of| of as usize + 2))] = true;
    }
    // From a cell to those within `range` of it; wrapping, for some of them are before it.
    let shifts = |range: usize| -> Vec<usize> {
        let width = || 0..2 * range + 1;
        let (layers, layer) = if dimension == 2 { (0..1, 0) } else { (width(), range) };
        let own = index([range, range, layer]);
        let row = |j: usize, k: usize| width().map(move |i| index([i, j, k]).wrapping_sub(own));
        layers.flat_map(|k| width().flat_map(move |j| row(j, k))).collect()
    };
    let near = |of: &[bool], cell: usize, shift: usize| of[cell.wrapping_add(shift)];
    let filled = || (0..is_filled.len()).filter(|&cell| is_filled[cell]);
    let beside = shifts(1);
    let mut is_inside = vec![false; is_filled.len()];
    for cell in filled() {
        let count = beside.iter().filter(|&&shift| near(&is_filled, cell, shift)).count();
        is_inside[cell] = count as f64 >= FILLED * beside.len() as f64;
    }
    let around = shifts(2);
    filled().all(|cell| around.iter().any(|&shift| near(&is_inside, cell, shift)))
}

impl<'a> Operator<'a> {
    fn new(
        sites: Vec<(DVec3, f64)>,
        list: NeighborList,
        periodic: &'a Periodic,
        elastic: &ElasticConstants,
    ) -> Self {
        let moduli = [elastic.lambda, elastic.shear].map(|modulus| modulus / elastic.longitudinal_modulus());
        Self { sites, weights: vec![0.0; list.pairs()], list, periodic, inverse: Vec::new(), moduli }
    }

    /// Finds the weights of pairs for a support, m.
    fn weigh(&mut self, kernel: &Kernel, support: f64) {
        let length = kernel.smoothing_length(support);
        let weight = &|i: usize, j: u32| {
            let volume = self.sites[j as usize].1;
            volume * kernel.pair_weight(self.offset(i, j).length(), length).abs()
        };
        let weigh = |i: usize| self.list.row(i).iter().map(move |&j| weight(i, j));
        self.weights = (0..self.sites.len()).into_par_iter().flat_map_iter(weigh).collect();
    }

    fn offset(&self, i: usize, j: u32) -> DVec3 {
        let x = self.sites[j as usize].0 - self.sites[i].0;
        if self.periodic.any() { self.periodic.minimal_image(x) } else { x }
    }

    /// Neighbours of a particle, by their numbers, the vectors to them and `V_j w_ij`.
    fn around(&self, i: usize) -> impl Iterator<Item = (usize, DVec3, f64)> {
        let pairs = self.list.row(i).iter().zip(&self.weights[self.list.range(i)]);
        pairs.map(move |(&j, &weight)| (j as usize, self.offset(i, j), weight))
    }

    /// Finds the matrices M^-1; gives the largest estimate over c_l^2, 1/m2, if the body is thin somewhere.
    fn correct(&mut self, dimension: usize, spacing: f64) -> Option<f64> {
        let of_waves = StepEstimate { wave: 1.0, bond: 0.0, hessian: 0.0 };
        let found: Vec<(Sym3, f64, bool)> = (0..self.sites.len())
            .into_par_iter()
            .map(|i| {
                let (mut moment, mut first, mut sum) = (MomentMatrix::new(dimension), DVec3::ZERO, 0.0);
                for (_, x, weight) in self.around(i) {
                    moment.add(weight, x);
                    first += weight * x;
                    sum += weight;
                }
                let Some(inverse) = moment.inverse() else { return (Sym3::ZERO, 0.0, true) };
                let is_outside = (inverse * first).length() * spacing > AT_SURFACE;
                (inverse, of_waves.of_stress(sum, inverse.trace() / dimension as f64), is_outside)
            })
            .collect();
        let is_outside = |j: &u32| found[*j as usize].2;
        let is_thin = |i: usize| found[i].2 && found[i].1 > 0.0 && self.list.row(i).iter().all(is_outside);
        if !(0..found.len()).any(is_thin) {
            return None;
        }
        self.inverse = found.iter().map(|(inverse, ..)| *inverse).collect();
        Some(found.iter().map(|(_, estimate, _)| *estimate).fold(0.0, f64::max))
    }

    /// The largest eigenvalue over c_l^2, 1/m2.
    fn largest(&self, dimension: usize) -> f64 {
        let size = |u: &[DVec3]| {
            let squares = u.iter().zip(&self.sites).map(|(u, (_, volume))| volume * u.length_squared());
            squares.sum::<f64>().sqrt()
        };
        let mut u: Vec<DVec3> = (0..self.sites.len()).map(|i| scattered(i, dimension)).collect();
        let mut largest = 0.0;
        for _ in 0..STEPS {
            let scale = size(&u).recip();
            u.iter_mut().for_each(|u| *u *= scale);
            u = self.acceleration(&u);
            let now = size(&u);
            let change = (now - largest).abs();
            largest = now;
            if change <= CHANGE * now {
                break;
            }
        }
        largest
    }

    /// `-u''` over c_l^2, 1/m.
    fn acceleration(&self, u: &[DVec3]) -> Vec<DVec3> {
        let [lambda, shear] = self.moduli;
        let stress = |i: usize| {
            let gradient: DMat3 = self.around(i).map(|(j, x, weight)| weight * dyad(u[j] - u[i], x)).sum();
            let gradient = gradient * self.inverse[i].to_matrix();
            let trace = gradient.x_axis.x + gradient.y_axis.y + gradient.z_axis.z;
            let stress = DMat3::from_diagonal(DVec3::splat(lambda * trace));
            (stress + (gradient + gradient.transpose()) * shear) * self.inverse[i].to_matrix()
        };
        let stress: Vec<DMat3> = (0..u.len()).into_par_iter().map(stress).collect();
        let force = |i: usize| -> DVec3 {
            self.around(i).map(|(j, x, weight)| -weight * ((stress[i] + stress[j]) * x)).sum()
        };
        (0..u.len()).into_par_iter().map(force).collect()
    }
}

/// A vector of a particle, like those of no mode.
fn scattered(i: usize, dimension: usize) -> DVec3 {
    let part = |k: usize| ((i * 3 + k) as f64 * 0.618_033_988_749_895 + 0.1).fract() - 0.5;
    DVec3::new(part(0), part(1), if dimension == 2 { 0.0 } else { part(2) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::KernelName;

    /// The largest eigenvalue of a block over c_l^2 / dx^2, and the estimate; none of a thick one.
    fn block(counts: [usize; 3], poisson: f64) -> Option<[f64; 2]> {
        let dimension = if counts[2] == 1 { 2 } else { 3 };
        let [a, b, c] = counts;
        let cells =
            (0..a * b * c).map(|k| DVec3::new((k % a) as f64, (k / a % b) as f64, (k / a / b) as f64));
        let positions: Vec<DVec3> = cells.collect();
        let list =
            NeighborList::reference(Cloud::uniform(&positions, 2.41), &Periodic::NONE).expect("a list");
        let kernel = Kernel::new(KernelName::Spiky, dimension).expect("a kernel");
        let elastic = ElasticConstants::from_young_poisson(1e6, poisson);
        let sites = positions.iter().map(|x| (*x, 1.0)).collect();
        let mut operator = Operator::new(sites, list, &Periodic::NONE, &elastic);
        operator.weigh(&kernel, 2.41);
        let estimate = operator.correct(dimension, 1.0)?;
        Some([operator.largest(dimension), estimate])
    }

    #[test]
    fn the_fastest_mode_of_thin_bodies_is_their_breathing_along_all_thin_axes() {
        // Strain 2 u / dx along each thin axis, u to both sides: energy V/2 (d lambda + 2 mu) d 4 u^2 / dx^2,
        // mass V d u^2.
        for poisson in [0.0, 0.3, 0.45] {
            for (counts, axes) in [([2, 2, 1], 2.0), ([2, 2, 2], 3.0)] {
                let breathing = 4.0 * (1.0 + (axes - 1.0) * poisson / (1.0 - poisson));
                let [largest, _] = block(counts, poisson).expect("thin");
                assert!((largest / breathing - 1.0).abs() < 5e-3, "{counts:?} {poisson}: {largest}");
            }
        }
        // A sheet: the same along one axis, with a little more where it alternates along the sheet.
        let [largest, estimate] = block([40, 2, 1], 0.3).expect("thin");
        assert!((4.0..4.4).contains(&largest) && largest > 1.5 * estimate, "{largest} {estimate}");
    }

    #[test]
    fn thick_bodies_are_told_by_cells() {
        let block = |counts: [usize; 3], turn: f64| {
            let [a, b, c] = counts;
            let turn = DMat3::from_rotation_z(turn);
            let cells =
                (0..a * b * c).map(|k| DVec3::new((k % a) as f64, (k / a % b) as f64, (k / a / b) as f64));
            cells.map(|x| turn * x).collect::<Vec<DVec3>>()
        };
        for turn in [0.0, 0.3, 0.785] {
            assert!(is_thick(&block([20, 12, 1], turn), 1.0, 2), "{turn}");
            assert!(is_thick(&block([20, 12, 6], turn), 1.0, 3), "{turn}");
            assert!(!is_thick(&block([40, 2, 1], turn), 1.0, 2), "{turn}");
            assert!(!is_thick(&block([20, 12, 2], turn), 1.0, 3), "{turn}");
        }
        // A thick block with a fin of two layers.
        let fin = (0..40).map(|k| DVec3::new((20 + k / 2) as f64, (k % 2) as f64, 0.0));
        let finned: Vec<DVec3> = block([20, 12, 1], 0.0).into_iter().chain(fin).collect();
        assert!(!is_thick(&finned, 1.0, 2));
    }

    #[test]
    fn bodies_with_particles_inside_keep_the_estimate() {
        assert!(block([3, 3, 1], 0.45).is_none() && block([8, 3, 1], 0.3).is_none());
        assert!(block([3, 4, 3], 0.3).is_none());
    }
}
