//! A value for each axis, or none: `(None, "-0.1*min(t/0.01, 1)", 0.0)`.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A value for each of the axes x, y, z, or `None` for an axis that is not affected. Written with two entries
/// (the third is then `None`) or three.
#[derive(Clone, Debug, PartialEq)]
pub struct PerAxis<T>(pub [Option<T>; 3]);

impl<T> Default for PerAxis<T> {
    fn default() -> Self {
        Self([None, None, None])
    }
}

struct AxisEntries<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for AxisEntries<T> {
    type Value = PerAxis<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an entry for each axis, `(x, y)` or `(x, y, z)`, each a value or `None`")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<PerAxis<T>, A::Error> {
        let x = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let y = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(1, &self))?;
        let z = seq.next_element()?.flatten();
        if seq.next_element::<Option<T>>()?.is_some() {
            return Err(A::Error::invalid_length(4, &self));
        }
        Ok(PerAxis([x, y, z]))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for PerAxis<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_tuple(3, AxisEntries(PhantomData))
    }
}

impl<T: Serialize> Serialize for PerAxis<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(3)?;
        for entry in &self.0 {
            tuple.serialize_element(entry)?;
        }
        tuple.end()
    }
}

impl<T: JsonSchema> JsonSchema for PerAxis<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("PerAxis<{}>", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let entry = generator.subschema_for::<Option<T>>();
        json_schema!({ "type": "array", "items": entry, "minItems": 2, "maxItems": 3 })
    }
}
