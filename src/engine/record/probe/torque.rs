//! Torque of the forces on a selection about its centre of mass, or about a fixed point.

use glam::DVec3;

use crate::plugin::Selection;
use crate::world::{Column, Force, Mass, MissingColumn, Position, World};

/// The particles whose forces turn something.
pub struct TorqueGauge {
    pub(super) selection: Selection,
    /// The point about which they turn it \[m\]; without it the centre of mass.
    pub(super) about: Option<DVec3>,
}

impl TorqueGauge {
    /// Names of the particle columns that it reads.
    pub(super) const NEEDS: [&'static str; 3] = [Force::NAME, Mass::NAME, Position::NAME];

    /// The three components, N m. Sums run in row order, body by body.
    pub(super) fn read(&self, world: &World) -> Result<Vec<f64>, MissingColumn> {
        let (mut mass, mut moment, mut force, mut torque) = (0.0, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (view, _) = world.body_view(*body);
            let (x, m, f) = (view.read::<Position>()?, view.read::<Mass>()?, view.read::<Force>()?);
            for row in rows.iter().map(|&row| row as usize) {
                mass += m[row].0;
                moment += m[row].0 * x[row].0;
                force += f[row].0;
                torque += x[row].0.cross(f[row].0);
            }
        }
        let about = self.about.unwrap_or(moment / mass);
        Ok((torque - about.cross(force)).to_array().to_vec())
    }
}
