//! Stiffness-proportional damping of sub-cycled bodies, for modes too fast for a force that is frozen in a
//! long step.
//!
//! A body with sub-steps in the long step of a fluid feels a force that lags behind its motion by up to the
//! long step. A mode of the body whose phase advances by theta = omega dt in it gains the share `kappa /
//! omega^2 (1 - cos theta - theta/2 sin theta)` of its energy per step, where kappa is the stiffness of the
//! adjacent fluid over its mass; for theta above one the fluid resolves no wave that could radiate this
//! energy. Slow modes gain with theta^4. Stiffness-proportional damping removes energy with theta^2 and so
//! bounds all of them. The stress is that of the strain extrapolated by a share c of the last sub-step,
//!
//! `S_v = c (lambda tr(dE) I + 2 mu dE)`, `P = F (S + S_v)`, `dE = E_n - E_n-1`,
//!
//! symmetric in S, so that angular momentum is conserved. A mode of the period T loses the share `c 4 pi^2
//! dt_short / T` of its energy per period.

use glam::DMat3;

use crate::linalg::Sym3;
use crate::materials::ElasticConstants;
use crate::parallel::split_by_rows;

crate::column! {
    /// Green-Lagrange strain at the end of the last sub-step.
    pub struct DampedStrain(crate::linalg::Sym3) = "damped_strain", "E_n", "1";
}
crate::column! {
    /// Second Piola-Kirchhoff stress of the damping.
    pub struct DampingStress(crate::linalg::Sym3) = "damping_stress", "S_v", "Pa";
}

/// Account of the energy dissipated by the damping.
pub(super) const ACCOUNT: &str = "coupling_damping";

/// Handed to solids whose sub-steps are damped, by what sub-cycles them.
pub(crate) struct DampedSubSteps {
    /// c.
    pub share: f64,
}

/// The columns of a body, empty where it is not damped.
#[derive(Default)]
pub(super) struct DampingRows<'a> {
    pub strain: &'a mut [Sym3],
    pub stress: &'a mut [Sym3],
}

split_by_rows!(DampingRows { strain, stress });

/// A block of particles after its law.
pub(super) struct Damping<'a> {
    pub elastic: &'a ElasticConstants,
    /// Length of the step, s; zero before the first and where bonds are cut: the strain is then measured
    /// anew.
    pub dt: f64,
    /// c; zero where the step is not a part of a long one.
    pub share: f64,
    pub deformation: &'a [DMat3],
    /// H = F - I.
    pub gradient: &'a [DMat3],
    /// Current Young's modulus, Pa.
    pub modulus: &'a [f64],
    pub volume: &'a [f64],
}

impl Damping<'_> {
    /// Adds the damping to the stress; returns the work that it took in the step, by the trapezoidal rule of
    /// the two kicks, J.
    pub fn add(&self, rows: DampingRows<'_>, stress: &mut [DMat3]) -> f64 {
        let ElasticConstants { lambda, shear, young, .. } = *self.elastic;
        let mut work = 0.0;
        for (k, (before, damping)) in rows.strain.iter_mut().zip(rows.stress).enumerate() {
            let h = self.gradient[k];
            let strain = Sym3::symmetric_part(h) + Sym3::gram(h) * 0.5;
            if self.dt > 0.0 {
                let change = strain - *before;
                let stiffness = self.share * self.modulus[k] / young;
                let now = Sym3::IDENTITY * (stiffness * lambda * change.trace())
                    + change * (2.0 * stiffness * shear);
                work += 0.5 * self.volume[k] * (*damping + now).double_dot(&change);
                *damping = now;
            }
            *before = strain;
            stress[k] += self.deformation[k] * damping.to_matrix();
        }
        work
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-6;
    const SHARE: f64 = 0.1;

    /// The stress that is added at F = I + H, and the work, after a step from the strain of `before`.
    fn added(before: DMat3, h: DMat3, share: f64) -> (DMat3, f64) {
        let elastic = ElasticConstants::from_young_poisson(1e6, 0.3);
        let (mut strain, mut damping, mut stress) = ([Sym3::ZERO], [Sym3::ZERO], [DMat3::ZERO]);
        let mut work = 0.0;
        for (h, dt) in [(before, 0.0), (h, DT)] {
            stress = [DMat3::ZERO];
            let block = Damping {
                elastic: &elastic,
                dt,
                share,
                deformation: &[DMat3::IDENTITY + h],
                gradient: &[h],
                modulus: &[1e6],
                volume: &[2.0],
            };
            let rows = DampingRows { strain: &mut strain, stress: &mut damping };
            work = block.add(rows, &mut stress);
        }
        (stress[0], work)
    }

    #[test]
    fn a_turn_is_not_damped_and_a_stretch_is_by_its_share_of_the_stress() {
        let stretch = DMat3::from_diagonal(glam::DVec3::new(0.1, -0.05, 0.02));
        let turn = DMat3::from_rotation_z(0.3);
        let turned = turn * (DMat3::IDENTITY + stretch) - DMat3::IDENTITY;
        let (stress, work) = added(stretch, turned, SHARE);
        assert!(stress.to_cols_array().iter().all(|p| p.abs() < 1e-9) && work.abs() < 1e-12, "{stress}");
        let h = DMat3::from_diagonal(glam::DVec3::new(1e-6, 0.0, 0.0));
        let (stress, work) = added(DMat3::ZERO, h, SHARE);
        let modulus = ElasticConstants::from_young_poisson(1e6, 0.3).longitudinal_modulus();
        assert!((stress.x_axis.x / (SHARE * modulus * 1e-6) - 1.0).abs() < 1e-5, "{stress}");
        assert!((work / (SHARE * modulus * 1e-12) - 1.0).abs() < 1e-5, "{work}");
        assert_eq!(added(DMat3::ZERO, h, 0.0), (DMat3::ZERO, 0.0), "one step for all is not damped");
    }
}
