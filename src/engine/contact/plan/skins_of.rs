//! The bodies whose contact surface is their skin.

use std::sync::Arc;

use crate::plugin::{BodyKind, BodyPlan, Offer, SimBuilder};
use crate::scene::ContactSurface;
use crate::skins::Skin;
use crate::symmetry::{MirrorPlane, Repeat, periods_of};
use crate::world::BodyId;

/// The skins that have been built, each once for all contacts of its body.
#[derive(Default)]
pub(in crate::contact) struct BodySkins {
    known: Vec<(BodyId, Option<Arc<Skin>>)>,
}

/// Why a body touches with its particles.
type Reason = &'static str;

impl BodySkins {
    /// The skin of a deformable body; for bodies without one, the reason for the warning.
    pub fn of(
        &mut self,
        body: &BodyPlan,
        surface: ContactSurface,
        planes: &[MirrorPlane],
        sim: &SimBuilder<'_>,
    ) -> Result<Arc<Skin>, Option<Reason>> {
        if surface == ContactSurface::Particles {
            return Err(None);
        }
        if body.kind == BodyKind::Boundary {
            return Err(Some(
                "walls bound fluids with particles; a `Rigid` body that `Fix` holds touches with its exact surface",
            ));
        }
        if !body.offers(Offer::DeformedContact) {
            return Err(Some("its formulation carries no surface"));
        }
        if !self.known.iter().any(|(id, _)| *id == body.id) {
            let shape = &sim.scene().bodies[body.id.0].shape;
            let cuts = |plane: &&MirrorPlane| plane.bodies.contains(body.id);
            let planes = planes.iter().filter(cuts).map(Repeat::from);
            let repeats: Vec<Repeat> = planes.chain(periods_of(body, sim)).collect();
            let skin = Skin::of(body, shape, &repeats, sim.dimension(), sim.folder());
            self.known.push((body.id, skin.map(Arc::new)));
        }
        let known = self.known.iter().find(|(id, _)| *id == body.id);
        known
            .and_then(|(_, skin)| skin.clone())
            .ok_or(Some("the surface of its shape is not known in facets"))
    }
}
