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
    /// The particles over which the probe averages (sums, for forces and torques), or the `surface` of a
    /// body. Either this, `at` or `line`.
    #[serde(default)]
    pub on: Option<Select>,
    /// The point at which the probe measures \[m\]. Either this or `on`. A field is interpolated there from
    /// the bodies that have it, except walls, whose particles represent the fluid next to them. Of fluids,
    /// solids and rigid bodies only the kind of the particle nearest to the point contributes.
    #[serde(default)]
    pub at: Option<Vec3>,
    /// A line along which the probe measures, with a column for each point. Instead of `on` or `at`.
    #[serde(default)]
    pub line: Option<Line>,
    /// With `at` or `line`: the solid or rigid body to which the points belong, given by their initial
    /// positions. They move with the body, and on its surface they show the surface values. A
    /// `PressureSensor` turns with the wall or body that it follows, and so does a `WaterLevel` that has a
    /// direction `along`; the point of the latter may lie beside the body, such as in the middle of a tank
    /// that moves. Without it the points are fixed in space.
    #[serde(default)]
    pub follows: Option<String>,
    /// Reduction over the particles of `on`, or over its `surface`. The default is the mean, for forces the
    /// sum.
    #[serde(default)]
    pub take: Option<Reduction>,
    /// A second position, whose value is subtracted.
    #[serde(default)]
    pub relative_to: Option<RelativeTo>,
    /// Whether there may be no body at the point at the start: the probe shows NaN until there is one.
    /// Otherwise this is an error. A probe that has found nothing until the end causes a warning without it.
    #[serde(default)]
    pub may_be_empty: bool,
    /// Whether each sample is the mean over all steps since the last sample, instead of the value at its
    /// time. Forces of fluids oscillate with acoustic waves, so that instantaneous samples scatter.
    /// `stop_when` always compares instantaneous values.
    #[serde(default)]
    pub mean: bool,
    /// The measured quantity.
    pub quantity: Quantity,
    /// Time between two samples \[s\]; without it a tenth of the interval of the recording. A sample is taken
    /// at the end of the first step at or after the stated time, and the file contains the time of that step.
    #[serde(default)]
    pub every: Option<f64>,
}

/// A straight line of equidistant points, its ends included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// First point \[m\].
    pub from: Vec3,
    /// Last point \[m\].
    pub to: Vec3,
    /// Number of points, 2 to 1000.
    pub points: u32,
}

/// Reduction over a selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Reduction {
    /// The mean, weighted by mass: of a rigid body the motion of its mass centre. Walls have no mass: a mean
    /// over them alone is weighted by volume, and one over bodies leaves them out. A `surface` is weighted by
    /// area.
    Mean,
    /// The sum over the particles.
    Sum,
    /// The minimum and its position; for vectors that of the magnitude.
    Minimum,
    /// The maximum and its position; for vectors that of the magnitude.
    Maximum,
}

/// The reference position of a relative probe.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelativeTo {
    /// The mean over these particles. Either this or `at`.
    #[serde(default)]
    pub on: Option<Select>,
    /// This point \[m\]. Either this or `on`.
    #[serde(default)]
    pub at: Option<Vec3>,
    /// With `at`: the body to which the point belongs.
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
    /// Sum of all forces on the particles of the selection except those of supports \[N\]. Where a condition
    /// holds or drives the selection, it is the force that the body exerts on the condition, its own weight
    /// included: the weight of a body that hangs from its support points down. What accelerates the driven
    /// particles themselves, their mass times their acceleration, is not part of it: a rigid body that is
    /// lifted shows its weight. Of a rigid body it is that on the whole body. Walls and half-spaces have no
    /// weight: on them it is that of flows and contacts. On a part of a wall it is 6 and 3 % off in water 10
    /// and 20 particles deep, as flows act below the surface and the tension that this makes along the wall
    /// counts where the part ends: use `FluidForce` there.
    Force,
    /// Torque of the same forces about the centre of mass of the selection, of walls, which have no mass,
    /// about that of their volume \[N m\]. A half-space has none: use `Moment`. On a part of a wall use
    /// `FluidTorque`.
    Torque,
    /// Moment of the same forces about a fixed point \[N m\]. On a part of a wall use `FluidTorque`.
    Moment {
        /// The point \[m\].
        about: Vec3,
    },
    /// Distance from the position of `relative_to` \[m\]: a strain gauge.
    Distance,
    /// A field of the particles by name, such as `"pressure"`, `"velocity.x"` or `"stress.xy"`.
    Field(String),
    /// Kinetic, strain and all other energies of the selected bodies, or of the whole scene without a
    /// selection \[J\].
    Energy,
    /// Height of the free surface of the fluids above the point `at`, and the wetted length of a wire gauge
    /// that starts at the point \[m\]. In a breaking wave the height is that of the highest surface.
    WaterLevel {
        /// Direction of the gauge; without it against gravity.
        #[serde(default)]
        along: Option<Vec3>,
    },
    /// Reading of a pressure sensor in a wall \[Pa\]: the mean over its face of the pressure of the fluids in
    /// front of it, zero where there are none. `at` is the centre of its face.
    PressureSensor {
        /// Diameter of the circular face; in two dimensions the length of the face \[m\]. Zero: the pressure
        /// at the point.
        #[serde(default)]
        diameter: f64,
        /// Normal of the face, into the fluid.
        normal: Vec3,
    },
    /// Volume flow rate of the fluids through a plane at `at` \[m3/s\], in two dimensions per metre of width.
    /// In a periodic domain an oblique plane goes on in the images of the domain.
    Flux {
        /// Normal of the plane, in the direction of positive flow.
        normal: Vec3,
        /// The part of the plane that is measured; without it the whole plane.
        #[serde(default)]
        within: Option<Shape>,
    },
    /// Force of all fluids on the selection, by pressure and viscosity, and its viscous part \[N\].
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
    /// difference `Rz` of the maximum and the minimum height, and the mean height. Of a body that can fail it
    /// is the surface of the largest piece of what has not failed, of each part of the body.
    Roughness {
        /// Outward normal of the surface.
        normal: Vec3,
    },
}

impl Quantity {
    /// Whether the quantity is measured at a point (true) or on a selection (false); none if both are
    /// possible.
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
