//! The stable time step of contact.

use super::law::{NormalForce, Touch};
use crate::schedule::Step;
use crate::world::BodyId;

/// A third of the critical step of the contacts alone: bonds, which have used up 0.6 of theirs, and contacts together stay stable, and what
/// the first and the last step of a touch miss of its energy, which goes with the square of this, stays small.
const FREQUENCY_FACTOR: f64 = 0.7;
/// Share of the distance of two particles that just touch by which they may approach in a step.
const SWEPT_FACTOR: f64 = 0.25;

/// Square of that factor over the square of the one of skins, 0.55: two fifths of the critical step of the contact of a skin alone, which is 1.33 over the
/// root of stiffness over the mass of a layer of particles. Bodies that bounce then keep their energy to a thousandth.
pub(super) const OF_SKIN: f64 = (FREQUENCY_FACTOR / 0.55) * (FREQUENCY_FACTOR / 0.55);

/// Steps of the present length within which skins that are apart may touch: from then on the step is that of a touch. A step that is longer than the contact
/// allows would put a point that touches for the first time too deep, and make energy.
const AHEAD: f64 = 3.0;
/// Overlap over the spacing whose stiffness stands for that of a touch to come: laws may begin with none.
const EXPECTED: f64 = 0.05;

/// The stiffness of a touch that may begin soon, N/m: of skins that are `gap` apart, m, and move at speeds that add up to `speed`, m/s; zero if that takes
/// longer. `touch` is that of the law.
pub(super) fn expected(law: &dyn NormalForce, touch: &Touch, gap: f64, speed: f64, dt: f64) -> f64 {
    // Nothing is known yet of the length of the first step.
    let is_near = gap.is_finite() && (dt == 0.0 || gap < AHEAD * speed * dt);
    if is_near && speed > 0.0 {
        law.at(&Touch { overlap: EXPECTED * touch.length, ..*touch }).stiffness
    } else {
        0.0
    }
}

/// Proposes the limits of two bodies: for contacts of a squared frequency, 1/s2, and for an approach at `speed`, m/s,
/// of particles that touch at a distance of `reach`, m.
pub(super) fn propose(step: &mut Step<'_>, pair: (BodyId, BodyId), squared: f64, speed: f64, reach: f64) {
    let world = step.world;
    let (one, other) = (&world.body(pair.0).name, &world.body(pair.1).name);
    if squared > 0.0 {
        step.limits.propose(
            FREQUENCY_FACTOR / squared.sqrt(),
            format_args!("stiffness of contact of `{one}` and `{other}`"),
        );
    }
    if speed > 0.0 {
        let limit = SWEPT_FACTOR * reach / speed;
        step.limits.propose(limit, format_args!("speed of approach of `{one}` and `{other}`"));
    }
}

/// Step of the contacts of rigid bodies, over one over their frequency: some sixty steps an impact, for its energy.
const IMPACT_FACTOR: f64 = 0.05;

/// Proposes the limit of contacts of two rigid bodies of a squared frequency, 1/s2.
pub(super) fn propose_rigid(step: &mut Step<'_>, pair: (BodyId, BodyId), squared: f64) {
    if squared > 0.0 {
        let world = step.world;
        let (one, other) = (&world.body(pair.0).name, &world.body(pair.1).name);
        let limit = IMPACT_FACTOR / squared.sqrt();
        step.limits.propose(limit, format_args!("contact of rigid `{one}` and `{other}`"));
    }
}
