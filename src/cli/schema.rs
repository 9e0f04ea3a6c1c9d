//! `meshless schema`: the reference of the scene language, as Markdown.

use std::fmt::Write;

use clap::Args;
use meshless_engine::plugin::{EntryKind, Registry};
use meshless_engine::scene::{Scene, TypeDoc, expression_names, schema_markdown, type_docs};

use super::failure::CommandFailure;
use super::plugins::KINDS;
use super::text::say;

/// Print the reference of scenes, with all that is registered, as Markdown
#[derive(Args)]
pub struct SchemaArguments {}

const INTRODUCTION: &str = "\
# Scene reference

<!-- Written by `meshless schema`; a test compares the two. -->

A scene is a RON text: structs with named fields in round brackets, lists in square ones, maps in curly ones. Units are
SI, and points and vectors have two or three components (with two, z = 0). Fields that have a default may be left out. Numbers that may
depend on place and time are expressions in x, y, z, t within quotes. An expression without these variables may stand
wherever a number is expected, also in plugins: `spacing: \"0.1/8\"`.

Expressions may use the names of `parameters`, which are constants, and of `tables`, which are functions of one
argument:

```ron
parameters: { \"dx\": 0.005, \"h\": \"10*dx\" },
tables: { \"pull\": (file: \"pull.csv\") },
bodies: [Body(spacing: \"dx\", shape: Box(min: (0, 0), max: (\"4*h\", \"h\")), ...)],
conditions: [Traction(value: (\"1e5*pull(t)\", None), ...)],
```

`meshless run scene.ron --set parameters.dx=0.01` replaces a value, and `meshless sweep scene.ron --set
parameters.dx=0.01,0.005` runs the scene once for each value.
";

/// Prints the reference.
pub fn execute(_: &SchemaArguments, registry: &Registry) -> Result<(), CommandFailure> {
    say(&reference(registry));
    Ok(())
}

/// The names of expressions and of fields.
fn names(registry: &Registry) -> String {
    let mut text = "\n# Names in expressions\n\n| name | meaning |\n|---|---|\n".to_owned();
    for (name, meaning) in expression_names() {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| `{name}` | {meaning} |");
    }
    text += "\n# Fields\n\nFields for probes, recordings and ParaView files; a body has those that its particles have. `velocity.x` is a \
        component of a vector, `stress.xy` one of a tensor. Plugins may add fields.\n\n| field | unit | meaning |\n|---|---|---|\n";
    for field in meshless_engine::assembly::fields(registry) {
        let unit = if field.unit() == "1" { "-" } else { field.unit() };
        let _ = writeln!(text, "| `{}` | {unit} | {} |", field.name(), field.description());
    }
    text
}

fn reference(registry: &Registry) -> String {
    let mut page = format!("{INTRODUCTION}\n{}{}", schema_markdown(), names(registry));
    let mut told: Vec<TypeDoc> = type_docs::<Scene>();
    for kind in KINDS {
        // Writing to a String cannot fail.
        let _ = writeln!(page, "\n# {}", heading(kind));
        let mut types = Vec::new();
        for entry in registry.entries(kind) {
            let _ = write!(page, "\n## {}\n\n{}\n", entry.name, entry.doc());
            if let Some(own) = entry.docs().first() {
                page += &own.body;
            }
            if !entry.reference.is_empty() {
                let _ = writeln!(page, "\nSource: {}", entry.reference);
            }
            types.extend(entry.docs().iter().skip(1));
        }
        for docs in types {
            if !told.contains(docs) {
                let _ = write!(page, "\n### {}\n\n{}\n{}", docs.name, docs.doc, docs.body);
                told.push(docs.clone());
            }
        }
    }
    page
}

fn heading(kind: EntryKind) -> &'static str {
    match kind {
        EntryKind::Material => "Materials",
        EntryKind::Formulation => "Formulations",
        EntryKind::Condition => "Conditions",
        EntryKind::ContactLaw => "Contact laws",
        EntryKind::Plugin => "Plugins",
    }
}
