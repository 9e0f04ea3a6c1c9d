//! Fluid that fills a space up to a roof of walls without suction.
//!
//! At rest it has no pressure at its top, and the particles of the roof, above it, have less than none by the
//! weight of fluid between (Adami, Hu, Adams 2012, eq. 27). Without suction they have none instead: the roof
//! drives the fluid down until the pressure below it is that of some two spacings more of fluid.

use glam::DVec3;
use rayon::prelude::*;

use crate::formulations::fluid::walls::Wall;
use crate::notation::quantity;
use crate::plugin::{BodyKind, SimBuilder};
use crate::shapes::{Region, images_near};
use crate::world::BodyId;

/// Pressure that a roof adds, over that of a layer of fluid one spacing thick.
const LAYERS: f64 = 1.3;
/// Share of the largest pressure that is worth a warning, as that of work that walls take.
const SHARE: f64 = 0.03;

/// A piece of the fluids below a roof, without a free surface.
pub struct Roofed {
    /// The fluid at its top, and its density, kg/m3.
    pub fluid: BodyId,
    pub density: f64,
    /// Places of its particles, m.
    pub places: Vec<DVec3>,
    /// Its largest pressure at the start, Pa.
    pub largest: f64,
}

impl Roofed {
    /// The warning of walls alone that bound it without suction; a body among them has its own weight.
    /// `reach` is the distance at which particles touch what bounds them, m, and `head` gravity times the
    /// spacing, m2/s2.
    pub fn pressed(
        &self,
        covers: &[(BodyId, Box<dyn Region>)],
        reach: f64,
        head: f64,
        sim: &SimBuilder<'_>,
    ) -> Option<String> {
        let more = LAYERS * self.density * head;
        let lengths = sim.periodic().lengths();
        let touches = |region: &dyn Region| {
            let bounds = region.bounds();
            let images = |at: DVec3| images_near(&bounds, at, lengths, reach);
            self.places.par_iter().any(|&at| images(at).any(|place| region.distance(place) < reach))
        };
        let are_walls = covers.iter().filter(|(_, region)| touches(region.as_ref())).all(|(id, _)| {
            let wall = sim.scene().bodies[id.0].formulation.parse::<Wall>();
            sim.body(*id).kind == BodyKind::Boundary && wall.is_ok_and(|wall| !wall.suction)
        });
        (are_walls && more > SHARE * self.largest).then(|| {
            format!(
                "`{}` fills a space up to its roof, and its walls cannot pull: the roof will raise the pressure in it by some {}, {:.0} % of the largest one; give these walls \
                 `Wall(suction: true)`, as a body of their own where other walls bound a fluid with a free surface",
                sim.body(self.fluid).name,
                quantity(more, "Pa"),
                100.0 * more / self.largest,
            )
        })
    }
}
