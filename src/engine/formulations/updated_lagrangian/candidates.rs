//! Candidates for neighbours in the reference of a body: a list that is valid for many updates.
//!
//! Two particles are neighbours where both measure a distance below the mean of their support radii. With
//! half axes l and support radii s, they are then closer than the mean of `s l`, more exactly of [`radii`].
//! The list holds pairs closer than that plus a skin, and is valid as long as the relative displacement of
//! nearby particles is less than the skin. The neighbours selected from it do not depend on its age: rows are
//! ascending, and the distance is the only criterion.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::bonded::Ellipsoid;
use crate::neighbors::{
    Cloud, NeighborError, NeighborList, NeighborSearch, Periodic, RelativeBounds, RelativeDisplacements,
    SupportRadii,
};
use crate::symmetry::Ghosts;

/// Skin over the largest radius.
const SKIN: f64 = 0.1;
/// Length of a cell over the largest radius, in which motions are compared.
const CELL: f64 = 2.0;
/// Tolerance of the half axes of ellipsoids, over their length.
const ROUNDING: f64 = 1e-6;

/// The particles of a body and their supports.
#[derive(Clone, Copy)]
pub(super) struct Searched<'a> {
    /// Places of the phase, m.
    pub places: &'a [DVec3],
    /// Radii of the phase, m; see [`radii`].
    pub radii: &'a [f64],
    pub ghosts: &'a Ghosts,
    /// Particles that no other one sees, by their numbers in the body, ascending.
    pub hidden: &'a [u32],
}

/// Candidates for neighbours of the particles of a body.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    /// A row for every particle of the body, with rows of the phase.
    list: NeighborList,
    skin: f64,
    parting: RelativeDisplacements,
    /// The radii that it was built with, m; empty where it holds for one time.
    radii: Vec<f64>,
    /// Whether a list was built before: that of the start lasts no longer than the start.
    is_late: bool,
}

impl Candidates {
    /// The list of a body with these rows and rows of ghosts.
    pub fn renewed(
        &mut self,
        rows: Range<usize>,
        ghost_rows: Range<usize>,
        searched: &Searched<'_>,
        search: &mut NeighborSearch,
    ) -> Result<&NeighborList, NeighborError> {
        let (places, radii) = (&searched.places[rows.clone()], &searched.radii[rows.clone()]);
        if !self.holds(places, radii) {
            self.make(rows, ghost_rows, searched, search)?;
        }
        Ok(&self.list)
    }

    /// Drops a list that is valid only once.
    pub fn rest(&mut self) {
        if self.radii.is_empty() {
            self.list = NeighborList::default();
        }
    }

    /// Whether the list has all that are closer than these radii at these places.
    fn holds(&mut self, places: &[DVec3], radii: &[f64]) -> bool {
        if self.radii.len() != places.len() {
            return false;
        }
        let grown = radii.iter().zip(&self.radii).map(|(now, then)| now - then).fold(0.0, f64::max);
        let RelativeBounds { near, all } = self.parting.parted(places);
        near + grown <= self.skin && all + largest(radii) <= self.parting.length()
    }

    fn make(
        &mut self,
        rows: Range<usize>,
        ghost_rows: Range<usize>,
        searched: &Searched<'_>,
        search: &mut NeighborSearch,
    ) -> Result<(), NeighborError> {
        let Searched { places, radii, ghosts, hidden } = *searched;
        let (own_places, own_radii) = (&places[rows.clone()], &radii[rows.clone()]);
        let lasts = self.is_late && ghost_rows.is_empty();
        self.is_late = true;
        self.radii.clear();
        self.skin = 0.0;
        if lasts {
            self.skin = SKIN * largest(own_radii);
            self.radii.extend_from_slice(own_radii);
            self.parting.note(own_places, CELL * largest(own_radii));
        }
        let mut find = |positions: &[DVec3], radii: &[f64]| {
            let cloud = Cloud { positions, support: SupportRadii::PerParticle(radii) };
            search.within(cloud, self.skin, &Periodic::NONE, &mut self.list)
        };
        if ghost_rows.is_empty() {
            find(own_places, own_radii)?;
        } else {
            let more = ghost_rows.clone().map(|row| ghosts.place(places, row));
            let their_radii = ghost_rows.clone().map(|row| radii[ghosts.source(row)]);
            let all: Vec<DVec3> = own_places.iter().copied().chain(more).collect();
            let all_radii: Vec<f64> = own_radii.iter().copied().chain(their_radii).collect();
            find(&all, &all_radii)?;
        }
        if !hidden.is_empty() {
            let mut is_seen = vec![true; rows.len()];
            hidden.iter().for_each(|&number| is_seen[number as usize] = false);
            for row in ghost_rows.clone() {
                is_seen.push(is_seen[ghosts.source(row) - rows.start]);
            }
            self.list.retain(|i, j| is_seen[i] && is_seen[j as usize]);
        }
        let count = rows.len() as u32;
        let (first, first_ghost) = (rows.start as u32, ghost_rows.start as u32);
        self.list.renumber_from(0, |number| match number.checked_sub(count) {
            None => first + number,
            Some(ghost) => first_ghost + ghost,
        });
        Ok(())
    }
}

/// How far particles with these support radii, m, and ellipsoids can see: two that measure less than the mean
/// of their support radii are closer than the mean of these. With distances `|r|^2 (1/l_i^2 + 1/l_j^2) / 2`
/// and more, they are closer than the product of the means of s and l, which exceeds the mean of the products
/// by no more than a quarter of the product of the ranges of s and l.
pub(super) fn radii(support: &[f64], ellipsoids: &[Ellipsoid], radii: &mut Vec<f64>) {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let empty = (f64::INFINITY, 0.0_f64);
        let (least, most) = values.fold(empty, |(least, most), value| (least.min(value), most.max(value)));
        (most - least).max(0.0)
    };
    let of_support = range(&mut support.iter().copied());
    let of_axes = range(&mut ellipsoids.iter().map(|own| own.longest));
    let more = 0.25 * of_support * of_axes;
    radii.extend(support.iter().zip(ellipsoids).map(|(s, own)| (s * own.longest + more) * (1.0 + ROUNDING)));
}

/// The largest of some radii, m.
pub(super) fn largest(radii: &[f64]) -> f64 {
    radii.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Sym3;

    #[test]
    fn a_list_that_lasts_misses_nobody_however_the_body_moves_and_stretches() {
        let place = |k: usize| {
            let t = k as f64;
            DVec3::new((0.37 * t).sin(), (1.7 * t + 0.3).sin(), 0.3 * (0.9 * t + 1.1).sin())
        };
        let start: Vec<DVec3> = (0..600).map(place).collect();
        let support: Vec<f64> = (0..600).map(|k| if k % 50 == 7 { 0.3 } else { 0.22 }).collect();
        let (ghosts, mut candidates) = (Ghosts::new(600), Candidates::default());
        let mut search = NeighborSearch::default();
        let (mut made, mut pairs) = (0, 0);
        for n in 0..60 {
            let t = 0.002 * f64::from(n);
            let places: Vec<DVec3> = start
                .iter()
                .map(|x| *x + DVec3::new(40.0 * t + t * x.y, t * (2.0 * x.x).sin(), -t * x.z))
                .collect();
            let ellipsoid =
                |x: &DVec3| Ellipsoid::new(Sym3 { xx: 1.0 + t * x.y, xy: 0.5 * t, ..Sym3::IDENTITY });
            let ellipsoids: Vec<Ellipsoid> = start.iter().map(ellipsoid).collect();
            let mut far = Vec::new();
            radii(&support, &ellipsoids, &mut far);
            let searched = Searched { places: &places, radii: &far, ghosts: &ghosts, hidden: &[3, 500] };
            made += i32::from(!candidates.holds(&places, &far));
            let list = candidates.renewed(0..600, 600..600, &searched, &mut search).expect("a list");
            for i in 0..600 {
                let row = list.row(i);
                assert!(row.is_sorted() && !row.contains(&3) && !row.contains(&500), "{row:?}");
                for j in (0..600).filter(|&j| j != i && ![i, j].iter().any(|k| [3, 500].contains(k))) {
                    let r = places[j] - places[i];
                    let square = |own: &Ellipsoid| r.dot(own.tensor.to_matrix() * r);
                    let distance = (0.5 * (square(&ellipsoids[i]) + square(&ellipsoids[j]))).sqrt();
                    if distance < 0.5 * (support[i] + support[j]) {
                        pairs += 1;
                        assert!(row.contains(&(j as u32)), "{i} and {j} after {n}");
                    }
                }
            }
        }
        assert!(made > 2 && made < 20, "{made} lists");
        assert!(pairs > 60 * 600, "{pairs} pairs");
    }
}
