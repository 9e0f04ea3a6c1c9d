//! The step: stages, systems with declared access, their order, and the interface of a running system.

mod common_motion;
mod each;
mod intruders;
mod ledger;
mod limits;
mod order;
mod resources;
mod stage;
mod step;
mod step_part;
mod system;
mod trigger;

pub(crate) use common_motion::CommonMotion;
pub use each::{Adds, EachRow};
pub use intruders::Intruders;
pub use ledger::{
    Account, AccountId, AccountKind, EnergyAccount, GRAVITY, INTO_HEAT, Ledger, REMOVED_ENERGY,
};
pub use limits::{Limit, TimeStepLimits};
pub use order::{Schedule, ScheduleError};
pub use resources::{Resources, Shareable, Shared, SharedValues};
pub use stage::Stage;
pub use step::{Clock, Step, StepError, raise_warning, replace_warning};
pub use system::{Run, System};

pub use crate::world::{Access, Mode};
pub use step_part::{Cadence, StepPart};
pub use trigger::Trigger;
