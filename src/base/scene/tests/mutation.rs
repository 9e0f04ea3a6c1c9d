//! Damaged scenes: always an error or a scene, never a panic.

use proptest::prelude::*;

use super::super::*;
use super::{cases, everything};

/// Bits of scenes that are likely to confuse.
const PIECES: [&str; 24] = [
    "(", ")", "[", "]", "{", "}", "\"", "\\", ",", ":", "/*", "*/", "//", "r#\"", "None", "Some(", "inf",
    "-", "1e999", "é", "\u{1f}", "Box", "#![", "'",
];

fn survives(source: &Source) {
    if let Err(error) = parse(source.clone()) {
        assert!(!error.problems.is_empty());
        assert!(error.to_string().contains("everything.ron"));
    }
}

fn boundary(text: &str, place: f64) -> usize {
    let mut at = (place * text.len() as f64) as usize;
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(400), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_scenes(cuts in prop::collection::vec((0.0..1.0f64, 0usize..12, 0usize..PIECES.len()), 1..5)) {
        let mut source = everything();
        for (place, length, piece) in cuts {
            let start = boundary(&source.text, place);
            let mut end = (start + length).min(source.text.len());
            while !source.text.is_char_boundary(end) {
                end += 1;
            }
            source.text.replace_range(start..end, PIECES[piece]);
        }
        survives(&source);
    }

    #[test]
    fn exchanged_pieces(a in 0.0..1.0f64, b in 0.0..1.0f64, length in 1usize..60) {
        let mut source = everything();
        let from = boundary(&source.text, a);
        let to = boundary(&source.text, ((from + length) as f64 / source.text.len() as f64).min(1.0)).max(from);
        let piece = source.text[from..to].to_owned();
        let at = boundary(&source.text, b);
        source.text.insert_str(at, &piece);
        survives(&source);
    }

    #[test]
    fn truncated_scenes(place in 0.0..1.0f64) {
        let mut source = everything();
        source.text.truncate(boundary(&source.text, place));
        survives(&source);
    }

    #[test]
    fn any_text(text in "\\PC{0,60}", path in "[a-z.\\[\\]0-9]{0,20}") {
        survives(&Source::new("everything.ron", text.clone()));
        if let Err(problem) = everything().with_override(&path, &text) {
            prop_assert!(problem.render(&everything()).contains("everything.ron"));
        }
        let _ = text.parse::<Expression>();
        let _ = text.parse::<Item>();
    }
}
