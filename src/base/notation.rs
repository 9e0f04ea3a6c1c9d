//! Engineering notation of numbers: `13 ms`, `4.80 kJ`, `21 670 steps`.

/// SI prefixes and their powers of ten.
const PREFIXES: [(i32, &str); 9] =
    [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G"), (12, "T")];
/// Units that take a prefix.
const PREFIXED: [&str; 12] =
    ["s", "m", "N", "J", "Pa", "W", "m/s", "J/m", "N/m", "N m", "particle-steps/s", "particles/s"];

/// A number with at most six digits: `0.205`, `21670`, `1e308`.
pub fn number(value: f64) -> String {
    if !value.is_finite() || value == 0.0 {
        return format!("{}", value + 0.0);
    }
    let digits = format!("{value:.5e}");
    let Some((mantissa, exponent)) = digits.split_once('e') else { return digits };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let mantissa = trimmed(mantissa);
    match exponent {
        -4..=6 => {
            let decimals = usize::try_from(5 - exponent).unwrap_or(0);
            trimmed(&format!("{value:.decimals$}")).to_owned()
        }
        _ => format!("{mantissa}e{exponent}"),
    }
}

/// A value with its unit and an SI prefix, at most four digits: `13 ms`, `0 s`.
pub fn quantity(value: f64, unit: &str) -> String {
    let text = quantity_to(value, unit, 4);
    let (digits, unit) = text.split_once(' ').unwrap_or((&text, ""));
    match digits.split_once('e') {
        Some((mantissa, exponent)) => format!("{}e{exponent} {unit}", trimmed(mantissa)),
        None => format!("{} {unit}", trimmed(digits)),
    }
    .trim_end()
    .to_owned()
}

/// A value with its unit and an SI prefix, all of its `digits`: `4.80 kJ`. Pure numbers have the unit `1` and
/// no prefix.
pub fn quantity_to(value: f64, unit: &str, digits: usize) -> String {
    let unit = if unit == "1" { "" } else { unit };
    if value == 0.0 || !value.is_finite() {
        return format!("{} {unit}", value + 0.0).trim_end().to_owned();
    }
    let precision = digits.saturating_sub(1);
    let scientific = format!("{value:.precision$e}");
    // The exponent is that of the rounded value: 999.96 to four digits is 1000.
    let exponent: i32 = scientific.split_once('e').and_then(|(_, text)| text.parse().ok()).unwrap_or(0);
    let power = 3 * exponent.div_euclid(3);
    let prefix = PREFIXES.iter().find(|(known, _)| *known == power && PREFIXED.contains(&unit));
    let decimals = |exponent: i32| usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
    match prefix {
        Some((_, prefix)) => {
            let scaled = value / 10f64.powi(power);
            format!("{scaled:.*} {prefix}{unit}", decimals(exponent - power))
        }
        None if (-3..6).contains(&exponent) => {
            format!("{value:.*} {unit}", decimals(exponent)).trim_end().to_owned()
        }
        None => format!("{scientific} {unit}").trim_end().to_owned(),
    }
}

/// A point with at most six digits per coordinate, `(0.1, 0.03)`; z is omitted where it is zero, as in two
/// dimensions.
pub fn place(coordinates: impl Into<[f64; 3]>) -> String {
    let [x, y, z] = coordinates.into();
    let shown = if z == 0.0 { vec![x, y] } else { vec![x, y, z] };
    format!("({})", shown.into_iter().map(number).collect::<Vec<_>>().join(", "))
}

/// An integer with the counted noun, which is given in the singular: `1 step`, `21 670 steps`.
pub fn count(number: u64, noun: &str) -> String {
    let plural = match noun {
        _ if number == 1 => noun.to_owned(),
        _ if noun.ends_with('y') => format!("{}ies", &noun[..noun.len() - 1]),
        _ => format!("{noun}s"),
    };
    format!("{} {plural}", digits(number))
}

/// An integer in groups of three digits: `21 670`; four digits are not separated.
pub fn digits(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) && digits.len() > 4 {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// Digits without trailing zeros of the fraction.
fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_matter() {
        for (value, expected) in [
            (0.20500000000000002, "0.205"),
            (0.0048200000000000005, "0.00482"),
            (21670.0, "21670"),
            (-0.01, "-0.01"),
            (-0.0, "0"),
            (1e308, "1e308"),
            (1.5e-300, "1.5e-300"),
            (123456789.0, "1.23457e8"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), expected);
        }
    }

    #[test]
    fn quantities_have_prefixes() {
        for (value, unit, expected) in [
            (0.013, "s", "13 ms"),
            (1.3e-2 + 1e-18, "s", "13 ms"),
            (4803.2, "J", "4.803 kJ"),
            (999.99, "Pa", "1 kPa"),
            (0.0, "s", "0 s"),
            (2.5, "m", "2.5 m"),
            (0.5, "1", "0.5"),
            (7850.0, "kg", "7850 kg"),
            (1e-20, "J", "1e-20 J"),
            (-5.88, "J", "-5.88 J"),
        ] {
            assert_eq!(quantity(value, unit), expected);
        }
        assert_eq!(quantity_to(4800.0, "J", 3), "4.80 kJ");
        assert_eq!(quantity_to(999.6, "J", 3), "1.00 kJ");
    }

    #[test]
    fn places_have_the_coordinates_that_matter() {
        assert_eq!(place([0.1 + 1e-17, 0.03, 0.0]), "(0.1, 0.03)");
        assert_eq!(place([4.999999999996327e-7, -0.0, 2.0]), "(5e-7, 0, 2)");
    }

    #[test]
    fn counts_have_plurals() {
        assert_eq!(count(1, "step"), "1 step");
        assert_eq!(count(21_670, "step"), "21 670 steps");
        assert_eq!(count(4000, "particle"), "4000 particles");
        assert_eq!(count(0, "body"), "0 bodies");
    }
}
