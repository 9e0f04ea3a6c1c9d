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

use std::f64::consts::PI;

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
#[derive(Clone, Copy)]
pub(crate) struct DampedSubSteps {
    /// c in the sub-steps that the body takes where it is the stiffest one.
    pub share: f64,
    /// Largest c for which they need not be shorter.
    pub room: f64,
    /// Whether contacts may use up what shorter sub-steps leave of their limit.
    pub touches: bool,
    /// Length of these over the stable step.
    pub factor: f64,
    /// Least time of the damping.
    pub least: LeastTime,
    /// Largest c by that time: in a body that is crushed the stable step falls far below its first one.
    pub most: f64,
}

/// Least time of the damping that the motions of a stiff body need beside a fluid: those of a frequency omega
/// that the long step dt does not resolve take energy from a frozen force that acts on the mass m with the
/// stiffness `kappa m`, and none with a damping of the time `kappa / omega^3` or so.
#[derive(Clone, Copy)]
pub(crate) struct LeastTime {
    /// That time over the square of dt where a motion has half a period in dt, 1/s: `kappa dt` is a constant.
    pub rate: f64,
    /// Lowest frequency of the body, rad/s.
    pub lowest: f64,
}

impl LeastTime {
    /// In a long step, s.
    pub fn of(self, long: f64) -> f64 {
        self.rate * long * long * (PI / (self.lowest * long)).min(1.0).powi(3)
    }

    /// Longest step with a time of no more than `time`, s.
    pub fn longest_step(self, time: f64) -> f64 {
        match self.of(PI / self.lowest) <= time {
            true => f64::INFINITY,
            false => (time / self.rate).sqrt(),
        }
    }
}

impl DampedSubSteps {
    /// Time of the damping, s, and length of the sub-steps that the body alone would take in a long step, s,
    /// where its stable step is `stable`, s.
    ///
    /// What a mode needs is a time, which does not depend on other bodies: where these take shorter
    /// sub-steps, each of which changes the strain by less, c is larger. Such a step has room for it:
    /// (omega dt)^2 falls faster than c grows.
    fn time(self, long: f64, stable: f64) -> (f64, f64) {
        let own = long / (long / (self.factor * stable) - 1e-9).ceil().max(1.0);
        let least = self.least.of(long).min(self.most * own);
        (f64::max(self.share * own, least), own)
    }
}

/// c of a body in a sub-step of length dt, s, whose own stable step is `stable`, s; zero without a long step.
pub(super) fn share_in(dt: f64, damped: Option<(f64, DampedSubSteps)>, stable: f64) -> f64 {
    damped.map_or(0.0, |(long, damped)| {
        let (time, own) = damped.time(long, stable);
        time / own.min(dt)
    })
}

/// Stable step of the body with that damping, s. The leapfrog is stable while `a x^2 (1 + 2 c / x)` is no
/// more than 4, with a the square of the phase of the fastest mode in a stable step, c the time of the
/// damping over that step and x the share of it that is taken; contacts take what the square leaves.
pub(super) fn stable_step(damped: Option<(f64, DampedSubSteps)>, stable: f64) -> f64 {
    damped.map_or(stable, |(long, damped)| {
        let (time, own) = damped.time(long, stable);
        let (c, room) = (time / own, damped.room);
        let share = if damped.touches { room / c } else { (c * c + 1.0 + 2.0 * room).sqrt() - c };
        stable * share.min(1.0)
    })
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

    fn least(rate: f64) -> LeastTime {
        LeastTime { rate, lowest: 0.1 }
    }

    #[test]
    fn compact_bodies_need_no_time_in_long_steps() {
        let least = LeastTime { rate: 0.1, lowest: PI };
        // Half a period of the lowest motion is a second.
        assert!((least.of(0.5) / 0.025 - 1.0).abs() < 1e-12);
        assert!((least.of(1.0) / 0.1 - 1.0).abs() < 1e-12);
        assert!((least.of(10.0) / 0.01 - 1.0).abs() < 1e-12);
        assert_eq!(least.longest_step(0.11), f64::INFINITY);
        assert!((least.longest_step(0.025) / 0.5 - 1.0).abs() < 1e-12);
        // A body without stiffness.
        assert_eq!(LeastTime { rate: 0.1, lowest: 0.0 }.of(2.0), 0.4);
    }

    #[test]
    fn the_time_of_the_damping_does_not_depend_on_how_many_sub_steps_others_take() {
        let own = DampedSubSteps {
            share: SHARE,
            room: 0.5,
            touches: false,
            factor: 1.0,
            least: least(0.0),
            most: 2.0,
        };
        // Two and a half stable steps are three of its own.
        for (dt, expected) in [(10.0 / 3.0, SHARE), (0.1, SHARE * 100.0 / 3.0), (5.0, SHARE)] {
            let share = share_in(dt, Some((10.0, own)), 4.0);
            assert!((share / expected - 1.0).abs() < 1e-12, "{share} in sub-steps of {dt} s");
        }
        // A soft body, whose stable step is longer than the long one, is damped for a share of that.
        assert!((share_in(1.0, Some((10.0, own)), 400.0) / (10.0 * SHARE) - 1.0).abs() < 1e-12);
        // Half the factor, half the time.
        let short = DampedSubSteps { factor: 0.5, ..own };
        assert!((share_in(0.1, Some((10.0, short)), 4.0) / (20.0 * SHARE) - 1.0).abs() < 1e-12);
        assert_eq!(share_in(0.1, None, 4.0), 0.0, "one step for all is not damped");
    }

    #[test]
    fn the_time_of_the_damping_is_no_less_than_the_long_step_demands() {
        let own = DampedSubSteps {
            share: SHARE,
            room: 0.5,
            touches: true,
            factor: 1.0,
            least: least(0.1),
            most: 2.0,
        };
        // 2.5 s in steps of 2 s.
        assert!((share_in(2.0, Some((5.0, own)), 2.5) / (2.5 / 2.0) - 1.0).abs() < 1e-12);
        // Twice the largest share of 0.5 in a step of 2.5 s.
        let stable = stable_step(Some((5.0, own)), 2.5);
        assert!((stable / 1.25 - 1.0).abs() < 1e-12, "{stable}");
        let free = stable_step(Some((5.0, DampedSubSteps { touches: false, ..own })), 2.5) / 2.5;
        assert!((free * (free + 2.0) / 2.0 - 1.0).abs() < 1e-12, "{free}");
        assert_eq!(stable_step(Some((0.5, own)), 2.5), 2.5, "a soft body");
        // 0.1 s, and twice the stable step.
        let crushed = share_in(0.01, Some((1.0, own)), 0.01);
        assert!((crushed / 2.0 - 1.0).abs() < 1e-6, "{crushed}");
        assert_eq!(stable_step(None, 2.5), 2.5, "one step for all");
    }

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
