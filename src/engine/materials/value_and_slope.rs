//! A function with its derivative.

/// The value of a function, and its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueAndSlope {
    /// Value.
    pub value: f64,
    /// Derivative.
    pub slope: f64,
}
