//! What programs that add to `meshless` or build scenes in Rust use most: `use meshless::prelude::*;`.

pub use meshless_engine::assembly::{BuildOptions, build, build_with};
pub use meshless_engine::column;
pub use meshless_engine::glam::{DMat3, DVec3};
pub use meshless_engine::materials::{
    ElasticConstants, Hyperelastic, Material, MaterialModel, ParameterError,
};
pub use meshless_engine::pair::{Pair, PairTerm, Rates, Relative};
pub use meshless_engine::parallel::{Arithmetic, FourLanes, Matrix, Number, Vector};
pub use meshless_engine::plugin::{
    BodyKind, Formulation, Offer, Plugin, Prescription, Registry, SetupError, SimBuilder,
};
pub use meshless_engine::record::read_series;
pub use meshless_engine::scene::{
    Dimension, Expression, Item, Scene, SceneError, Select, Source, Vec3, load, parse,
};
pub use meshless_engine::schedule::{
    AccountKind, Adds, Clock, EnergyAccount, Mode, Run, Stage, Step, StepError, System,
};
pub use meshless_engine::schemars::JsonSchema;
pub use meshless_engine::serde::Deserialize;
pub use meshless_engine::simulation::{Checkpoint, RunError, Simulation};
pub use meshless_engine::solids::{FoldedEnergy, FoldedRows, FoldedTerm};
pub use meshless_engine::world::{
    BodyId, BodySet, Column, DeformationGradient, Force, Mass, PiolaStress, Position, ReferencePosition,
    Velocity, World,
};

pub use crate::standard_plugins;
