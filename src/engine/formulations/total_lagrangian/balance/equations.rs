//! The linear equations for the shares.

use glam::DVec3;

use super::body::HeldBody;
use super::lattice::{Lattice, Share};
use super::least_squares::SparseRows;
use super::zone::Zone;

/// n . b_i as a function of the changes of the shares, over the area of a particle.
pub(super) struct Equations {
    /// The coefficients of the unknown shares.
    pub rows: SparseRows,
    /// What is missing with the shares of the start.
    pub rest: Vec<f64>,
}

impl Equations {
    /// The equations of a zone in the lattice as it is, for the b of the lattice that goes on, about the shares that all particles of the body have at the start.
    pub fn of(body: &HeldBody<'_>, zone: &Zone, (now, goes_on): (&Lattice, &Lattice), start: &[f64]) -> Self {
        let mut column = vec![None; start.len()];
        (0..).zip(&zone.unknown).for_each(|(c, (k, _))| column[*k as usize] = Some(c));
        let area = body.plan.spacing.powi(body.kernel.dimension() as i32 - 1);
        let (mut rows, mut rest) = (SparseRows::default(), Vec::with_capacity(zone.equations.len()));
        for &(k, normal) in &zone.equations {
            let mut missing = target(goes_on, start, k).dot(normal) / area;
            let mut own = 0.0;
            for share in now.shares(k) {
                let part = share.other_part.dot(normal) / area;
                own += share.own_part.dot(normal) / area;
                missing -= start[share.other as usize] * part;
                if let Some(column) = column[share.other as usize] {
                    rows.add(column, part);
                }
            }
            missing -= start[k as usize] * own;
            if let Some(column) = column[k as usize] {
                rows.add(column, own);
            }
            rows.end();
            rest.push(missing);
        }
        // The volume stays.
        let count = zone.unknown.len();
        (0..count as u32).for_each(|column| rows.add(column, 1.0 / (count as f64).sqrt()));
        rows.end();
        rest.push(0.0);
        Self { rows, rest }
    }
}

/// b of a particle where the lattice goes on behind the sides.
fn target(lattice: &Lattice, start: &[f64], k: u32) -> DVec3 {
    let part =
        |share: Share| start[k as usize] * share.own_part + start[share.other as usize] * share.other_part;
    lattice.shares(k).map(part).sum()
}
