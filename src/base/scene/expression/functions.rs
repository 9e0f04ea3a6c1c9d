//! The constants and functions that an expression may name.

use std::f64::consts::FRAC_PI_2;

/// Names of the variables, in the order in which an evaluation gets them.
pub(super) const VARIABLES: [&str; 4] = ["x", "y", "z", "t"];

pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// Names allowed in expressions, with their meaning.
pub(in crate::scene) const MEANINGS: [(&str, &str); 30] = [
    ("x", "first coordinate [m]"),
    ("y", "second coordinate [m]"),
    ("z", "third coordinate [m]"),
    ("t", "time [s]"),
    ("pi", "3.14159..."),
    ("e", "2.71828..."),
    ("abs", "absolute value"),
    ("sqrt", "square root"),
    ("exp", "exponential function"),
    ("ln", "natural logarithm"),
    ("log10", "logarithm to base 10"),
    ("sin", "sine of an angle in radians"),
    ("cos", "cosine of an angle in radians"),
    ("tan", "tangent of an angle in radians"),
    ("asin", "inverse sine [rad]"),
    ("acos", "inverse cosine [rad]"),
    ("atan", "inverse tangent [rad]"),
    ("sinh", "hyperbolic sine"),
    ("cosh", "hyperbolic cosine"),
    ("tanh", "hyperbolic tangent"),
    ("floor", "largest whole number that is not above the argument"),
    ("sign", "-1, 0 or 1"),
    ("step", "0 below 0, 1 from 0 on"),
    ("ramp", "linear from 0 at 0 to 1 at 1, constant outside"),
    ("smoothstep", "3 s^2 - 2 s^3 from 0 at 0 to 1 at 1, constant outside"),
    ("min", "smaller one of two arguments"),
    ("max", "larger one of two arguments"),
    ("pow", "first argument to the power of the second"),
    ("atan2", "angle of the point (second, first argument) [rad]"),
    ("mod", "remainder of a division, never negative"),
];

/// Whether a name is already a variable, constant or function.
pub(in crate::scene) fn is_reserved(name: &str) -> bool {
    VARIABLES.contains(&name)
        || CONSTANTS.iter().any(|(other, _)| *other == name)
        || UNARY.iter().any(|(other, _)| *other == name)
        || BINARY.iter().any(|(other, _)| *other == name)
}

/// A function of one argument.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unary {
    pub at: fn(f64) -> f64,
    pub course: Course,
}

/// How a function of one argument changes with it: what its values over an interval follow from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Course {
    /// It only rises, or only falls.
    Monotonic,
    /// It falls to its smallest value at zero, and rises from there.
    Even,
    /// It has its largest value of one at this angle and its smallest of minus one half a turn from there.
    Wave(f64),
    /// It has poles.
    Poles,
}

/// A function of two arguments.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binary {
    pub at: fn(f64, f64) -> f64,
    pub kind: BinaryKind,
}

/// How a function of two arguments changes with them.
#[derive(Clone, Copy, Debug)]
pub(super) enum BinaryKind {
    /// With one argument held it only rises, or only falls, with the other one.
    Monotonic,
    Quotient,
    Power,
    Angle,
    Remainder,
}

const fn monotonic(at: fn(f64) -> f64) -> Unary {
    Unary { at, course: Course::Monotonic }
}

const fn with(at: fn(f64) -> f64, course: Course) -> Unary {
    Unary { at, course }
}

pub(super) const NEGATIVE: Unary = monotonic(|a| -a);
pub(super) const PLUS: Binary = Binary { at: |a, b| a + b, kind: BinaryKind::Monotonic };
pub(super) const MINUS: Binary = Binary { at: |a, b| a - b, kind: BinaryKind::Monotonic };
pub(super) const TIMES: Binary = Binary { at: |a, b| a * b, kind: BinaryKind::Monotonic };
pub(super) const OVER: Binary = Binary { at: |a, b| a / b, kind: BinaryKind::Quotient };
pub(super) const POWER: Binary = Binary { at: f64::powf, kind: BinaryKind::Power };

pub(super) const UNARY: [(&str, Unary); 19] = [
    ("abs", with(f64::abs, Course::Even)),
    ("sqrt", monotonic(f64::sqrt)),
    ("exp", monotonic(f64::exp)),
    ("ln", monotonic(f64::ln)),
    ("log10", monotonic(f64::log10)),
    ("sin", with(f64::sin, Course::Wave(FRAC_PI_2))),
    ("cos", with(f64::cos, Course::Wave(0.0))),
    ("tan", with(f64::tan, Course::Poles)),
    ("asin", monotonic(f64::asin)),
    ("acos", monotonic(f64::acos)),
    ("atan", monotonic(f64::atan)),
    ("sinh", monotonic(f64::sinh)),
    ("cosh", with(f64::cosh, Course::Even)),
    ("tanh", monotonic(f64::tanh)),
    ("floor", monotonic(f64::floor)),
    ("sign", monotonic(|s| if s == 0.0 { 0.0 } else { s.signum() })),
    ("step", monotonic(|s| if s < 0.0 { 0.0 } else { 1.0 })),
    ("ramp", monotonic(|s| s.clamp(0.0, 1.0))),
    ("smoothstep", monotonic(smoothstep)),
];

pub(super) const BINARY: [(&str, Binary); 5] = [
    ("min", Binary { at: min, kind: BinaryKind::Monotonic }),
    ("max", Binary { at: max, kind: BinaryKind::Monotonic }),
    ("pow", POWER),
    ("atan2", Binary { at: f64::atan2, kind: BinaryKind::Angle }),
    ("mod", Binary { at: f64::rem_euclid, kind: BinaryKind::Remainder }),
];

fn smoothstep(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

// Unlike `f64::min` and `f64::max` these keep a NaN, so that the watchdog sees it.
fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

fn max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
