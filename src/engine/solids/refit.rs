//! The effect of a cut bond on the measured deformation of a particle.
//!
//! Without a removed neighbour the fit F_i changes although nothing has moved. A law of F alone uses the new
//! fit directly. Plastic flow, however, belongs to the F under which it occurred: a jump of the fit by some
//! per cent would put the metal far beyond yield, and energy into the body. Such a law continues where it
//! was: it sees F_i C_i with C_i = (F_i after the cut)^-1 F_i C_i before it. The force is the gradient of its
//! energy by F_i, P_i C_i^T.
//!
//! A fit that changes by a factor of two has rested on the lost neighbour: what is left of debris measures no
//! deformation. The energy of a law would jump with it.

use glam::DMat3;

use crate::linalg::{Eigen, Sym3};

/// Largest factor by which the fit may stretch any direction, or shrink it.
const LARGEST_CHANGE: f64 = 2.0;

/// The factors C of the rows that have one, ascending by row.
#[derive(Clone, Debug, Default)]
pub struct Refits(Vec<(u32, DMat3)>);

impl Refits {
    /// Those of a checkpoint.
    pub fn restored(entries: Vec<(u32, DMat3)>) -> Self {
        Self(entries)
    }

    /// All rows with their factors.
    pub fn entries(&self) -> &[(u32, DMat3)] {
        &self.0
    }

    /// Those of `n` rows from `first` on.
    pub fn of_block(&self, first: usize, n: usize) -> &[(u32, DMat3)] {
        let until = |row: usize| self.0.partition_point(|entry| (entry.0 as usize) < row);
        if self.0.is_empty() { &[] } else { &self.0[until(first)..until(first + n)] }
    }

    /// Takes in the change (F after)^-1 (F before) of the fit of a row.
    pub fn take_in(&mut self, row: u32, change: &DMat3) {
        match self.0.binary_search_by_key(&row, |entry| entry.0) {
            Ok(k) => self.0[k].1 = *change * self.0[k].1,
            Err(k) => self.0.insert(k, (row, *change)),
        }
    }
}

/// The change (F after)^-1 (F before) of a fit; none where what is left measures no deformation.
pub fn change_of_fit(before: &DMat3, after: &DMat3) -> Option<DMat3> {
    let change = after.inverse() * *before;
    let limits = LARGEST_CHANGE.powi(-2)..=LARGEST_CHANGE.powi(2);
    let is_small = |change: &DMat3| {
        let squares = Eigen::new(&Sym3::symmetric_part(change.transpose() * *change)).values;
        squares.to_array().iter().all(|square| limits.contains(square))
    };
    let measures = after.determinant() > 0.0 && change.determinant() > 0.0;
    Some(change).filter(|change| measures && is_small(change))
}

/// Before the law: replaces the columns of a row by the input of the law. The stress column is the one whose
/// Cauchy stress with F is that of the law, P C^T / det C.
pub(super) fn to_law(refits: &[(u32, DMat3)], first: usize, deformation: &mut [DMat3], stress: &mut [DMat3]) {
    for (row, c) in refits {
        let k = *row as usize - first;
        deformation[k] *= *c;
        stress[k] = stress[k] * c.inverse().transpose() * c.determinant();
    }
}

/// After the law: F is the fit again, and the stress the one that makes forces, P C^T.
pub(super) fn from_law(
    refits: &[(u32, DMat3)],
    first: usize,
    fitted: impl Fn(usize) -> DMat3,
    deformation: &mut [DMat3],
    stress: &mut [DMat3],
) {
    for (row, c) in refits {
        let k = *row as usize - first;
        deformation[k] = fitted(k);
        stress[k] *= c.transpose();
    }
}

/// For the column: the stress of the forces, over det C.
pub(super) fn to_column(refits: &[(u32, DMat3)], first: usize, stress: &mut [DMat3]) {
    for (row, c) in refits {
        stress[*row as usize - first] *= 1.0 / c.determinant();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_sees_what_it_saw_before_however_often_the_fit_changes() {
        let first = DMat3::from_cols_array(&[1.1, 0.1, 0.0, 0.02, 0.9, 0.0, 0.1, 0.0, 1.05]);
        let second = DMat3::from_cols_array(&[1.0, 0.2, 0.1, 0.0, 0.95, 0.0, 0.0, 0.1, 1.15]);
        let third = DMat3::from_cols_array(&[0.8, 0.1, 0.1, 0.3, 1.0, 0.0, 0.0, 0.0, 1.0]);
        let mut refits = Refits::default();
        let mut take_in = |row, before, after| {
            refits.take_in(row, &change_of_fit(before, after).unwrap());
        };
        take_in(9, &third, &first);
        take_in(4, &first, &second);
        take_in(4, &second, &third);
        assert_eq!(refits.entries().iter().map(|entry| entry.0).collect::<Vec<_>>(), [4, 9]);
        assert_eq!((refits.of_block(0, 4).len(), refits.of_block(4, 6).len()), (0, 2));
        let own = refits.of_block(3, 2);
        let (mut deformation, stress) = ([DMat3::IDENTITY, third], [DMat3::IDENTITY, second * 7.0]);
        let mut column = stress;
        to_law(own, 3, &mut deformation, &mut column);
        assert!(deformation[1].abs_diff_eq(first, 1e-14));
        from_law(own, 3, |_| third, &mut deformation, &mut column);
        to_column(own, 3, &mut column);
        assert!(deformation[1] == third && column[1].abs_diff_eq(stress[1], 1e-13));
        assert!(deformation[0] == DMat3::IDENTITY && column[0] == DMat3::IDENTITY);
    }

    #[test]
    fn a_fit_that_rests_on_one_neighbour_measures_nothing_without_it() {
        let stretched = |x: f64, y: f64| DMat3::from_diagonal(glam::DVec3::new(x, y, 1.0));
        let turn = DMat3::from_rotation_z(2.0);
        assert!(change_of_fit(&(turn * stretched(1.1, 0.9)), &(turn * stretched(0.6, 1.7))).is_some());
        assert!(change_of_fit(&DMat3::IDENTITY, &stretched(0.49, 1.0)).is_none());
        assert!(change_of_fit(&DMat3::IDENTITY, &stretched(1.0, 2.1)).is_none());
        // Inside out.
        assert!(change_of_fit(&DMat3::IDENTITY, &stretched(-1.0, 1.0)).is_none());
    }
}
