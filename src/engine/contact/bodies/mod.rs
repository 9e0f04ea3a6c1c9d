//! The bodies in contact in their current state: their motion bounds, particles with the ellipsoids into
//! which they deform, points and surfaces.

mod circle;
mod crossing;

mod ellipsoid;

mod error;

mod motion;

pub(super) mod shape;

mod members;

mod node_pose;

mod node_view;

mod sides;

pub(super) use crossing::{RAMP, share_of_slope};
pub use error::CONTACT;
pub(super) use error::failed;
pub(super) use members::{APART, BUMPS, MemberColumns, MemberParticles, Members};
pub(super) use motion::MotionBounds;
pub(super) use node_pose::NodePose;
pub(super) use node_view::{NodeMotion, NodeTurn, NodeView};
pub(super) use shape::{ParticleShape, Proximity, of_pair};
pub(super) use sides::{ContactSides, SideNodes};
