//! The world: particles as hecs entities, component columns with symbol and unit, bodies as row ranges.

mod access;
mod body;
mod by_row;
mod column;
mod own;
mod own_only;
mod permute;
mod registry;
mod rows_now;
mod standard;
mod state;

pub(crate) use access::Watch;
pub use access::{Access, Declared, Mode, Undeclared};
pub use body::{Body, BodyId, BodySet, PhaseId};
pub use by_row::sum_by_row;
pub use column::{Column, Value};
pub use registry::{ColumnInfo, ColumnSet};
pub use standard::*;
pub use state::{MissingColumn, Phase, PhaseView, World};
