//! Force and torque of the fluids on a selection.

use glam::DVec3;

use crate::formulations::fluid::FlowCloud;
use crate::parallel::BlockSum;
use crate::plugin::Selection;
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::world::{Column, MissingColumn, Position, World, sum_by_row};

/// The particles on which fluids act.
pub struct ReactionGauge {
    pub(super) selection: Selection,
    /// The point about which the force turns; without it the force itself is measured.
    pub(super) about: Option<DVec3>,
}

/// Force, N, its viscous part, and torque, N m.
#[derive(Clone, Copy, Default)]
struct ReactionSum {
    force: DVec3,
    viscous: DVec3,
    torque: DVec3,
}

impl BlockSum for ReactionSum {
    fn add(&mut self, next: &Self) {
        self.force += next.force;
        self.viscous += next.viscous;
        self.torque += next.torque;
    }
}

impl Measure for ReactionGauge {
    fn columns(&self) -> Vec<(String, &'static str)> {
        let (names, unit): (&[&str], _) = match self.about {
            None => (&["x", "y", "z", "viscous_x", "viscous_y", "viscous_z"], "N"),
            Some(_) => (&["x", "y", "z"], "N m"),
        };
        names.iter().map(|name| ((*name).to_owned(), unit)).collect()
    }

    fn needs(&self) -> Vec<&'static str> {
        vec![Position::NAME]
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let mut sum = ReactionSum::default();
        let cloud = FlowCloud::whole(resources);
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let Some(forces) = cloud.as_ref().and_then(|cloud| cloud.forces_on(*body)) else { continue };
            let (view, all) = world.body_view(*body);
            let position = view.read::<Position>()?;
            let position = &position[..];
            sum.add(&sum_by_row(all.len(), rows.len(), &|k| rows[k] as usize - all.start, &|k| {
                let row = rows[k] as usize;
                let (force, viscous) = forces[row - all.start];
                let arm = position[row].0 - self.about.unwrap_or_default();
                ReactionSum { force, viscous, torque: arm.cross(force) }
            }));
        }
        let ReactionSum { force, viscous, torque } = sum;
        Ok(match self.about {
            None => [force.to_array(), viscous.to_array()].concat(),
            Some(_) => torque.to_array().to_vec(),
        })
    }
}
