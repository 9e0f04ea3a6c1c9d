//! The artificial stress of Gray, Monaghan and Swift (2001), for comparison with hourglass control.
//!
//! `f_i = V_i sum_j V_j w_ij (W_ij / W(dp))^n (R_i + R_j) x_ij` with `R = -epsilon sigma_+`, where sigma_+ is
//! the tensile part of the Cauchy stress in its principal axes: a repulsion of particles that tension draws
//! into clumps. Gray and others divide by densities, 1/rho_i^2 and 1/rho_j^2, which is the same to the order
//! of the change of density. The force has no energy; its work is booked.

use glam::DMat3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::rows::EulerianRows;
use crate::column;
use crate::kernels::Kernel;
use crate::linalg::{Eigen, Sym3};
use crate::materials::ParameterError;
use crate::pair::{Pair, PairTerm, Rates};
use crate::parallel::{Arithmetic, Matrix, for_each_block};
use crate::plugin::SimBuilder;
use crate::world::{BodyId, BodySet, MissingColumn, PhaseId, PiolaStress, World};

column! {
    /// Tensile part of the Cauchy stress in its principal axes.
    pub struct TensileStress(DMat3) = "tensile_stress", "sigma_+", "Pa";
}

/// Artificial stress against the tensile instability, for comparison: it leaves hourglass modes as they are.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArtificialStress {
    /// Share epsilon of the tensile stress.
    pub epsilon: f64,
    /// Exponent n of W over W at one spacing.
    pub exponent: u32,
}

impl Default for ArtificialStress {
    fn default() -> Self {
        Self { epsilon: 0.3, exponent: 4 }
    }
}

impl ArtificialStress {
    pub(super) fn check(&self) -> Result<(), ParameterError> {
        ParameterError::require_not_negative("artificial_stress.epsilon", self.epsilon)?;
        if self.exponent == 0 || self.exponent > 16 {
            let message = format!("`artificial_stress.exponent` must be 1 to 16, found {}", self.exponent);
            return Err(ParameterError::new("artificial_stress.exponent", message, "4 is usual"));
        }
        Ok(())
    }

    /// Adds the term to a body, with its column.
    pub(super) fn add(self, id: BodyId, kernel: &Kernel, support: f64, sim: &mut SimBuilder<'_>) {
        let bodies = BodySet::new([id]);
        sim.add_column_to::<TensileStress>(&bodies);
        let spacing = sim.body(id).spacing;
        let at_spacing = kernel.w(spacing, kernel.smoothing_length(support));
        let Self { epsilon, exponent } = self;
        sim.add_pair_term(
            bodies,
            "artificial_stress",
            ArtificialStressTerm { epsilon, exponent, at_spacing },
        );
    }
}

/// The term of one body.
struct ArtificialStressTerm {
    epsilon: f64,
    exponent: u32,
    /// W at one spacing.
    at_spacing: f64,
}

impl PairTerm for ArtificialStressTerm {
    type ReadI = (TensileStress,);
    type ReadJ = (TensileStress,);

    const READS_VELOCITY: bool = false;
    const NEEDS_REFERENCE: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (own,): (Matrix<A>,),
        (other,): (Matrix<A>,),
        rates: &mut Rates<A>,
    ) {
        let near = pair.kernel * (1.0 / self.at_spacing);
        let mut factor = near;
        for _ in 1..self.exponent {
            factor = factor * near;
        }
        let weight = factor * pair.volume_i * pair.volume_j * pair.weight * self.epsilon;
        rates.force -= (own + other) * pair.x_ij * weight;
    }
}

/// Writes the tensile stresses of the phase, where it has their column.
pub(super) fn write(world: &World, phase: PhaseId, packed: &EulerianRows) -> Result<(), MissingColumn> {
    let view = world.phase(phase);
    if !view.has::<TensileStress>() {
        return Ok(());
    }
    let stress = view.read::<PiolaStress>()?;
    let mut tensile = view.write::<TensileStress>()?;
    let rows = (&mut tensile[..], &stress[..], &packed.deformation[..]);
    type Rows<'a> = (&'a mut [TensileStress], &'a [PiolaStress], &'a [DMat3]);
    for_each_block(rows, &mut Vec::new(), &|_, (tensile, stress, deformation): Rows<'_>| {
        for (k, tensile) in tensile.iter_mut().enumerate() {
            let f = &deformation[k];
            let cauchy = Sym3::symmetric_part(stress[k].0 * f.transpose()) * (1.0 / f.determinant());
            tensile.0 = Eigen::new(&cauchy).map(|principal| principal.max(0.0)).to_matrix();
        }
    });
    Ok(())
}
