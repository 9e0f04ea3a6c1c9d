//! The system of the first pass over all bodies of the phase.

use super::deformation::{DeformationPass, DeformationRows};
use super::phase::{PackedRows, middle};
use super::removed::RemovedRows;
use crate::formulations::bonded::{AffineFrame, BondedSites, EdgeRows, FrameIndifferent, pack};
use crate::parallel::share_picked;
use crate::ranks;
use crate::schedule::{Run, Step, StepError};
use crate::solids::{AppliedLosses, BodyPass, BodyStep, Loss, Refits, SolidBodies, SolidColumns, SolidPart};
use crate::world::{Damage, MissingColumn, PhaseId, Removed, SupportRadius, Velocity, World};

/// The system.
pub(super) struct Deformation {
    pub(super) phase: PhaseId,
    pub(super) plane: bool,
    pub(super) solids: SolidBodies,
    pub(super) removed: RemovedRows,
    /// Rows that had failed when the step began, and have not been removed; ascending.
    pub(super) failed: Vec<u32>,
    /// Whether these rows and the bonds still have to be restored from the checkpoint of the run.
    pub(super) is_restored: bool,
}

impl Deformation {
    pub fn new(phase: PhaseId, plane: bool, solids: SolidBodies) -> Self {
        let removed = RemovedRows::default();
        Self { phase, plane, solids, removed, failed: Vec::new(), is_restored: false }
    }

    /// Leaves out the particles that have failed in the last step.
    fn update_failed(&mut self, world: &World, packed: &mut PackedRows) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        // Without terms on bonds, nothing of them crosses a crack.
        let damage = view.read::<Damage>().ok().filter(|_| self.solids.has_terms());
        let Some(damage) = damage else { return Ok(()) };
        let removed = view.read::<Removed>()?;
        let PackedRows { bonds, ghosts, cracks, .. } = packed;
        let known = self.failed.len();
        cracks.update(&mut self.failed, &damage, &removed, bonds, ghosts);
        if self.failed.len() != known {
            AppliedLosses::write(&mut view.write::<AppliedLosses>()?, Loss::Failed, &self.failed);
        }
        Ok(())
    }

    /// Packs the sites that the pass reads.
    fn pack(&self, world: &World, packed: &mut PackedRows) -> Result<(), StepError> {
        let view = world.phase(self.phase);
        if !packed.halo.is_current() {
            packed.make_halo(view.body_rows());
        }
        let PackedRows { sites, halo, origin, has_places, .. } = packed;
        let halo = (ranks::has_several() && *has_places).then_some(&*halo);
        pack(&view, *origin, self.removed.rows(), &mut sites[..view.len()], halo)?;
        *has_places = true;
        Ok(())
    }

    /// Runs the pass over all bodies.
    pub(super) fn pass(
        &mut self,
        world: &World,
        packed: &mut PackedRows,
        part: SolidPart<'_>,
    ) -> Result<(), StepError> {
        let view = world.phase(self.phase);
        self.pack(world, packed)?;
        packed.fill_ghost_sites();
        let mut columns = SolidColumns::own(&view)?;
        // Beside cracks the velocities of neighbours count too.
        let velocity = match packed.cracks.edges.is_empty() {
            true => view.read_own::<Velocity>()?,
            false => view.read::<Velocity>()?,
        };
        let support = view.read::<SupportRadius>()?;
        let PackedRows {
            bonds, ghosts, sites, stresses, self_force, frames, cracks, hessian, kernels, ..
        } = &mut *packed;
        hessian.begin(
            BondedSites { bonds, ghosts, sites },
            kernels,
            bytemuck::cast_slice(&support),
            self.plane,
        );
        frames.clear();
        self.solids.begin();
        for k in 0..self.solids.len() {
            let rows = world.body(self.solids.id(k)).rows.clone();
            let middle = middle(&rows);
            share_picked(&mut columns.deformation[middle..=middle], &[middle as u32], &rows);
            let frame = AffineFrame::of(rows.end, &columns.deformation[middle].0, &sites[middle]);
            frames.push(frame);
            let (states, plane) = (&cracks.states[..], self.plane);
            let pass =
                DeformationPass { bonds, ghosts, sites, frame: &frame, states, velocity: &velocity, plane };
            let own = DeformationRows {
                stresses: &mut stresses[rows.clone()],
                self_force: &mut self_force[rows.clone()],
                edges: EdgeRows::of(&mut cracks.edges, rows.start, rows.len()),
                hessian: hessian.block(k, &rows),
            };
            let part = SolidPart { refits: Some(self.removed.refits()), ..part };
            let pass_of_body = BodyPass { body: k, view: &view, rows, part };
            self.solids.run(pass_of_body, &mut columns, own, &|law, rows, own, block| {
                pass.run(law, rows, own, block)
            });
        }
        self.solids.iter().for_each(|body| cracks.share_edges(&world.body(body.id).rows));
        hessian.share();
        let plane = self.plane;
        let difference =
            FrameIndifferent { bonds, ghosts, sites, frames, stresses, self_force, hessian, plane };
        difference.run(&view, &mut self.solids, part.dt, |_| true)?;
        hessian.add_vidal_stress(BondedSites { bonds, ghosts, sites }, stresses, self_force);
        packed.halo.fill(&mut packed.stresses);
        packed.fill_ghost_stresses();
        packed.cracks.age_marks();
        Ok(())
    }
}

impl Run for Deformation {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let mut packed = resources.solid_rows_mut::<PackedRows>(self.phase);
        self.update_restored(step.world, &mut packed)?;
        self.update_failed(step.world, &mut packed)?;
        if !self.update_removed(step, &mut packed)? {
            self.pass(step.world, &mut packed, SolidPart::of(step))?;
            self.solids.book(step)?;
        }
        self.solids.limit(step, &packed.stable_step, &packed.bonds.carried)
    }

    fn save(&self) -> Vec<u8> {
        let steps = self.solids.steps();
        let RemovedRows { refits, released, .. } = &self.removed;
        postcard::to_stdvec(&(steps, refits.entries(), released)).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        type Saved = (Vec<BodyStep>, Vec<(u32, glam::DMat3)>, Vec<u32>);
        let Ok((steps, refits, released)) = postcard::from_bytes::<Saved>(state) else {
            return false;
        };
        (self.removed.refits, self.removed.released) = (Refits::restored(refits), released);
        self.is_restored = true;
        self.solids.restore_steps(&steps)
    }
}
