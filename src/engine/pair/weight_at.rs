//! The configuration to which the weights of pairs belong.

/// The configuration whose length a pair weight, and a kernel value, was taken at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WeightAt {
    /// |X_ij|: total-Lagrangian solids.
    #[default]
    Reference,
    /// |x_ij|: fluids, and solids whose neighbours are those of the current configuration.
    Current,
}
