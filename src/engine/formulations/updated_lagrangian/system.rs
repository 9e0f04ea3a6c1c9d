//! The system of the first pass, and of updates of the reference.

use std::ops::Range;

use glam::DMat3;

use super::columns::{UpdatedGradient, UpdatedMetric, UpdatedReference, UpdatedVolume};
use super::control::{Control, ControlPass};
use super::due::UpdateRule;
use super::force;
use super::force_change::ForceChange;
use super::gradient::{GradientRows, UpdatedGradientPass};
use super::lost_neighbors::widen;
use super::phase::UpdatedRows;
use super::reference_fit::ReferenceFit;
use super::smoothed_reference::{ReferenceRelaxation, ReferenceSmoothing};
use crate::formulations::bonded::{AffineFrame, BondedSites, Ellipsoid, FrameIndifferent, PackedParticle};
use crate::notation::quantity;
use crate::parallel::share_picked;
use crate::schedule::{AccountKind, Run, Shared, Step, StepError};
use crate::solids::{
    AppliedLosses, BodyPass, BodyStep, HessianForm, Loss, SolidBodies, SolidColumns, SolidPart, StepEstimate,
    count_rows, fill_rows,
};
use crate::world::{
    Damage, DeformationGradient, Force, Mass, MissingColumn, PhaseId, PhaseView, Position, ReferencePosition,
    ReferenceVolume, Removed, SupportRadius, World,
};

/// Account of what an update of the reference changes of the stored energies.
const ACCOUNT: &str = "reference_update";

/// The system.
pub(super) struct UpdatedSolids {
    phase: PhaseId,
    /// Plane strain.
    plane: bool,
    solids: SolidBodies,
    /// Of every body: when its reference is updated.
    rules: Vec<UpdateRule>,
    /// Of every body: whether it keeps the reference that it has.
    keeps: Vec<bool>,
    /// Of every body: whether its reference is updated in this step.
    due: Vec<bool>,
    /// Of every body: whether it has lost particles since the last update.
    has_lost: Vec<bool>,
    /// Removed rows that the reference knows of, ascending.
    removed: Vec<u32>,
    /// Rows of failed particles that it knows of, ascending.
    failed: Vec<u32>,
    /// Whether the lists are those of another reference than that of the columns: after a restart.
    is_stale: bool,
    /// What the update of this step has changed of internal forces.
    change: Shared<ForceChange>,
    kept: KeptMemory,
}

/// Memory that is kept from one update to the next.
#[derive(Default)]
struct KeptMemory {
    relaxation: ReferenceRelaxation,
    fit: ReferenceFit,
    /// Internal forces before the update, N.
    before: Vec<Force>,
}

impl UpdatedSolids {
    /// The system of these bodies, one rule for each.
    pub fn new(
        phase: PhaseId,
        plane: bool,
        solids: SolidBodies,
        rules: Vec<UpdateRule>,
        change: Shared<ForceChange>,
    ) -> Self {
        Self {
            phase,
            plane,
            solids,
            keeps: vec![false; rules.len()],
            rules,
            due: Vec::new(),
            has_lost: Vec::new(),
            removed: Vec::new(),
            failed: Vec::new(),
            is_stale: false,
            change,
            kept: KeptMemory::default(),
        }
    }

    /// Estimates of the stable step of each body.
    pub fn estimates(&self) -> Vec<StepEstimate> {
        self.solids.iter().map(|body| body.estimate).collect()
    }

    /// Of every body: whether stabilizers act on it that are folded terms, or differences of Laplacians.
    pub fn is_stabilized(&self) -> Vec<bool> {
        self.solids.iter().map(|body| body.has_terms() || body.has_hessian_residual()).collect()
    }

    /// Runs the pass over all bodies. Where the fit of f is known, the sites of the reference are filled.
    fn pass(
        &mut self,
        world: &World,
        packed: &mut UpdatedRows,
        part: SolidPart<'_>,
        fit: Option<&ReferenceFit>,
    ) -> Result<(), StepError> {
        let view = world.phase(self.phase);
        if fit.is_none() {
            packed.pack_reference(world, self.phase)?;
        }
        packed.pack_original(world, self.phase)?;
        packed.has_force = false;
        let mut columns = SolidColumns::own(&view)?;
        let support = view.read_near::<SupportRadius>()?;
        let UpdatedRows { bonds, ghosts, hessian, kernels, sites, .. } = &mut *packed;
        let support = bytemuck::cast_slice(&support);
        hessian.begin(BondedSites { bonds, ghosts, sites }, kernels, support, self.plane);
        packed.frames.clear();
        packed.control.frames.clear();
        self.solids.begin();
        for k in 0..self.solids.len() {
            let rows = world.body(self.solids.id(k)).rows.clone();
            let of_body = BodyPass { body: k, view: &view, rows, part };
            self.pass_over_body(of_body, packed, &mut columns, fit)?;
        }
        packed.hessian.share();
        self.add_differences(&view, packed, part.dt)?;
        packed.share_stresses();
        packed.fill_ghost_stresses();
        Ok(())
    }

    /// Runs the pass over a body.
    fn pass_over_body(
        &mut self,
        of_body: BodyPass<'_>,
        packed: &mut UpdatedRows,
        columns: &mut SolidColumns<'_>,
        fit: Option<&ReferenceFit>,
    ) -> Result<(), MissingColumn> {
        let (k, rows, plane) = (of_body.body, of_body.rows.clone(), self.plane);
        let reference_volume = of_body.view.read::<ReferenceVolume>()?;
        let UpdatedRows {
            bonds,
            sites,
            gradient,
            stresses,
            self_force,
            frames,
            follows,
            hessian,
            control,
            ..
        } = &mut *packed;
        let (follows, is_apart) = (follows[k], control.is_apart[k]);
        let middle = rows.start + rows.len() / 2;
        share_picked(&mut columns.deformation[middle..=middle], &[middle as u32], &rows);
        let moved = |sites: &[PackedParticle]| {
            AffineFrame::of(rows.end, &columns.deformation[middle].0, &sites[middle])
        };
        let frame = if follows { AffineFrame::at_rest(rows.end) } else { moved(sites) };
        let of_control = if is_apart { moved(&control.sites) } else { AffineFrame::at_rest(rows.end) };
        frames.push(frame);
        control.frames.push(of_control);
        let own_control = if is_apart { rows.clone() } else { 0..0 };
        let control_pass =
            ControlPass { bonds: &control.bonds, sites: &control.sites, frame: of_control, plane };
        let pass = UpdatedGradientPass {
            bonds,
            sites,
            fit,
            gradient: follows.then_some(&gradient[..]),
            control: is_apart.then_some(control_pass),
            reference_volume: bytemuck::cast_slice(&reference_volume),
            frame: &frame,
            plane,
        };
        let own = GradientRows {
            stresses: &mut stresses[rows.clone()],
            self_force: &mut self_force[rows.clone()],
            control: &mut control.stresses[own_control.clone()],
            control_force: &mut control.self_force[own_control],
            hessian: hessian.block(k, &rows),
        };
        self.solids.run(of_body, columns, own, &|law, rows, own, block| pass.block(law, rows, own, block));
        Ok(())
    }

    /// Adds what differences of second derivatives put into the corrected stresses, after the stress of all
    /// bodies.
    fn add_differences(
        &mut self,
        view: &PhaseView<'_>,
        packed: &mut UpdatedRows,
        dt: f64,
    ) -> Result<(), StepError> {
        let plane = self.plane;
        let UpdatedRows { bonds, ghosts, sites, frames, stresses, self_force, hessian, control, .. } = packed;
        let folded = FrameIndifferent { bonds, ghosts, sites, frames, stresses, self_force, hessian, plane };
        folded.run(view, &mut self.solids, dt, |k| !control.is_apart[k])?;
        let Control {
            is_apart,
            bonds: own_bonds,
            sites: own_sites,
            stresses: own_stresses,
            self_force: own_force,
            frames: own_frames,
            ..
        } = &mut *control;
        let apart = FrameIndifferent {
            bonds: own_bonds,
            ghosts,
            frames: own_frames,
            sites: own_sites,
            stresses: own_stresses,
            self_force: own_force,
            hessian,
            plane,
        };
        apart.run(view, &mut self.solids, dt, |k| is_apart[k])?;
        hessian.add_vidal_stress(BondedSites { bonds, ghosts, sites }, stresses, self_force);
        Ok(())
    }

    /// Whether the reference of body `k` is to be updated after the pass of this step. A body whose reference
    /// could only follow by separating neighbours that its material holds together keeps the one that it has.
    fn is_due(&mut self, k: usize, step: &mut Step<'_>, packed: &UpdatedRows) -> Result<bool, MissingColumn> {
        let body = step.world.body(self.solids.id(k));
        let (rows, number) = (body.rows.clone(), step.part.number());
        if self.keeps[k] || !self.rules[k].is_due(rows.clone(), number, packed) {
            return Ok(false);
        }
        let view = step.world.phase(self.phase);
        let (original, deformation) =
            (view.read::<ReferencePosition>()?, view.read::<DeformationGradient>()?);
        let original = bytemuck::cast_slice(&original);
        self.keeps[k] = self.rules[k].would_separate(rows, original, &deformation, packed);
        if self.keeps[k] {
            step.warnings.push(format!(
                "body `{}` keeps its reference from {} on: an update would separate neighbours, which its elastic material holds together; `update: Automatic`, the default, makes none in such a body",
                body.name,
                quantity(step.clock.time, "s")
            ));
        }
        Ok(!self.keeps[k])
    }

    /// Makes the present configuration the reference of the bodies that are due, among them those of which
    /// particles have been removed or have failed.
    ///
    /// What the second kick of the step takes from the motion by new forces, where it uses these already, is
    /// booked with the change of the stored energies.
    fn update(
        &mut self,
        step: &mut Step<'_>,
        packed: &mut UpdatedRows,
        is_due: &[bool],
        has_lost: &[bool],
    ) -> Result<(), StepError> {
        let held = self.solids.stored();
        let mut kept = std::mem::take(&mut self.kept);
        self.write_forces(step.world, packed, &mut kept.before)?;
        self.move_reference(step.world, packed, is_due, &mut kept)?;
        // States of laws have advanced by this step already.
        self.pass(step.world, packed, SolidPart::REPEATED, Some(&kept.fit))?;
        self.solids.book_repeated(step)?;
        packed.warn_of_released(step)?;
        let mut after = std::mem::take(&mut packed.force);
        self.write_forces(step.world, packed, &mut after)?;
        // At the start there is no kick before the first one.
        let at_once = (0..has_lost.len()).filter(|&k| has_lost[k] || step.clock.dt == 0.0);
        let rows = at_once.map(|k| step.world.body(self.solids.id(k)).rows.clone());
        step.resources.of_mut(self.change).note(&kept.before, &mut after, rows);
        let account = step.ledger.account(ACCOUNT, AccountKind::Dissipated);
        self.solids.book_change(step, account, &held, &kept.before, &after)?;
        (packed.force, packed.has_force) = (after, true);
        self.kept = kept;
        Ok(())
    }

    /// Places the reference of the bodies that are due where their particles are, as nearly as it may be.
    fn place_reference(
        &self,
        world: &World,
        packed: &UpdatedRows,
        is_due: &[bool],
        relaxation: &mut ReferenceRelaxation,
    ) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        let (position, original) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
        let (deformation, start) = (view.read::<DeformationGradient>()?, view.read::<ReferenceVolume>()?);
        let damage = view.read::<Damage>().ok();
        let mut reference = view.write::<UpdatedReference>()?;
        let mut volume = view.write::<UpdatedVolume>()?;
        let mut metric = view.write::<UpdatedMetric>()?;
        for k in (0..is_due.len()).filter(|&k| is_due[k]) {
            let rows = world.body(self.solids.id(k)).rows.clone();
            let (position, deformation, start) = (&position[..], &deformation[..], &start[..]);
            fill_rows(&mut reference[rows.clone()], rows.start, |row| UpdatedReference(position[row].0));
            fill_rows(&mut metric[rows.clone()], rows.start, |row| {
                UpdatedMetric(Ellipsoid::following(&deformation[row].0))
            });
            fill_rows(&mut volume[rows.clone()], rows.start, |row| {
                UpdatedVolume(start[row].0 * deformation[row].0.determinant())
            });
            if self.is_smoothed(k) {
                let (damage, h) = (damage.as_deref(), self.rules[k].h);
                let (original, plane) = (bytemuck::cast_slice(&original), self.plane);
                let by = ReferenceSmoothing { packed, original, deformation, damage, h, plane };
                relaxation.smooth(&by, rows, &mut reference);
            }
        }
        Ok(())
    }

    /// Gives the bodies that are due another reference, with the same deformation gradient.
    fn move_reference(
        &self,
        world: &World,
        packed: &mut UpdatedRows,
        is_due: &[bool],
        kept: &mut KeptMemory,
    ) -> Result<(), StepError> {
        self.place_reference(world, packed, is_due, &mut kept.relaxation)?;
        let view = world.phase(self.phase);
        let deformation = view.read::<DeformationGradient>()?;
        let damage = view.read::<Damage>().ok();
        loop {
            let renewed = packed.renew(world, self.phase, &self.estimates(), &self.removed);
            renewed.map_err(|error| error.in_step(world))?;
            let mut support = view.write::<SupportRadius>()?;
            if !widen(packed, world, damage.as_deref(), &mut support) {
                break;
            }
        }
        packed.pack_reference(world, self.phase)?;
        let bodies = (0..is_due.len()).map(|k| world.body(self.solids.id(k)).rows.clone());
        kept.fit.make(&packed.bonds, &packed.sites, self.plane, bodies);
        let changes = &kept.fit.gradient[..];
        {
            let mut gradient = view.write::<UpdatedGradient>()?;
            for k in (0..is_due.len()).filter(|&k| is_due[k]) {
                let (rows, deformation) = (world.body(self.solids.id(k)).rows.clone(), &deformation[..]);
                let is_smoothed = self.is_smoothed(k);
                fill_rows(&mut gradient[rows.clone()], rows.start, |row| {
                    let since = DMat3::IDENTITY + changes[row];
                    let since = if is_smoothed { since } else { DMat3::IDENTITY };
                    UpdatedGradient(since.inverse() * deformation[row].0)
                });
            }
        }
        packed.take_gradients(world, self.phase, &self.failed)?;
        Ok(())
    }

    /// Whether the reference of body `k` is that of its particles without what no gradient sees. The form of
    /// the paper sees it itself, and without a stabilizer nothing would hold places and reference together.
    fn is_smoothed(&self, k: usize) -> bool {
        self.solids.iter().nth(k).is_some_and(|body| {
            body.is_stabilized() && body.hessian.is_none_or(|term| term.form != HessianForm::Vidal2007)
        })
    }

    /// Writes the internal forces of the last pass.
    fn write_forces(
        &self,
        world: &World,
        packed: &UpdatedRows,
        force: &mut Vec<Force>,
    ) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        force.resize(view.len(), Force::default());
        force::write(packed, &view.read::<Mass>()?, self.plane, force);
        Ok(())
    }
}

impl UpdatedSolids {
    /// Leaves out the particles removed or failed since the last update, and notes the bodies with losses.
    fn update_lost(&mut self, world: &World, has_lost: &mut [bool]) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        let removed = view.read::<Removed>()?;
        let count = count_rows(&removed, |row| *row != Removed::NO);
        let damage = view.read::<Damage>().ok();
        let damage = damage.as_deref().unwrap_or_default();
        let failed = count_rows(damage, has_failed);
        if count == self.removed.len() && failed == self.failed.len() {
            return Ok(());
        }
        let take = |rows: &mut Vec<u32>, is_lost: &dyn Fn(usize) -> bool, all: usize| {
            let lost = (0..all as u32).filter(|&row| is_lost(row as usize)).collect();
            std::mem::replace(rows, lost)
        };
        let before = [
            take(&mut self.removed, &|row| removed[row] != Removed::NO, removed.len()),
            take(&mut self.failed, &|row| has_failed(&damage[row]), damage.len()),
        ];
        for (k, has_lost) in has_lost.iter_mut().enumerate() {
            let rows = &world.body(self.solids.id(k)).rows;
            let now = [&self.removed, &self.failed];
            *has_lost =
                now.into_iter().zip(&before).any(|(now, before)| within(now, rows) != within(before, rows));
        }
        let mut applied = view.write::<AppliedLosses>()?;
        AppliedLosses::write(&mut applied, Loss::Removed, &self.removed);
        AppliedLosses::write(&mut applied, Loss::Failed, &self.failed);
        Ok(())
    }

    /// Restores the losses that the sums had left out from their column, after a restart.
    fn read_applied_losses(&mut self, world: &World) -> Result<(), MissingColumn> {
        let applied = world.phase(self.phase).read::<AppliedLosses>()?;
        self.removed = AppliedLosses::rows(&applied, Loss::Removed);
        self.failed = AppliedLosses::rows(&applied, Loss::Failed);
        Ok(())
    }
}

/// Number of rows that are within a range; they are ascending.
fn within(rows: &[u32], range: &Range<usize>) -> usize {
    let below = |end: usize| rows.partition_point(|&row| (row as usize) < end);
    below(range.end) - below(range.start)
}

impl Run for UpdatedSolids {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let mut packed = resources.solid_rows_mut::<UpdatedRows>(self.phase);
        if std::mem::take(&mut self.is_stale) {
            self.read_applied_losses(step.world)?;
            let renewed = packed.renew(step.world, self.phase, &self.estimates(), &self.removed);
            renewed.map_err(|error| error.in_step(step.world))?;
            packed.take_gradients(step.world, self.phase, &self.failed)?;
        }
        resources.of_mut(self.change).forget();
        self.pass(step.world, &mut packed, SolidPart::of(step), None)?;
        self.solids.book(step)?;
        // From the first step on, so that it has its place among the energies.
        step.ledger.account(ACCOUNT, AccountKind::Dissipated);
        let mut due = std::mem::take(&mut self.due);
        due.clear();
        due.resize(self.solids.len(), false);
        self.update_lost(step.world, &mut due)?;
        self.has_lost.clone_from(&due);
        for (k, due) in due.iter_mut().enumerate() {
            if !*due && self.is_due(k, step, &packed)? {
                *due = true;
                packed.warn_of_side(k, step);
            }
        }
        if due.contains(&true) {
            let has_lost = std::mem::take(&mut self.has_lost);
            self.update(step, &mut packed, &due, &has_lost)?;
            self.has_lost = has_lost;
        }
        self.due = due;
        let UpdatedRows { stable_step, gradient, kernels, follows, bonds, .. } = &*packed;
        let world = step.world;
        let since = |k: usize| follows[k].then(|| &gradient[world.body(kernels[k].body).rows.clone()]);
        self.solids.limit_since(step, stable_step, &bonds.carried, since)
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&(self.solids.steps(), &self.keeps)).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok((steps, keeps)) = postcard::from_bytes::<(Vec<BodyStep>, Vec<bool>)>(state) else {
            return false;
        };
        self.keeps = keeps;
        self.is_stale = true;
        self.solids.restore_steps(&steps)
    }
}

fn has_failed(damage: &Damage) -> bool {
    damage.0 >= 1.0
}
