//! Records and arithmetic of the passes over neighbours, for four of them at once.

mod record;

mod kernel;

mod axial;

mod batch;

pub use axial::{Axial, pack_axial, unpack_axial};
pub use batch::{BATCH, Batch};
pub use kernel::{FluidKernel, KernelLoop, PairShape};
pub use record::{
    FILLS, FlowParticle, Four, FourPlaces, MASKS, OwnRecord, Periods, as_rows, dot, filled_up, sums,
};
