//! The constants and functions that an expression may name.

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

pub(super) type Unary = fn(f64) -> f64;
pub(super) type Binary = fn(f64, f64) -> f64;

pub(super) const UNARY: [(&str, Unary); 19] = [
    ("abs", f64::abs),
    ("sqrt", f64::sqrt),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("floor", f64::floor),
    ("sign", |s| if s == 0.0 { 0.0 } else { s.signum() }),
    ("step", |s| if s < 0.0 { 0.0 } else { 1.0 }),
    ("ramp", |s| s.clamp(0.0, 1.0)),
    ("smoothstep", smoothstep),
];

pub(super) const BINARY: [(&str, Binary); 5] =
    [("min", min), ("max", max), ("pow", f64::powf), ("atan2", f64::atan2), ("mod", f64::rem_euclid)];

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
