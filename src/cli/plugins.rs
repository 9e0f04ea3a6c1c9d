//! `meshless plugins`: the names allowed in scenes, and their parameters.

use std::fmt::Write;

use clap::Args;
use meshless_engine::plugin::{Entry, EntryKind, Registry};
use meshless_engine::scene::{Scene, TypeDoc, expression_names, type_docs, unknown};

use super::failure::CommandFailure;
use super::text::{TextTable, program, say};

/// List everything that a scene can name, or describe one of these
#[derive(Args)]
pub struct PluginsArguments {
    /// Name to describe
    #[arg(value_name = "NAME")]
    name: Option<String>,
}

/// Kinds in the order in which a scene uses them.
pub const KINDS: [EntryKind; 5] = [
    EntryKind::Material,
    EntryKind::Formulation,
    EntryKind::Condition,
    EntryKind::ContactLaw,
    EntryKind::Plugin,
];

/// Prints the list or the description.
pub fn execute(arguments: &PluginsArguments, registry: &Registry) -> Result<(), CommandFailure> {
    let text = match &arguments.name {
        None => list(registry),
        Some(name) => describe(registry, name)?,
    };
    say(&text);
    Ok(())
}

fn list(registry: &Registry) -> String {
    let mut table = TextTable::new(&["", ""], 0);
    let mut section = |heading: &str, entries: Vec<(String, String)>| {
        table.row([heading.to_owned(), String::new()]);
        for (name, doc) in entries {
            table.row([format!("  {name}"), first_sentence(&doc).to_owned()]);
        }
    };
    for kind in KINDS {
        let entries = registry.entries(kind).map(|entry| (entry.name.to_owned(), entry.doc().to_owned()));
        section(&format!("{}s", kind.word()), entries.collect());
    }
    for (heading, entries) in language(registry) {
        section(heading, entries);
    }
    let text = table.render();
    format!(
        "{text}\n`meshless plugins NAME` describes one of these. Plugins may add fields; `velocity.x` is a component of one."
    )
}

/// The types of the scene whose variants are listed, each with its heading.
const LISTED: [(&str, &str); 6] = [
    ("shapes", "Shape"),
    ("lattices", "Lattice"),
    ("faces", "Face"),
    ("kernels", "KernelName"),
    ("quantities of probes", "Quantity"),
    ("at the sides of the domain", "Outside"),
];

/// Names of the scene language beside those registered: heading, and name and meaning of each.
fn language(registry: &Registry) -> Vec<(&'static str, Vec<(String, String)>)> {
    let docs = documented(registry);
    let variants = |name: &str| docs.iter().find(|docs| docs.name == name).map(|docs| docs.variants.clone());
    let mut sections: Vec<_> =
        LISTED.iter().map(|(heading, name)| (*heading, variants(name).unwrap_or_default())).collect();
    let fields = meshless_engine::assembly::fields(registry).into_iter().map(|field| {
        let unit = if field.unit() == "1" { "-" } else { field.unit() };
        (field.name().to_owned(), format!("{} [{unit}]", field.description()).trim().to_owned())
    });
    sections.push(("fields", fields.collect()));
    let names = expression_names().iter().map(|(name, meaning)| ((*name).to_owned(), (*meaning).to_owned()));
    sections.push(("expressions", names.collect()));
    sections
}

/// All types of the scene and of the parameters of registered items.
fn documented(registry: &Registry) -> Vec<TypeDoc> {
    let mut docs = type_docs::<Scene>();
    for kind in KINDS {
        for entry in registry.entries(kind) {
            docs.extend(entry.docs().iter().skip(1).cloned());
        }
    }
    docs
}

/// The description of a name of the scene language, or of a type of it.
fn in_language(registry: &Registry, name: &str) -> Option<String> {
    let docs = documented(registry);
    let holder = |docs: &&TypeDoc| docs.variants.iter().any(|(variant, _)| variant == name);
    if let Some(docs) = docs.iter().find(|docs| docs.name == name).or_else(|| docs.iter().find(holder)) {
        let what = if docs.name == name { String::new() } else { format!(" (of {})", docs.name) };
        let meaning = docs.variants.iter().find(|(variant, _)| variant == name).map(|(_, meaning)| meaning);
        let body = match meaning {
            Some(_) => variant_body(&docs.body, name),
            None => docs.body.clone(),
        };
        return Some(format!("{name}{what}\n\n  {}\n{}", meaning.unwrap_or(&docs.doc), aligned(&body)));
    }
    let sections = language(registry);
    let (heading, (_, meaning)) = sections
        .iter()
        .find_map(|(heading, entries)| Some((heading, entries.iter().find(|(other, _)| other == name)?)))?;
    Some(format!("{name} ({})\n\n  {meaning}\n", heading))
}

/// A description with its Markdown tables as aligned columns.
fn aligned(body: &str) -> String {
    let mut text = String::new();
    let mut rows: Vec<Vec<String>> = Vec::new();
    for line in body.lines().chain([""]) {
        if let Some(row) = line.strip_prefix("| ") {
            let cells = row.trim_end_matches(" |").split(" | ");
            rows.push(cells.map(|cell| cell.trim_matches('`').replace("\\|", "|")).collect());
        } else if !line.starts_with("|---") {
            text += &table_of(&std::mem::take(&mut rows));
            if !line.is_empty() {
                text += &format!("{line}\n");
            }
        }
    }
    text
}

/// Rows as a table, the first one its heading; nothing where there are none.
fn table_of(rows: &[Vec<String>]) -> String {
    let Some((head, rest)) = rows.split_first() else { return String::new() };
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let mut table = TextTable::new(&head, 0);
    rest.iter().filter(|row| row.len() == head.len()).for_each(|row| table.row(row.clone()));
    table.render()
}

/// The table of the fields of a variant, out of the description of its type.
fn variant_body(body: &str, name: &str) -> String {
    let start = format!("- `{name}");
    let lines = body.lines().skip_while(|line| !line.starts_with(&start)).skip(1);
    lines.take_while(|line| !line.starts_with("- `")).map(|line| format!("{line}\n")).collect()
}

/// The text up to the first full stop that ends a sentence.
fn first_sentence(text: &str) -> &str {
    text.find(". ").map_or(text, |end| &text[..end]).trim_end_matches('.')
}

fn describe(registry: &Registry, name: &str) -> Result<String, CommandFailure> {
    let all: Vec<(EntryKind, &Entry)> =
        KINDS.into_iter().flat_map(|kind| registry.entries(kind).map(move |entry| (kind, entry))).collect();
    let found: Vec<_> = all.iter().filter(|(_, entry)| entry.name == name).collect();
    if found.is_empty() {
        if let Some(text) = in_language(registry, name) {
            return Ok(text);
        }
        let sections = language(registry);
        let mut known: Vec<&str> = all.iter().map(|(_, entry)| entry.name).collect();
        known.extend(sections.iter().flat_map(|(_, entries)| entries.iter().map(|(name, _)| name.as_str())));
        let (message, helps) = unknown("name", name, &known);
        // Only the nearest name of the help is shown: the list of all names fills the screen.
        let near = helps.iter().filter(|help| help.starts_with("did")).map(|help| format!("; {help}"));
        return Err(CommandFailure::Usage(format!(
            "{message}{}\n`{} plugins` lists all that scenes can name",
            near.collect::<String>(),
            program()
        )));
    }
    Ok(found.into_iter().map(|(kind, entry)| description(*kind, entry)).collect::<Vec<_>>().join("\n"))
}

fn description(kind: EntryKind, entry: &Entry) -> String {
    let mut text = format!("{} ({})\n\n  {}\n", entry.name, kind.word(), entry.doc());
    if !entry.reference.is_empty() {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  Source: {}", entry.reference);
    }
    if entry.parameters().is_empty() {
        return text + "\n  It has no parameters.\n";
    }
    let mut table = TextTable::new(&["parameter", "type", "default", "meaning"], 0);
    for parameter in entry.parameters() {
        let default = match &parameter.default {
            Some(default) => default.clone(),
            None if parameter.required => "required".into(),
            None => "-".into(),
        };
        table.row([parameter.name.clone(), parameter.kind.clone(), default, parameter.doc.clone()]);
    }
    let _ = write!(text, "\n{}", table.render());
    let common = type_docs::<Scene>();
    for docs in entry.docs().iter().skip(1).filter(|docs| !common.contains(docs)) {
        let _ = write!(text, "\n{}: {}\n{}", docs.name, docs.doc, aligned(&docs.body));
    }
    let known: Vec<&str> =
        entry.docs().iter().skip(1).filter(|docs| common.contains(docs)).map(|docs| &*docs.name).collect();
    if !known.is_empty() {
        let _ = writeln!(text, "\nSee `meshless schema` for {}.", known.join(", "));
    }
    text
}
