//! The reference of the last update, one row per particle.

use glam::{DMat3, DVec3};

use crate::column;
use crate::linalg::Sym3;

column! {
    /// Position at the last update of the reference.
    pub struct UpdatedReference(DVec3) = "updated_reference", "x_r", "m";
    /// Deformation gradient at the last update of the reference.
    pub struct UpdatedGradient(DMat3) = "updated_gradient", "F_r", "1";
    /// Volume at the last update of the reference.
    pub struct UpdatedVolume(f64) = "updated_volume", "V", "m3";
    /// Metric of distances in the kernel, from the last update on.
    pub struct UpdatedMetric(Sym3) = "updated_metric", "G", "1";
}
