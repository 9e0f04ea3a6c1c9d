//! The frame-indifferent form: the difference of two Laplacians of the positions stores energy.
//!
//! ```text
//! d_i = h_i sum_j V_j w_ij [x_ij - (Q_i + Q_j) r_ij / 2] ,     U = sum_i kappa_i |d_i|^2 / 2 ,     kappa = eta^2 E V_0
//! ```
//!
//! with the gradient Q since the reference configuration, its pair vectors r_ij, and half of the support radius h. `2 sum_j V_j w_ij x_ij` is the Laplacian of the
//! positions, `sum_j V_j w_ij (Q_j - Q_i) r_ij` the divergence of their gradient. Every bond for itself gives nothing for an affine motion, beside a
//! surface too, and d turns with the body: no direction counts more than another. With p_i = h_i kappa_i d_i / V_i the force is exactly -dU/dx:
//!
//! ```text
//! stress  S_i = sum_j V_j w_ij (p_j - p_i) (x) r_ij / 2      beside that of the material
//! f_i += V_i sum_j V_j w_ij (p_i - p_j)
//! ```
//!
//! Both are given to the pass of the internal force. A particle with a failed neighbour resists nothing.

use glam::{DMat3, DVec3};

use super::super::bonds::Bonds;
use super::super::rows::Site;
use super::rows::HessianRows;
use crate::linalg::{Sym3, dyad};
use crate::parallel::{FourLanes, HotLoop, for_each_block, run_hot, sum_over_blocks};
use crate::solids::{
    CorrectedStress, FoldedEnergy, HessianForm, HessianResidual, HessianStiffness, SolidBodies,
};
use crate::symmetry::Ghosts;
use crate::world::{Damage, MissingColumn, PhaseView, SupportRadius};

/// The two passes of the form over all its bodies.
pub(in crate::formulations) struct FrameIndifferent<'a> {
    pub bonds: &'a Bonds,
    pub ghosts: &'a Ghosts,
    pub sites: &'a [Site],
    pub stresses: &'a mut [CorrectedStress],
    pub self_force: &'a mut [DVec3],
    pub hessian: &'a mut HessianRows,
}

/// Rows of the first pass.
type ResidualRows<'a> =
    (&'a mut [HessianResidual], &'a mut [HessianStiffness], &'a mut [DVec3], &'a [f64], &'a [SupportRadius]);

impl FrameIndifferent<'_> {
    /// Computes the residuals, their energies and their forces, after the stress of all bodies. A pass that repeats a step has `dt` zero.
    pub fn run(self, view: &PhaseView<'_>, solids: &mut SolidBodies, dt: f64) -> Result<(), MissingColumn> {
        let form = HessianForm::FrameIndifferent;
        if !self.hessian.has(form) {
            return Ok(());
        }
        let Self { bonds, ghosts, sites, stresses, self_force, hessian } = self;
        let mut residual = view.write::<HessianResidual>()?;
        let mut held = view.write::<HessianStiffness>()?;
        let support = view.read::<SupportRadius>()?;
        let damage = view.read::<Damage>().ok();
        hessian.fill_ghost_gradients(ghosts);
        let HessianRows { bodies, gradient, stiffness, pull, .. } = hessian;
        for body in bodies.iter().filter(|body| body.term.form == form) {
            let rows = body.rows.clone();
            let pass = Residuals {
                bonds,
                ghosts,
                sites,
                gradient,
                damage: damage.as_deref(),
                first: rows.start,
                moves: dt > 0.0,
            };
            let own: ResidualRows<'_> = (
                &mut residual[rows.clone()],
                &mut held[rows.clone()],
                &mut pull[rows.clone()],
                &stiffness[rows.clone()],
                &support[rows],
            );
            let energy = sum_over_blocks(own, &|first, own: ResidualRows<'_>| {
                run_hot(ResidualBlock { pass: &pass, first, own })
            });
            solids.add_hessian(body.body, energy);
        }
        ghosts.fill(pull, |ghost, pull| ghost.map.vector(*pull));
        for body in bodies.iter().filter(|body| body.term.form == form) {
            let rows = body.rows.clone();
            let pass = Forces { bonds, sites, pull, first: rows.start };
            type Rows<'a> = (&'a mut [CorrectedStress], &'a mut [DVec3]);
            let own: Rows<'_> = (&mut stresses[rows.clone()], &mut self_force[rows]);
            for_each_block(own, &mut Vec::new(), &|first, own: Rows<'_>| {
                let (stresses, self_force) = own;
                run_hot(ForceBlock { pass: &pass, first, stresses, self_force });
            });
        }
        Ok(())
    }
}

/// First pass: residual and pull.
struct Residuals<'a> {
    bonds: &'a Bonds,
    ghosts: &'a Ghosts,
    sites: &'a [Site],
    gradient: &'a [DMat3],
    damage: Option<&'a [Damage]>,
    /// First row of the body.
    first: usize,
    /// Whether the step is one, and no repetition.
    moves: bool,
}

struct ResidualBlock<'a, 'r> {
    pass: &'a Residuals<'a>,
    first: usize,
    own: ResidualRows<'r>,
}

impl HotLoop for ResidualBlock<'_, '_> {
    type Output = FoldedEnergy;

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) -> FoldedEnergy {
        let Residuals { bonds, ghosts, sites, gradient, damage, first, moves } = *self.pass;
        let (residual, held, pull, stiffness, support) = self.own;
        let mut energy = FoldedEnergy::default();
        let may_be_loose = damage.is_some() || !bonds.free.is_empty();
        for k in 0..residual.len() {
            let i = first + self.first + k;
            let (site, h_i) = (&sites[i], gradient[i]);
            let mut sum = DVec3::ZERO;
            // The motion of a neighbour that has failed, or has no gradient of its own, says nothing.
            let mut is_beside_loose = may_be_loose && bonds.inverse_moment[i] == Sym3::ZERO;
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let j = bonds.neighbors[bond] as usize;
                let other = &sites[j];
                let weight = f64::from(bonds.weights[bond]) * other.reference.0[3];
                let arm = other.reference.xyz() - site.reference.xyz();
                let change = other.displacement.xyz() - site.displacement.xyz();
                sum += (change - (h_i + gradient[j]) * (0.5 * arm)) * weight;
                if may_be_loose && weight > 0.0 {
                    let j = ghosts.source(j);
                    let has_failed = damage.is_some_and(|damage| damage[j].0 >= 1.0);
                    is_beside_loose |= has_failed || bonds.inverse_moment[j] == Sym3::ZERO;
                }
            }
            let before = (residual[k].0, held[k].0);
            let h = 0.5 * support[k].0;
            let now = sum * h;
            let kappa = if is_beside_loose { 0.0 } else { stiffness[k] };
            energy.stored += 0.5 * kappa * now.length_squared();
            if moves {
                // The trapezoidal rule of the leapfrog spends this beyond the change of energy.
                energy.released += 0.5 * (before.1 - kappa) * before.0.dot(now);
            }
            (residual[k].0, held[k].0) = (now, kappa);
            let volume = site.reference.0[3];
            pull[k] = if volume > 0.0 { now * (h * kappa / volume) } else { DVec3::ZERO };
        }
        energy
    }
}

/// Second pass: the stress that makes the force.
struct Forces<'a> {
    bonds: &'a Bonds,
    sites: &'a [Site],
    pull: &'a [DVec3],
    /// First row of the body.
    first: usize,
}

struct ForceBlock<'a, 'r> {
    pass: &'a Forces<'a>,
    first: usize,
    stresses: &'r mut [CorrectedStress],
    self_force: &'r mut [DVec3],
}

impl HotLoop for ForceBlock<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let Forces { bonds, sites, pull, first } = *self.pass;
        for (k, (stress, self_force)) in self.stresses.iter_mut().zip(self.self_force).enumerate() {
            let i = first + self.first + k;
            let (x, volume) = (sites[i].reference.xyz(), sites[i].reference.0[3]);
            if volume <= 0.0 {
                continue;
            }
            let mut sum = DMat3::ZERO;
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let j = bonds.neighbors[bond] as usize;
                let other = &sites[j].reference;
                let arm = (other.xyz() - x) * (f64::from(bonds.weights[bond]) * other.0[3]);
                sum += dyad(pull[j], arm);
            }
            let reach = bonds.reach[i];
            let own = (sum - dyad(pull[i], reach)) * 0.5;
            let own = own * bonds.inverse_moment[i].to_matrix();
            stress.add(&own, x);
            stress.add_traction(-pull[i]);
            *self_force += own * reach + pull[i] * bonds.weight_sum[i];
        }
    }
}
