//! The stress of a particle in the form that its neighbours read: 128 bytes, four lanes of f64 each.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};

use crate::parallel::Lanes4;
use crate::symmetry::Map;

/// The corrected first Piola-Kirchhoff stress of a particle, A_i = P_i M_i^-1, and all that its neighbours
/// need to know of it.
///
/// The force on particle i is `V_i sum_j V_j w_ij [(A_i + A_j) X_ij + (k_i + k_j) u_ij]`. The stress alone
/// gives A_i = P_i M_i^-1 and k_i = 0: then this is sum_j V_i V_j (P_i g_ij - P_j g_ji) with g_ij = M_i^-1
/// w_ij X_ij.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub struct CorrectedStress {
    /// The columns of A_i, and the bond stiffness k_i in the last lane of the first column.
    pub columns: [Lanes4; 3],
    /// Affine traction q_i = A_i X_i + k_i u_i, and the volume V_i in the last lane; for formulations that
    /// sum it.
    pub traction: Lanes4,
}

impl CorrectedStress {
    /// The corrected stress A, without bond stiffness and affine traction.
    #[inline(always)]
    pub fn new(a: &DMat3) -> Self {
        // One by one: the map of an array would be called.
        let columns = [Lanes4::new(a.x_axis, 0.0), Lanes4::new(a.y_axis, 0.0), Lanes4::new(a.z_axis, 0.0)];
        Self { columns, ..Self::default() }
    }

    /// The image S A S of a ghost, with the same bond stiffness, without affine traction.
    pub fn image(&self, map: &Map) -> Self {
        let mut columns = self.columns;
        for (axis, column) in columns.iter_mut().enumerate() {
            *column = Lanes4::new(column.xyz() * map.signs * map.signs[axis], column.0[3]);
        }
        Self { columns, ..Self::default() }
    }

    /// The bond stiffness k_i, Pa/m2 times m2: a force per volume squared, weight and length.
    #[inline(always)]
    pub fn stiffness(&self) -> f64 {
        self.columns[0].0[3]
    }

    /// `A X + k u` for any X and u.
    #[inline(always)]
    pub fn apply(&self, reference: DVec3, displacement: DVec3) -> DVec3 {
        let [x, y, z] = &self.columns;
        let stress = x.xyz() * reference.x + y.xyz() * reference.y + z.xyz() * reference.z;
        stress + displacement * self.stiffness()
    }

    /// Adds to q_i alone: a force on every neighbour, whatever its place.
    #[inline(always)]
    pub fn add_traction(&mut self, traction: DVec3) {
        self.traction = Lanes4::new(self.traction.xyz() + traction, self.traction.0[3]);
    }

    /// Adds to A_i, and to q_i, what no frame changes, of a particle at that place in the reference
    /// configuration.
    #[inline(always)]
    pub fn add(&mut self, stress: &DMat3, reference: DVec3) {
        CorrectedStressRows(std::slice::from_mut(self)).add_scaled(0, 1.0, stress);
        self.add_traction(stress * reference);
    }
}

/// The corrected stress of a block of particles, to be added to.
pub struct CorrectedStressRows<'a>(pub &'a mut [CorrectedStress]);

impl CorrectedStressRows<'_> {
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
