//! A point or vector as a scene writes it: `(x, y)` or `(x, y, z)`.

use std::borrow::Cow;
use std::fmt;

use glam::DVec3;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A point or vector in a scene, written `(x, y)` with z = 0 or `(x, y, z)`. The unit is that of the field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3(pub DVec3);

impl Vec3 {
    /// The vector with the components `x`, `y`, `z`.
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self(DVec3::new(x, y, z))
    }
}

impl From<DVec3> for Vec3 {
    fn from(vector: DVec3) -> Self {
        Self(vector)
    }
}

impl From<Vec3> for DVec3 {
    fn from(vector: Vec3) -> Self {
        vector.0
    }
}

struct VectorEntries;

impl<'de> Visitor<'de> for VectorEntries {
    type Value = Vec3;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a vector `(x, y)` or `(x, y, z)`")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec3, A::Error> {
        let x = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let y = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(1, &self))?;
        let z = seq.next_element()?.unwrap_or(0.0);
        if seq.next_element::<f64>()?.is_some() {
            return Err(A::Error::invalid_length(4, &self));
        }
        Ok(Vec3::new(x, y, z))
    }
}

impl<'de> Deserialize<'de> for Vec3 {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_tuple(3, VectorEntries)
    }
}

impl Serialize for Vec3 {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(3)?;
        for component in self.0.to_array() {
            tuple.serialize_element(&component)?;
        }
        tuple.end()
    }
}

impl JsonSchema for Vec3 {
    fn schema_name() -> Cow<'static, str> {
        "Vec3".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 3 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_or_three_components() {
        assert_eq!(ron::from_str::<Vec3>("(1, -2.5)").unwrap(), Vec3::new(1.0, -2.5, 0.0));
        assert_eq!(ron::from_str::<Vec3>("(1.0, 2.0, 3e2,)").unwrap(), Vec3::new(1.0, 2.0, 300.0));
        assert!(ron::from_str::<Vec3>("(1.0)").is_err());
        assert!(ron::from_str::<Vec3>("(1.0, 2.0, 3.0, 4.0)").is_err());
        assert!(ron::from_str::<Vec3>("[1.0, 2.0]").is_err());
    }

    #[test]
    fn reads_what_it_writes() {
        let vector = Vec3::new(0.1, -2e-300, 7.0);
        assert_eq!(ron::from_str::<Vec3>(&ron::to_string(&vector).unwrap()).unwrap(), vector);
    }
}
