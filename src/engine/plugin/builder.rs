//! The interface of a plugin while a simulation is built.

use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use glam::DVec3;

use super::error::SetupError;
use super::handed::Contributions;
use super::offers::BodyKind;
use super::plan::BodyPlan;
use super::prescription::Prescription;
use super::selection::{self, Selection};
use super::setup::{Setup, SetupStep};
use super::touching_pairs::TouchingPairs;
use crate::materials::{Law, SolidLaw};
use crate::neighbors::Periodic;
use crate::notation::place;
use crate::scene::{Dimension, Scene, Select};
use crate::schedule::{Shared, SharedValues, Stage, Step, System};
use crate::shapes::{Shape, Surface};
use crate::world::{BodyId, BodySet, Column, ColumnSet, PhaseId};

/// A simulation under construction: bodies are placed, columns not yet spawned. Plugins add systems, terms,
/// columns.
pub struct SimBuilder<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) folder: &'s Path,
    pub(crate) bodies: Vec<BodyPlan>,
    pub(crate) phases: Vec<(&'static str, ColumnSet)>,
    pub(crate) systems: Vec<System>,
    pub(crate) setup: Vec<SetupStep>,
    pub(crate) scope: BodySet,
    /// The body whose plugin is being built; none for a plugin of the scene.
    pub(crate) own_body: Option<BodyId>,
    pub(crate) sub_cycled: Vec<PhaseId>,
    /// Things to tell the user; also of selections, which are made through a shared reference.
    pub(crate) warnings: RefCell<Vec<String>>,
    pub(crate) references: Vec<String>,
    /// Of particles with a prescribed motion the numbers of those who prescribe it, by axis.
    pub(crate) prescribed: BTreeMap<(PhaseId, u32), [Option<usize>; 3]>,
    pub(crate) prescriptions: Vec<Prescription>,
    /// Bodies that conditions may carry, by the axis along which they do.
    pub(crate) carried: [BTreeSet<BodyId>; 3],
    /// Bodies that selections hold.
    pub(crate) held: RefCell<Vec<BodyId>>,
    pub(crate) handed: Contributions,
    /// The pairs of bodies in contact, once they have been asked for.
    pub(super) touching: OnceCell<Arc<TouchingPairs>>,
    /// Shared values of systems.
    pub(crate) shared: SharedValues,
}

impl<'s> SimBuilder<'s> {
    pub(crate) fn new(
        scene: &'s Scene,
        folder: &'s Path,
        bodies: Vec<BodyPlan>,
        phases: Vec<(&'static str, ColumnSet)>,
    ) -> Self {
        Self {
            scene,
            folder,
            bodies,
            phases,
            systems: Vec::new(),
            touching: OnceCell::new(),
            setup: Vec::new(),
            scope: BodySet::default(),
            own_body: None,
            sub_cycled: Vec::new(),
            warnings: RefCell::default(),
            references: Vec::new(),
            prescribed: BTreeMap::new(),
            prescriptions: Vec::new(),
            carried: <[BTreeSet<BodyId>; 3]>::default(),
            held: RefCell::default(),
            handed: Contributions::default(),
            shared: SharedValues::default(),
        }
    }

    /// The scene.
    pub fn scene(&self) -> &'s Scene {
        self.scene
    }

    /// The folder that files named in the scene are relative to.
    pub fn folder(&self) -> &'s Path {
        self.folder
    }

    /// Plane strain or three dimensions.
    pub fn dimension(&self) -> Dimension {
        self.scene.dimension
    }

    /// Acceleration of gravity, m/s2.
    pub fn gravity(&self) -> DVec3 {
        self.scene.gravity.0
    }

    /// Work that gravity could do on all bodies but boundaries along their own heights, J. What is at rest
    /// has hardly any other energy.
    pub fn work_of_weight(&self) -> f64 {
        let of = |body: &BodyPlan| {
            let height = body.bounds.extent().abs().dot(self.gravity().abs());
            if height.is_finite() { body.mass() * height } else { 0.0 }
        };
        self.bodies().iter().filter(|body| body.kind != BodyKind::Boundary).map(of).sum()
    }

    /// The periodic axes of the scene.
    pub fn periodic(&self) -> Periodic {
        let Some(domain) = &self.scene.domain else { return Periodic::NONE };
        let mut axes = [false; 3];
        domain.periodic.iter().for_each(|axis| axes[axis.index()] = true);
        // Bounds of domains are checked with the scene.
        Periodic::new(domain.min.0, domain.max.0, axes).unwrap_or(Periodic::NONE)
    }

    /// All bodies in scene order.
    pub fn bodies(&self) -> &[BodyPlan] {
        &self.bodies
    }

    /// A body.
    pub fn body(&self, id: BodyId) -> &BodyPlan {
        &self.bodies[id.0]
    }

    /// The bodies that the plugin being built is meant for: one body for a plugin of a body, else all bodies
    /// that do not have a plugin of that name themselves.
    pub fn scope(&self) -> &BodySet {
        &self.scope
    }

    /// The body in whose own list the plugin stands; none in that of the scene.
    pub fn own_body(&self) -> Option<BodyId> {
        self.own_body
    }

    /// The phases of the bodies of the scope.
    pub fn phases_of(&self, bodies: &BodySet) -> Vec<PhaseId> {
        let mut phases: Vec<PhaseId> = bodies.iter().map(|id| self.body(id).phase).collect();
        phases.sort_unstable();
        phases.dedup();
        phases
    }

    /// The columns of a phase, as far as they have been added.
    pub fn columns(&self, phase: PhaseId) -> &ColumnSet {
        &self.phases[phase.0].1
    }

    /// Gives all particles of the phases of the scope a column, zero at the start.
    pub fn add_column<T: Column>(&mut self) {
        self.add_column_to::<T>(&self.scope.clone());
    }

    /// Gives all particles of the phases of the given bodies a column, zero at the start.
    pub fn add_column_to<T: Column>(&mut self, bodies: &BodySet) {
        for phase in self.phases_of(bodies) {
            self.phases[phase.0].1.add::<T>();
        }
    }

    /// Puts a law in the place of the one that a body's material has, made from that: damage about any solid.
    ///
    /// # Errors
    /// The material of the body is not a solid; what `wrap` finds wrong.
    pub fn wrap_solid_law<L: SolidLaw + 'static>(
        &mut self,
        id: BodyId,
        wrap: impl FnOnce(Arc<dyn SolidLaw>) -> Result<L, SetupError>,
    ) -> Result<(), SetupError> {
        let law = wrap(Arc::clone(self.body(id).solid_law()?))?;
        law.state(&mut self.phases[self.bodies[id.0].phase.0].1);
        self.bodies[id.0].material.law = Law::Solid(Arc::new(law));
        Ok(())
    }

    /// Adds a system.
    pub fn add_system(&mut self, system: System) {
        let system = system.added_by(self.handed.by.clone());
        let phases = system.bodies_without_phases().map(|bodies| self.phases_of(bodies));
        self.systems.push(match phases {
            Some(phases) => system.on_phases(phases),
            None => system,
        });
    }

    /// Lets these phases take sub-steps, as many as their limits ask for, in the step of all others. What
    /// acts between the two must be frozen in the long step.
    pub fn sub_cycle(&mut self, phases: impl IntoIterator<Item = PhaseId>) {
        self.sub_cycled.extend(phases);
    }

    /// Keeps the time step at or below `dt`, s; `by` names the cause to the user.
    pub fn limit_step(&mut self, dt: f64, by: &'static str) {
        self.add_system(System::new(
            Stage::External,
            format!("{by}_step_limit"),
            move |step: &mut Step<'_>| {
                step.limits.propose(dt, by);
                Ok(())
            },
        ));
    }

    /// Gives a value that several systems share a place, where they find it by
    /// [`Resources::of`](crate::schedule::Resources::of).
    pub fn share<T: Send + 'static>(&mut self, value: T) -> Shared<T> {
        self.shared.add(value)
    }

    /// The value in a place that [`SimBuilder::share`] gave, while the simulation is put together.
    pub fn shared_mut<T: Send + 'static>(&mut self, place: Shared<T>) -> &mut T {
        self.shared.of_mut(place)
    }

    /// Adds something to do once, after the particles are spawned and before the first step.
    pub fn add_setup(&mut self, step: impl FnOnce(&mut Setup<'_>) -> Result<(), SetupError> + 'static) {
        self.setup.push((self.handed.by.clone(), Box::new(step)));
    }

    /// The rows that a selection means; `field` is its name among the parameters, for errors. The bodies keep
    /// the order of their rows through the run: fluids among them are not sorted, which makes them slower.
    pub fn select(&self, select: &Select, field: &str) -> Result<Selection, SetupError> {
        let selection = self.select_at_start(select, field)?;
        self.held.borrow_mut().extend(selection.parts.iter().map(|(body, _)| *body));
        Ok(selection)
    }

    /// The rows of a selection, valid until the first step: for uses at the start only, or with
    /// [`World::rows_now`](crate::world::World::rows_now) later. An error at `field` if nothing is selected.
    pub fn select_at_start(&self, select: &Select, field: &str) -> Result<Selection, SetupError> {
        let selection = selection::resolve(select, field, &self.bodies, self.scene.dimension, self.folder)?;
        let mut warnings = self.warnings.borrow_mut();
        let remote = selection.remote(select, &self.bodies).filter(|warning| !warnings.contains(warning));
        warnings.extend(remote);
        drop(warnings);
        Ok(selection)
    }

    /// The surface of a shape, which a tool has; `field` is the shape's name among the parameters, for
    /// errors.
    pub fn surface(&self, shape: &Shape, field: &str) -> Result<Box<dyn Surface>, SetupError> {
        shape.surface(self.scene.dimension, self.folder, field).map_err(|error| {
            SetupError::parameter(error.path.clone(), error.message(), error.kind.help().unwrap_or_default())
        })
    }

    /// Sets the inverse mass of the selected particles along the given axes to zero, so that a condition can
    /// prescribe their motion; `by` is the name of the condition, or its prescription. Two conditions on one
    /// axis of one particle are an error unless both give the same prescription.
    pub fn prescribe(
        &mut self,
        selection: &Selection,
        axes: [bool; 3],
        by: impl Into<Prescription>,
    ) -> Result<(), SetupError> {
        let (by, end, own) = (by.into(), self.scene.time.end, self.prescriptions.len());
        for (id, rows) in &selection.parts {
            let body = &self.bodies[id.0];
            for &row in rows {
                let taken = self.prescribed.entry((body.phase, row)).or_default();
                let number = row as usize - body.rows.start;
                let point = body.sites[number].position;
                for axis in (0..3).filter(|&axis| axes[axis]) {
                    let before = taken[axis].replace(own).map(|other| &self.prescriptions[other]);
                    if let Some(other) = before.filter(|other| !by.agrees(other, axis, point, end)) {
                        let name = ["x", "y", "z"][axis];
                        return Err(SetupError::parameter(
                            "on",
                            format!(
                                "two conditions prescribe the {name} motion of one particle: `{}` and `{}` \
                                 both hold particle {number} of body `{}` at {}, and differ",
                                other.by(),
                                by.by(),
                                body.name,
                                place(point)
                            ),
                            "let the selections not overlap, leave the axis to one of them, or give both the same value",
                        ));
                    }
                }
            }
        }
        self.prescriptions.push(by);
        Ok(())
    }

    /// Notes that a condition moves, holds or loads the selected particles along the given axes, and so may
    /// carry the weight of their bodies.
    pub fn carry(&mut self, selection: &Selection, axes: [bool; 3]) {
        for axis in (0..3).filter(|&axis| axes[axis]) {
            self.carried[axis].extend(selection.parts.iter().map(|(body, _)| *body));
        }
    }

    /// Whether a condition may carry a body against this acceleration.
    pub fn is_carried(&self, body: BodyId, against: DVec3) -> bool {
        (0..3).any(|axis| against[axis] != 0.0 && self.carried[axis].contains(&body))
    }

    /// Tells the user something that is worth looking at; repeated at the end of the run.
    pub fn warn(&mut self, text: impl Into<String>) {
        self.warnings.get_mut().push(text.into());
    }

    /// States the source of a method in use.
    pub fn cite(&mut self, reference: impl Into<String>) {
        let reference = reference.into();
        if !reference.is_empty() && !self.references.contains(&reference) {
            self.references.push(reference);
        }
    }
}
