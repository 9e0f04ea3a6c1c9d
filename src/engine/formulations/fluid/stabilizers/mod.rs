//! What plugins that stabilize a flow do to it: they move particles, and pay energy back.

mod displace;

mod repay;

pub use displace::displace;
pub use repay::Repayment;
