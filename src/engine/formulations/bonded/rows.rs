//! Rows that the hot passes read per neighbour: four lanes each, packed from the columns in every step.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::parallel::{Lanes4, for_each_block, for_each_own_block};
use crate::ranks::Halo;
use crate::schedule::StepError;
use crate::solids::HasPlace;
use crate::world::{PhaseView, Position, ReferencePosition, ReferenceVolume};

/// Where a particle is: reference position X with the volume V_0 in the last lane, and displacement u = x -
/// X.
///
/// The passes work with displacements: differences of current positions would lose the digits of a small
/// strain. X is measured from the middle of the bodies, because sums are taken over X_j before X_i is
/// subtracted.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub struct PackedParticle {
    /// X, and V_0 in the last lane.
    pub reference: Lanes4,
    /// u.
    pub displacement: Lanes4,
}

impl PackedParticle {
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

impl HasPlace for PackedParticle {
    #[inline(always)]
    fn place(&self) -> Lanes4 {
        self.reference
    }
}

/// Fills the sites of the real rows; a removed particle has no volume, so that no sum over neighbours sees
/// it. Of several ranks each fills the rows that it computes and those of the halo, once it has the places of
/// all; until then there is no halo.
pub(in crate::formulations) fn pack(
    view: &PhaseView<'_>,
    origin: DVec3,
    removed: &[u32],
    sites: &mut [PackedParticle],
    halo: Option<&Halo>,
) -> Result<(), StepError> {
    let position = match halo {
        Some(halo) => view.read_halo::<Position>(halo)?,
        None => view.read_near::<Position>()?,
    };
    let reference = view.read_near::<ReferencePosition>()?;
    let volume = view.read_near::<ReferenceVolume>()?;
    type Columns<'a> = (&'a [Position], &'a [ReferencePosition], &'a [ReferenceVolume]);
    let columns = |rows: Range<usize>| (&position[rows.clone()], &reference[rows.clone()], &volume[rows]);
    let fill = |sites: &mut [PackedParticle], (x, reference, volume): Columns<'_>| {
        for (k, site) in sites.iter_mut().enumerate() {
            let reference = reference[k].0;
            *site = PackedParticle::new(reference - origin, x[k].0 - reference, volume[k].0);
        }
    };
    type Rows<'a> = (&'a mut [PackedParticle], Columns<'a>);
    let body = |_, (sites, columns): Rows<'_>| fill(sites, columns);
    match halo {
        None => {
            let all = columns(0..sites.len());
            for_each_block((&mut *sites, all), &mut Vec::new(), &body);
        }
        Some(halo) => {
            for rows in view.body_rows() {
                let own = (&mut sites[rows.clone()], columns(rows.clone()));
                for_each_own_block(own, &mut Vec::new(), &body);
            }
            for row in halo.rows().iter().map(|&row| row as usize) {
                fill(&mut sites[row..=row], columns(row..row + 1));
            }
        }
    }
    for &row in removed {
        sites[row as usize].reference.0[3] = 0.0;
    }
    Ok(())
}
