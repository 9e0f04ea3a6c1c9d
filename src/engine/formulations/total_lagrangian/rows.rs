//! What the hot passes read per neighbour: packed rows of four lanes, derived from the columns in every step.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};

use super::frame::Frame;
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
    let position = view.read::<Position>()?;
    let reference = view.read::<ReferencePosition>()?;
    let volume = view.read::<ReferenceVolume>()?;
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

/// The pair stress of a particle, and all that its neighbours need to know of it.
///
/// The force on particle i is `V_i sum_j V_j w_ij [(A_i + A_j) X_ij + (k_i + k_j) u_ij]`. The stress alone gives
/// A_i = P_i M_i^-1 and k_i = 0: then this is sum_j V_i V_j (P_i g_ij - P_j g_ji) with g_ij = M_i^-1 w_ij X_ij.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub struct PairStress {
    /// The columns of A_i, and the bond stiffness k_i in the last lane of the first column.
    pub columns: [Lanes4; 3],
    /// q_i = A_i X_i + k_i u_i, and the volume V_i in the last lane. A_i and u_i are taken in the frame of the body.
    pub pull: Lanes4,
}

impl PairStress {
    /// The bond stiffness k_i, Pa/m2 times m2: a force per volume squared, weight and length.
    #[inline(always)]
    pub fn stiffness(&self) -> f64 {
        self.columns[0].0[3]
    }

    /// `A X + k u` for any X and u.
    #[inline(always)]
    pub fn times(&self, reference: DVec3, displacement: DVec3) -> DVec3 {
        let [x, y, z] = &self.columns;
        let stress = x.xyz() * reference.x + y.xyz() * reference.y + z.xyz() * reference.z;
        stress + displacement * self.stiffness()
    }

    /// Adds to A_i what no frame changes, of a particle at that place in the reference configuration.
    pub(super) fn add(&mut self, stress: &DMat3, reference: DVec3) {
        PairStressRows(std::slice::from_mut(self)).add_scaled(0, 1.0, stress);
        let pull = stress * reference;
        self.pull = Lanes4::new(self.pull.xyz() + pull, self.pull.0[3]);
    }

    /// Takes A_i into the frame of the body, and makes q_i.
    #[inline(always)]
    pub(super) fn complete(&mut self, frame: &Frame, site: &Site) {
        let stiffness = self.stiffness();
        let Frame { gradient, .. } = frame;
        for (column, add) in self.columns.iter_mut().zip([gradient.x_axis, gradient.y_axis, gradient.z_axis])
        {
            column.0[0] += stiffness * add.x;
            column.0[1] += stiffness * add.y;
            column.0[2] += stiffness * add.z;
        }
        self.pull = Lanes4::new(self.times(site.reference.xyz(), frame.rest(site)), site.reference.0[3]);
    }
}

/// The pair stress of a block of particles, open for terms to add to.
pub struct PairStressRows<'a>(pub(super) &'a mut [PairStress]);

impl PairStressRows<'_> {
    /// Adds `s M` to A of row `k`.
    #[inline(always)]
    pub fn add_scaled(&mut self, k: usize, s: f64, m: &DMat3) {
        let columns = &mut self.0[k].columns;
        for (column, add) in columns.iter_mut().zip([m.x_axis, m.y_axis, m.z_axis]) {
            column.0[0] += s * add.x;
            column.0[1] += s * add.y;
            column.0[2] += s * add.z;
        }
    }

    /// Adds to the bond stiffness k of row `k`.
    #[inline(always)]
    pub fn add_stiffness(&mut self, k: usize, stiffness: f64) {
        self.0[k].columns[0].0[3] += stiffness;
    }
}
