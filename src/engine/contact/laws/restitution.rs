//! Restitution of a spring and dashpot without adhesion.

use std::f64::consts::PI;

/// Ratio of the speeds after and before an impact on a linear spring and dashpot of damping ratio zeta, where
/// the contact ends when the force has fallen to zero (Schwager and Poeschel, Granular Matter 9 (2007)
/// 465-469).
pub fn restitution(zeta: f64) -> f64 {
    if zeta < 1.0 {
        let frequency = (1.0 - zeta * zeta).sqrt();
        // The angle from 0 to pi whose tangent is 2 zeta frequency / (frequency^2 - zeta^2) runs backwards.
        let angle = PI - (2.0 * zeta * frequency).atan2(1.0 - 2.0 * zeta * zeta);
        (-zeta / frequency * angle).exp()
    } else if zeta > 1.0 {
        let root = (zeta * zeta - 1.0).sqrt();
        (-zeta / root * ((zeta + root) / (zeta - root)).ln()).exp()
    } else {
        (-2.0_f64).exp()
    }
}

/// Minimum restitution that a dashpot makes: the damping ratio of zero would be infinite, and a ratio above 5
/// more than the steps of an impact bear: it would turn the velocity around within one.
const MIN_RESTITUTION: f64 = 0.01;

/// Damping ratio of a restitution from 0 to 1.
pub fn damping_ratio(wanted: f64) -> f64 {
    if wanted >= 1.0 {
        return 0.0;
    }
    let wanted = wanted.max(MIN_RESTITUTION);
    // For large ratios the restitution is 1/(2 zeta)^2.
    let (mut low, mut high) = (0.0, 1.0 / wanted.sqrt());
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if restitution(middle) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restitution_is_that_of_the_integrated_motion() {
        // u' = -x - 2 zeta u by small steps, until the force is zero.
        for zeta in [0.01, 0.1, 0.4, 0.7, 0.999, 1.0, 1.5, 4.0_f64] {
            let (mut x, mut u, dt) = (0.0, 1.0, 1e-5);
            loop {
                let middle = (x + 0.5 * dt * u, u + 0.5 * dt * (-x - 2.0 * zeta * u));
                (x, u) = (x + dt * middle.1, u + dt * (-middle.0 - 2.0 * zeta * middle.1));
                if x + 2.0 * zeta * u <= 0.0 {
                    break;
                }
            }
            assert!((restitution(zeta) + u).abs() < 1e-4, "{zeta}: {} {u}", restitution(zeta));
        }
    }

    #[test]
    fn the_damping_ratio_is_the_inverse() {
        for wanted in [0.01, 0.1, 0.36, 0.5717, 0.9, 0.999, 1.0] {
            let zeta = damping_ratio(wanted);
            assert!((restitution(zeta) - wanted).abs() < 1e-9, "{wanted}: {zeta}");
        }
        assert!(damping_ratio(0.0) < 6.0);
    }
}
