//! Hydrostatic pressure of particles above which there is no free surface, from those beside them.

use glam::DVec3;
use rayon::prelude::*;

use super::endless::BESIDE;
use crate::neighbors::{Cloud, NeighborError, NeighborList, Periodic};

/// The particles of all fluids.
pub struct AllFluids {
    pub positions: Vec<DVec3>,
    pub densities: Vec<f64>,
    pub gravity: DVec3,
    pub spacing: f64,
    pub periodic: Periodic,
}

impl AllFluids {
    /// Gives particles without pressure that of those beside them, from one to the next. Where a piece of the
    /// fluids has none at all, its highest particle i has `below_top(i)`; these pieces are returned.
    ///
    /// # Errors
    /// Particles that cannot be sorted into cells.
    pub fn spread(
        &self,
        pressure: &mut [Option<f64>],
        support: f64,
        below_top: impl Fn(usize) -> f64,
    ) -> Result<Vec<Vec<usize>>, NeighborError> {
        let list = NeighborList::reference(Cloud::uniform(&self.positions, support), &self.periodic)?;
        self.spread_known(pressure, &list);
        let mut pieces = Vec::new();
        while let Some(first) = pressure.iter().position(Option::is_none) {
            let rest: Vec<usize> = (first..pressure.len()).filter(|&i| pressure[i].is_none()).collect();
            pressure[first] = Some(0.0);
            self.spread_known(pressure, &list);
            let piece = || rest.iter().filter_map(|&i| Some((i, pressure[i]?)));
            let Some((highest, least)) = piece().min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            let raise = below_top(highest) - least;
            let piece: Vec<usize> = piece().map(|(i, _)| i).collect();
            piece.iter().for_each(|&i| pressure[i] = pressure[i].map(|p| p + raise));
            pieces.push(piece);
        }
        Ok(pieces)
    }

    fn spread_known(&self, pressure: &mut [Option<f64>], list: &NeighborList) {
        let unknown = |pressure: &[Option<f64>]| -> Vec<usize> {
            (0..pressure.len()).filter(|&i| pressure[i].is_none()).collect()
        };
        let find = |among: &[usize], pressure: &[Option<f64>], far| -> Vec<(usize, f64)> {
            let beside = |&i: &usize| Some((i, self.beside(i, pressure, list.row(i), far)?));
            among.par_iter().filter_map(beside).collect()
        };
        let (mut near, mut is_near) = (unknown(pressure), vec![false; pressure.len()]);
        loop {
            let mut next = find(&near, pressure, false);
            if next.is_empty() {
                next = find(&unknown(pressure), pressure, true);
            }
            if next.is_empty() {
                break;
            }
            next.iter().for_each(|&(i, p)| pressure[i] = Some(p));
            // For all others nothing has changed.
            let beside = next.iter().flat_map(|&(i, _)| list.row(i)).map(|&j| j as usize);
            near.clear();
            near.extend(
                beside.filter(|&j| pressure[j].is_none() && !std::mem::replace(&mut is_near[j], true)),
            );
            near.iter().for_each(|&j| is_near[j] = false);
        }
    }

    /// Mean of the pressures that continue those known around i: in the same liquid, else across an interface
    /// from adjacent particles, else, with `far`, from any.
    fn beside(&self, i: usize, pressure: &[Option<f64>], row: &[u32], far: bool) -> Option<f64> {
        let x_ji = |j: usize| self.periodic.minimal_image(self.positions[i] - self.positions[j]);
        let mean = |counts: &dyn Fn(usize) -> bool| {
            let known = row.iter().map(|&j| j as usize).filter(|&j| counts(j));
            let continued = known.filter_map(|j| {
                let density = 0.5 * (self.densities[i] + self.densities[j]);
                Some(pressure[j]? + density * self.gravity.dot(x_ji(j)))
            });
            let (sum, count) = continued.fold((0.0, 0), |(sum, count), p| (sum + p, count + 1));
            (count > 0).then(|| sum / f64::from(count))
        };
        mean(&|j| self.densities[j] == self.densities[i])
            .or_else(|| mean(&|j| x_ji(j).length() < BESIDE * self.spacing))
            .or_else(|| if far { mean(&|_| true) } else { None })
    }
}
