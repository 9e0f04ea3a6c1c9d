//! Rows that the hot passes read per neighbour: four lanes each, packed from the columns in every step.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::parallel::{Lanes4, for_each_block};
use crate::schedule::StepError;
use crate::world::{PhaseView, Position, ReferencePosition, ReferenceVolume};

/// Where a particle is: reference position X with the volume V_0 in the last lane, and displacement u = x - X.
///
/// The passes work with displacements: differences of current positions would lose the digits of a small strain. X is
/// measured from the middle of the bodies, because sums are taken over X_j before X_i is subtracted.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub struct Site {
    /// X, and V_0 in the last lane.
    pub reference: Lanes4,
    /// u.
    pub displacement: Lanes4,
}

impl Site {
    /// Packs a particle: X and u in m, V_0 in m3.
    pub fn new(reference: DVec3, displacement: DVec3, volume: f64) -> Self {
        Self { reference: Lanes4::new(reference, volume), displacement: Lanes4::new(displacement, 0.0) }
    }

    /// Whether it counts in sums over neighbours: a removed particle has no volume here.
    #[inline(always)]
    pub fn is_present(&self) -> bool {
        self.reference.0[3] > 0.0
    }
}

/// Fills the sites of the real rows; a removed particle has no volume, so that no sum over neighbours sees it.
pub(super) fn pack(
    view: &PhaseView<'_>,
    origin: DVec3,
    removed: &[u32],
    sites: &mut [Site],
) -> Result<(), StepError> {
    let position = view.read_near::<Position>()?;
    let reference = view.read_near::<ReferencePosition>()?;
    let volume = view.read_near::<ReferenceVolume>()?;
    let rows = (&mut sites[..], &position[..], &reference[..], &volume[..]);
    type Rows<'a> = (&'a mut [Site], &'a [Position], &'a [ReferencePosition], &'a [ReferenceVolume]);
    for_each_block(rows, &mut Vec::new(), &|_, (sites, x, reference, volume): Rows<'_>| {
        for (k, site) in sites.iter_mut().enumerate() {
            let reference = reference[k].0;
            *site = Site::new(reference - origin, x[k].0 - reference, volume[k].0);
        }
    });
    for &row in removed {
        sites[row as usize].reference.0[3] = 0.0;
    }
    Ok(())
}
