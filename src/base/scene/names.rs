//! The nearest known name to a misspelt one.

use super::slips::synonym;

/// Maximum number of characters of a name in a message.
const LONGEST_NAME: usize = 80;

/// Message and help lines for a name that is not known: what was found, the nearest known name, all known
/// names. `kind` says what is named, in the singular: `plugin`, `material`.
pub fn unknown<S: AsRef<str>>(kind: &str, name: &str, known: &[S]) -> (String, Vec<String>) {
    let mut help = Vec::new();
    if let Some(near) = synonym(name, known).or_else(|| nearest(name, known)) {
        help.push(format!("did you mean `{near}`?"));
    }
    if known.is_empty() {
        help.push(format!("the scene has no {kind}"));
    } else {
        let names: Vec<_> = known.iter().map(|known| format!("`{}`", known.as_ref())).collect();
        help.push(format!("known here: {}", names.join(", ")));
    }
    (format!("unknown {kind} `{}`", shortened(name)), help)
}

/// The name as messages show it; a very long one is truncated.
fn shortened(name: &str) -> String {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}...", &name[..end]),
        None => name.to_owned(),
    }
}

/// The known name that `name` most likely stands for, if any is similar enough.
pub fn nearest<'a, S: AsRef<str>>(name: &str, known: &'a [S]) -> Option<&'a str> {
    if name.len() > 4 * LONGEST_NAME {
        return None;
    }
    let wanted = name.to_lowercase();
    let mut best: Option<(f64, &str)> = None;
    for candidate in known.iter().map(AsRef::as_ref) {
        let other = candidate.to_lowercase();
        let edits = strsim::damerau_levenshtein(&wanted, &other);
        let near =
            edits <= (wanted.chars().count() / 3).max(1) || strsim::jaro_winkler(&wanted, &other) >= 0.88;
        let likeness = strsim::normalized_damerau_levenshtein(&wanted, &other);
        if near && best.is_none_or(|(most, _)| likeness > most) {
            best = Some((likeness, candidate));
        }
    }
    let contains = |candidate: &&str| wanted.len() > 3 && candidate.to_lowercase().contains(&wanted);
    let longer = || known.iter().map(AsRef::as_ref).filter(contains).min_by_key(|candidate| candidate.len());
    best.map(|(_, candidate)| candidate).or_else(longer).or_else(|| of_like_words(&wanted, known))
}

/// The known name whose words of three letters and more all occur in the wanted one, in any order: the one
/// with the most such words.
fn of_like_words<'a, S: AsRef<str>>(wanted: &str, known: &'a [S]) -> Option<&'a str> {
    let words: Vec<&str> = wanted.split('_').collect();
    let of = |candidate: &'a str| candidate.split('_').filter(|word| word.len() > 2);
    let fits = |candidate: &&'a str| of(candidate).all(|word| words.contains(&word));
    let with_words = known.iter().map(AsRef::as_ref).filter(|candidate| of(candidate).count() > 0);
    with_words.filter(fits).max_by_key(|candidate| of(candidate).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_nearest() {
        let known = ["hourglass_control", "artificial_viscosity", "xsph"];
        assert_eq!(nearest("hourglas_control", &known), Some("hourglass_control"));
        assert_eq!(nearest("HourglassControl", &known), Some("hourglass_control"));
        assert_eq!(nearest("hourglass", &known), Some("hourglass_control"));
        assert_eq!(nearest("spam", &known), None);
        assert_eq!(nearest("mises", &["von_mises", "max_von_mises", "mass"]), Some("von_mises"));
        assert_eq!(nearest("Level", &["Energy", "WaterLevel"]), Some("WaterLevel"));
        assert_eq!(nearest("speed_of_sound", &["density", "sound_speed", "speed"]), Some("sound_speed"));
        assert_eq!(nearest("modulus_young_of_steel", &["density", "young"]), Some("young"));
        assert_eq!(nearest("colour", &["color", "count"]), Some("color"));
    }
}
