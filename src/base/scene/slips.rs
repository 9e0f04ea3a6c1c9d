//! Frequent mistakes in first scenes: units, expressions without quotes, decimal commas, everyday names of
//! shapes.

/// Units that users write after numbers, with the exponent of ten relative to the SI unit.
const UNITS: [(&str, i32); 33] = [
    ("m", 0),
    ("mm", -3),
    ("cm", -2),
    ("um", -6),
    ("µm", -6),
    ("km", 3),
    ("s", 0),
    ("ms", -3),
    ("us", -6),
    ("µs", -6),
    ("ns", -9),
    ("kg", 0),
    ("g", -3),
    ("t", 3),
    ("N", 0),
    ("mN", -3),
    ("kN", 3),
    ("MN", 6),
    ("Pa", 0),
    ("kPa", 3),
    ("MPa", 6),
    ("GPa", 9),
    ("bar", 5),
    ("J", 0),
    ("mJ", -3),
    ("kJ", 3),
    ("MJ", 6),
    ("W", 0),
    ("kW", 3),
    ("K", 0),
    ("Hz", 0),
    ("kHz", 3),
    ("%", -2),
];

/// Everyday names and the names in scenes, with their values where a name alone is not enough.
const SYNONYMS: [(&str, &str); 36] = [
    ("disk", "Sphere"),
    ("disc", "Sphere"),
    ("circle", "Sphere"),
    ("ball", "Sphere"),
    ("rectangle", "Box"),
    ("rect", "Box"),
    ("square", "Box"),
    ("cuboid", "Box"),
    ("cube", "Box"),
    ("plane", "HalfSpace"),
    ("halfplane", "HalfSpace"),
    ("pipe", "Tube"),
    ("annulus", "Ring"),
    ("rotation", "RotationRate"),
    ("turn", "RotationRate"),
    ("support", "Fix"),
    ("clamp", "Fix"),
    ("linearelastic", "StVenantKirchhoff"),
    ("elastic", "StVenantKirchhoff"),
    ("water", "Fluid"),
    ("liquid", "Fluid"),
    ("youngsmodulus", "young"),
    ("elasticmodulus", "young"),
    ("emodulus", "young"),
    ("poissonsratio", "poisson"),
    ("nu", "poisson"),
    ("rho", "density"),
    ("stress", "Field(\"stress\")"),
    ("vonmises", "Field(\"von_mises\")"),
    ("strain", "max_principal_stretch"),
    ("strain", "Field(\"max_principal_stretch\")"),
    ("plasticstrain", "Field(\"plastic_strain\")"),
    ("pressure", "Field(\"pressure\")"),
    ("temperature", "Field(\"temperature\")"),
    ("damage", "Field(\"damage\")"),
    ("density", "Field(\"density\")"),
];

/// Formulations, which first scenes have in the place of `Body`.
const FORMULATIONS: [&str; 6] =
    ["Fluid", "Wall", "Rigid", "TotalLagrangian", "UpdatedLagrangian", "Eulerian"];

/// Help for the name of a struct where another one is expected.
pub(super) fn in_place_of(expected: &str, found: &str) -> String {
    if expected == "Body" && FORMULATIONS.contains(&found) {
        return format!("`{found}` is the formulation of a body: `Body(formulation: {found}(), ...)`");
    }
    format!("the name may also be left out: `(...)` is a `{expected}` here")
}

/// The known name for an everyday name.
pub(super) fn synonym<S: AsRef<str>>(name: &str, known: &[S]) -> Option<&'static str> {
    let plain: String = name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    let is_known = |meant: &str| known.iter().any(|known| Some(known.as_ref()) == meant.split('(').next());
    SYNONYMS.iter().find(|(word, meant)| *word == plain && is_known(meant)).map(|(_, meant)| *meant)
}

/// Help if text, `rest`, follows directly on a complete number at the end of `before`.
pub(super) fn after_number(before: &str, rest: &str) -> Option<String> {
    let before = before.trim_end();
    let start = before.rfind(|c: char| !(c.is_alphanumeric() || matches!(c, '.' | '_' | '-' | '+')));
    let number = &before[start.map_or(0, |at| at + before[at..].chars().next().map_or(1, char::len_utf8))..];
    number.parse::<f64>().ok()?;
    if rest.starts_with(['*', '/', '^', '+', '-']) {
        let end = rest.find([',', ')', ']', '}', '\n']).unwrap_or(rest.len());
        return Some(format!("an expression stands in quotes: `\"{number}{}\"`", rest[..end].trim_end()));
    }
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '%')).unwrap_or(rest.len());
    with_unit(number, &rest[..end])
}

/// Help for a number with a unit attached, such as `3ms`.
pub(super) fn attached_unit(text: &str) -> Option<String> {
    let at = text.rfind(|c: char| c.is_ascii_digit() || matches!(c, '.' | '_'))? + 1;
    let number = text[..at].trim_end_matches('_');
    number.parse::<f64>().ok()?;
    with_unit(number, &text[at..])
}

/// Whether a word is a unit.
pub(super) fn is_unit(word: &str) -> bool {
    UNITS.iter().any(|(unit, _)| *unit == word)
}

fn with_unit(number: &str, unit: &str) -> Option<String> {
    let (_, power) = UNITS.iter().find(|(known, _)| *known == unit)?;
    let value = match (*power, number.split_once(['e', 'E'])) {
        (0, _) => number.to_owned(),
        (power, None) => format!("{number}e{power}"),
        (power, Some((mantissa, exponent))) => {
            format!("{mantissa}e{}", exponent.parse::<i32>().ok()? + power)
        }
    };
    Some(format!("numbers are in SI units, which are not written: `{value}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_become_powers_of_ten() {
        let said = |value: &str| Some(format!("numbers are in SI units, which are not written: `{value}`"));
        assert_eq!(after_number("(end: 3 ", "ms)"), said("3e-3"));
        assert_eq!(after_number("young: 210e9 ", "Pa,"), said("210e9"));
        assert_eq!(after_number("young: 2.1e2 ", "GPa,"), said("2.1e11"));
        assert_eq!(after_number("x: 50", "%)"), said("50e-2"));
        assert_eq!(attached_unit("3mm"), said("3e-3"));
        assert_eq!(attached_unit("3_ms"), said("3e-3"));
        assert_eq!(attached_unit("3.0e6x"), None);
        assert_eq!(after_number("end: now ", "ms"), None);
        assert_eq!(after_number("end: 3 ", "parsec"), None);
    }

    #[test]
    fn expressions_are_put_in_quotes() {
        assert_eq!(
            after_number("(end: 1", "/3)").as_deref(),
            Some("an expression stands in quotes: `\"1/3\"`")
        );
        assert_eq!(after_number("µ", "/3"), None);
    }

    #[test]
    fn everyday_names_have_one_in_scenes() {
        let shapes = ["Box", "Sphere", "HalfSpace"];
        assert_eq!(synonym("Disk", &shapes), Some("Sphere"));
        assert_eq!(synonym("half_plane", &shapes), Some("HalfSpace"));
        assert_eq!(synonym("Pipe", &shapes), None);
        assert_eq!(synonym("VonMises", &["Velocity", "Field"]), Some("Field(\"von_mises\")"));
        assert_eq!(synonym("VonMises", &["Velocity"]), None);
    }
}
