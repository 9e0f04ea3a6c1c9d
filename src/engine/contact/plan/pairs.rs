//! From a contact of a scene to the pairs of bodies, of their images and of their sides that touch.

use std::sync::Arc;

use super::body::{elastic_of, is_rigid};
use super::checks::NamedPair;
use super::images::mirrors;
use super::skins_of::BodySkins;
use crate::contact::bodies::{BUMPS, ContactSides, MemberParticles, NodeTurn, SideNodes};
use crate::contact::laws::{ContactPair, NormalForce, damping_ratio};
use crate::contact::particles::ParticleContact;
use crate::contact::response::Interaction;
use crate::contact::skins::{SkinContact, SkinOnTool};
use crate::contact::system::{ContactActivity, FailingSkins, Touching};
use crate::contact::tools::SurfaceContact;
use crate::plugin::{BodyPlan, Distances, SimBuilder};
use crate::rigid::sphere_of;
use crate::scene::{ContactSurface, Item, Problem};
use crate::skins::Skin;
use crate::symmetry::{MirrorPlane, periods_of};

/// Makes the force of a law between two bodies.
pub type MakeLaw<'m> = &'m dyn Fn(&Item, &ContactPair) -> Result<Box<dyn NormalForce>, Vec<Problem>>;

/// The pairs of a scene, as they are found.
pub(super) struct Planner<'a> {
    pub sim: &'a SimBuilder<'a>,
    pub make: MakeLaw<'a>,
    pub planes: &'a [MirrorPlane],
    /// The skins that bodies touch with.
    pub skins: BodySkins,
    /// Pairs that touch with skins until a particle of these fails.
    pub fragile: Vec<FailingSkins>,
    /// Warnings of bodies that have none.
    pub warnings: Vec<String>,
}

fn always(touching: Vec<Touching>) -> Vec<(Touching, ContactActivity)> {
    touching.into_iter().map(|touching| (touching, ContactActivity::Always)).collect()
}

impl Planner<'_> {
    /// The pairs in contact by a contact of the scene.
    ///
    /// # Errors
    /// The parameters of the law are wrong, or the domain is too short for the particles.
    pub fn pairs_of(
        &mut self,
        named: &NamedPair<'_>,
    ) -> Result<Vec<(Touching, ContactActivity)>, Vec<Problem>> {
        let [first, second] = named.bodies;
        match (is_rigid(first), is_rigid(second)) {
            (false, false) => self.deformable(named, [first, second]),
            (false, true) => self.on_tool(named, first, second),
            (true, false) => self.on_tool(named, second, first),
            (true, true) => Ok(always(self.rigid(named, [first, second])?)),
        }
    }

    /// Two deformable bodies, or one with itself: their skins, or particles with each image of the second
    /// one.
    fn deformable(
        &mut self,
        named: &NamedPair<'_>,
        [first, second]: [&BodyPlan; 2],
    ) -> Result<Vec<(Touching, ContactActivity)>, Vec<Problem>> {
        if first.id == second.id
            && let Some(reason) = self.reason_for_particles(first)
        {
            if named.contact.surface == ContactSurface::Skin {
                let name = &first.name;
                self.warnings.push(format!(
                    "body `{name}` touches itself with its particles, not with its surface: {reason}; {BUMPS}"
                ));
            }
        } else if let (Some(one), Some(other)) = (self.skin(first, named), self.skin(second, named)) {
            let interaction = self.interaction(named, ContactSurface::Skin)?;
            let pair = SkinContact::new(interaction, [one.clone(), other.clone()], self.sim.periodic());
            named.refuse_short_periods(pair.min_period(), self.sim)?;
            let mut carried = vec![(first, one), (second, other)];
            carried.dedup_by_key(|(body, _)| body.id);
            return self.until_failure(Touching::Skins(Box::new(pair)), &carried, &|planner| {
                planner.of_particles(named, [first, second])
            });
        }
        Ok(always(self.of_particles(named, [first, second])?))
    }

    /// Why a body that touches itself does so with its particles, if it does.
    fn reason_for_particles(&self, body: &BodyPlan) -> Option<&'static str> {
        if mirrors(self.planes, body.id, body.id).len() > 1 {
            return Some("it may touch its image behind a symmetry plane");
        }
        let joins = body.distances != Distances::Reference;
        joins.then_some("its kernels join what is near and does not touch")
    }

    /// The particles of two deformable bodies, or of one with itself.
    fn of_particles(
        &self,
        named: &NamedPair<'_>,
        [first, second]: [&BodyPlan; 2],
    ) -> Result<Vec<Touching>, Vec<Problem>> {
        let mut pairs = Vec::new();
        for mirror in mirrors(self.planes, first.id, second.id) {
            let mut bodies = [first, second].map(|body| self.particles(body));
            // Beside spheres the other side keeps spheres, too: then forces act along the line of the
            // centres.
            let deform = bodies.iter().all(|particles| particles.deform);
            bodies.iter_mut().for_each(|particles| particles.deform = deform);
            let interaction = self.interaction(named, ContactSurface::Particles)?;
            let pair = ParticleContact::new(interaction, bodies, mirror, self.sim.periodic());
            named.refuse_short_periods(pair.min_period(), self.sim)?;
            pairs.push(Touching::Particles(Box::new(pair)));
        }
        Ok(pairs)
    }

    /// A deformable body on a rigid one.
    fn on_tool(
        &mut self,
        named: &NamedPair<'_>,
        soft: &BodyPlan,
        tool: &BodyPlan,
    ) -> Result<Vec<(Touching, ContactActivity)>, Vec<Problem>> {
        let sides = self.sides(SideNodes::Particles(self.particles(soft)), [soft, tool]);
        let Some(skin) = self.skin(soft, named) else {
            return Ok(always(vec![self.on_surface(named, sides)?]));
        };
        let interaction = self.interaction(named, ContactSurface::Skin)?;
        let on_tool = SkinOnTool::new(interaction, Arc::clone(&skin), sides.clone());
        self.until_failure(Touching::SkinOnTool(Box::new(on_tool)), &[(soft, skin)], &|planner| {
            Ok(vec![planner.on_surface(named, sides.clone())?])
        })
    }

    /// A contact of skins, which ends where a body can fail and does so; `particles` are what touches from
    /// then on.
    fn until_failure(
        &mut self,
        skins: Touching,
        of: &[(&BodyPlan, Arc<Skin>)],
        particles: &dyn Fn(&Self) -> Result<Vec<Touching>, Vec<Problem>>,
    ) -> Result<Vec<(Touching, ContactActivity)>, Vec<Problem>> {
        let fragile = of.iter().filter(|(body, _)| body.can_fail()).map(|(_, skin)| Arc::clone(skin));
        let fragile: Vec<Arc<Skin>> = fragile.collect();
        if fragile.is_empty() {
            return Ok(always(vec![skins]));
        }
        let number = self.fragile.len();
        self.fragile.push(FailingSkins::new(&fragile));
        let particles = particles(self)?.into_iter().map(|pair| (pair, ContactActivity::OnceBroken(number)));
        Ok(std::iter::once((skins, ContactActivity::WhileWhole(number))).chain(particles).collect())
    }

    /// Two rigid bodies.
    fn rigid(
        &self,
        named: &NamedPair<'_>,
        [first, second]: [&BodyPlan; 2],
    ) -> Result<Vec<Touching>, Vec<Problem>> {
        let bodies = &self.sim.scene().bodies;
        let is_sphere = |body: &BodyPlan| sphere_of(&bodies[body.id.0].shape).is_some();
        // A sphere is one node, and touches the surface of the other exactly.
        let of_nodes: &[([&BodyPlan; 2], NodeTurn)] = match (is_sphere(first), is_sphere(second)) {
            (true, _) => &[([first, second], NodeTurn::Alone)],
            (false, true) => &[([second, first], NodeTurn::Alone)],
            (false, false) => &[([first, second], NodeTurn::First), ([second, first], NodeTurn::Second)],
        };
        let touching = |(bodies, turn): &([&BodyPlan; 2], NodeTurn)| {
            self.on_surface(named, ContactSides { turn: *turn, ..self.sides(SideNodes::Rigid, *bodies) })
        };
        of_nodes.iter().map(touching).collect()
    }

    /// The nodes of the first body on the surface of the second.
    fn on_surface(&self, named: &NamedPair<'_>, sides: ContactSides) -> Result<Touching, Vec<Problem>> {
        let interaction = self.interaction(named, ContactSurface::Particles)?;
        let gravity = self.sim.gravity().length();
        Ok(Touching::Surface(Box::new(SurfaceContact::new(interaction, sides, gravity))))
    }

    fn sides(&self, nodes: SideNodes, [of, on]: [&BodyPlan; 2]) -> ContactSides {
        ContactSides {
            first: of.id,
            nodes,
            second: on.id,
            turn: NodeTurn::Alone,
            periodic: self.sim.periodic(),
            seams: periods_of(on, self.sim),
        }
    }

    fn particles(&self, body: &BodyPlan) -> MemberParticles {
        MemberParticles::of(body, self.sim.dimension())
    }

    /// Interaction of the two bodies of a contact, where surfaces or particles touch.
    fn interaction(
        &self,
        named: &NamedPair<'_>,
        surface: ContactSurface,
    ) -> Result<Interaction, Vec<Problem>> {
        let contact = named.contact;
        let [first, second] = named.bodies;
        let softness =
            |body: &BodyPlan| elastic_of(body).map_or(0.0, |e| (1.0 - e.poisson.powi(2)) / e.young);
        let modulus = 1.0 / (softness(first) + softness(second));
        let both = [first, second].into_iter().filter_map(elastic_of).map(|elastic| elastic.poisson);
        let (count, sum) = both.fold((0.0, 0.0), |(count, sum), poisson| (count + 1.0, sum + poisson));
        let poisson = if count > 0.0 { sum / count } else { 0.0 };
        let mut heat = contact.friction_heat.map_or([0.0; 2], |share| [share, 1.0 - share]);
        if is_rigid(first) && !is_rigid(second) {
            // The nodes are those of the deformable one.
            heat.reverse();
        }
        let pair = ContactPair { dimension: self.sim.dimension(), surface, modulus };
        Ok(Interaction {
            law: (self.make)(&contact.law, &pair)?,
            friction: contact.friction,
            damping_ratio: damping_ratio(contact.restitution),
            tangential: 2.0 * (1.0 - poisson) / (2.0 - poisson),
            heat,
        })
    }

    /// The skin that a body touches with, if it has one; else the reason is reported.
    fn skin(&mut self, body: &BodyPlan, named: &NamedPair<'_>) -> Option<Arc<Skin>> {
        let contact = named.contact;
        let reason = match self.skins.of(body, contact.surface, self.planes, self.sim) {
            Ok(skin) => return Some(skin),
            Err(reason) => reason?,
        };
        let (name, (a, b)) = (&body.name, &self.sim.scene().contacts[named.number].between);
        let warning = format!(
            "body `{name}` touches with its particles in the contact of `{a}` and `{b}`: {reason}; {BUMPS}"
        );
        // Once for all pairs of a contact.
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
        None
    }
}
