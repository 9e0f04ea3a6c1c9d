//! The particles of other ranks of which this one has current values.

use crate::ranks::Halo;

/// Which rows of other ranks this one knows.
#[derive(Debug, Default)]
pub struct OtherParticles {
    /// Whether loops need only the particles near their own ones unless walls move relative to each other,
    /// and whether this holds in this step.
    pub(super) may_be_local: bool,
    pub(super) is_local: bool,
    /// Whether the records of all rows are those of now.
    pub(super) is_whole: bool,
    pub(super) fluids: Halo,
    pub(super) boundaries: Halo,
    /// Rows that are near own particles.
    pub(super) wanted: Vec<bool>,
    /// Volumes, m3, and pressures, Pa, on their way.
    pub(super) states: Vec<[f64; 2]>,
}
