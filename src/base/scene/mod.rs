//! The scene: the description of an experiment as a RON text, read into typed values with errors that point
//! at the text.
//!
//! The stages are [`Source`] -> tree of values with their positions -> typed [`Scene`] -> checks beyond the
//! types. A value that a registry knows by name remains an [`Item`] until its type is found.

mod body;
mod check;
mod contact;
mod decode;
mod definitions;
mod description;
mod domain;
mod edge;
mod expression;
mod item;
mod literal;
mod load;
mod names;
mod overrides;
mod path;
mod per_axis;
mod precision;
mod probe;
mod probe_check;
mod problem;
mod record;
mod reference;
mod requirements;
mod select;
mod slips;
mod source;
mod symbols;
mod syntax;
mod table;
mod text_fault;
mod time;
mod tree;

pub use crate::space::{Dimension, Vec3};
pub use body::BodyDescription;
pub use contact::{Contact, ContactSurface};
pub use description::Scene;
pub use domain::{Axis, Domain, Outside};
pub use edge::Edge;
pub use expression::{Expression, ExpressionError, expression_names};
pub use item::Item;
pub use load::{load, load_checked, parse, parse_checked, parse_with};
pub use names::{nearest, unknown};
pub use per_axis::PerAxis;
pub use precision::Precision;
pub use probe::{Line, Probe, Quantity, Reduction, RelativeTo};
pub use problem::{Problem, SceneError, SourcePlace};
pub use record::RecordDescription;
pub use reference::{Described, Parameter, TypeDoc, parameters, schema_markdown, type_docs};
pub use select::{Face, Select, SurfacePart};
pub use source::Source;
pub use table::Table;
pub use time::{StepRule, StopWhen, Time};

#[cfg(test)]
mod tests;
