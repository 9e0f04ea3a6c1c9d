//! Stress at the end of the step: the neighbours within the support, the laws, the corrected stress for the
//! force.

use glam::{DMat3, DVec3};

use super::artificial_stress;
use super::control::{self, HourglassEnergy};
use super::control_rows::Carried;
use super::divergence::{Divergence, corrected};
use super::force;
use super::near::{ComputePairs, NearbyMotion, NeighborRows};
use super::particle::EulerianParticle;
use super::rows::{EulerianKernel, EulerianRows, PointColumns};
use super::separation;
use super::supports::{SUPPORT_CHANGE, SupportMetric};
use crate::formulations::bonded::SeenEllipsoid;
use crate::linalg::Sym3;
use crate::parallel::{Lanes4, Maximum, split_by_rows, sum_over_blocks};
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{Access, AccountKind, Run, Step, StepError};
use crate::solids::{
    AppliedLosses, BodyPass, BodyStep, Constitutive, CorrectedStress, Loss, SolidBlock, SolidBodies,
    SolidColumns, SolidPart, SolidRows, SolidSum, count_rows,
};
use crate::world::{
    Force, Mass, MissingColumn, PhaseId, PhaseView, Position, ReferenceVolume, Removed, Velocity, World,
};

/// The system.
pub(super) struct Stress {
    phase: PhaseId,
    solids: SolidBodies,
    /// Share of its stress that every row carries; empty where all carry all of it.
    shares: Vec<f64>,
    /// Removed rows that the sums know of, ascending.
    removed: Vec<u32>,
    /// Whether these still have to be restored from the checkpoint of the run.
    is_restored: bool,
}

impl Run for Stress {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut packed = step.resources.solid_rows_mut::<EulerianRows>(self.phase);
        if std::mem::take(&mut self.is_restored) {
            let applied = step.world.phase(self.phase).read::<AppliedLosses>()?;
            self.removed = AppliedLosses::rows(&applied, Loss::Removed);
        }
        self.pack(step.world, &mut packed)?;
        self.pass(step.world, &mut packed, SolidPart::of(step))?;
        self.solids.book(step)?;
        if packed.lists.bodies.iter().any(|body| body.follows) {
            // From the first step on, so that it has its place among the energies.
            step.ledger.account(SUPPORT_CHANGE, AccountKind::Dissipated);
        }
        self.follow(step, &mut packed)?;
        self.update_removed(step, &mut packed)?;
        artificial_stress::write(step.world, self.phase, &packed)?;
        separation::warn(self.phase, &packed, step);
        self.find_stable_steps(&mut packed);
        let stable = std::mem::take(&mut packed.stable_step);
        // Weights are those of the present places: of the stretches, only the change of volume stiffens what
        // they see.
        let limited = self.solids.limit_from_present(step, &stable);
        packed.stable_step = stable;
        limited
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.solids.steps()).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok(steps) = postcard::from_bytes::<Vec<BodyStep>>(state) else { return false };
        self.is_restored = true;
        self.solids.restore_steps(&steps)
    }
}

impl Stress {
    pub fn new(phase: PhaseId, solids: SolidBodies, shares: Vec<f64>) -> Self {
        Self { phase, solids, shares, removed: Vec::new(), is_restored: false }
    }

    /// The columns that it touches for its bodies.
    pub fn access(&self) -> Vec<Access> {
        self.solids.access()
    }

    fn pack(&self, world: &World, packed: &mut EulerianRows) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        let columns = PointColumns {
            position: &view.read_near::<Position>()?,
            velocity: &view.read_near::<Velocity>()?,
            volume: &view.read_near::<ReferenceVolume>()?,
            deformation: &view.read_near()?,
        };
        packed.pack(&columns, 0.0, self.removed.iter().map(|&row| row as usize));
        Ok(())
    }

    /// Runs the pass over all bodies.
    fn pass(
        &mut self,
        world: &World,
        packed: &mut EulerianRows,
        part: SolidPart<'_>,
    ) -> Result<(), StepError> {
        let view = world.phase(self.phase);
        let (volume, mass) = (view.read::<ReferenceVolume>()?, view.read::<Mass>()?);
        let mut columns = SolidColumns::of(&view)?;
        self.solids.begin();
        for k in 0..self.solids.len() {
            let rows = packed.lists.bodies[k].rows.clone();
            let of_body = BodyPass { body: k, view: &view, rows, part };
            self.of_body(of_body, &volume, &mass, &mut columns, packed);
        }
        self.resist(&view, &mass, packed)?;
        packed.fill_ghost_stresses();
        Ok(())
    }

    /// Adds the control along pairs.
    fn resist(
        &mut self,
        view: &PhaseView<'_>,
        mass: &[Mass],
        packed: &mut EulerianRows,
    ) -> Result<(), MissingColumn> {
        if packed.kernels.iter().all(|of| of.control.is_none()) {
            return Ok(());
        }
        packed.fill_ghost_carried();
        let mut energy = view.write::<HourglassEnergy>()?;
        for k in 0..self.solids.len() {
            if let Some(own) = packed.kernels[k].control {
                let rows = packed.lists.bodies[k].rows.clone();
                let sum = control::run(packed, k, own, &mut energy[rows], mass);
                self.solids.add_control(k, sum);
            }
        }
        Ok(())
    }

    fn of_body(
        &mut self,
        of_body: BodyPass<'_>,
        volume: &[ReferenceVolume],
        mass: &[Mass],
        columns: &mut SolidColumns<'_>,
        packed: &mut EulerianRows,
    ) {
        let BodyPass { body: k, ref rows, part, .. } = of_body;
        let EulerianRows {
            lists,
            kernels,
            points,
            supports,
            near,
            deformation,
            carried,
            stresses,
            plane,
            ..
        } = packed;
        let (body, kernel) = (&lists.bodies[k], kernels[k]);
        let own = OwnRows {
            near: near.of_rows(&lists.pairs, rows.clone()),
            deformation: &mut deformation[rows.clone()],
            carried: &mut carried[rows.clone()],
            stresses: &mut stresses[rows.clone()],
        };
        let pass = StressPass {
            kernel,
            support: body.support,
            lists: lists.pairs.indices(),
            points,
            ellipsoids: supports.of(body),
            volume,
            mass,
            shares: &self.shares,
            plane: *plane,
            follows: body.follows,
            starts: part.dt == 0.0,
        };
        self.solids.run(of_body, columns, own, &|law, rows, own, block| pass.block(law, rows, own, block));
    }

    /// Goes on to other supports where they are due. The pass runs again at the same places.
    fn follow(&mut self, step: &mut Step<'_>, packed: &mut EulerianRows) -> Result<(), StepError> {
        if !packed.supports.is_renewed {
            return Ok(());
        }
        let held = self.solids.stored();
        let before = self.forces(step.world, packed)?;
        packed.load_supports(&step.world.phase(self.phase).read_near::<SupportMetric>()?);
        self.pass(step.world, packed, SolidPart::REPEATED)?;
        self.solids.book_repeated(step)?;
        let after = self.forces(step.world, packed)?;
        let account = step.ledger.account(SUPPORT_CHANGE, AccountKind::Dissipated);
        self.solids.book_change(step, account, &held, &before, &after)
    }

    /// Takes out of the sums what has been removed since the last step. The pass runs twice from the same
    /// places: what the removed particles held leaves the energy balance, and what the motion up to here,
    /// with the old forces, loses by the new ones in the second kick goes with it.
    fn update_removed(&mut self, step: &mut Step<'_>, packed: &mut EulerianRows) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let removed = view.read_near::<Removed>()?;
        if count_rows(&removed, |row| *row != Removed::NO) == self.removed.len() {
            return Ok(());
        }
        let held = self.solids.stored();
        let before = self.forces(step.world, packed)?;
        let gone = (0..removed.len() as u32).filter(|&row| removed[row as usize] != Removed::NO);
        let gone: Vec<u32> = gone.collect();
        let new = gone.iter().filter(|row| self.removed.binary_search(row).is_err());
        separation::open_beside(packed, new.map(|&row| row as usize));
        self.removed = gone;
        AppliedLosses::write(&mut view.write::<AppliedLosses>()?, Loss::Removed, &self.removed);
        self.pack(step.world, packed)?;
        // States of laws have advanced by this step already.
        self.pass(step.world, packed, SolidPart::REPEATED)?;
        self.solids.book_repeated(step)?;
        let after = self.forces(step.world, packed)?;
        let account = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
        self.solids.book_change(step, account, &held, &before, &after)
    }

    /// The internal forces of the last pass.
    fn forces(&self, world: &World, packed: &EulerianRows) -> Result<Vec<Force>, MissingColumn> {
        let view = world.phase(self.phase);
        let mut force = vec![Force::default(); view.len()];
        force::write(packed, &view.read::<Mass>()?, &mut force);
        Ok(force)
    }

    /// The stable step of each body with the weights that it has now, s.
    fn find_stable_steps(&self, packed: &mut EulerianRows) {
        let EulerianRows { lists, supports, near, control, stable_step, plane, .. } = packed;
        let axes = if *plane { 2.0 } else { 3.0 };
        stable_step.clear();
        for (own, body) in self.solids.iter().zip(&lists.bodies) {
            let rows = (&near.around[body.rows.clone()], &control.stiffness[body.rows.clone()]);
            type Rows<'a> = (&'a [NearbyMotion], &'a [f64]);
            let fastest: Maximum = sum_over_blocks(rows, &|first, (around, stiffness): Rows<'_>| {
                let step = |(k, (of, stiffness)): (usize, (&NearbyMotion, &f64))| {
                    let inverse = &of.inverse_moment;
                    let trace = match supports.ellipsoid(body, body.rows.start + first + k) {
                        Some(own) => own.trace(inverse, own.axis_bound()),
                        None => inverse.trace(),
                    };
                    1.0 / own.estimate.stable_step_with_pairs(of.weight_sum, trace / axes, *stiffness)
                };
                let rows = around.iter().zip(stiffness).enumerate();
                Maximum::of(rows.filter(|(_, (of, _))| of.inverse_moment != Sym3::ZERO).map(step))
            });
            stable_step.push(1.0 / fastest.0);
        }
    }
}

/// Packed rows that the pass writes, split by rows of one body.
struct OwnRows<'a> {
    near: NeighborRows<'a>,
    deformation: &'a mut [DMat3],
    carried: &'a mut [Carried],
    stresses: &'a mut [CorrectedStress],
}

split_by_rows!(OwnRows { near, deformation, carried, stresses });

/// The pass over one body.
struct StressPass<'a> {
    kernel: EulerianKernel,
    support: f64,
    lists: &'a [u32],
    points: &'a [EulerianParticle],
    /// Ellipsoids of all rows; empty where supports are spheres.
    ellipsoids: &'a [SeenEllipsoid],
    volume: &'a [ReferenceVolume],
    mass: &'a [Mass],
    shares: &'a [f64],
    plane: bool,
    /// Whether supports follow the deformation, so that the control alone holds particles in their places.
    follows: bool,
    /// Whether there is no step before.
    starts: bool,
}

impl StressPass<'_> {
    /// The share of its stress that a row carries.
    fn share(&self, row: usize, around: &NearbyMotion) -> f64 {
        let is_fitted = around.inverse_moment != Sym3::ZERO;
        if is_fitted { self.shares.get(row).copied().unwrap_or(1.0) } else { 0.0 }
    }

    /// Computes the pairs of the rows of a block.
    fn find_pairs<'b>(&'b self, first: usize, rows: &mut NeighborRows<'b>) {
        let Self { support, lists, points, ellipsoids, plane, .. } = *self;
        let kernel = self.kernel.kernel;
        kernel.dispatch(ComputePairs { kernel, support, lists, points, ellipsoids, first, plane, rows });
    }

    fn block(
        &self,
        constitutive: &Constitutive<'_>,
        mut rows: SolidRows<'_>,
        own: OwnRows<'_>,
        block: &mut SolidBlock,
    ) -> SolidSum {
        let Self { kernel: EulerianKernel { divergence, .. }, points, .. } = *self;
        let (n, first) = (rows.deformation.len(), block.first);
        let OwnRows { mut near, deformation, carried, stresses } = own;
        self.find_pairs(first, &mut near);
        deformation.copy_from_slice(rows.deformation);
        for (k, f) in deformation.iter().enumerate() {
            block.gradient[k] = *f - DMat3::IDENTITY;
            block.volume[k] = if points[first + k].place.0[3] > 0.0 { self.volume[first + k].0 } else { 0.0 };
        }
        block.residual[..n].fill(0.0);
        let around = &*near.around;
        let share = |k: usize| self.share(first + k, &around[k]);
        let mut sum = SolidSum::default();
        constitutive.stress(&mut rows, block, share, &mut sum, |stress| {
            for (k, out) in stresses.iter_mut().enumerate() {
                let f = &deformation[k];
                let kirchhoff = stress[k] * f.transpose();
                let (mass, point) = (self.mass[first + k].0, &points[first + k]);
                let measure = match divergence {
                    Divergence::Adjoint => point.place.0[3],
                    Divergence::Shepard => mass,
                };
                *out = weighted(&corrected(divergence, &kirchhoff, &around[k], mass, point), measure);
                if point.place.0[3] <= 0.0 {
                    *out = CorrectedStress::default();
                }
            }
        });
        if self.follows {
            block.brace(&rows);
        }
        // Terms that only look: they leave the stresses as they are.
        let mut folded = constitutive.folded(&mut rows, block, stresses);
        let controlled = self.kernel.control.is_some();
        if controlled {
            for (carried, before) in carried.iter_mut().zip(&*folded.memory.modulus) {
                carried.set_modulus_before(*before);
            }
        }
        constitutive.fold(&mut folded, &mut sum);
        if controlled {
            for (k, carried) in carried.iter_mut().enumerate() {
                let modulus = folded.memory.modulus[k];
                if self.starts {
                    carried.set_modulus_before(modulus);
                }
                carried.set(&deformation[k], modulus, self.volume[first + k].0);
            }
        }
        sum.close(&rows, block);
        sum
    }
}

/// A corrected stress, and its weight in the sums of the force.
fn weighted(stress: &DMat3, measure: f64) -> CorrectedStress {
    CorrectedStress { traction: Lanes4::new(DVec3::ZERO, measure), ..CorrectedStress::new(stress) }
}
