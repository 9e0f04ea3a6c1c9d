//! Folded terms of particles at the edge of a crack, computed without the failed neighbours.
//!
//! The energy of a term is that of the residual of a fit, which is computed again over the intact neighbours:
//! the force is then the gradient of an energy in which the failed particles do not occur. The energy of the
//! bonds cut by a failure is released. At the positions at the end of a step it is the difference of the two
//! energies; the motion of that step was computed with the old forces, that of the next step with the new
//! ones.

use glam::{DMat3, DVec3};

use super::deformation::DeformationPass;
use crate::correction::MomentMatrix;
use crate::formulations::bonded::{CrackEdge, EdgeRows, FailureState};
use crate::linalg::dyad;
use crate::solids::{Constitutive, FoldedEnergy, FoldedRows, FoldedTerm, SolidSum};

/// The displacement gradient that fits the neighbours which count, and its error.
struct EdgeFit {
    gradient: DMat3,
    residual: f64,
    /// Whether there are enough neighbours for one.
    is_one: bool,
}

/// A bond of a particle.
struct EdgeBond {
    /// Row of the neighbour, which may be an image.
    to: usize,
    /// V_j w_ij.
    weight: f64,
    /// X_ij, m.
    arm: DVec3,
    /// u_ij, m.
    change: DVec3,
}

/// Contribution of a term to the corrected stress and to the bond stiffness of a particle.
#[derive(Clone, Copy)]
struct Added {
    stress: DMat3,
    stiffness: f64,
}

impl DeformationPass<'_> {
    /// Adds all folded terms to a block.
    pub(super) fn add_terms(
        &self,
        constitutive: &Constitutive<'_>,
        mut rows: FoldedRows<'_>,
        edges: EdgeRows<'_>,
        sum: &mut SolidSum,
    ) {
        let EdgeRows { edges, first } = edges;
        let mut next = 0;
        for edge in edges {
            let k = edge.row as usize - first;
            constitutive.fold(&mut rows.part(next..k), sum);
            self.add_at_edge(constitutive, edge, &mut rows.part(k..k + 1), sum);
            next = k + 1;
        }
        let end = rows.volume.len();
        constitutive.fold(&mut rows.part(next..end), sum);
    }

    /// Adds all folded terms to the row of an edge. Where a neighbour has failed in the last step, the terms
    /// before the failure are added first, and the energy that they lose is released.
    fn add_at_edge(
        &self,
        constitutive: &Constitutive<'_>,
        edge: &mut CrackEdge,
        row: &mut FoldedRows<'_>,
        sum: &mut SolidSum,
    ) {
        (edge.stress, edge.stiffness) = (DMat3::ZERO, 0.0);
        let i = edge.row as usize;
        let held = |state: FailureState| state != FailureState::Failed;
        let holds = |state: FailureState| state == FailureState::Intact;
        let of_all = row.displacement_gradient[0];
        let old = edge.is_new.then(|| self.fit(i, of_all, held));
        let new = self.fit(i, of_all, holds);
        let half = 0.5 * constitutive.dt;
        for (sum, term) in sum.terms.iter_mut().zip(constitutive.terms) {
            if let Some(old) = &old {
                let others = row.stress.0[0];
                let (energy, added) = add_fitted(*term, row, old);
                sum.released += energy.released + energy.stored + half * self.power(i, &added, held);
                row.stress.0[0] = others;
            }
            let (energy, added) = add_fitted(*term, row, &new);
            sum.stored += energy.stored;
            sum.released += energy.released;
            if old.is_some() {
                sum.released -= energy.stored + half * self.power(i, &added, holds);
            }
            edge.stress += added.stress;
            edge.stiffness += added.stiffness;
        }
    }

    /// The fit over the neighbours whose states count; the one `of_all` where these are too few, and then
    /// nothing resists.
    fn fit(&self, i: usize, of_all: DMat3, counts: impl Fn(FailureState) -> bool) -> EdgeFit {
        let mut moment = MomentMatrix::new(if self.plane { 2 } else { 3 });
        self.bonds_of(i, &counts).for_each(|bond| moment.add(bond.weight, bond.arm));
        let Some(inverse) = moment.inverse() else {
            return EdgeFit { gradient: of_all, residual: 0.0, is_one: false };
        };
        let mut gradient = DMat3::ZERO;
        // What holds may be nearly a plane, and its inverse lose digits: the second time finds them again.
        for _ in 0..2 {
            let mut rest = DMat3::ZERO;
            for bond in self.bonds_of(i, &counts) {
                let (arm, error) = (bond.arm * bond.weight, bond.change - gradient * bond.arm);
                rest += dyad(error, arm);
            }
            gradient += rest * inverse.to_matrix();
        }
        let error = |bond: EdgeBond| bond.weight * (gradient * bond.arm - bond.change).length_squared();
        EdgeFit { gradient, residual: self.bonds_of(i, &counts).map(error).sum(), is_one: true }
    }

    /// The power, W, of the contribution of a term, on the particle and on the neighbours that count.
    fn power(&self, i: usize, added: &Added, counts: impl Fn(FailureState) -> bool) -> f64 {
        let of_bond = |EdgeBond { to, weight, arm, change }: EdgeBond| {
            let signs = self.ghosts.mirror(to).unwrap_or(DVec3::ONE);
            let parting = self.velocity[i].0 - signs * self.velocity[self.ghosts.source(to)].0;
            weight * (added.stress * arm + change * added.stiffness).dot(parting)
        };
        self.sites[i].reference.0[3] * self.bonds_of(i, &counts).map(of_bond).sum::<f64>()
    }

    /// The bonds with the neighbours whose states count.
    fn bonds_of(&self, i: usize, counts: &impl Fn(FailureState) -> bool) -> impl Iterator<Item = EdgeBond> {
        let own = &self.sites[i];
        let that_count = move |(j, _): &(usize, f32)| counts(self.states[self.ghosts.source(*j)]);
        self.bonds.row(i).filter(that_count).map(move |(j, weight)| {
            let other = &self.sites[j];
            let arm = other.reference.xyz() - own.reference.xyz();
            let change = other.displacement.xyz() - own.displacement.xyz();
            EdgeBond { to: j, weight: f64::from(weight) * other.reference.0[3], arm, change }
        })
    }
}

/// Adds a term to a row with another fit than its own.
fn add_fitted(term: &dyn FoldedTerm, row: &mut FoldedRows<'_>, fit: &EdgeFit) -> (FoldedEnergy, Added) {
    let before = row.stress.0[0];
    let modulus = if fit.is_one { row.modulus[0] } else { 0.0 };
    let energy = term.add(&mut FoldedRows {
        displacement_gradient: &[fit.gradient],
        residual: &[fit.residual],
        modulus: &[modulus],
        ..row.part(0..1)
    });
    let after = &row.stress.0[0];
    let [x, y, z] = [0, 1, 2].map(|axis| after.columns[axis].xyz() - before.columns[axis].xyz());
    let stress = DMat3::from_cols(x, y, z);
    (energy, Added { stress, stiffness: after.stiffness() - before.stiffness() })
}
