//! Pressure of a fluid as a function of its density, and its viscosity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pressure as a function of density.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub enum EquationOfState {
    /// p = c_0^2 (rho - rho_0).
    #[default]
    Linear,
    /// p = c_0^2 rho_0 / gamma ((rho / rho_0)^gamma - 1) (Tait; Monaghan, J. Comput. Phys. 110 (1994)
    /// 399-406).
    Tait {
        /// Exponent gamma above 1; 7 for water.
        gamma: f64,
    },
}

/// Constitutive data of a fluid: equation of state and viscosity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluidLaw {
    /// Speed of sound c_0, m/s; none until it is estimated from the scene.
    pub sound_speed: Option<f64>,
    /// Dynamic viscosity mu, Pa s.
    pub viscosity: f64,
    /// Pressure as a function of density.
    pub eos: EquationOfState,
}

impl EquationOfState {
    /// Pressure p, Pa, at the density rho, kg/m3, of a fluid of density rho_0 and speed of sound c_0, m/s.
    #[inline(always)]
    pub fn pressure(&self, rho: f64, rho_0: f64, c_0: f64) -> f64 {
        match *self {
            Self::Linear => c_0 * c_0 * (rho - rho_0),
            Self::Tait { gamma } => c_0 * c_0 * rho_0 / gamma * ((rho / rho_0).powf(gamma) - 1.0),
        }
    }

    /// Density rho, kg/m3, at the pressure p, Pa: the inverse of [`EquationOfState::pressure`].
    pub fn density(&self, p: f64, rho_0: f64, c_0: f64) -> f64 {
        let compression = p / (c_0 * c_0 * rho_0);
        match *self {
            Self::Linear => rho_0 * (1.0 + compression),
            Self::Tait { gamma } => rho_0 * (1.0 + gamma * compression).max(0.0).powf(1.0 / gamma),
        }
    }

    /// Energy of compression per mass from rho_0 to rho, J/kg: the integral of p / rho^2.
    #[inline(always)]
    pub fn energy(&self, rho: f64, rho_0: f64, c_0: f64) -> f64 {
        match *self {
            Self::Linear => self.energy_change(rho_0, rho, rho_0, c_0),
            Self::Tait { gamma } => {
                let excess = rho / rho_0 - 1.0;
                let ratio = 1.0 + excess;
                let power = ratio.powf(gamma - 1.0) - 1.0;
                c_0 * c_0 / gamma * (power / (gamma - 1.0) - excess / ratio)
            }
        }
    }

    /// Energy of compression per mass from one density to another, J/kg: the integral of p / rho^2 between
    /// them. A small change keeps its digits, which a difference of two energies loses, and costs no
    /// logarithm.
    #[inline(always)]
    pub fn energy_change(&self, from: f64, to: f64, rho_0: f64, c_0: f64) -> f64 {
        match *self {
            Self::Linear => {
                // One division for both.
                let (change, sum, product) = (to - from, to + from, to * from);
                let inverse = 1.0 / (sum * product);
                let z = change * product * inverse;
                let square = z * z;
                // ln(to / from) = 2 artanh z; the series is exact to 1e-18 here.
                let log = if square < 1e-4 {
                    2.0 * z * (1.0 + square * (1.0 / 3.0 + square * (1.0 / 5.0 + square * (1.0 / 7.0))))
                } else {
                    logarithm(to / from)
                };
                c_0 * c_0 * (log - rho_0 * change * sum * inverse)
            }
            Self::Tait { .. } => self.energy(to, rho_0, c_0) - self.energy(from, rho_0, c_0),
        }
    }
}

/// Out of line, where it leaves the registers of a loop alone.
#[cold]
fn logarithm(x: f64) -> f64 {
    x.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAWS: [EquationOfState; 3] =
        [EquationOfState::Linear, EquationOfState::Tait { gamma: 7.0 }, EquationOfState::Tait { gamma: 1.4 }];

    #[test]
    fn density_is_the_inverse_of_pressure_whose_slope_is_the_square_of_the_speed_of_sound() {
        for eos in LAWS {
            for p in [-4e3, 0.0, 5e3, 2e5] {
                let rho = eos.density(p, 1000.0, 30.0);
                assert!((eos.pressure(rho, 1000.0, 30.0) - p).abs() < 1e-9 * p.abs() + 1e-6, "{eos:?} {p}");
            }
            let slope = (eos.pressure(1000.001, 1000.0, 30.0) - eos.pressure(999.999, 1000.0, 30.0)) / 2e-3;
            assert!((slope - 900.0).abs() < 1e-3, "{eos:?}: {slope}");
        }
    }

    #[test]
    fn a_change_of_energy_is_the_difference_of_two() {
        for eos in LAWS {
            for (from, to) in [(1000.0, 1000.1), (1003.0, 1002.0), (980.0, 1020.0), (700.0, 1300.0)] {
                let closed = |rho: f64| match eos {
                    EquationOfState::Linear => 900.0 * ((rho / 1000.0).ln() + 1000.0 / rho - 1.0),
                    EquationOfState::Tait { .. } => eos.energy(rho, 1000.0, 30.0),
                };
                let (wanted, change) = (closed(to) - closed(from), eos.energy_change(from, to, 1000.0, 30.0));
                assert!((change - wanted).abs() < 1e-12, "{eos:?} {from} {to}: {change} {wanted}");
            }
        }
    }

    #[test]
    fn the_slope_of_the_energy_is_pressure_over_density_squared() {
        for eos in LAWS {
            assert_eq!(eos.energy(1000.0, 1000.0, 30.0), 0.0);
            for rho in [990.0, 1005.0, 1080.0] {
                let d = 1e-3;
                let slope =
                    (eos.energy(rho + d, 1000.0, 30.0) - eos.energy(rho - d, 1000.0, 30.0)) / (2.0 * d);
                let wanted = eos.pressure(rho, 1000.0, 30.0) / (rho * rho);
                assert!((slope - wanted).abs() < 1e-6 * wanted.abs(), "{eos:?} {rho}: {slope} {wanted}");
            }
        }
    }
}
