//! What programs that add to `meshless` or build scenes in Rust use most: `use meshless::prelude::*;`.

pub use meshless_engine::column;
pub use meshless_engine::glam::{DMat3, DVec3};
pub use meshless_engine::materials::{Hyperelastic, Material, MaterialModel, ParameterError};
pub use meshless_engine::plugin::{Formulation, Plugin, Registry, SetupError, SimBuilder, build};
pub use meshless_engine::scene::{Dimension, Item, Scene, SceneError, Select, Source, load, parse};
pub use meshless_engine::schedule::{AccountKind, Clock, Stage, Step, StepError, System};
pub use meshless_engine::schemars::JsonSchema;
pub use meshless_engine::serde::Deserialize;
pub use meshless_engine::simulation::{Checkpoint, RunError, Simulation};
pub use meshless_engine::world::{
    BodyId, BodySet, Column, Force, Mass, Position, ReferencePosition, Velocity, World,
};

pub use crate::standard_plugins;
