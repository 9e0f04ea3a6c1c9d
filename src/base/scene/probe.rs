//! A quantity that is written as a function of time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Select, Vec3};
use crate::shapes::Shape;

/// A quantity of a selection or at a point, written to `<name>.csv` as a function of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name of the probe and of its file.
    pub name: String,
    /// The particles that it averages over (for forces and torques: sums over), or the `surface` of a body.
    /// Either this, `at` or `line`.
    #[serde(default)]
    pub on: Option<Select>,
    /// The point in space at which it measures \[m\]. Either this or `on`. A field there is interpolated from
    /// the bodies that have it, walls left out: their particles stand for the fluid beside them. Of fluids,
    /// solids and rigid bodies only those count to which the particle nearest to the point belongs.
    #[serde(default)]
    pub at: Option<Vec3>,
    /// A line along which it measures, a column for each of its places. Instead of `on` or `at`.
    #[serde(default)]
    pub line: Option<Line>,
    /// With `at` or `line`: the solid or rigid body whose points these are, given in their places at the
    /// start. They move with the body, and at its surface they show the values at the surface. Without it
    /// they are points of space.
    #[serde(default)]
    pub follows: Option<String>,
    /// Reduction over the particles of `on`, or over its `surface`: without it the mean, of forces the sum.
    #[serde(default)]
    pub take: Option<Take>,
    /// A second place, whose value is subtracted.
    #[serde(default)]
    pub relative_to: Option<RelativeTo>,
    /// No error where nothing is at the point at the start: the probe shows NaN until something is.
    #[serde(default)]
    pub may_be_empty: bool,
    /// Whether each sample is the mean over the time since the last one, in the place of the value at its
    /// end: measured in every step. Forces of fluids oscillate with acoustic waves, so that instantaneous
    /// samples scatter. `stop_when` compares the values all the same.
    #[serde(default)]
    pub mean: bool,
    /// The measured quantity.
    pub quantity: Quantity,
    /// Time between two samples \[s\]; without it a tenth of the interval of the recording. A sample is taken
    /// at the end of the first step at or after the stated time, and the file has the time of that step.
    #[serde(default)]
    pub every: Option<f64>,
}

/// A straight line with places at equal distances, its ends among them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// First place \[m\].
    pub from: Vec3,
    /// Last place \[m\].
    pub to: Vec3,
    /// Number of places, 2 to 1000.
    pub points: u32,
}

/// Reduction over a selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Take {
    /// The mean: of equal shares of particles, of areas of a `surface`.
    Mean,
    /// The sum over the particles.
    Sum,
    /// The minimum with its place; of vectors that of the magnitude.
    Minimum,
    /// The maximum with its place; of vectors that of the magnitude.
    Maximum,
}

/// The place to which a probe is relative.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelativeTo {
    /// The mean over these particles. Either this or `at`.
    #[serde(default)]
    pub on: Option<Select>,
    /// This point \[m\]. Either this or `on`.
    #[serde(default)]
    pub at: Option<Vec3>,
    /// With `at`: the body whose point it is.
    #[serde(default)]
    pub follows: Option<String>,
}

/// Quantity measured by a probe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum Quantity {
    /// Displacement from the start \[m\].
    Displacement,
    /// Position \[m\].
    Position,
    /// Velocity \[m/s\].
    Velocity,
    /// Sum over the selection of all forces on its particles except those of supports \[N\]: where a
    /// condition holds or drives the selection, the force that the body exerts on the condition. A body that
    /// hangs from its support by its weight pulls it down.
    Force,
    /// Torque of the same forces about the centre of mass of the selection \[N m\].
    Torque,
    /// Moment of the same forces about a fixed point \[N m\].
    Moment {
        /// The point \[m\].
        about: Vec3,
    },
    /// Distance from the place of `relative_to` \[m\]: a strain gauge.
    Distance,
    /// A field of the particles by name, such as `"pressure"`, `"velocity.x"` or `"stress.xy"`.
    Field(String),
    /// Kinetic, strain and all other energies of the selected bodies, or of everything where none is given
    /// \[J\].
    Energy,
    /// Height of the surface of the fluids above the point `at`, and the length of the line up from that
    /// point which is wet, as a wire gauge shows it \[m\]. Where a wave breaks over the point, the height is
    /// that of its highest surface.
    WaterLevel {
        /// Direction of the line; without it against gravity.
        #[serde(default)]
        along: Option<Vec3>,
    },
    /// Pressure that a sensor in the surface of a wall shows \[Pa\]: the mean over its area of the pressure
    /// of the fluids in front of it, zero where there are none. `at` is the centre of its face.
    PressureSensor {
        /// Diameter of its round face; in two dimensions the length of its face \[m\]. Zero: at the point.
        #[serde(default)]
        diameter: f64,
        /// Direction out of its face, into the fluid.
        normal: Vec3,
    },
    /// Volume of fluid that passes a plane through `at` in a second \[m3/s\], in two dimensions for each
    /// metre of width.
    Flux {
        /// The direction in which it counts as positive.
        normal: Vec3,
        /// The part of the plane that counts; without it the whole plane.
        #[serde(default)]
        within: Option<Shape>,
    },
    /// Force of all fluids on the selection, by pressure and viscosity, and the viscous part of it \[N\].
    FluidForce,
    /// Torque of the force of all fluids on the selection \[N m\].
    FluidTorque {
        /// Reference point of the torque \[m\].
        about: Vec3,
    },
    /// Reference volume of the removed particles of the selection: the volume worn off or cut off \[m3; m2 in
    /// two dimensions\].
    RemovedVolume,
    /// Roughness of the surface of the selection, seen against its normal, from the highest particle of every
    /// column that is a spacing wide \[m\]: the arithmetic mean deviation `Ra` from the mean height, the
    /// difference `Rz` of the highest and the lowest height, and the mean height.
    Roughness {
        /// Direction out of the surface.
        normal: Vec3,
    },
}

impl Quantity {
    /// Whether it is measured at a point and not of a selection; neither where it may be either.
    pub fn at_point(&self) -> Option<bool> {
        match self {
            Self::WaterLevel { .. } | Self::PressureSensor { .. } | Self::Flux { .. } => Some(true),
            Self::Force
            | Self::Torque
            | Self::Moment { .. }
            | Self::Energy
            | Self::FluidForce
            | Self::RemovedVolume
            | Self::Roughness { .. }
            | Self::FluidTorque { .. } => Some(false),
            Self::Displacement | Self::Position | Self::Velocity | Self::Distance | Self::Field(_) => None,
        }
    }
}
