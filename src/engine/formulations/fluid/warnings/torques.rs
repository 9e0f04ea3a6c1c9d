//! Warning of torques by friction without spin.
//!
//! Friction without spins is that of the stress `mu grad v`, without its transpose: inside of a fluid the
//! force is the same, and so is the traction on a surface that does not turn. On one that turns at the rate w
//! it lacks `2 mu w` along the surface, and angular momentum is not conserved: torques on a cylinder and on a
//! ring twice as wide were 0.2 to 0.9 and 1.0 to 1.6 of what they should be. Flows of so little viscosity
//! usually lose far more to stabilizers, but not where sound is very much faster than the flow.

use glam::DVec3;

use super::closed::named;
use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud, Group};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{Account, AccountKind, Step};

/// Energy that friction has dissipated over the largest that any account has held that is worth a warning.
const SHARE: f64 = 0.01;
/// Speed of the rim of a boundary that turns over the largest speed in the flow from which it counts.
const RIM: f64 = 0.1;

/// Evaluates the dissipation of friction and the rotation of the boundaries at the end of a run.
pub fn look(is_told: &mut bool, cloud: &FlowCloud, step: &mut Step<'_>) {
    let friction = step.ledger.total_named(ACCOUNTS[0]);
    if *is_told || cloud.viscosities.spin || friction <= SHARE * step.ledger.largest() {
        return;
    }
    let is_stabilizer = |account: &&Account| {
        let name = account.name.as_str();
        account.kind == AccountKind::Dissipated && !ACCOUNTS.contains(&name) && name != REMOVED_ENERGY
    };
    let stabilizers = step.ledger.accounts().iter().filter(is_stabilizer);
    let taken: f64 = stabilizers.map(|account| step.ledger.total_named(&account.name)).sum();
    if friction <= taken {
        return;
    }
    let frame = step.ledger.frame();
    let speeds = cloud.records().iter().map(|record| record.velocity().distance(frame));
    let fastest = speeds.fold(0.0, f64::max);
    let turns =
        |group: &&Group| group.sticks() && rim_speed(&cloud.records()[group.cloud.clone()]) > RIM * fastest;
    let Some(group) = cloud.groups.iter().find(turns) else { return };
    let fluids = cloud.groups.iter().filter_map(|group| group.fluid());
    let sound =
        fluids.map(|fluid| fluid.viscosity / (fluid.density * cloud.viscosities.least)).fold(0.0, f64::max);
    *is_told = true;
    step.warnings.push(format!(
        "`{}` turns in {}, whose friction has dissipated {} by {}, more than all stabilizers, but is too small beside its sound to be corrected for rotation: torques are wrong (0.2 to 0.9 of it on a cylinder that turns in a ring twice as wide, 1.0 to 1.6 on the ring), and free bodies turn at a wrong rate; \
         take a `sound_speed` below {}, or smaller particles",
        step.world.body(group.body).name,
        named(cloud, step),
        quantity(friction, "J"),
        quantity(step.clock.time, "s"),
        quantity(sound, "m/s"),
    ));
}

/// Root mean square speed by the rotation that fits the motion of a boundary best, m/s.
fn rim_speed(records: &[FlowParticle]) -> f64 {
    let count = records.len().max(1) as f64;
    let mean = |of: &dyn Fn(&FlowParticle) -> DVec3| records.iter().map(of).sum::<DVec3>() / count;
    let (centre, drift) = (mean(&FlowParticle::position), mean(&FlowParticle::velocity));
    let (mut momentum, mut moment) = (DVec3::ZERO, 0.0);
    for record in records {
        let r = record.position() - centre;
        momentum += r.cross(record.velocity() - drift);
        moment += r.length_squared();
    }
    if moment > 0.0 { momentum.length() / (moment * count).sqrt() } else { 0.0 }
}
