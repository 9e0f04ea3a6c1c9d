//! The frame-indifferent form: the difference of two Laplacians of the positions stores energy.
//!
//! ```text
//! d_i = h_i sum_j V_j w_ij [x_ij - (Q_i + Q_j) r_ij / 2] ,     U = sum_i kappa_i |d_i|^2 / 2 ,     kappa = eta^2 E V_0
//! ```
//!
//! with the gradient Q since the reference configuration, its pair vectors r_ij, and half of the support
//! radius h. `2 sum_j V_j w_ij x_ij` is the Laplacian of the positions, `sum_j V_j w_ij (Q_j - Q_i) r_ij` the
//! divergence of their gradient. The contribution of every bond vanishes for an affine motion, beside a
//! surface too, and d rotates with the body: no direction is preferred. With p_i = h_i kappa_i d_i / V_i the
//! force is exactly -dU/dx:
//!
//! ```text
//! stress  S_i = sum_j V_j w_ij (p_j - p_i) (x) r_ij / 2      beside that of the material
//! f_i += V_i sum_j V_j w_ij (p_i - p_j)
//! ```
//!
//! Both are given to the pass of the internal force. A particle with a failed neighbour resists nothing.
//!
//! As in that pass, sums run over the neighbours alone, with Q and u in the [`AffineFrame`] of the body: with
//! H = Q - I and b_j = u_j - H_j X_j / 2,
//!
//! ```text
//! d_i / h_i = sum_j V_j w_ij b_j + (sum_j V_j w_ij H_j / 2) X_i - sum_j V_j w_ij u_i - H_i sum_j V_j w_ij X_ij / 2
//! ```

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::super::bond_sum::{BondSum, SumOverBonds};
use super::super::bonds::Bonds;
use super::super::displacement_moment::DisplacementMoment;
use super::super::frame::{AffineFrame, frame_of};
use super::super::rows::PackedParticle;
use super::rows::{BondedSites, HessianBody, HessianRows};
use crate::linalg::Sym3;
use crate::parallel::{
    FourLanes, Lanes4, PlaneOrSpace, for_each_block, for_each_own_block, run_hot_in, share_rows,
    sum_over_own_blocks,
};
use crate::solids::{
    CorrectedStress, FoldedEnergy, HessianForm, HessianResidual, HessianStiffness, SolidBodies, fit,
};
use crate::symmetry::Ghosts;
use crate::world::{Damage, MissingColumn, PhaseView, SupportRadius};

/// The two passes of the form over all its bodies.
pub(in crate::formulations) struct FrameIndifferent<'a> {
    pub bonds: &'a Bonds,
    pub ghosts: &'a Ghosts,
    pub sites: &'a [PackedParticle],
    /// Of every body.
    pub frames: &'a [AffineFrame],
    pub stresses: &'a mut [CorrectedStress],
    pub self_force: &'a mut [DVec3],
    pub hessian: &'a mut HessianRows,
    /// Plane strain.
    pub plane: bool,
}

/// Rows of the first pass.
type ResidualRows<'a> = (
    &'a mut [HessianResidual],
    &'a mut [HessianStiffness],
    &'a mut [PackedParticle],
    &'a [f64],
    &'a [SupportRadius],
);

impl FrameIndifferent<'_> {
    /// Computes the residuals, their energies and their forces, after the stress of all bodies, for those
    /// bodies whose number is taken. A pass that repeats a step has `dt` zero.
    pub fn run(
        self,
        view: &PhaseView<'_>,
        solids: &mut SolidBodies,
        dt: f64,
        is_taken: impl Fn(usize) -> bool,
    ) -> Result<(), MissingColumn> {
        let is_own =
            |own: &&HessianBody| own.term.form == HessianForm::FrameIndifferent && is_taken(own.body);
        if !self.hessian.bodies.iter().any(|own| is_own(&own)) {
            return Ok(());
        }
        let Self { bonds, ghosts, sites, frames, stresses, self_force, hessian, plane } = self;
        let mut residual = view.write_own::<HessianResidual>()?;
        let mut held = view.write_own::<HessianStiffness>()?;
        let support = view.read_near::<SupportRadius>()?;
        let damage = view.read::<Damage>().ok();
        let HessianRows { bodies, gradient, slopes, stiffness, bond_forces, loose, .. } = hessian;
        fill_loose(bonds, ghosts, sites, damage.as_deref(), loose);
        let bonded = BondedSites { bonds, ghosts, sites };
        fill_slopes(bodies.iter().filter(is_own), gradient, bonded, frames, slopes);
        for body in bodies.iter().filter(is_own) {
            let rows = body.rows.clone();
            let pass = Residuals {
                bonds,
                sites,
                slopes,
                frame: frames[frame_of(frames, rows.start)],
                loose,
                moves: dt > 0.0,
            };
            let own: ResidualRows<'_> = (
                &mut residual[rows.clone()],
                &mut held[rows.clone()],
                &mut bond_forces[rows.clone()],
                &stiffness[rows.clone()],
                &support[rows.clone()],
            );
            let energy = sum_over_own_blocks(own, &|first, own: ResidualRows<'_>| {
                let mut energy = FoldedEnergy::default();
                let first = rows.start + first;
                run_hot_in(plane, ResidualBlock { pass: &pass, first, own, energy: &mut energy });
                energy
            });
            solids.add_hessian(body.body, energy);
            share_rows(&mut bond_forces[rows]);
        }
        ghosts.fill(bond_forces, |ghost, own| {
            let bond_force = ghost.map.vector(own.displacement.xyz());
            PackedParticle {
                reference: sites[ghost.row].reference,
                displacement: Lanes4::new(bond_force, 0.0),
            }
        });
        let pass = ForcePass { bonds, bond_forces, plane };
        for HessianBody { rows, .. } in bodies.iter().filter(is_own) {
            pass.add(rows, &mut stresses[rows.clone()], &mut self_force[rows.clone()]);
        }
        Ok(())
    }
}

/// Marks the rows, ghosts too, that have failed or have no gradient of their own: their motion has no
/// meaning. Removed particles are in no sum.
fn fill_loose(
    bonds: &Bonds,
    ghosts: &Ghosts,
    sites: &[PackedParticle],
    damage: Option<&[Damage]>,
    loose: &mut Vec<bool>,
) {
    loose.clear();
    if damage.is_none() && bonds.free.is_empty() {
        return;
    }
    loose.resize(sites.len(), false);
    for &row in &bonds.free {
        loose[row as usize] = sites[row as usize].is_present();
    }
    if let Some(damage) = damage {
        for ((loose, damage), site) in loose.iter_mut().zip(damage).zip(sites) {
            *loose |= damage.0 >= 1.0 && site.is_present();
        }
    }
    ghosts.fill(loose, |_, source| *source);
}

/// Record of a gradient for neighbours: -H/2, with 1 in the last lane of the first column, and b with the
/// volume, in the frame.
#[inline(always)]
fn slope(h: &DMat3, site: &PackedParticle, frame: &AffineFrame) -> CorrectedStress {
    let half = (*h - frame.gradient) * -0.5;
    let (x, y, z) = (half.x_axis, half.y_axis, half.z_axis);
    let columns = [Lanes4::new(x, 0.0), Lanes4::new(y, 0.0), Lanes4::new(z, 0.0)];
    let mut slope = CorrectedStress { columns, traction: Lanes4::ZERO };
    let moved = slope.apply(site.reference.xyz(), DVec3::ZERO) + frame.rest(site);
    slope.columns[0].0[3] = 1.0;
    slope.traction = Lanes4::new(moved, site.reference.0[3]);
    slope
}

fn fill_slopes<'b>(
    bodies: impl Iterator<Item = &'b HessianBody>,
    gradient: &[DMat3],
    bonded: BondedSites<'_>,
    frames: &[AffineFrame],
    slopes: &mut [CorrectedStress],
) {
    let BondedSites { ghosts, sites, .. } = bonded;
    for HessianBody { rows: Range { start, end }, .. } in bodies {
        let frame = &frames[frame_of(frames, *start)];
        for_each_block(&mut slopes[*start..*end], &mut Vec::new(), &|first, own: &mut [CorrectedStress]| {
            for (own, row) in own.iter_mut().zip(start + first..) {
                *own = slope(&gradient[row], &sites[row], frame);
            }
        });
    }
    ghosts.fill(slopes, |ghost, _| {
        let h = ghost.map.tensor(gradient[ghost.source]);
        slope(&h, &sites[ghost.row], &frames[frame_of(frames, ghost.source)])
    });
}

/// First pass: residual and the forces along bonds.
struct Residuals<'a> {
    bonds: &'a Bonds,
    sites: &'a [PackedParticle],
    slopes: &'a [CorrectedStress],
    frame: AffineFrame,
    /// Of every row, whether its motion says nothing; empty where that of all does.
    loose: &'a [bool],
    /// Whether the step is one, and no repetition.
    moves: bool,
}

struct ResidualBlock<'a, 'r> {
    pass: &'a Residuals<'a>,
    /// First row of the block in the phase.
    first: usize,
    own: ResidualRows<'r>,
    energy: &'r mut FoldedEnergy,
}

impl PlaneOrSpace for ResidualBlock<'_, '_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Residuals { bonds, sites, slopes, frame, loose, moves } = *self.pass;
        let (residual, held, bond_forces, stiffness, support) = self.own;
        for k in 0..residual.len() {
            let i = self.first + k;
            let site = &sites[i];
            let of_others = BondSum::<D>::over(a, bonds, slopes, i);
            let rest = frame.rest_in(a, site);
            let mut sum = a.scale_add(-of_others.columns[0].0[3], rest, of_others.traction);
            for axis in 0..D {
                sum = a.scale_add(-site.reference.0[axis], of_others.columns[axis], sum);
            }
            let sum = sum.xyz() + slopes[i].apply(bonds.first_moment[i], DVec3::ZERO);
            let before = (residual[k].0, held[k].0);
            let h = 0.5 * support[k].0;
            let now = sum * h;
            let mut is_beside_loose = false;
            if !loose.is_empty() {
                is_beside_loose = bonds.inverse_moment[i] == Sym3::ZERO;
                for &j in &bonds.neighbors[bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize] {
                    is_beside_loose |= loose[j as usize];
                }
            }
            let kappa = if is_beside_loose { 0.0 } else { stiffness[k] };
            self.energy.stored += 0.5 * kappa * now.length_squared();
            if moves {
                // The trapezoidal rule of the leapfrog spends this beyond the change of energy.
                self.energy.released += 0.5 * (before.1 - kappa) * before.0.dot(now);
            }
            (residual[k].0, held[k].0) = (now, kappa);
            let volume = site.reference.0[3];
            let bond_force = if volume > 0.0 { now * (h * kappa / volume) } else { DVec3::ZERO };
            bond_forces[k] =
                PackedParticle { reference: site.reference, displacement: Lanes4::new(bond_force, 0.0) };
        }
    }
}

/// Second pass: the stress from which the force follows.
struct ForcePass<'a> {
    bonds: &'a Bonds,
    /// The force along its bonds of every row, at its place.
    bond_forces: &'a [PackedParticle],
    plane: bool,
}

impl ForcePass<'_> {
    /// Adds to the stresses and self forces of the particles of some rows.
    fn add(&self, rows: &Range<usize>, stresses: &mut [CorrectedStress], self_force: &mut [DVec3]) {
        type Rows<'a> = (&'a mut [CorrectedStress], &'a mut [DVec3]);
        let own: Rows<'_> = (stresses, self_force);
        for_each_own_block(own, &mut Vec::new(), &|first, (stresses, self_force): Rows<'_>| {
            let first = rows.start + first;
            run_hot_in(self.plane, ForceBlock { pass: self, first, stresses, self_force });
        });
    }
}

struct ForceBlock<'a> {
    pass: &'a ForcePass<'a>,
    /// First row of the block in the phase.
    first: usize,
    stresses: &'a mut [CorrectedStress],
    self_force: &'a mut [DVec3],
}

impl PlaneOrSpace for ForceBlock<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self { pass: ForcePass { bonds, bond_forces, .. }, first, stresses, self_force } = self;
        for (k, (stress, self_force)) in stresses.iter_mut().zip(self_force).enumerate() {
            let i = first + k;
            if !bond_forces[i].is_present() {
                continue;
            }
            let (x, bond_force) = (bond_forces[i].reference.xyz(), bond_forces[i].displacement.xyz());
            let DisplacementMoment { spread, .. } = DisplacementMoment::<D>::over(a, bonds, bond_forces, i);
            let own = fit::<A, D>(a, &spread, &bonds.inverse_moment[i]);
            let own = DMat3::from_cols(own[0].xyz(), own[1].xyz(), own[2].xyz()) * 0.5;
            stress.add(&own, x);
            stress.add_traction(-bond_force);
            *self_force += own * bonds.first_moment[i] + bond_force * bonds.weight_sum[i];
        }
    }
}
