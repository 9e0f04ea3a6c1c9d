//! The distances of neighbours from which the weights of a formulation follow.

/// By which distances a formulation weighs the neighbours of a particle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distances {
    /// Those of a reference configuration.
    #[default]
    Reference,
    /// Those of the current configuration.
    Present,
    /// Those of the current configuration, as ellipsoids measure them that follow the deformation half way in
    /// the logarithm of the stretches.
    HalfWay,
}

impl Distances {
    /// Distance from its length in the reference configuration and its present one, m.
    ///
    /// An ellipsoid `V^-1` with the left stretch tensor V measures X = F^-1 x by `X . U X`, which along every
    /// axis of stretch is the product of both lengths.
    #[inline]
    pub(crate) fn between(self, reference: f64, present: f64) -> f64 {
        match self {
            Self::Reference => reference,
            Self::Present => present,
            Self::HalfWay => (reference * present).sqrt(),
        }
    }

    /// Change of the square of that distance with the square of the present one.
    #[inline]
    pub(crate) fn slope(self, reference: f64, present: f64) -> f64 {
        match self {
            Self::Reference => 0.0,
            Self::Present => 1.0,
            Self::HalfWay => 0.5 * reference / present.max(f64::MIN_POSITIVE),
        }
    }
}
