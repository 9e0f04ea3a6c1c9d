//! Errors in the input of a neighbour search.

use glam::DVec3;

/// Error of building a neighbour list.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NeighborError {
    /// A position is NaN or infinite.
    #[error("position of {set} particle {index} is not finite: {position}")]
    Position {
        /// "target" or "source".
        set: &'static str,
        /// Row of the particle in its set.
        index: usize,
        /// The position (m).
        position: DVec3,
    },
    /// A support radius is not a positive finite number.
    #[error("the support radius of {set} particle {index} must be positive and finite, found {value} m")]
    SupportRadius {
        /// "target" or "source".
        set: &'static str,
        /// Row of the particle in its set; 0 where all particles have one radius.
        index: usize,
        /// The support radius (m).
        value: f64,
    },
    /// The number of support radii differs from the number of particles.
    #[error("{supports} support radii for {positions} {set} particles; one for each is needed")]
    Length {
        /// "target" or "source".
        set: &'static str,
        /// Number of positions.
        positions: usize,
        /// Number of support radii.
        supports: usize,
    },
    /// The skin is negative or not finite.
    #[error("the skin must be finite and not negative, found {0} m")]
    Skin(f64),
    /// A particle would have two periodic images of another within its support.
    #[error(
        "periodic domain is {length} m long in {axis}; it must be at least twice the largest support radius plus \
         skin, {needed} m"
    )]
    PeriodicTooShort {
        /// "x", "y" or "z".
        axis: char,
        /// Length of the domain (m).
        length: f64,
        /// Minimum length (m).
        needed: f64,
    },
    /// The bounds of a periodic axis are not an interval of positive length.
    #[error(
        "periodic domain reaches from {min} m to {max} m in {axis}; the end must be above the start, both finite"
    )]
    PeriodicBounds {
        /// "x", "y" or "z".
        axis: char,
        /// Start (m).
        min: f64,
        /// End (m).
        max: f64,
    },
    /// The number of particles exceeds 32-bit row indices.
    #[error("{0} particles in one neighbour search; at most 4294967294 are possible")]
    TooMany(usize),
}
