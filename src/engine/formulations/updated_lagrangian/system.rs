//! The system of the first pass, and of updates of the reference.

use glam::{DMat3, DVec3};

use super::columns::{UpdatedGradient, UpdatedMetric, UpdatedReference, UpdatedVolume};
use super::force;
use super::gradient::{GradientPass, GradientRows};
use super::lost_neighbors::widen;
use super::parameters::{Update, UpdatedLagrangian};
use super::phase::UpdatedRows;
use super::smoothed_reference::{Smoothing, increments, smooth};
use crate::formulations::total_lagrangian::{
    BondedSites, Ellipsoid, Ellipsoids, Frame, FrameIndifferent, Site,
};
use crate::parallel::{Largest, for_each_block, sum_over_blocks};
use crate::schedule::{AccountKind, Run, Step, StepError};
use crate::solids::{
    BodyPass, HessianForm, SolidBodies, SolidBody, SolidColumns, SolidPart, StepEstimate, count_rows,
    fill_rows,
};
use crate::world::{
    BodyId, Damage, DeformationGradient, Force, Mass, MissingColumn, PhaseId, PhaseView, Position,
    ReferencePosition, ReferenceVolume, Removed, SupportRadius, World,
};

/// Account of what an update of the reference changes of the stored energies.
const ACCOUNT: &str = "reference_update";
/// Steps between two looks at the lengths of pairs: they change slowly against the stable step.
const INTERVAL: u64 = 4;

/// The system.
pub(super) struct UpdatedSolids {
    phase: PhaseId,
    /// Plane strain.
    plane: bool,
    solids: SolidBodies,
    /// Of every body: when its reference is updated, and the smoothing length, m.
    updates: Vec<(Update, f64)>,
    /// Of every body: whether its reference is updated in this step.
    due: Vec<bool>,
    /// Removed rows that the reference knows of, ascending.
    removed: Vec<u32>,
    /// Number of failed particles that it knows of.
    failed: u64,
    /// Whether the lists are those of another reference than that of the columns: after a restart.
    is_stale: bool,
}

impl UpdatedSolids {
    pub fn new(
        phase: PhaseId,
        plane: bool,
        solids: SolidBodies,
        bodies: &[(BodyId, UpdatedLagrangian)],
        spacing: impl Fn(BodyId) -> f64,
    ) -> Self {
        let update = |(id, own): &(BodyId, UpdatedLagrangian)| (own.update, 0.5 * own.support * spacing(*id));
        let updates = bodies.iter().map(update).collect();
        Self {
            phase,
            plane,
            solids,
            updates,
            due: Vec::new(),
            removed: Vec::new(),
            failed: 0,
            is_stale: false,
        }
    }

    /// What the stable step of each body depends on.
    pub fn estimates(&self) -> Vec<StepEstimate> {
        self.solids.iter().map(|body| body.estimate).collect()
    }

    /// Whether plugins have handed in folded terms.
    pub fn has_control(&self) -> bool {
        self.solids.has_terms() || self.solids.iter().any(SolidBody::has_hessian_residual)
    }

    /// Runs the pass over all bodies.
    fn pass(
        &mut self,
        world: &World,
        packed: &mut UpdatedRows,
        part: SolidPart<'_>,
    ) -> Result<(), StepError> {
        let view = world.phase(self.phase);
        pack(world, self.phase, packed)?;
        let reference_volume = view.read::<ReferenceVolume>()?;
        let mut columns = SolidColumns::of(&view)?;
        let support = view.read::<SupportRadius>()?;
        let UpdatedRows {
            bonds,
            ghosts,
            hessian,
            kernels,
            sites,
            originals,
            gradient,
            stresses,
            control,
            control_bonds,
            self_force,
            frames,
            ..
        } = &mut *packed;
        let (support, plane) = (bytemuck::cast_slice(&support), self.plane);
        hessian.begin(BondedSites { bonds, ghosts, sites }, kernels, support, plane);
        frames.clear();
        self.solids.begin();
        for k in 0..self.solids.len() {
            let rows = world.body(self.solids.id(k)).rows.clone();
            let frame = Frame::at_rest(rows.end);
            frames.push(frame);
            let reference_volume = bytemuck::cast_slice(&reference_volume);
            let (bonds, control_bonds, frame) = (&*bonds, &*control_bonds, &frame);
            let pass = GradientPass {
                bonds,
                control_bonds,
                sites,
                originals,
                gradient,
                reference_volume,
                frame,
                plane,
            };
            let own = GradientRows {
                stresses: &mut stresses[rows.clone()],
                control: if control.is_empty() { &mut [] } else { &mut control[rows.clone()] },
                self_force: &mut self_force[rows.clone()],
                hessian: hessian.block(k, &rows),
            };
            let of_body = BodyPass { body: k, view: &view, rows, part };
            self.solids
                .run(of_body, &mut columns, own, &|law, rows, own, block| pass.block(law, rows, own, block));
        }
        self.add_differences(&view, packed, part.dt)?;
        packed.fill_ghost_stresses();
        Ok(())
    }

    /// Adds what differences of second derivatives put into the corrected stresses, after the stress of all bodies.
    fn add_differences(
        &mut self,
        view: &PhaseView<'_>,
        packed: &mut UpdatedRows,
        dt: f64,
    ) -> Result<(), StepError> {
        let UpdatedRows { bonds, ghosts, sites, stresses, self_force, hessian, .. } = packed;
        let difference = FrameIndifferent {
            bonds: &packed.control_bonds,
            ghosts,
            sites: &packed.originals,
            stresses: &mut packed.control,
            self_force: &mut packed.control_self_force,
            hessian,
        };
        difference.run(view, &mut self.solids, dt)?;
        hessian.add_vidal_stress(BondedSites { bonds, ghosts, sites }, stresses, self_force);
        Ok(())
    }

    /// Whether the reference of body `k` is to be updated after the pass of this step.
    fn is_due(&self, k: usize, step: &Step<'_>, packed: &UpdatedRows) -> bool {
        let (update, h) = self.updates[k];
        let number = step.turn.number();
        match update {
            Update::Never => false,
            Update::Every(steps) => number > 0 && number.is_multiple_of(steps),
            Update::Adaptive { change } => {
                let rows = step.world.body(self.solids.id(k)).rows.clone();
                number.is_multiple_of(INTERVAL) && has_changed(rows, packed, change * h)
            }
        }
    }

    /// Makes the present configuration the reference: of the bodies that are due, and of all where particles have been removed or have failed.
    ///
    /// The second kick of the step uses the new forces, the motion up to here was made by the old ones: what that takes from the motion is booked with the
    /// change of the stored energies.
    fn update(
        &mut self,
        step: &mut Step<'_>,
        packed: &mut UpdatedRows,
        is_due: &[bool],
    ) -> Result<(), StepError> {
        let held = self.solids.stored();
        let before = self.forces(step.world, packed)?;
        self.move_reference(step.world, packed, is_due)?;
        // States of laws have advanced by this step already.
        self.pass(step.world, packed, SolidPart::REPEATED)?;
        self.solids.book(step)?;
        packed.warn_of_released(step);
        let after = self.forces(step.world, packed)?;
        let account = step.ledger.account(ACCOUNT, AccountKind::Dissipated);
        self.solids.book_change(step, account, &held, &before, &after)
    }

    /// Gives the bodies that are due another reference, with the same deformation gradient.
    fn move_reference(
        &self,
        world: &World,
        packed: &mut UpdatedRows,
        is_due: &[bool],
    ) -> Result<(), StepError> {
        let view = world.phase(self.phase);
        let position = view.read::<Position>()?;
        let deformation = view.read::<DeformationGradient>()?;
        let damage = view.read::<Damage>().ok();
        let due = |k: &usize| is_due[*k];
        {
            let mut reference = view.write::<UpdatedReference>()?;
            let mut volume = view.write::<UpdatedVolume>()?;
            let mut metric = view.write::<UpdatedMetric>()?;
            let start = view.read::<ReferenceVolume>()?;
            for k in (0..is_due.len()).filter(due) {
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
                    let (damage, h) = (damage.as_deref(), self.updates[k].1);
                    smooth(&Smoothing { packed, deformation, damage, h }, rows, &mut reference);
                }
            }
        }
        loop {
            let renewed = packed.renew(world, self.phase, &self.estimates(), &self.removed);
            renewed.map_err(|error| error.in_step(world))?;
            let mut support = view.write::<SupportRadius>()?;
            if !widen(packed, world, damage.as_deref(), &mut support) {
                break;
            }
        }
        pack(world, self.phase, packed)?;
        let changes = increments(packed, self.plane);
        {
            let mut gradient = view.write::<UpdatedGradient>()?;
            for k in (0..is_due.len()).filter(due) {
                let (rows, deformation) = (world.body(self.solids.id(k)).rows.clone(), &deformation[..]);
                let is_smoothed = self.is_smoothed(k);
                fill_rows(&mut gradient[rows.clone()], rows.start, |row| {
                    let since = DMat3::IDENTITY + changes[row];
                    let since = if is_smoothed { since } else { DMat3::IDENTITY };
                    UpdatedGradient(since.inverse() * deformation[row].0)
                });
            }
        }
        packed.take_gradients(world, self.phase)?;
        Ok(())
    }

    /// Whether the reference of body `k` is that of its particles without what no gradient sees. The form of the paper sees it itself, and without a stabilizer nothing
    /// would hold places and reference together.
    fn is_smoothed(&self, k: usize) -> bool {
        self.solids.iter().nth(k).is_some_and(|body| {
            body.is_stabilized() && body.hessian.is_none_or(|term| term.form != HessianForm::Vidal2007)
        })
    }

    /// The internal forces of the last pass.
    fn forces(&self, world: &World, packed: &UpdatedRows) -> Result<Vec<Force>, MissingColumn> {
        let view = world.phase(self.phase);
        let mut force = vec![Force::default(); view.len()];
        force::write(packed, &view.read::<Mass>()?, DVec3::ZERO, self.plane, &mut force);
        Ok(force)
    }
}

impl UpdatedSolids {
    /// Takes up what has been removed or has failed since the last update; returns whether anything has.
    fn take_up_lost(&mut self, world: &World) -> Result<bool, MissingColumn> {
        let view = world.phase(self.phase);
        let removed = view.read::<Removed>()?;
        let count = count_rows(&removed, |row| *row != Removed::NO);
        let damage = view.read::<Damage>().ok();
        let failed = damage.map_or(0, |damage| count_rows(&damage, has_failed));
        let has_lost = count != self.removed.len() || failed as u64 != self.failed;
        if has_lost {
            self.removed.clear();
            self.removed
                .extend((0..removed.len() as u32).filter(|&row| removed[row as usize] != Removed::NO));
            self.failed = failed as u64;
        }
        Ok(has_lost)
    }
}

impl Run for UpdatedSolids {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let mut packed = resources.solid_rows_mut::<UpdatedRows>(self.phase);
        if std::mem::take(&mut self.is_stale) {
            let renewed = packed.renew(step.world, self.phase, &self.estimates(), &self.removed);
            renewed.map_err(|error| error.in_step(step.world))?;
        }
        self.pass(step.world, &mut packed, SolidPart::of(step))?;
        self.solids.book(step)?;
        // From the first step on, so that it has its place among the energies.
        step.ledger.account(ACCOUNT, AccountKind::Dissipated);
        let has_lost = self.take_up_lost(step.world)?;
        let mut due = std::mem::take(&mut self.due);
        due.clear();
        due.extend((0..self.solids.len()).map(|k| has_lost || self.is_due(k, step, &packed)));
        if due.contains(&true) {
            self.update(step, &mut packed, &due)?;
        }
        self.due = due;
        let UpdatedRows { stable_step, gradient, kernels, follows, .. } = &*packed;
        let world = step.world;
        let since = |k: usize| follows[k].then(|| &gradient[world.body(kernels[k].body).rows.clone()]);
        self.solids.limit_since(step, stable_step, since)
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&(self.solids.stretch_factors(), &self.removed, self.failed)).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        type Saved = (Vec<f64>, Vec<u32>, u64);
        let Ok((factors, removed, failed)) = postcard::from_bytes::<Saved>(state) else {
            return false;
        };
        (self.removed, self.failed) = (removed, failed);
        self.is_stale = true;
        self.solids.restore_stretch_factors(&factors)
    }
}

fn has_failed(damage: &Damage) -> bool {
    damage.0 >= 1.0
}

/// Fills the sites from the columns.
fn pack(world: &World, phase: PhaseId, packed: &mut UpdatedRows) -> Result<(), MissingColumn> {
    let view = world.phase(phase);
    let position = view.read::<Position>()?;
    let original = view.read::<ReferencePosition>()?;
    let reference = view.read::<UpdatedReference>()?;
    let damage = view.read::<Damage>().ok();
    let UpdatedRows { sites, pair_sites, originals, volume, origin, has_control, .. } = &mut *packed;
    let (count, origin) = (view.len(), *origin);
    let (position, original, reference) = (&position[..], &original[..], &reference[..]);
    let damage = damage.as_deref();
    let rows = (&mut sites[..count], &mut pair_sites[..count]);
    type Rows<'a> = (&'a mut [Site], &'a mut [Site]);
    for_each_block(rows, &mut Vec::new(), &|first, (sites, pair_sites): Rows<'_>| {
        for (k, (site, pair_site)) in sites.iter_mut().zip(pair_sites).enumerate() {
            let row = first + k;
            let (x, r, start) = (position[row].0, reference[row].0, original[row].0);
            *site = Site::new(r - origin, x - r, volume[row]);
            *pair_site = Site::new(start, x - start, volume[row]);
        }
    });
    if *has_control {
        let holds = |row: usize| damage.is_none_or(|damage| !has_failed(&damage[row]));
        for_each_block(&mut originals[..count], &mut Vec::new(), &|first, originals: &mut [Site]| {
            for (k, site) in originals.iter_mut().enumerate() {
                let row = first + k;
                let start = original[row].0;
                *site = Site::new(start, position[row].0 - start, if holds(row) { volume[row] } else { 0.0 });
            }
        });
    }
    packed.fill_ghost_sites();
    Ok(())
}

/// Whether a pair has changed its length by more than `most` since the last update, m.
fn has_changed(rows: std::ops::Range<usize>, packed: &UpdatedRows, most: f64) -> bool {
    let UpdatedRows { sites, bonds, ghosts, .. } = packed;
    let ellipsoids = Ellipsoids(&packed.ellipsoids);
    let first_row = rows.start;
    // A length changes by no more than the pair vector does: few pairs need a look at their ellipsoids.
    let shortest =
        packed.ellipsoids[rows.clone()].iter().map(|own| own.shortest).fold(f64::INFINITY, f64::min);
    let least = (most * shortest).powi(2);
    let largest: Largest = sum_over_blocks(&sites[rows], &|first, own: &[Site]| {
        let changes = own.iter().enumerate().flat_map(|(k, site)| {
            let i = first_row + first + k;
            bonds.row(i).filter_map(move |(j, _)| {
                let change = sites[j].displacement.xyz() - site.displacement.xyz();
                if change.length_squared() < least {
                    return None;
                }
                let length = |r_ij| ellipsoids.distance(ghosts, i, j, r_ij);
                let reference = sites[j].reference.xyz() - site.reference.xyz();
                Some((length(reference + change) - length(reference)).abs())
            })
        });
        Largest::of(changes)
    });
    largest.0 > most
}
