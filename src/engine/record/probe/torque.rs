//! Torque of the forces on a selection about its centre of mass, or about a fixed point.

use glam::DVec3;

use crate::parallel::BlockSum;
use crate::plugin::Selection;
use crate::world::{
    Column, Force, Mass, MissingColumn, Position, ReferenceVolume, Removed, World, sum_by_row,
};

/// The particles whose forces turn something.
pub struct TorqueGauge {
    pub(super) selection: Selection,
    /// The point about which they turn it \[m\]; without it the centre of mass. Walls have no mass: their
    /// centre alone is that of their volume.
    pub(super) about: Option<DVec3>,
}

/// Sum of torques about the origin.
#[derive(Clone, Copy, Default)]
struct TorqueSum {
    mass: f64,
    /// Sum of masses times positions, kg m.
    moment: DVec3,
    volume: f64,
    /// Sum of reference volumes times positions, m4.
    volume_moment: DVec3,
    force: DVec3,
    torque: DVec3,
}

impl BlockSum for TorqueSum {
    fn add(&mut self, next: &Self) {
        self.mass += next.mass;
        self.moment += next.moment;
        self.volume += next.volume;
        self.volume_moment += next.volume_moment;
        self.force += next.force;
        self.torque += next.torque;
    }
}

impl TorqueGauge {
    /// Names of the particle columns that it reads.
    pub(super) const NEEDS: [&'static str; 5] =
        [Force::NAME, Mass::NAME, Position::NAME, ReferenceVolume::NAME, Removed::NAME];

    /// The three components, N m, of the forces on the particles that have not been removed. Sums run along
    /// the tree of blocks, body by body.
    pub(super) fn read(&self, world: &World) -> Result<Vec<f64>, MissingColumn> {
        let mut all = TorqueSum::default();
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (view, own) = world.body_view(*body);
            let (x, m, f) = (view.read::<Position>()?, view.read::<Mass>()?, view.read::<Force>()?);
            let (removed, volume) = (view.read::<Removed>()?, view.read::<ReferenceVolume>()?);
            let (x, m, f, removed, volume) = (&x[..], &m[..], &f[..], &removed[..], &volume[..]);
            all.add(&sum_by_row(own.len(), rows.len(), &|k| rows[k] as usize - own.start, &|k| {
                let row = rows[k] as usize;
                if removed[row] != Removed::NO {
                    return TorqueSum::default();
                }
                TorqueSum {
                    mass: m[row].0,
                    moment: m[row].0 * x[row].0,
                    volume: volume[row].0,
                    volume_moment: volume[row].0 * x[row].0,
                    force: f[row].0,
                    torque: x[row].0.cross(f[row].0),
                }
            }));
        }
        let TorqueSum { mass, moment, volume, volume_moment, force, torque } = all;
        let centre = if mass > 0.0 { moment / mass } else { volume_moment / volume };
        let about = self.about.unwrap_or(centre);
        Ok((torque - about.cross(force)).to_array().to_vec())
    }
}
