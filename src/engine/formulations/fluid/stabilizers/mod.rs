//! Support for plugins that stabilize a flow: detection of the interior, displacement of particles,
//! compensation of energy.

mod displace;

mod interior;

mod repay;

pub use displace::displace;
pub use interior::Interior;
pub use repay::Repayment;
