//! The documentation of scenes and parameters, from the types themselves, so that it cannot drift.

use std::fmt::Write;

use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value};

use super::Scene;

/// A parameter of a plugin, material, condition, or a field of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Name in a scene.
    pub name: String,
    /// Type, in the terms of a scene.
    pub kind: String,
    /// Default value in the notation of a scene, if there is one.
    pub default: Option<String>,
    /// Description, with its unit.
    pub doc: String,
    /// Whether a scene must give it.
    pub required: bool,
}

/// The parameters of a struct, in the order of its fields; none for other types.
pub fn parameters<T: JsonSchema>() -> Vec<Parameter> {
    Described::of::<T>().parameters()
}

/// A type with its schema, from which its parameters and its documentation follow. Only the schema is
/// generic, so that the rest is compiled once.
pub struct Described {
    name: String,
    schema: Value,
}

impl Described {
    /// The type `T`.
    pub fn of<T: JsonSchema>() -> Self {
        let schema = SchemaGenerator::default().into_root_schema_for::<T>().to_value();
        Self { name: T::schema_name().into_owned(), schema }
    }

    /// [`parameters`].
    pub fn parameters(&self) -> Vec<Parameter> {
        fields(&self.schema, &Definitions(self.schema.get("$defs")))
    }

    /// [`type_docs`].
    pub fn docs(&self) -> Vec<TypeDoc> {
        docs_of(&self.name, &self.schema)
    }
}

/// The documentation of a type as scenes write it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TypeDoc {
    /// Name of the type.
    pub name: String,
    /// Description, with its unit.
    pub doc: String,
    /// Its fields or variants as Markdown; empty if it has none.
    pub body: String,
    /// Name and meaning of its variants; none if it has none.
    pub variants: Vec<(String, String)>,
}

/// The documentation of a type, and then of every type that it mentions, each once.
pub fn type_docs<T: JsonSchema>() -> Vec<TypeDoc> {
    Described::of::<T>().docs()
}

fn docs_of(name: &str, schema: &Value) -> Vec<TypeDoc> {
    let definitions = Definitions(schema.get("$defs"));
    let mut docs = vec![type_doc(name, schema, &definitions)];
    let mut waiting = mentioned(schema);
    let mut done = Vec::new();
    while !waiting.is_empty() {
        let name = waiting.remove(0);
        if done.contains(&name) {
            continue;
        }
        if let Some(definition) = definitions.get(&name).filter(|definition| !doc(definition).is_empty()) {
            docs.push(type_doc(&name, definition, &definitions));
            waiting.extend(mentioned(definition));
        }
        done.push(name);
    }
    docs
}

/// The reference of the scene language without registered items, as Markdown.
pub fn schema_markdown() -> String {
    let section = |TypeDoc { name, doc, body, .. }| {
        if body.is_empty() { format!("## {name}\n\n{doc}\n") } else { format!("## {name}\n\n{doc}\n{body}") }
    };
    type_docs::<Scene>().into_iter().map(section).collect::<Vec<_>>().join("\n")
}

struct Definitions<'a>(Option<&'a Value>);

impl<'a> Definitions<'a> {
    fn get(&self, name: &str) -> Option<&'a Value> {
        self.0?.get(name)
    }

    /// The schema that a reference refers to, or the schema itself.
    fn resolve<'b>(&self, schema: &'b Value) -> &'b Value
    where
        'a: 'b,
    {
        reference(schema).and_then(|name| self.get(&name)).unwrap_or(schema)
    }
}

/// The name of the type that a schema refers to.
fn reference(schema: &Value) -> Option<String> {
    let target = schema.get("$ref")?.as_str()?.strip_prefix("#/$defs/")?;
    Some(target.replace("%3C", "<").replace("%3E", ">"))
}

/// The types that a schema refers to, in order.
fn mentioned(schema: &Value) -> Vec<String> {
    match schema {
        Value::Object(object) => {
            let inner =
                object.iter().filter(|(key, _)| *key != "$defs").flat_map(|(_, value)| mentioned(value));
            reference(schema).into_iter().chain(inner).collect()
        }
        Value::Array(entries) => entries.iter().flat_map(mentioned).collect(),
        _ => Vec::new(),
    }
}

fn doc(schema: &Value) -> String {
    let text = schema.get("description").and_then(Value::as_str).unwrap_or_default();
    text.replace("\\[", "[").replace("\\]", "]").replace('\n', " ")
}

fn properties(schema: &Value) -> Option<&Map<String, Value>> {
    schema.get("properties")?.as_object()
}

fn fields(schema: &Value, definitions: &Definitions) -> Vec<Parameter> {
    let required = |name: &str| {
        schema
            .get("required")
            .and_then(Value::as_array)
            .is_some_and(|names| names.iter().any(|other| other == name))
    };
    let parameter = |(name, field): (&String, &Value)| Parameter {
        name: name.clone(),
        kind: kind(field, definitions),
        default: field.get("default").map(|value| written(value, field, definitions)),
        doc: doc(field),
        required: required(name),
    };
    properties(schema).into_iter().flatten().map(parameter).collect()
}

/// The type of a value in the terms of a scene.
fn kind(schema: &Value, definitions: &Definitions) -> String {
    if let Some(name) = reference(schema) {
        let definition = definitions.get(&name).unwrap_or(&Value::Null);
        return match variants(definition) {
            Some(variants) if variants.iter().all(|(_, content)| content.is_none()) => {
                variants.into_iter().map(|(name, _)| name).collect::<Vec<_>>().join(" or ")
            }
            _ if properties(definition).is_none() && definition.get("type").is_some() => {
                kind(definition, definitions)
            }
            _ => name,
        };
    }
    if let Some(options) = schema.get("anyOf").and_then(Value::as_array) {
        let options = options.iter().filter(|option| option.get("type") != Some(&Value::from("null")));
        return options.map(|option| kind(option, definitions)).collect::<Vec<_>>().join(" or ");
    }
    let types = match schema.get("type") {
        Some(Value::Array(types)) => {
            types.iter().filter_map(Value::as_str).filter(|name| *name != "null").collect()
        }
        Some(Value::String(name)) => vec![name.as_str()],
        _ => vec![],
    };
    types.into_iter().map(|name| simple_kind(name, schema, definitions)).collect::<Vec<_>>().join(" or ")
}

fn simple_kind(name: &str, schema: &Value, definitions: &Definitions) -> String {
    match name {
        "string" => "text".into(),
        "integer" => "whole number".into(),
        "boolean" => "true or false".into(),
        "array" => match (schema.get("prefixItems").and_then(Value::as_array), schema.get("items")) {
            (Some(entries), _) => {
                let entries: Vec<_> = entries.iter().map(|entry| kind(entry, definitions)).collect();
                format!("({})", entries.join(", "))
            }
            (None, Some(entry)) if is_tuple(schema) => match kind(entry, definitions).as_str() {
                "number" => "(x, y) or (x, y, z)".into(),
                entry => format!("(x, y) or (x, y, z), each a {entry}"),
            },
            (None, Some(entry)) => format!("list of {}", kind(entry, definitions)),
            (None, None) => "list".into(),
        },
        "object" => match schema.get("additionalProperties").filter(|entry| entry.is_object()) {
            Some(entry) => format!("map of names to {}", kind(entry, definitions)),
            None => "map".into(),
        },
        other => other.into(),
    }
}

/// Whether a value is written in round brackets.
fn is_tuple(schema: &Value) -> bool {
    schema.get("maxItems").is_some()
}

/// The variants of an enum: name and, for those that have any, the schema of the contents.
fn variants(schema: &Value) -> Option<Vec<(String, Option<&Value>)>> {
    if let Some(names) = schema.get("enum").and_then(Value::as_array) {
        return Some(names.iter().filter_map(Value::as_str).map(|name| (name.to_owned(), None)).collect());
    }
    let mut variants = Vec::new();
    for option in schema.get("oneOf")?.as_array()? {
        if let Some(name) = option.get("const").and_then(Value::as_str) {
            variants.push((name.to_owned(), None));
        } else if let Some(names) = option.get("enum").and_then(Value::as_array) {
            variants.extend(names.iter().filter_map(Value::as_str).map(|name| (name.to_owned(), None)));
        } else {
            let (name, content) = properties(option)?.iter().next()?;
            variants.push((name.clone(), Some(content)));
        }
    }
    Some(variants)
}

/// A value in the notation of a scene.
fn written(value: &Value, schema: &Value, definitions: &Definitions) -> String {
    let schema = definitions.resolve(schema);
    match value {
        Value::Null => "None".into(),
        Value::String(name) if variants(schema).is_some() => name.clone(),
        Value::String(text) => format!("{text:?}"),
        Value::Array(entries) => {
            let entry_schema = schema.get("items").unwrap_or(&Value::Null);
            let entries: Vec<_> =
                entries.iter().map(|entry| written(entry, entry_schema, definitions)).collect();
            let entries = entries.join(", ");
            if is_tuple(schema) { format!("({entries})") } else { format!("[{entries}]") }
        }
        Value::Object(object) => match (variants(schema), object.iter().next()) {
            (Some(variants), Some((name, content))) => {
                let schema = variants.iter().find(|(other, _)| other == name).and_then(|(_, schema)| *schema);
                let content = written(content, schema.unwrap_or(&Value::Null), definitions);
                if content.starts_with('(') {
                    format!("{name}{content}")
                } else {
                    format!("{name}({content})")
                }
            }
            _ if properties(schema).is_none() => {
                let entry = |(name, value): (&String, &Value)| {
                    let schema = schema.get("additionalProperties").unwrap_or(&Value::Null);
                    format!("{name:?}: {}", written(value, schema, definitions))
                };
                format!("{{{}}}", object.iter().map(entry).collect::<Vec<_>>().join(", "))
            }
            _ => {
                let field = |(name, value): (&String, &Value)| {
                    let schema =
                        properties(schema).and_then(|fields| fields.get(name)).unwrap_or(&Value::Null);
                    format!("{name}: {}", written(value, schema, definitions))
                };
                format!("({})", object.iter().map(field).collect::<Vec<_>>().join(", "))
            }
        },
        other => other.to_string(),
    }
}

fn type_doc(name: &str, schema: &Value, definitions: &Definitions) -> TypeDoc {
    let mut body = String::new();
    write_body(&mut body, schema, definitions);
    let variants = variants(schema).unwrap_or_default();
    let variants =
        variants.into_iter().map(|(name, _)| (name.clone(), doc_of_variant(schema, &name))).collect();
    TypeDoc { name: name.to_owned(), doc: doc(schema), body, variants }
}

fn write_body(page: &mut String, schema: &Value, definitions: &Definitions) {
    let parameters = fields(schema, definitions);
    if !parameters.is_empty() {
        table(page, &parameters);
    }
    let Some(variants) = variants(schema) else { return };
    let doc_of = |variant: &str| doc_of_variant(schema, variant);
    for (variant, content) in variants {
        match content {
            None => {
                // Writing to a String cannot fail.
                let _ = writeln!(page, "\n- `{variant}`: {}", doc_of(&variant));
            }
            Some(content) => {
                let parameters = fields(content, definitions);
                let inner = if parameters.is_empty() { kind(content, definitions) } else { "...".into() };
                let inner = inner.trim_start_matches('(').trim_end_matches(')');
                let _ = writeln!(page, "\n- `{variant}({inner})`: {}", doc_of(&variant));
                if !parameters.is_empty() {
                    table(page, &parameters);
                }
            }
        }
    }
}

/// Meaning of a variant of an enum.
fn doc_of_variant(schema: &Value, variant: &str) -> String {
    let options = schema.get("oneOf").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let is = |option: &&Value| {
        option.get("const") == Some(&Value::from(variant))
            || properties(option).is_some_and(|fields| fields.contains_key(variant))
    };
    options.iter().find(is).map(doc).unwrap_or_default()
}

fn table(page: &mut String, parameters: &[Parameter]) {
    let _ = writeln!(page, "\n| field | type | default | meaning |\n|---|---|---|---|");
    for Parameter { name, kind, default, doc, required } in parameters {
        let default = match default {
            Some(default) => format!("`{default}`"),
            None if *required => "required".into(),
            None => String::new(),
        };
        let _ = writeln!(page, "| `{name}` | {kind} | {default} | {} |", doc.replace('|', "\\|"));
    }
}
