//! The system of all contacts of a scene.

use super::apart::{InContact, PairDistance};
use super::beside_held::ReachedSide;
use super::chatter::Chatter;
use super::fragile::{ContactActivity, FailingSkins, break_skins};
use super::touching::{Saved, Touching};
use crate::contact::bodies::{CONTACT, NodeTurn};
use crate::contact::response::{CHANGE_OF_SURFACE, ContactEnergy, energy};
use crate::neighbors::Periodic;
use crate::plugin::SimBuilder;
use crate::removal::LEAVING;
use crate::rigid::{RIGID_BODIES, RigidBodies, Wrench};
use crate::schedule::{AccountKind, Mode, Resources, Run, Shared, Stage, Step, StepError, System};
use crate::solids::{CORRECTED_STRESS, HeatCapacity, PACKED_SOLID};
use crate::world::{
    Body, BodyId, BodySet, Damage, DeformationGradient, Force, Mass, Mobility, Position, ReferencePosition,
    Removed, Temperature, Velocity,
};

/// Label of the system that adds them to the particles.
const CONTACT_FORCE: &str = "contact_force";

/// Pairs near each other for each body with memory from the start.
const NEIGHBORS: usize = 8;

/// The contacts of a scene, when each of them acts, and the bodies that can fail among them.
#[derive(Default)]
pub(in crate::contact) struct Planned {
    pub touching: Vec<Touching>,
    pub acts: Vec<ContactActivity>,
    pub fragile: Vec<FailingSkins>,
}

/// Adds the system of the pairs.
pub(in crate::contact) fn add(sim: &mut SimBuilder<'_>, planned: Planned, bodies: &BodySet) {
    let Planned { touching, acts, fragile } = planned;
    let phases = sim.phases_of(bodies);
    // Where no contact heats anything, temperatures are left alone.
    let heats = sim.scene().contacts.iter().any(|contact| contact.friction_heat.is_some());
    let warm = |body: BodyId| Some((body, sim.body(body).specific_heat().filter(|_| heats)?));
    let in_contact = InContact::of(bodies.iter(), &touching);
    let distance = |pair: &Touching| PairDistance::new(pair, &in_contact, |body| sim.body(body).spacing);
    let contacts = Contacts {
        specific_heats: bodies.iter().filter_map(warm).collect(),
        stored: bodies.iter().map(|body| (body, 0.0)).collect(),
        energies: Vec::with_capacity(touching.len().min(NEIGHBORS * in_contact.len())),
        acting: Vec::with_capacity(touching.len()),
        distances: touching.iter().map(distance).collect(),
        bodies: in_contact,
        periodic: sim.periodic(),
        chatter: vec![Chatter::default(); touching.len()],
        gone: Vec::new(),
        reached: bodies.iter().flat_map(|body| ReachedSide::of(sim.body(body))).collect(),
        touching,
        acts,
        fragile,
    };
    let can_break = !contacts.fragile.is_empty();
    let deforms = contacts.touching.iter().any(Touching::deforms);
    let contacts = sim.share(contacts);
    let mut system = System::new(Stage::Boundary, CONTACT, ContactSystem(contacts));
    if deforms {
        system = system.reads_near::<DeformationGradient>().touches(CORRECTED_STRESS, Mode::Adds);
    }
    if can_break {
        system = system.reads_near::<Damage>();
    }
    sim.add_system(
        system
            .on_phases(phases.clone())
            .reads_near::<Position>()
            .reads_near::<ReferencePosition>()
            .reads_near::<Velocity>()
            .reads_near::<Mobility>()
            .reads_near::<Removed>()
            .reads::<Mass>()
            .touches(PACKED_SOLID, Mode::ReadsNear)
            .touches(LEAVING, Mode::Reads)
            .touches_packed(RIGID_BODIES, Mode::Adds),
    );
    let push = move |step: &mut Step<'_>| step.resources.of(contacts).push(step);
    let system = System::new(Stage::External, CONTACT_FORCE, push).on_phases(phases).adds::<Force>();
    let warms =
        |system: System| system.reads::<Mass>().adds::<Temperature>().touches(PACKED_SOLID, Mode::ReadsNear);
    sim.add_system(if heats { warms(system) } else { system });
}

/// The contacts of the scene, which two systems share.
struct Contacts {
    bodies: Vec<InContact>,
    /// Energy of the springs that each holds, J.
    stored: Vec<(BodyId, f64)>,
    /// Bodies that friction may warm, with their specific heat, J/(kg K).
    specific_heats: Vec<(BodyId, f64)>,
    touching: Vec<Touching>,
    /// When each of them acts.
    acts: Vec<ContactActivity>,
    /// The bodies that can fail and touch with their skins until then.
    fragile: Vec<FailingSkins>,
    /// How far apart the bodies of each are.
    distances: Vec<PairDistance>,
    /// Those that act in this step and whose bodies are near each other, ascending.
    acting: Vec<u32>,
    periodic: Periodic,
    energies: Vec<((BodyId, BodyId), ContactEnergy)>,
    /// Whether each of them chatters.
    chatter: Vec<Chatter>,
    /// Rigid bodies that have been removed from the run.
    gone: Vec<BodyId>,
    /// Sides held along their normals that contact may reach.
    reached: Vec<ReachedSide>,
}

impl Contacts {
    fn meet(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for body in &mut self.bodies {
            body.follow(step)?;
        }
        if let Some(mut bodies) = step.resources.try_get_mut::<RigidBodies>() {
            bodies.iter_mut().for_each(|body| body.contact_stiffness = Wrench::default());
            self.gone.clear();
            self.gone.extend(bodies.iter().filter(|body| body.state.gone).map(|body| body.id));
        }
        if !self.fragile.is_empty() {
            // From the first step on, so that the tables of energies have a column for it.
            step.ledger.account(CHANGE_OF_SURFACE, AccountKind::Dissipated);
        }
        for fragile in &mut self.fragile {
            fragile.look(step)?;
        }
        self.choose_acting(step)?;
        for &k in &self.acting {
            let k = k as usize;
            self.touching[k].find(step, self.distances[k].motion(&self.bodies))?;
        }
        self.energies.clear();
        for number in 0..self.fragile.len() {
            if self.fragile[number].is_breaking() {
                let Self { touching, acts, distances, bodies, .. } = self;
                let motion_of = |k: usize| distances[k].motion(bodies);
                self.energies.push(break_skins(number, touching, acts, step, &motion_of)?);
            }
        }
        for at in 0..self.acting.len() {
            let k = self.acting[at] as usize;
            let other = match self.touching[k].turn() {
                NodeTurn::Alone => None,
                NodeTurn::First => Some(k + 1),
                NodeTurn::Second => Some(k - 1),
            };
            let beside = other.and_then(|other| self.touching[other].beside_the_other());
            let (pair, motion) = (&mut self.touching[k], self.distances[k].motion(&self.bodies));
            let mut energies = pair.run(step, motion, beside)?;
            let [first, second] = pair.bodies();
            self.chatter[k].look([first, second], &energies.losses.sliding, step);
            if self.acts[k].begins(&self.fragile) {
                energies = energies.taken_over();
            }
            self.energies.push(((first, second), energies));
        }
        let Self { touching, acting, reached, .. } = self;
        for patch in acting.iter().flat_map(|&k| touching[k as usize].patches()) {
            reached.iter_mut().for_each(|side| side.look(patch, step));
        }
        energy::book(step, &self.energies, &mut self.stored);
        self.add_couples(step);
        Ok(())
    }

    /// Whether a contact acts in this step: not one of a body that has been removed from the run.
    fn acts_now(&self, k: usize) -> bool {
        let is_there = |body: &InContact| self.gone.is_empty() || !self.gone.contains(&body.body);
        let [first, second] = self.distances[k].of(&self.bodies);
        self.acts[k].now(&self.fragile) && is_there(first) && is_there(second)
    }

    /// Chooses the contacts that act in this step, of bodies that are near each other. The others only limit
    /// the time step.
    fn choose_acting(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        self.acting.clear();
        for k in 0..self.touching.len() {
            if !self.acts_now(k) {
                continue;
            }
            let Self { touching, distances, bodies, periodic, acting, .. } = self;
            let (pair, distance) = (&mut touching[k], &mut distances[k]);
            if !distance.follow(pair, bodies, periodic, step)? {
                acting.push(k as u32);
            }
        }
        Ok(())
    }

    /// The contacts that act in this step, of bodies that are near each other.
    fn acting(&self) -> impl Iterator<Item = &Touching> {
        self.acting.iter().map(|&k| &self.touching[k as usize])
    }

    /// Adds what acts on the material beside particles to its stress, before the pass of the internal force.
    fn add_couples(&self, step: &Step<'_>) {
        let mut deforming = self.acting().filter(|touching| touching.deforms()).peekable();
        if deforming.peek().is_none() {
            return;
        }
        for touching in deforming {
            for (body, contact_nodes) in touching.contact_nodes() {
                let Body { phase, rows, .. } = step.world.body(body);
                if let Some(mut solid) = step.resources.solid_mut(*phase) {
                    contact_nodes.add_couples(&mut *solid, rows.start);
                }
            }
            for patch in touching.patches() {
                let Body { phase, rows, .. } = step.world.body(patch.skin.body);
                if let Some(mut solid) = step.resources.solid_mut(*phase) {
                    patch.add_couples(&mut *solid, rows.start);
                }
            }
        }
        for phase in step.world.phases() {
            if let Some(mut solid) = step.resources.solid_mut(phase) {
                solid.renew_ghosts();
            }
        }
    }

    /// Adds the forces on particles, and warms them.
    fn push(&self, step: &Step<'_>) -> Result<(), StepError> {
        for (body, contact_nodes) in self.acting().flat_map(Touching::contact_nodes) {
            let (view, rows) = step.world.body_view(body);
            contact_nodes.add_forces(&mut view.write::<Force>()?[rows]);
            self.warm(body, step, |capacity, temperature| contact_nodes.warm(capacity, temperature))?;
        }
        for patch in self.acting().flat_map(Touching::patches) {
            let body = patch.skin.body;
            let (view, rows) = step.world.body_view(body);
            patch.add_forces(&mut view.write::<Force>()?[rows]);
            self.warm(body, step, |capacity, temperature| patch.warm(capacity, temperature))?;
        }
        Ok(())
    }

    /// Warms the particles of a body, if friction may warm it.
    fn warm(
        &self,
        body: BodyId,
        step: &Step<'_>,
        by: impl FnOnce(&HeatCapacity<'_>, &mut [Temperature]),
    ) -> Result<(), StepError> {
        let Some(&(_, specific_heat)) = self.specific_heats.iter().find(|(id, _)| *id == body) else {
            return Ok(());
        };
        let (view, rows) = step.world.body_view(body);
        let (mass, mut temperature) = (view.read::<Mass>()?, view.write::<Temperature>()?);
        let solid = step.resources.solid(step.world.body(body).phase);
        by(
            &HeatCapacity::of_body(specific_heat, &mass, rows.start, solid.as_deref()),
            &mut temperature[rows],
        );
        Ok(())
    }
}

/// The system that computes the forces.
struct ContactSystem(Shared<Contacts>);

impl Run for ContactSystem {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        resources.of_mut(self.0).meet(step)
    }

    fn save_with(&self, resources: &Resources) -> Vec<u8> {
        let contacts = resources.of(self.0);
        let saved: Vec<Saved> = contacts.touching.iter().map(Touching::saved).collect();
        let whole: Vec<bool> = contacts.fragile.iter().map(FailingSkins::is_whole).collect();
        postcard::to_stdvec(&(saved, whole, &contacts.chatter)).unwrap_or_default()
    }

    fn restore_with(&mut self, state: &[u8], resources: &Resources) -> bool {
        type State = (Vec<Saved>, Vec<bool>, Vec<Chatter>);
        let Ok((saved, whole, chatter)) = postcard::from_bytes::<State>(state) else { return false };
        let mut contacts = resources.of_mut(self.0);
        contacts.chatter = chatter;
        contacts.fragile.iter_mut().zip(&whole).for_each(|(fragile, &whole)| fragile.restore(whole));
        whole.len() == contacts.fragile.len()
            && contacts.chatter.len() == contacts.touching.len()
            && saved.len() == contacts.touching.len()
            && contacts.touching.iter_mut().zip(saved).all(|(pair, saved)| pair.restore(saved))
    }
}
