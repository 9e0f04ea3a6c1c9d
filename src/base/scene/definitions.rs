//! The parameters and tables of a scene, read from its tree before anything that may use them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::Problem;
use super::decode::{decode, expression_problem};
use super::expression::{constant, is_reserved, words};
use super::literal::refused;
use super::symbols::Symbols;
use super::table::Table;
use super::tree::{Node, NodeKind};

/// The names that the scene `root` defines. Files of tables are relative to `folder`.
///
/// # Errors
/// All problems with the definitions.
pub(super) fn define(root: &Node, text: &str, folder: &Path) -> Result<Arc<Symbols>, Vec<Problem>> {
    let mut problems = Vec::new();
    let parameters = entries(root, "parameters", &mut problems);
    let mut symbols = Symbols { parameters: evaluate(&parameters, &mut problems), ..Symbols::default() };
    let tables = entries(root, "tables", &mut problems);
    for (name, key, _) in &tables {
        if symbols.parameters.contains_key(*name) {
            let message = format!("`{name}` is both a parameter and a table");
            problems.push(Problem::at_span(key.span.clone(), message).help("names must differ"));
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let known = Arc::new(Symbols { parameters: symbols.parameters.clone(), ..Symbols::default() });
    for (name, _, value) in tables {
        let decoded = decode::<Table>(value, text, 0, false, &known);
        problems.extend(decoded.problems);
        let path = format!("tables.{name}");
        match decoded.value.map(|table| table.interpolation(folder, &path)) {
            Some(Ok(table)) => _ = symbols.tables.insert(name.to_owned(), Arc::new(table)),
            Some(Err(problem)) => problems.push(problem),
            None => {}
        }
    }
    if problems.is_empty() { Ok(Arc::new(symbols)) } else { Err(problems) }
}

type Entry<'a> = (&'a str, &'a Node, &'a Node);

/// Name, key and value of the entries of a block of the scene. The reader of the scene checks that the block
/// is a map.
fn entries<'a>(root: &'a Node, block: &str, problems: &mut Vec<Problem>) -> Vec<Entry<'a>> {
    let Some(NodeKind::Map(entries)) = root.field(block).map(|field| &field.value.kind) else {
        return Vec::new();
    };
    let mut found: Vec<Entry<'a>> = Vec::new();
    for (key, value) in entries {
        let NodeKind::Text { value: name, .. } = &key.kind else { continue };
        if let Some((message, help)) = fault_of_name(name) {
            problems.push(Problem::at_span(key.span.clone(), message).help(help));
        } else if !found.iter().any(|(other, ..)| other == name) {
            found.push((name, key, value));
        }
    }
    found
}

/// The values of parameters, which may refer to each other in any order.
fn evaluate(parameters: &[Entry<'_>], problems: &mut Vec<Problem>) -> BTreeMap<String, f64> {
    let mut symbols = Symbols::default();
    let mut open: Vec<&Entry<'_>> = parameters.iter().collect();
    loop {
        let before = open.len();
        open.retain(|(name, _, node)| {
            let waits = used(node, parameters).any(|other| !symbols.parameters.contains_key(other));
            if waits {
                return true;
            }
            let value = match &node.kind {
                NodeKind::Number { value, .. } if let Some(fault) = refused(*value) => {
                    Err(Problem::at_span(node.span.clone(), format!("a number {fault}")))
                }
                NodeKind::Number { value, .. } => Ok(*value),
                NodeKind::Text { value, .. } => {
                    constant(value, &symbols).map_err(|error| expression_problem(node, &error))
                }
                _ => Err(Problem::at_span(
                    node.span.clone(),
                    format!("expected a number or an expression in double quotes, found {}", node.describe()),
                )),
            };
            // A bad parameter counts as known, so that it is reported once.
            symbols.parameters.insert(
                (*name).to_owned(),
                value.unwrap_or_else(|problem| {
                    problems.push(problem);
                    1.0
                }),
            );
            false
        });
        if open.is_empty() {
            return symbols.parameters;
        }
        if open.len() == before {
            problems.push(cycle(&open, parameters));
            return symbols.parameters;
        }
    }
}

/// The parameters that the expression of a parameter refers to.
fn used<'a>(node: &'a Node, parameters: &'a [Entry<'_>]) -> impl Iterator<Item = &'a str> {
    let text = match &node.kind {
        NodeKind::Text { value, .. } => value.as_str(),
        _ => "",
    };
    words(text).filter(|word| parameters.iter().any(|(name, ..)| name == word))
}

/// The problem of a circular definition. Each of `open` depends on another of them: the chain is followed
/// until a name repeats.
fn cycle(open: &[&Entry<'_>], parameters: &[Entry<'_>]) -> Problem {
    let mut chain: Vec<&Entry<'_>> = vec![open[0]];
    loop {
        let (_, _, node) = chain[chain.len() - 1];
        let next = used(node, parameters).find_map(|word| open.iter().find(|(name, ..)| *name == word));
        let Some(next) = next else { break };
        if let Some(start) = chain.iter().position(|(name, ..)| *name == next.0) {
            chain.drain(..start);
            break;
        }
        chain.push(next);
    }
    let mut names: Vec<&str> = chain.iter().map(|(name, ..)| *name).collect();
    names.push(names[0]);
    let message = format!("parameter `{}` depends on itself: {}", names[0], names.join(" -> "));
    Problem::at_span(chain[0].2.span.clone(), message).help("give one of them as a number")
}

/// Problem of a name that a scene defines: the message and the correction.
fn fault_of_name(name: &str) -> Option<(String, String)> {
    let fits = |c: char| c.is_alphanumeric() || c == '_';
    if is_reserved(name) {
        let message = format!("`{name}` is already a variable, constant or function of expressions");
        return Some((message, format!("choose another name, such as `{name}_0`")));
    }
    let starts = name.chars().next().is_some_and(|c| c.is_alphabetic() || c == '_');
    if starts && name.chars().all(fits) && name.len() <= 100 {
        return None;
    }
    let help =
        "names consist of letters, digits and `_`, do not start with a digit and have at most 100 bytes";
    Some(("the name cannot stand in an expression".to_owned(), help.to_owned()))
}
