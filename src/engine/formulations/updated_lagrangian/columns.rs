//! The reference of the last update, one row a particle.

use glam::{DMat3, DVec3};

use crate::column;

column! {
    /// Position at the last update of the reference.
    pub struct UpdatedReference(DVec3) = "updated_reference", "x_r", "m";
    /// Deformation gradient at the last update of the reference.
    pub struct UpdatedGradient(DMat3) = "updated_gradient", "F_r", "1";
    /// Volume at the last update of the reference.
    pub struct UpdatedVolume(f64) = "updated_volume", "V", "m3";
}
