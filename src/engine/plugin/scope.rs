//! The bodies that a plugin acts on, selected by their kind or by the offers of their formulations.

use super::builder::SimBuilder;
use super::error::SetupError;
use super::offers::{BodyKind, Offer};
use super::plan::BodyPlan;
use crate::world::BodySet;

impl SimBuilder<'_> {
    /// The bodies of the scope of that kind.
    ///
    /// # Errors
    /// The plugin stands in a body of another kind, or there is no body of this kind.
    pub fn scope_of(&self, kind: BodyKind) -> Result<BodySet, SetupError> {
        self.scope_where(&|body| body.kind == kind, &|| format!("acts on {}", kind.words()))
    }

    /// The bodies of the scope whose formulations have the offer.
    ///
    /// # Errors
    /// The plugin stands in a body that does not, or there is no body that does.
    pub fn scope_offering(&self, offer: Offer) -> Result<BodySet, SetupError> {
        self.scope_where(&|body| body.offers(offer), &|| format!("needs bodies that take {}", offer.words()))
    }

    fn scope_where(
        &self,
        fits: &dyn Fn(&BodyPlan) -> bool,
        what: &dyn Fn() -> String,
    ) -> Result<BodySet, SetupError> {
        let fitting = BodySet::new(self.scope().iter().filter(|&id| fits(self.body(id))));
        if !fitting.is_empty() || self.scope().is_empty() {
            return Ok(fitting);
        }
        let message = match self.own_body {
            Some(id) => {
                let BodyPlan { name, formulation, .. } = self.body(id);
                format!("this {}, and body `{name}` has the formulation `{formulation}`", what())
            }
            None if self.bodies().iter().any(fits) => {
                format!("this {}, and all of them have it in their own lists", what())
            }
            None => format!("this {}, and the scene has none", what()),
        };
        Err(SetupError::parameter("", message, "leave it out"))
    }
}
