//! Invalid contacts of a scene.

use super::body::is_rigid;
use crate::plugin::{BodyKind, BodyPlan, Offer, SimBuilder};
use crate::scene::{Contact, Problem};

/// A pair of bodies of a scene, and the number of the contact that names it.
pub(super) struct NamedPair<'a> {
    pub contact: &'a Contact,
    pub number: usize,
    pub bodies: [&'a BodyPlan; 2],
    /// Whether a contact before it is between the same bodies.
    pub is_known: bool,
    /// Whether the contact of the scene is between bodies of which one has a specific heat, these or others
    /// of a family.
    pub is_warm: bool,
}

impl NamedPair<'_> {
    /// A problem with the bodies that the contact is between.
    fn problem(&self, message: String, help: &str) -> Problem {
        Problem::at_path(format!("contacts[{}].between", self.number), message).help(help)
    }

    /// Why there cannot be such a contact.
    pub fn refused(&self) -> Option<Problem> {
        self.with_a_fluid()
            .or_else(|| self.named_before())
            .or_else(|| self.rigid_with_itself())
            .or_else(|| self.heat_without_temperature())
            .or_else(|| self.own_contact_not_offered())
    }

    fn named_before(&self) -> Option<Problem> {
        let [a, b] = self.bodies.map(|body| &body.name);
        self.is_known.then(|| {
            let message = format!("the contact between `{a}` and `{b}` is given twice");
            self.problem(message, "give each pair of bodies once")
        })
    }

    fn with_a_fluid(&self) -> Option<Problem> {
        let fluid = self.bodies.into_iter().find(|body| body.kind == BodyKind::Fluid)?;
        let message = format!("`{}` is a fluid, which has no contacts", fluid.name);
        Some(self.problem(message, "leave this contact out: the flow acts on the bodies in it without one"))
    }

    fn rigid_with_itself(&self) -> Option<Problem> {
        let [a, b] = self.bodies.map(|body| &body.name);
        (a == b && is_rigid(self.bodies[0]))
            .then(|| self.problem(format!("rigid body `{a}` cannot touch itself"), "leave this contact out"))
    }

    /// The problem of a contact whose friction is to heat bodies that have no temperature.
    fn heat_without_temperature(&self) -> Option<Problem> {
        let [a, b] = self.bodies.map(|body| &body.name);
        (self.contact.friction_heat.is_some() && !self.is_warm).then(|| {
            let message = format!("neither `{a}` nor `{b}` is of a material with a specific heat");
            Problem::at_path(format!("contacts[{}].friction_heat", self.number), message)
                .help("give one of them a material with `specific_heat`, or leave `friction_heat` out")
        })
    }

    /// The problem of a body that is to touch itself and whose formulation has no such contact.
    fn own_contact_not_offered(&self) -> Option<Problem> {
        let [body, other] = self.bodies;
        if body.id != other.id || body.offers(Offer::SelfContact) {
            return None;
        }
        let BodyPlan { name, formulation, .. } = body;
        let message =
            format!("`{formulation}`, by which body `{name}` moves, has no {}", Offer::SelfContact.words());
        let help = "leave this contact out: where its kernels overlap, the body joins with itself";
        Some(self.problem(message, help))
    }

    /// A particle or facet must not see two images of another: periods must have at least that length, m.
    pub fn refuse_short_periods(&self, min_period: f64, sim: &SimBuilder<'_>) -> Result<(), Vec<Problem>> {
        let periodic = sim.periodic();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let length = periodic.lengths()[axis];
            if periodic.axes()[axis] && length < min_period {
                let message = format!(
                    "the period along {name} must be at least {min_period} m for this contact, found {length} m"
                );
                return Err(vec![self.problem(message, "use a longer domain, or smaller particles")]);
            }
        }
        Ok(())
    }
}
