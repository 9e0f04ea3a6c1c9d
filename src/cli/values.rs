//! Values of options, and errors that state the expected form.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A reader of whole numbers within a range.
pub fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: FromStr + PartialOrd + Display + Clone,
{
    move |text| {
        let value = text.parse().ok().filter(|value| range.contains(value));
        value.ok_or_else(|| format!("expected a whole number from {} to {}", range.start(), range.end()))
    }
}

/// A time, s.
pub fn time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("expected a time in seconds, as in `0.5`".into()),
    }
}

/// A duration, s.
pub fn duration(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("expected a number of seconds, as in `3` or `0.5`".into()),
    }
}

/// A number of particles; k and M stand for thousands and millions.
pub fn particles(text: &str) -> Result<usize, String> {
    let (digits, factor) = match text.trim_end_matches(['k', 'M']) {
        digits if text.ends_with('k') => (digits, 1e3),
        digits if text.ends_with('M') => (digits, 1e6),
        digits => (digits, 1.0),
    };
    match digits.parse::<f64>() {
        Ok(value) if (1.0..=4e9).contains(&(value * factor)) => Ok((value * factor) as usize),
        _ => Err("expected a number of particles, as in `32k` or `1M`".into()),
    }
}
