//! serde's view of a variant of an enum. A variant whose parameters all have defaults may be written without
//! brackets, one without parameters with empty ones.

use serde::de::{DeserializeSeed, Deserializer, EnumAccess, VariantAccess, Visitor};

use super::error::Error;
use super::value::{NodeValue, key};
use crate::scene::tree::NodeKind;

/// A named value as a variant.
pub(super) struct Variant<'a> {
    pub value: NodeValue<'a>,
}

impl<'a> EnumAccess<'a> for Variant<'a> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'a>>(self, seed: S) -> Result<(S::Value, Self), Error> {
        let name = self.name();
        let variant =
            seed.deserialize(key(name)).map_err(|error| error.report(self.value.node, self.value.context))?;
        Ok((variant, Self { value: NodeValue { unnamed: true, ..self.value } }))
    }
}

impl<'a> Variant<'a> {
    fn name(&self) -> &'a str {
        self.value.node.name.as_ref().map_or("", |name| &name.text)
    }

    fn wrong<T>(self, expected: String) -> Result<T, Error> {
        Err(Error::Expected(expected).report(self.value.node, self.value.context))
    }
}

impl<'a> VariantAccess<'a> for Variant<'a> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        match &self.value.node.kind {
            NodeKind::Bare => Ok(()),
            NodeKind::Tuple(entries) if entries.is_empty() => Ok(()),
            _ => {
                let name = self.name();
                self.wrong(format!("`{name}`, which has no parameters"))
            }
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'a>>(self, seed: T) -> Result<T::Value, Error> {
        let value = match &self.value.node.kind {
            NodeKind::Tuple(entries) if entries.len() == 1 => {
                NodeValue { node: &entries[0], unnamed: false, ..self.value }
            }
            _ => self.value,
        };
        seed.deserialize(value).map_err(|error| error.report(value.node, value.context))
    }

    fn tuple_variant<V: Visitor<'a>>(self, length: usize, visitor: V) -> Result<V::Value, Error> {
        match &self.value.node.kind {
            NodeKind::Tuple(entries) if entries.len() == length => {
                self.value.deserialize_tuple(length, visitor)
            }
            _ => {
                let (name, entries) = (self.name(), ["first", "second", "third", "fourth"]);
                let entries = entries[..length.min(entries.len())].join(", ");
                self.wrong(format!("`{name}({entries})`, {length} entries without names"))
            }
        }
    }

    fn struct_variant<V: Visitor<'a>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match &self.value.node.kind {
            NodeKind::Tuple(entries) if !entries.is_empty() => {
                let name = self.name();
                self.wrong(format!("`{name}(field: value, ...)`"))
            }
            _ => {
                let name = self.name();
                self.value.read_fields(name, fields, visitor)
            }
        }
    }
}
