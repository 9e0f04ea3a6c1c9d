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
    /// The particles that it averages over (for forces and torques: sums over). Either this or `at`.
    #[serde(default)]
    pub on: Option<Select>,
    /// The point in space at which it measures \[m\]. Either this or `on`. A field there is interpolated from the bodies that have
    /// it, walls left out: their particles stand for the fluid beside them. Of fluids, solids and rigid bodies only those count to which the
    /// particle nearest to the point belongs.
    #[serde(default)]
    pub at: Option<Vec3>,
    /// What is measured.
    pub quantity: Quantity,
    /// Time between two samples \[s\]; without it a tenth of the interval of the recording.
    #[serde(default)]
    pub every: Option<f64>,
}

/// What a probe measures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum Quantity {
    /// Displacement from the start \[m\].
    Displacement,
    /// Position \[m\].
    Position,
    /// Velocity \[m/s\].
    Velocity,
    /// Sum over the selection of all forces on its particles except that of what holds them \[N\]: where a condition
    /// holds or drives the selection, the force that the body exerts on the condition. A body that hangs from its
    /// support by its weight pulls it down.
    Force,
    /// Torque of the same forces about the centre of mass of the selection \[N m\].
    Torque,
    /// A field of the particles by name, such as `"pressure"`, `"velocity.x"` or `"stress.xy"`.
    Field(String),
    /// Kinetic, strain and all other energies of the selected bodies, or of everything where none is given \[J\].
    Energy,
    /// Height of the surface of the fluids above the point `at`, and the length of the line up from that point which is wet, as
    /// a wire gauge shows it \[m\]. Where a wave breaks over the point, the height is that of its highest surface.
    WaterLevel {
        /// Direction of the line; without it against gravity.
        #[serde(default)]
        along: Option<Vec3>,
    },
    /// Pressure that a sensor in the surface of a wall shows \[Pa\]: the mean over its area of the pressure of the fluids in front of it,
    /// zero where there are none. `at` is the centre of its face.
    PressureSensor {
        /// Diameter of its round face; in two dimensions the length of its face \[m\]. Zero: at the point.
        #[serde(default)]
        diameter: f64,
        /// Direction out of its face, into the fluid.
        normal: Vec3,
    },
    /// Volume of fluid that passes a plane through `at` in a second \[m3/s\], in two dimensions for each metre of width.
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
        /// The point about which the force turns \[m\].
        about: Vec3,
    },
}

impl Quantity {
    /// Whether it is measured at a point and not of a selection; neither where it may be either.
    pub fn at_point(&self) -> Option<bool> {
        match self {
            Self::WaterLevel { .. } | Self::PressureSensor { .. } | Self::Flux { .. } => Some(true),
            Self::Force | Self::Torque | Self::Energy | Self::FluidForce | Self::FluidTorque { .. } => {
                Some(false)
            }
            Self::Displacement | Self::Position | Self::Velocity | Self::Field(_) => None,
        }
    }
}
