//! The combinations of values of a sweep.

/// One combination: path and value of every setting.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepCase {
    /// Path and value of each, in the order given.
    pub settings: Vec<(String, String)>,
}

/// Maximum number of runs: more are most likely a mistake.
const MAX_RUNS: usize = 10_000;

/// Every combination of the values, the last setting changing fastest.
///
/// # Errors
/// A setting has an empty value, a path is given twice, or there are too many combinations.
pub fn combinations(settings: &[(String, String)]) -> Result<Vec<SweepCase>, String> {
    let mut cases = vec![SweepCase { settings: Vec::new() }];
    for (k, (path, values)) in settings.iter().enumerate() {
        if settings[..k].iter().any(|(other, _)| other == path) {
            return Err(format!("`{path}` is given twice; give all of its values at once: {path}=1,2,3"));
        }
        let values = split(values);
        if values.iter().any(|value| value.is_empty()) {
            return Err(format!("a value of `{path}` is empty"));
        }
        if cases.len() * values.len() > MAX_RUNS {
            return Err(format!("a sweep has at most {MAX_RUNS} runs"));
        }
        cases =
            cases.iter().flat_map(|case| values.iter().map(move |value| case.with(path, value))).collect();
    }
    Ok(cases)
}

impl SweepCase {
    fn with(&self, path: &str, value: &str) -> Self {
        let mut case = self.clone();
        case.settings.push((path.to_owned(), value.to_owned()));
        case
    }

    /// The case in a line: `dx = 0.01, end = 1`.
    pub fn label(&self) -> String {
        let parts = self.settings.iter().map(|(path, value)| format!("{} = {value}", short(path)));
        parts.collect::<Vec<_>>().join(", ")
    }

    /// The name of its folder: `dx=0.01_end=1`.
    pub fn folder(&self) -> String {
        let parts = self.settings.iter().map(|(path, value)| format!("{}={value}", short(path)));
        let name = parts.collect::<Vec<_>>().join("_");
        let fits = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '+' | '.' | '=');
        name.chars().map(|c| if fits(c) { c } else { '-' }).take(100).collect()
    }
}

/// The last name of a path; `parameters.dx` is `dx`, `bodies.plate.spacing` stays as it is.
pub fn short(path: &str) -> &str {
    path.strip_prefix("parameters.").unwrap_or(path)
}

/// The parts between commas outside of brackets and quotes.
fn split(values: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut depth, mut quoted, mut start) = (0i32, false, 0);
    for (at, c) in values.char_indices() {
        match c {
            '"' => quoted = !quoted,
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            ',' if !quoted && depth == 0 => {
                parts.push(values[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(values[start..].trim());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(settings: &[(&str, &str)]) -> Result<Vec<SweepCase>, String> {
        let owned: Vec<_> =
            settings.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
        combinations(&owned)
    }

    #[test]
    fn every_combination_has_a_folder() {
        let cases = given(&[("parameters.dx", "0.01, 0.005"), ("gravity", "(0,-1),(0,-2)")]).unwrap();
        let folders: Vec<String> = cases.iter().map(SweepCase::folder).collect();
        assert_eq!(
            folders,
            [
                "dx=0.01_gravity=-0--1-",
                "dx=0.01_gravity=-0--2-",
                "dx=0.005_gravity=-0--1-",
                "dx=0.005_gravity=-0--2-"
            ]
        );
        assert_eq!(cases[1].settings[1], ("gravity".to_owned(), "(0,-2)".to_owned()));
        assert_eq!(cases[0].label(), "dx = 0.01, gravity = (0,-1)");
    }

    #[test]
    fn slips_are_refused() {
        assert!(given(&[("a", "1,,2")]).unwrap_err().contains("empty"));
        assert!(given(&[("a", "1"), ("a", "2")]).unwrap_err().contains("twice"));
    }
}
