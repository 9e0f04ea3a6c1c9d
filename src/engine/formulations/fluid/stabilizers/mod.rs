//! What plugins that stabilize a flow do to it: they act away from free surfaces, move particles, and pay
//! energy back.

mod displace;

mod interior;

mod repay;

pub use displace::displace;
pub use interior::Interior;
pub use repay::Repayment;
