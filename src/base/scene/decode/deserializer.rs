//! How serde reads a value of the tree into a type.

use serde::de::{Deserializer, Error as _, Visitor};

use super::access::{Entries, ItemParts, MapEntries, StructValues};
use super::error::Error;
use super::value::{ITEM, NodeValue, Outcome};
use super::variant::Variant;
use crate::scene::Problem;
use crate::scene::literal::refused;
use crate::scene::names::{nearest, unknown};
use crate::scene::tree::{Node, NodeKind, StructField};

/// The fields of a struct as they are written.
struct WrittenFields<'a> {
    /// Those that the type has, each once.
    good: Vec<&'a StructField>,
    /// Fields that are missing because their names are misspelt or their values bad.
    meant: Vec<&'a str>,
}

impl<'a> NodeValue<'a> {
    /// Reads fields; those that the type does not have and those that are given twice are reported.
    pub fn read_fields<V: Visitor<'a>>(
        self,
        label: &str,
        known: &'static [&'static str],
        visitor: V,
    ) -> Outcome<V::Value> {
        let WrittenFields { good, meant } = self.fields(label, known);
        match visitor.visit_map(StructValues { fields: good.iter(), next: None, context: self.context }) {
            // If the name is misspelt or the value bad, that has been reported.
            Err(Error::Missing(field)) if meant.contains(&field) => Err(Error::Reported),
            result => self.here(result),
        }
    }

    /// The fields that the type has, each once; the others are reported.
    fn fields(self, label: &str, known: &'static [&'static str]) -> WrittenFields<'a> {
        let (mut good, mut meant) = (Vec::<&StructField>::new(), Vec::new());
        for field in self.node.fields() {
            let name = &field.name;
            let at = name.span.clone();
            if !known.contains(&name.text.as_str()) {
                let (message, help) = unknown("field", &name.text, known);
                self.context.report(Problem::at_span(at, format!("{message} of `{label}`")).helps(help));
                meant.extend(nearest(&name.text, known));
            } else if good.iter().any(|other| other.name.text == name.text) {
                self.context.report(Problem::at_span(at, format!("field `{}` is given twice", name.text)));
            } else if self.context.bad_fields.borrow().contains(&at.start) {
                meant.push(&name.text);
            } else {
                good.push(field);
            }
        }
        WrittenFields { good, meant }
    }

    fn read_entries<V: Visitor<'a>>(
        self,
        entries: &'a [Node],
        recover: bool,
        visitor: V,
    ) -> Outcome<V::Value> {
        let mut rest = entries.iter();
        let result = visitor.visit_seq(Entries { rest: &mut rest, recover, context: self.context });
        let unread = rest.len();
        self.here(
            result
                .map_err(|error| error.with_found(entries.len()))
                .and_then(|value| if unread == 0 { Ok(value) } else { Err(too_many(entries.len(), unread)) }),
        )
    }
}

/// The error for entries beyond the length of a tuple.
fn too_many(found: usize, unread: usize) -> Error {
    let expected = match found - unread {
        1 => "1 entry".into(),
        n => format!("{n} entries"),
    };
    Error::Length { found, expected }
}

macro_rules! whole_numbers {
    ($($method:ident)*) => {
        $(fn $method<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
            self.deserialize_i64(visitor)
        })*
    };
}

impl<'a> Deserializer<'a> for NodeValue<'a> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        let result = match &self.node.kind {
            NodeKind::Number { value, .. } if let Some(fault) = refused(*value) => {
                return self.here(Err(Error::Message(format!("a number {fault}"))));
            }
            NodeKind::Number { integer: Some(integer), value } => {
                match (u64::try_from(*integer), i64::try_from(*integer)) {
                    (Ok(integer), _) => visitor.visit_u64(integer),
                    (_, Ok(integer)) => visitor.visit_i64(integer),
                    _ => visitor.visit_f64(*value),
                }
            }
            NodeKind::Number { value, integer: None } => visitor.visit_f64(*value),
            NodeKind::Text { value, .. } => visitor.visit_borrowed_str(value),
            NodeKind::Character(value) => visitor.visit_char(*value),
            NodeKind::Bare if self.node.is_bare("true") => visitor.visit_bool(true),
            NodeKind::Bare if self.node.is_bare("false") => visitor.visit_bool(false),
            NodeKind::Bare if self.node.is_bare("None") => visitor.visit_none(),
            NodeKind::Bare | NodeKind::Fields(_) | NodeKind::Tuple(_) if self.name().is_some() => {
                visitor.visit_enum(Variant { value: self })
            }
            NodeKind::Bare => visitor.visit_unit(),
            NodeKind::Fields(fields) => {
                let fields: Vec<_> = fields.iter().collect();
                visitor.visit_map(StructValues { fields: fields.iter(), next: None, context: self.context })
            }
            NodeKind::Tuple(entries) => return self.read_entries(entries, false, visitor),
            NodeKind::List(entries) => return self.read_entries(entries, true, visitor),
            NodeKind::Map(_) => return self.deserialize_map(visitor),
        };
        self.here(result)
    }

    fn deserialize_f64<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        match self.expression()? {
            Some(value) => self.here(visitor.visit_f64(value)),
            None => self.deserialize_any(visitor),
        }
    }

    fn deserialize_f32<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_i64<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        match self.expression()? {
            // Larger integers are not all exact in floating point.
            Some(value) if value.fract() == 0.0 && value.abs() < 9e15 && value < 0.0 => {
                self.here(visitor.visit_i64(value as i64))
            }
            Some(value) if value.fract() == 0.0 && value.abs() < 9e15 => {
                self.here(visitor.visit_u64(value as u64))
            }
            Some(value) => {
                self.here(Err(Error::Message(format!("expected a whole number, found {value:?}"))))
            }
            None => self.deserialize_any(visitor),
        }
    }

    fn deserialize_str<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        match (&self.node.kind, self.name()) {
            (NodeKind::Bare, Some(name)) => {
                let problem = format!("expected a text in double quotes, found `{name}`");
                self.context
                    .report(Problem::at_span(self.node.head(), problem).help(format!("write `\"{name}\"`")));
                Err(Error::Reported)
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_string<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        match (self.name(), &self.node.kind) {
            (Some("None"), NodeKind::Bare) => visitor.visit_none(),
            (Some("Some"), NodeKind::Tuple(entries)) if entries.len() == 1 => {
                visitor.visit_some(self.of(&entries[0]))
            }
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_unit<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        match &self.node.kind {
            NodeKind::Tuple(entries) if entries.is_empty() => visitor.visit_unit(),
            NodeKind::Bare if self.unnamed => visitor.visit_unit(),
            _ => self.wrong("`()`"),
        }
    }

    fn deserialize_unit_struct<V: Visitor<'a>>(self, name: &'static str, visitor: V) -> Outcome<V::Value> {
        match (&self.node.kind, self.name()) {
            (NodeKind::Bare, Some(found)) if found == name => visitor.visit_unit(),
            (NodeKind::Bare, Some(_)) => self.wrong(format!("`{name}`")),
            _ => {
                self.check_name(name);
                self.deserialize_unit(visitor)
            }
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'a>>(self, name: &'static str, visitor: V) -> Outcome<V::Value> {
        if name == ITEM {
            return match self.name() {
                Some(_) => {
                    let start = self.node.span.start;
                    let text = &self.context.text
                        [start - self.context.offset..self.node.span.end - self.context.offset];
                    self.here(visitor.visit_seq(ItemParts { start: Some(start), text: Some(text) }))
                }
                None => {
                    self.wrong("a name, with or without parameters, such as `name` or `name(parameter: 1.0)`")
                }
            };
        }
        match &self.node.kind {
            NodeKind::Tuple(entries) if self.name() == Some(name) && entries.len() == 1 => {
                visitor.visit_newtype_struct(self.of(&entries[0]))
            }
            _ => visitor.visit_newtype_struct(self),
        }
    }

    fn deserialize_seq<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        match &self.node.kind {
            NodeKind::List(entries) => self.read_entries(entries, true, visitor),
            _ => self.wrong("a list `[...]`"),
        }
    }

    fn deserialize_tuple<V: Visitor<'a>>(self, _: usize, visitor: V) -> Outcome<V::Value> {
        match &self.node.kind {
            NodeKind::Tuple(entries) if self.name().is_none() => self.read_entries(entries, false, visitor),
            _ => self.here(Err(Error::invalid_type(serde::de::Unexpected::Unit, &visitor))),
        }
    }

    fn deserialize_tuple_struct<V: Visitor<'a>>(
        self,
        name: &'static str,
        length: usize,
        visitor: V,
    ) -> Outcome<V::Value> {
        self.check_name(name);
        Self { unnamed: true, ..self }.deserialize_tuple(length, visitor)
    }

    fn deserialize_map<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        match &self.node.kind {
            NodeKind::Map(entries) => {
                let result = visitor.visit_map(MapEntries::new(entries, self.context));
                self.here(result)
            }
            NodeKind::Fields(_) if self.name().is_none() => self.deserialize_any(visitor),
            _ => self.wrong("a map `{...}`"),
        }
    }

    fn deserialize_struct<V: Visitor<'a>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Outcome<V::Value> {
        match &self.node.kind {
            NodeKind::Bare if self.unnamed => self.read_fields(name, fields, visitor),
            NodeKind::Fields(_) => {
                self.check_name(name);
                self.read_fields(name, fields, visitor)
            }
            NodeKind::Tuple(entries) if entries.is_empty() => {
                self.check_name(name);
                self.read_fields(name, fields, visitor)
            }
            _ => self.wrong(format!("`{name}(field: value, ...)`")),
        }
    }

    fn deserialize_enum<V: Visitor<'a>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Outcome<V::Value> {
        if self.name().is_none() {
            return self.wrong(one_of(name, variants));
        }
        self.here(visitor.visit_enum(Variant { value: self }))
    }

    fn deserialize_ignored_any<V: Visitor<'a>>(self, visitor: V) -> Outcome<V::Value> {
        visitor.visit_unit()
    }

    serde::forward_to_deserialize_any! {
        <V: Visitor<'a>>
        bool i128 u128 char bytes byte_buf identifier
    }

    whole_numbers! {
        deserialize_i8 deserialize_i16 deserialize_i32 deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64
    }
}

/// The expected variants, for a message.
fn one_of(name: &str, variants: &[&str]) -> String {
    let known: Vec<_> = variants.iter().map(|variant| format!("`{variant}`")).collect();
    format!("one of {} for this {name}", known.join(", "))
}
