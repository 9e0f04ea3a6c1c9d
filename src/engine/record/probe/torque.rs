//! Torque of the forces on a selection about its centre of mass, or about a fixed point.

use glam::DVec3;

use crate::parallel::BlockSum;
use crate::plugin::Selection;
use crate::world::{Column, Force, Mass, MissingColumn, Position, World, sum_by_row};

/// The particles whose forces turn something.
pub struct TorqueGauge {
    pub(super) selection: Selection,
    /// The point about which they turn it \[m\]; without it the centre of mass.
    pub(super) about: Option<DVec3>,
}

/// Sum of torques about the origin.
#[derive(Clone, Copy, Default)]
struct TorqueSum {
    mass: f64,
    /// Sum of masses times positions, kg m.
    moment: DVec3,
    force: DVec3,
    torque: DVec3,
}

impl BlockSum for TorqueSum {
    fn add(&mut self, next: &Self) {
        self.mass += next.mass;
        self.moment += next.moment;
        self.force += next.force;
        self.torque += next.torque;
    }
}

impl TorqueGauge {
    /// Names of the particle columns that it reads.
    pub(super) const NEEDS: [&'static str; 3] = [Force::NAME, Mass::NAME, Position::NAME];

    /// The three components, N m. Sums run along the tree of blocks, body by body.
    pub(super) fn read(&self, world: &World) -> Result<Vec<f64>, MissingColumn> {
        let mut all = TorqueSum::default();
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (view, own) = world.body_view(*body);
            let (x, m, f) = (view.read::<Position>()?, view.read::<Mass>()?, view.read::<Force>()?);
            let (x, m, f) = (&x[..], &m[..], &f[..]);
            all.add(&sum_by_row(own.len(), rows.len(), &|k| rows[k] as usize - own.start, &|k| {
                let row = rows[k] as usize;
                TorqueSum {
                    mass: m[row].0,
                    moment: m[row].0 * x[row].0,
                    force: f[row].0,
                    torque: x[row].0.cross(f[row].0),
                }
            }));
        }
        let TorqueSum { mass, moment, force, torque } = all;
        let about = self.about.unwrap_or(moment / mass);
        Ok((torque - about.cross(force)).to_array().to_vec())
    }
}
