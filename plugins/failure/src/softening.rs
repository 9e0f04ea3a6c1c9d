//! The stress of a damaged particle.

use glam::{DMat3, DVec3};
use meshless_engine::linalg::{Eigen, Sym3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Behaviour of a particle whose damage has reached 1. While damage D grows, it reduces the part of the
/// stress that is to be lost by the share D.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum AfterFailure {
    /// It resists compression of its volume alone, like a granular material, until it is so long and thin
    /// that its areas are three times as large: it then carries no stress. While damage grows, it reduces
    /// positive principal stresses.
    #[default]
    NoTension,
    /// It resists changes of its volume alone, like a liquid, tension included, until it loses its integrity:
    /// volume ratio above 2, inverted (det F <= 0), or areas three times as large. It then carries no stress.
    /// While damage grows, it reduces the deviator.
    NoDeviator,
    /// It is removed. While damage grows, it reduces positive principal stresses.
    Removed,
    /// Wear: it is removed as soon as it is at a surface of its body. Inside, it behaves as with
    /// `NoDeviator`.
    RemovedAtSurface,
}

impl AfterFailure {
    /// The Cauchy stress, Pa, that damage 0 < D < 1 leaves.
    pub(crate) fn soften(self, stress: &Sym3, damage: f64) -> Sym3 {
        let left = 1.0 - damage;
        match self {
            Self::NoDeviator | Self::RemovedAtSurface => {
                let mean = Sym3::from_diagonal(DVec3::splat(stress.trace() / 3.0));
                stress.deviator() * left + mean
            }
            Self::NoTension | Self::Removed => {
                Eigen::new(stress).map(|principal| if principal > 0.0 { left * principal } else { principal })
            }
        }
    }

    /// The mean stress, Pa, that a failed particle bears of the one that its volume would have.
    pub(crate) fn borne(self, mean: f64) -> f64 {
        if self.is_liquid() { mean } else { mean.min(0.0) }
    }

    /// Whether a failed particle resists changes of its volume only.
    fn is_liquid(self) -> bool {
        matches!(self, Self::NoDeviator | Self::RemovedAtSurface)
    }

    /// Whether a failed particle of that deformation, volume ratio and cofactor has lost its integrity: it
    /// would act over large distances, at shapes that no time step can follow.
    pub(crate) fn is_torn(self, volume: f64, cofactor: &DMat3) -> bool {
        let [x, y, z] = [cofactor.x_axis, cofactor.y_axis, cofactor.z_axis];
        let area = ((x.length_squared() + y.length_squared() + z.length_squared()) / 3.0).sqrt();
        if self.is_liquid() {
            !(volume > 0.0 && volume <= TORN[0] && area <= TORN[1])
        } else {
            // What is loose carries nothing, and may be pressed together again.
            volume < 1.0 && area > TORN[1]
        }
    }
}

/// Volume ratio beyond which a liquid has lost its integrity, and mean ratio of areas beyond which liquids
/// and granular materials have.
const TORN: [f64; 2] = [2.0, 3.0];

/// The cofactor J F^-T: what turns a Cauchy stress into a first Piola-Kirchhoff stress, also where F is
/// singular.
pub(crate) fn cofactor(f: &DMat3) -> DMat3 {
    let (a, b, c) = (f.x_axis, f.y_axis, f.z_axis);
    DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b))
}

/// Cauchy stress, Pa, from the first Piola-Kirchhoff stress.
pub(crate) fn cauchy(p: &DMat3, f: &DMat3) -> Sym3 {
    Sym3::symmetric_part(*p * f.transpose()) * (1.0 / f.determinant())
}

/// Volume ratios between which the pressure of a failed particle follows its law; beyond them it stays.
const VOLUMES: [f64; 2] = [0.3, 3.0];

/// The deformation at failure, scaled to the volume ratio `j`: the input of the law of a failed particle.
/// Deviator and plastic strain do not change; only the pressure does.
pub(crate) fn at_volume(at_failure: &DMat3, j: f64) -> DMat3 {
    let ratio = j.clamp(VOLUMES[0], VOLUMES[1]) / at_failure.determinant().clamp(VOLUMES[0], VOLUMES[1]);
    *at_failure * ratio.cbrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tension_is_softened_and_compression_is_not() {
        let stress = Sym3::from_diagonal(DVec3::new(4.0, -6.0, 2.0));
        for then in [AfterFailure::NoTension, AfterFailure::Removed] {
            let left = then.soften(&stress, 0.25);
            assert!(
                (left.to_matrix() - DMat3::from_diagonal(DVec3::new(3.0, -6.0, 1.5)))
                    .abs_diff_eq(DMat3::ZERO, 1e-14)
            );
            assert_eq!((then.borne(5.0), then.borne(-5.0)), (0.0, -5.0));
        }
        // Mean 0: the deviator is all.
        let left = AfterFailure::NoDeviator.soften(&stress, 0.25);
        assert!((left.to_matrix() - (stress * 0.75).to_matrix()).abs_diff_eq(DMat3::ZERO, 1e-14));
        assert_eq!(AfterFailure::NoDeviator.borne(5.0), 5.0);
    }

    #[test]
    fn a_liquid_is_torn_by_volume_by_shear_and_inside_out() {
        let torn = |then: AfterFailure, x, y, z| {
            let f = DMat3::from_diagonal(DVec3::new(x, y, z));
            then.is_torn(f.determinant(), &cofactor(&f))
        };
        assert!(
            !torn(AfterFailure::NoDeviator, 1.0, 1.0, 1.9) && torn(AfterFailure::NoDeviator, 1.0, 1.0, 2.1)
        );
        assert!(
            torn(AfterFailure::NoDeviator, 1.0, 1.0, -1.0) && !torn(AfterFailure::NoDeviator, 0.5, 0.5, 0.5)
        );
        // Areas of 4, 4 and 1/16 times have a root of the mean square of 3.3, those of 2, 2 and 1/4 one of
        // 1.6.
        assert!(
            torn(AfterFailure::NoDeviator, 0.25, 0.25, 16.0)
                && !torn(AfterFailure::NoDeviator, 0.5, 0.5, 4.0)
        );
    }

    #[test]
    fn rubble_is_torn_where_it_would_press_at_a_distance() {
        let torn = |x, y, z| {
            let f = DMat3::from_diagonal(DVec3::new(x, y, z));
            AfterFailure::NoTension.is_torn(f.determinant(), &cofactor(&f))
        };
        // Loose, pressed from one side, inside out: it stays.
        assert!(!torn(1.0, 1.0, 9.0) && !torn(0.2, 1.0, 1.0) && !torn(1.0, 1.0, -1.0));
        // Ten times as long, a twentieth as thick.
        assert!(torn(10.0, 0.05, 1.0) && torn(10.0, -0.05, 1.0));
    }

    #[test]
    fn the_cofactor_is_that_of_the_inverse() {
        let f = DMat3::from_cols_array(&[1.1, 0.2, -0.1, 0.3, 0.9, 0.05, 0.0, -0.2, 1.3]);
        assert!((cofactor(&f) - f.inverse().transpose() * f.determinant()).abs_diff_eq(DMat3::ZERO, 1e-14));
        assert!((at_volume(&f, 0.8).determinant() - 0.8).abs() < 1e-14);
    }
}
