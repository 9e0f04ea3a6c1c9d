//! serde's view of the entries of lists, tuples and maps and of the fields of structs.

use serde::de::{Deserialize, DeserializeSeed, IntoDeserializer, MapAccess, SeqAccess};

use super::context::Context;
use super::error::Error;
use super::value::{NodeValue, key};
use crate::scene::Problem;
use crate::scene::tree::{Node, NodeKind, StructField};

fn value<'a>(node: &'a Node, context: &'a Context<'a>) -> NodeValue<'a> {
    NodeValue { node, context, unnamed: false }
}

/// The entries of a list or tuple.
pub(super) struct Entries<'a, 'i> {
    pub rest: &'i mut std::slice::Iter<'a, Node>,
    /// Whether a bad entry is reported and skipped, as in a list.
    pub recover: bool,
    pub context: &'a Context<'a>,
}

impl<'a> SeqAccess<'a> for Entries<'a, '_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'a>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        self.rest.next().map(|node| seed.deserialize(value(node, self.context))).transpose()
    }

    fn next_element<T: Deserialize<'a>>(&mut self) -> Result<Option<T>, Error> {
        for node in self.rest.by_ref() {
            match T::deserialize(value(node, self.context)) {
                Err(error) if self.recover => {
                    error.report(node, self.context);
                    self.context.incomplete.set(true);
                }
                result => return result.map(Some).map_err(|error| error.report(node, self.context)),
            }
        }
        Ok(None)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

/// The fields of a struct.
pub(super) struct StructValues<'a, 'i> {
    pub fields: std::slice::Iter<'i, &'a StructField>,
    pub next: Option<&'a StructField>,
    pub context: &'a Context<'a>,
}

impl<'a> MapAccess<'a> for StructValues<'a, '_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'a>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        self.next = self.fields.next().copied();
        self.next.map(|field| seed.deserialize(key(&field.name.text))).transpose()
    }

    fn next_value_seed<V: DeserializeSeed<'a>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let Some(field) = self.next else {
            return Err(Error::Message("a value was asked for before its key".into()));
        };
        let known = self.context.bad_fields.borrow().len();
        seed.deserialize(value(&field.value, self.context)).map_err(|error| {
            // If only a field within this one is bad, the next pass skips just that field.
            if self.context.bad_fields.borrow().len() == known {
                self.context.bad_fields.borrow_mut().insert(field.name.span.start);
            }
            error.report(&field.value, self.context)
        })
    }
}

/// The entries of a map.
pub(super) struct MapEntries<'a> {
    rest: std::slice::Iter<'a, (Node, Node)>,
    next: Option<&'a Node>,
    context: &'a Context<'a>,
}

impl<'a> MapEntries<'a> {
    /// The entries; keys that are given twice are reported.
    pub fn new(entries: &'a [(Node, Node)], context: &'a Context<'a>) -> Self {
        let text = |node: &'a Node| match &node.kind {
            NodeKind::Text { value, .. } => Some(value.as_str()),
            _ => None,
        };
        for (i, (key, _)) in entries.iter().enumerate() {
            if text(key).is_some() && entries[..i].iter().any(|(other, _)| text(other) == text(key)) {
                context
                    .report(Problem::at_span(key.span.clone(), format!("{} is given twice", key.describe())));
            }
        }
        Self { rest: entries.iter(), next: None, context }
    }
}

impl<'a> MapAccess<'a> for MapEntries<'a> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'a>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some((key, node)) = self.rest.next() else { return Ok(None) };
        self.next = Some(node);
        seed.deserialize(value(key, self.context)).map(Some).map_err(|error| error.report(key, self.context))
    }

    fn next_value_seed<V: DeserializeSeed<'a>>(&mut self, seed: V) -> Result<V::Value, Error> {
        match self.next {
            Some(node) => {
                seed.deserialize(value(node, self.context)).map_err(|error| error.report(node, self.context))
            }
            None => Err(Error::Message("a value was asked for before its key".into())),
        }
    }

    fn next_entry<K: Deserialize<'a>, V: Deserialize<'a>>(&mut self) -> Result<Option<(K, V)>, Error> {
        while let Some(key) = self.next_key::<K>().transpose() {
            match (key, self.next_value::<V>()) {
                (Ok(key), Ok(value)) => return Ok(Some((key, value))),
                _ => self.context.incomplete.set(true),
            }
        }
        Ok(None)
    }
}

/// Place and text of an item.
pub(super) struct ItemParts<'a> {
    pub start: Option<usize>,
    pub text: Option<&'a str>,
}

impl<'a> SeqAccess<'a> for ItemParts<'a> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'a>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        if let Some(start) = self.start.take() {
            return seed.deserialize(start.into_deserializer()).map(Some);
        }
        self.text.take().map(|text| seed.deserialize(key(text))).transpose()
    }
}
