//! The stable step of a flow beside a light rigid body.
//!
//! A body that moves by u compresses the rows of fluid before each of its faces, and their pressure pushes it
//! back: per area with the stiffness `K int (2 W_1(d))^2 dd` along the normal, where W_1 is the kernel
//! integrated over a plane at the distance d. For all kernels that integral is between 1.03 / h and 1.07 / h.
//! The frequencies of the body against the fluid are those of this stiffness and its mass; a body that is
//! much lighter than the fluid it displaces, such as a raft of foam, is faster than the sound of the fluid.

use glam::DVec3;

use crate::plugin::{BodyKind, SimBuilder};
use crate::rigid::RigidBody;
use crate::shapes::normal;
use crate::world::BodyId;

/// Stiffness of the fluid per area of a body with suction, over K / h; without it half of that, as the rate
/// of compression then counts the body once.
pub const STIFFNESS: f64 = 1.06;
/// Largest step over that of the fastest motion, 1 / omega. The leapfrog is stable up to 2, less what the
/// sound of the fluid itself takes: plates with suction, two and four particles thick, are stable at 1.67 and
/// 1.89 and not at 1.77 and 2.04.
const STABLE: f64 = 1.5;

/// The surface of a rigid body in the reference configuration.
pub struct WetSurface {
    pub body: BodyId,
    pieces: Vec<Piece>,
}

/// The piece of a surface before a particle.
struct Piece {
    /// A point on it, m.
    place: DVec3,
    normal: DVec3,
    /// Area, m2; in two dimensions per metre of thickness.
    area: f64,
}

/// Area of the surface of a body, m2, in two dimensions per metre of thickness; none where its shape is not
/// known.
pub fn surface_area(id: BodyId, sim: &SimBuilder<'_>) -> Option<f64> {
    pieces(id, sim).map(|pieces| pieces.iter().map(|piece| piece.area).sum())
}

/// The pieces of the surface of a body.
fn pieces(id: BodyId, sim: &SimBuilder<'_>) -> Option<Vec<Piece>> {
    let body = sim.body(id);
    let region = sim.scene().bodies[id.0].shape.region(sim.dimension(), sim.folder(), "shape").ok()?;
    let (axes, spacing) = (sim.dimension().count(), body.spacing);
    let mut pieces = Vec::new();
    for site in &body.sites {
        let depth = -region.distance(site.position);
        // The first row.
        if !(0.0..spacing).contains(&depth) {
            continue;
        }
        let normal = normal(|x| region.distance(x), site.position, 0.1 * spacing, axes);
        let area = site.volume / spacing;
        pieces.push(Piece { place: site.position + depth * normal, normal, area });
        // A sheet of one row has a second face behind it.
        if region.distance(site.position - 0.75 * spacing * normal) > 0.0 {
            pieces.push(Piece { place: site.position - depth * normal, normal: -normal, area });
        }
    }
    Some(pieces)
}

impl WetSurface {
    /// That of a rigid body; none of other bodies.
    pub fn new(id: BodyId, sim: &SimBuilder<'_>) -> Option<Self> {
        (sim.body(id).kind == BodyKind::Rigid)
            .then(|| pieces(id, sim))
            .flatten()
            .map(|pieces| Self { body: id, pieces })
    }

    /// Stable step of a flow of smoothing length `h`, m, and the largest bulk modulus `stiffest`, Pa, beside
    /// the body, s: the sum of the squared frequencies of all of its motions is no less than the fastest. All
    /// of the surface counts as wet. Infinite where nothing moves the body.
    pub fn stable_step(&self, body: &RigidBody, suction: bool, h: f64, stiffest: f64) -> f64 {
        let response = |piece: &Piece| {
            let normal = body.state.rotation * piece.normal;
            piece.area * body.inverse_mass_at(body.place(piece.place), normal)
        };
        let share = if suction { 1.0 } else { 0.5 };
        let squared = share * STIFFNESS * stiffest / h * self.pieces.iter().map(response).sum::<f64>();
        STABLE / squared.sqrt()
    }
}
