//! The warning of sides beside which a uniform stress is not in balance.

use super::body::HeldBody;
use crate::plugin::{HeldSide, SideHold};

/// Imbalance from which on plastic strain may be off by more than a tenth; it was chosen by the table of
/// lattices in docs/solids.md.
const UNEVEN: f64 = 0.01;

/// Warning of a body with that imbalance beside its sides, if its metal strains unevenly.
pub(in crate::formulations) fn warning(body: &HeldBody<'_>, imbalance: f64) -> Option<String> {
    let beside = beside(body).filter(|_| imbalance > UNEVEN)?;
    let off = format!("the forces of a uniform stress are off balance by {:.1} %", 100.0 * imbalance);
    Some(if body.stays {
        format!(
            "{beside}, and its particles do not lie in layers along it: {off} beside such sides, and plastic strain is off by 5 to 50 %; \
             use `lattice: Regular` or `BodyFitted()`"
        )
    } else {
        format!(
            "{beside}, and its particles carry all of their stress, as `update: Every` or `Adaptive` changes their neighbours: {off} beside such sides, \
             and plastic strain is off by 20 to 60 %; `update: Automatic` or `Never` draws the body evenly"
        )
    })
}

/// Warning of a body once its reference is another one: its particles carry the right share of their stress
/// with the initial one alone. The time is to follow.
pub(in crate::formulations) fn warning_of_update(body: &HeldBody<'_>) -> Option<String> {
    let beside = beside(body).filter(|_| body.stays)?;
    Some(format!(
        "{beside}, and the shares of stress of its particles are those of the initial configuration: plastic strain beside such sides may be off by 20 to 40 % \
         (`update: Never` and `TotalLagrangian` strain evenly) from the first update of the reference on, at"
    ))
}

/// The beginning of warnings of a body with sides beside which its metal may strain unevenly.
fn beside(body: &HeldBody<'_>) -> Option<String> {
    let plan = body.plan;
    let side = plan.sides.iter().find(|side| side.hold != SideHold::Clamped).filter(|_| plan.yields())?;
    let (name, face) = (&plan.name, face(side));
    let along = if side.hold == SideHold::Endless {
        "has no edges and is held or driven"
    } else {
        "is held or drawn along its normal alone"
    };
    Some(format!("the side `{face}` of body `{name}` {along}"))
}

/// The name of a side in scenes.
fn face(side: &HeldSide) -> String {
    let axis = side.plane.0;
    format!("{}{}", if side.normal[axis] < 0.0 { "Min" } else { "Max" }, ["X", "Y", "Z"][axis])
}
