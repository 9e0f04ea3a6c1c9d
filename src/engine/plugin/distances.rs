//! The distances of neighbours from which the weights of a formulation follow.

/// By which distances a formulation weighs the neighbours of a particle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distances {
    /// Those of a reference configuration.
    #[default]
    Reference,
    /// Those of the current configuration.
    Present,
    /// Those of the current configuration, as ellipsoids measure them that follow the deformation part of the
    /// way in the logarithm of the stretches, by `FOLLOWED`.
    PartWay,
}

/// Share of the logarithm of a stretch that the half axis of an ellipsoid follows. With a half, layers of a
/// sheared lattice have too few neighbours across, and slide past each other in jumps.
pub(crate) const FOLLOWED: f64 = 0.3125;

impl Distances {
    /// Distance from its length in the reference configuration and its present one, m.
    ///
    /// An ellipsoid `V^-2p` with the left stretch tensor V measures x = F X, along every axis of stretch, as
    /// the product of powers of both lengths, here sixteenths, for which square roots are enough.
    #[inline]
    pub(crate) fn between(self, reference: f64, present: f64) -> f64 {
        match self {
            Self::Reference => reference,
            Self::Present => present,
            Self::PartWay => (present * (present.powi(3) * reference.powi(5)).sqrt().sqrt().sqrt()).sqrt(),
        }
    }

    /// Change of the square of that distance with the square of the present one.
    #[inline]
    pub(crate) fn slope(self, reference: f64, present: f64) -> f64 {
        match self {
            Self::Reference => 0.0,
            Self::Present => 1.0,
            Self::PartWay => {
                let root = (reference / present.max(f64::MIN_POSITIVE)).sqrt();
                (1.0 - FOLLOWED) * root * root.sqrt().sqrt()
            }
        }
    }
}
