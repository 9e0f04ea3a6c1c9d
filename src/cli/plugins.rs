//! `meshless plugins`: what scenes may name, and the parameters of each.

use std::fmt::Write;

use clap::Args;
use meshless_engine::plugin::{Entry, Kind, Registry};
use meshless_engine::scene::{Scene, type_docs, unknown};

use super::failure::Failure;
use super::text::{Table, say};

/// List materials, formulations, conditions and plugins, or describe one of them
#[derive(Args)]
pub struct Arguments {
    /// Name of what is to be described
    #[arg(value_name = "NAME")]
    name: Option<String>,
}

/// Kinds in the order in which a scene uses them.
pub const KINDS: [Kind; 5] =
    [Kind::Material, Kind::Formulation, Kind::Condition, Kind::ContactLaw, Kind::Plugin];

/// Prints the list or the description.
pub fn execute(arguments: &Arguments, registry: &Registry) -> Result<(), Failure> {
    let text = match &arguments.name {
        None => list(registry),
        Some(name) => describe(registry, name)?,
    };
    say(&text);
    Ok(())
}

fn list(registry: &Registry) -> String {
    let mut table = Table::new(&["", ""], 0);
    for kind in KINDS {
        table.row([format!("{}s", kind.word()), String::new()]);
        for entry in registry.entries(kind) {
            table.row([format!("  {}", entry.name), first_sentence(entry.doc()).to_owned()]);
        }
    }
    format!(
        "{}\n`meshless plugins NAME` tells the parameters of one of them",
        table.render().trim_start_matches('\n')
    )
}

/// The text up to the first full stop that ends a sentence.
fn first_sentence(text: &str) -> &str {
    text.find(". ").map_or(text, |end| &text[..end]).trim_end_matches('.')
}

fn describe(registry: &Registry, name: &str) -> Result<String, Failure> {
    let all: Vec<(Kind, &Entry)> =
        KINDS.into_iter().flat_map(|kind| registry.entries(kind).map(move |entry| (kind, entry))).collect();
    let found: Vec<_> = all.iter().filter(|(_, entry)| entry.name == name).collect();
    if found.is_empty() {
        let known: Vec<&str> = all.iter().map(|(_, entry)| entry.name).collect();
        let (message, helps) = unknown("name", name, &known);
        return Err(Failure::Usage(format!("{message}\n{}", helps.join("\n"))));
    }
    Ok(found.into_iter().map(|(kind, entry)| description(*kind, entry)).collect::<Vec<_>>().join("\n"))
}

fn description(kind: Kind, entry: &Entry) -> String {
    let mut text = format!("{} ({})\n\n  {}\n", entry.name, kind.word(), entry.doc());
    if !entry.reference.is_empty() {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  Source: {}", entry.reference);
    }
    if entry.parameters.is_empty() {
        return text + "\n  It has no parameters.\n";
    }
    let mut table = Table::new(&["parameter", "type", "default", "meaning"], 0);
    for parameter in &entry.parameters {
        let default = match &parameter.default {
            Some(default) => default.clone(),
            None if parameter.required => "required".into(),
            None => "-".into(),
        };
        table.row([parameter.name.clone(), parameter.kind.clone(), default, parameter.doc.clone()]);
    }
    let _ = write!(text, "\n{}", table.render());
    let common = type_docs::<Scene>();
    for docs in entry.docs.iter().skip(1).filter(|docs| !common.contains(docs)) {
        let _ = write!(text, "\n{}: {}\n{}", docs.name, docs.doc, docs.body.replace("\n\n", "\n"));
    }
    let known: Vec<&str> =
        entry.docs.iter().skip(1).filter(|docs| common.contains(docs)).map(|docs| &*docs.name).collect();
    if !known.is_empty() {
        let _ = writeln!(text, "\nSee `meshless schema` for {}.", known.join(", "));
    }
    text
}
