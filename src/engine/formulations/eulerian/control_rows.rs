//! The rows of hourglass control along pairs.

use glam::DMat3;

use crate::parallel::Lanes4;
use crate::solids::FoldedEnergy;
use crate::symmetry::Map;

/// Initial data of a particle, as its neighbours read them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Carried {
    /// The columns of F, and in their last lanes the modulus of the control, that of the last step, Pa, and
    /// the reference volume, m3.
    pub columns: [Lanes4; 3],
    /// X.
    pub original: Lanes4,
}

impl Carried {
    /// Sets F, the modulus, Pa, and the reference volume, m3.
    pub fn set(&mut self, f: &DMat3, modulus: f64, volume: f64) {
        let before = self.columns[1].0[3];
        self.columns =
            [Lanes4::new(f.x_axis, modulus), Lanes4::new(f.y_axis, before), Lanes4::new(f.z_axis, volume)];
    }

    /// Sets the modulus of the last step, Pa.
    pub fn set_modulus_before(&mut self, modulus: f64) {
        self.columns[1].0[3] = modulus;
    }

    pub fn deformation(&self) -> DMat3 {
        let [x, y, z] = self.columns;
        DMat3::from_cols(x.xyz(), y.xyz(), z.xyz())
    }

    #[inline(always)]
    pub fn volume(&self) -> f64 {
        self.columns[2].0[3]
    }

    /// That of a ghost.
    pub fn image(&self, map: &Map) -> Self {
        let mut image = Self { original: Lanes4::new(map.place(self.original.xyz()), 0.0), ..*self };
        for (axis, column) in image.columns.iter_mut().enumerate() {
            *column = Lanes4::new(column.xyz() * map.signs * map.signs[axis], column.0[3]);
        }
        image
    }
}

/// Rows that the pass writes.
#[derive(Default)]
pub(super) struct EulerianControlRows {
    /// Force at fixed F, N.
    pub force: Vec<Lanes4>,
    /// Sum of the stiffnesses of the pairs over the mass of the particle, 1/s2.
    pub stiffness: Vec<f64>,
    pub sums: Vec<FoldedEnergy>,
}

/// The control of a body.
#[derive(Clone, Copy)]
pub(super) struct BodyControl {
    pub xi: f64,
    /// Coefficient of the error across a pair over xi, for each Pa of the lesser modulus of the pair, 1/Pa.
    pub across: f64,
    /// Density rho_0, kg/m3.
    pub density: f64,
}

impl EulerianControlRows {
    /// Room for real rows.
    pub fn resize(&mut self, rows: usize) {
        self.force.resize(rows, Lanes4::ZERO);
        self.stiffness.resize(rows, 0.0);
    }
}
