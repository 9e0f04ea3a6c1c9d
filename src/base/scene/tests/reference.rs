//! The documentation that is generated from the types.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::*;

/// How an hourglass is held.
#[derive(Default, Serialize, Deserialize, JsonSchema)]
enum Form {
    /// From a potential.
    #[default]
    Variational,
    /// As in the paper.
    Paper,
}

fn five() -> f64 {
    5.0
}

fn gone() -> Option<f64> {
    None
}

/// A plugin.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Control {
    /// Strength \[-\].
    #[serde(default = "five")]
    alpha: f64,
    /// Form.
    #[serde(default)]
    form: Form,
    /// Reference speed \[m/s\].
    speed: f64,
    /// Start \[s\].
    #[serde(default = "gone")]
    from: Option<f64>,
    /// Motion \[m/s\].
    #[serde(default)]
    value: PerAxis<Expression>,
    /// Direction \[-\].
    #[serde(default)]
    axis: Vec3,
    /// Where.
    #[serde(default)]
    on: Select,
}

#[test]
fn parameters_of_a_plugin() {
    let list = parameters::<Control>();
    let row = |p: &Parameter| {
        let default =
            p.default.clone().unwrap_or_else(|| if p.required { "required".into() } else { "?".into() });
        format!("{}: {} = {}; {}", p.name, p.kind, default, p.doc)
    };
    let rows: Vec<_> = list.iter().map(row).collect();
    assert_eq!(
        rows,
        [
            "alpha: number = 5.0; Strength [-].",
            "form: Variational or Paper = Variational; Form.",
            "speed: number = required; Reference speed [m/s].",
            "from: number = None; Start [s].",
            "value: (x, y) or (x, y, z), each a number or text = (None, None, None); Motion [m/s].",
            "axis: (x, y) or (x, y, z) = (0.0, 0.0, 0.0); Direction [-].",
            "on: Select = (body: None, within: None, face: None, nearest: None, surface: None); Where.",
        ]
    );
}

#[test]
fn every_field_is_documented() {
    let page = schema_markdown();
    for heading in [
        "Scene", "Body", "Domain", "Time", "Step", "Probe", "Quantity", "Select", "Record", "Contact",
        "Shape",
    ] {
        assert!(page.contains(&format!("## {heading}\n")), "{heading} is missing");
    }
    assert!(
        page.contains("| `spacing` | number | required | Distance between neighbouring particles [m]. |"),
        "{page}"
    );
    assert!(page.contains("| `step` | Step | `Adaptive(factor: 1.0)` |"), "{page}");
    assert!(page.contains("- `Fixed(number)`: A constant time step [s]."), "{page}");
    assert!(page.contains("- `Field(text)`: A field"), "{page}");
    for line in page.lines() {
        assert!(!(line.starts_with("| `") && line.ends_with("|  |")), "without meaning: {line}");
        assert!(!line.ends_with("`: "), "without meaning: {line}");
    }
}

#[test]
fn defaults_are_those_that_scenes_get() {
    // Each default that the page shows, written into a scene, changes nothing.
    let plain = parse(super::smallest_with("")).unwrap().0;
    let mut fields = String::new();
    for Parameter { name, default, .. } in parameters::<Scene>() {
        if let Some(default) = default {
            fields += &format!("{name}: {default},\n");
        }
    }
    assert!(fields.contains("gravity") && fields.contains("record"), "{fields}");
    assert_eq!(parse(super::smallest_with(&fields)).unwrap_or_else(|error| panic!("{error}")).0, plain);
}
