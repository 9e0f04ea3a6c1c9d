//! Force and torque of the fluids on a selection.

use glam::DVec3;

use crate::formulations::fluid::FlowCloud;
use crate::plugin::Selection;
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::world::{Column, MissingColumn, Position, World};

/// The particles on which fluids act.
pub struct ReactionGauge {
    pub(super) selection: Selection,
    /// The point about which the force turns; without it the force itself is measured.
    pub(super) about: Option<DVec3>,
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
        let (mut force, mut viscous, mut torque) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        let cloud = FlowCloud::whole(resources);
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let Some(forces) = cloud.as_ref().and_then(|cloud| cloud.forces_on(*body)) else { continue };
            let (view, all) = world.body_view(*body);
            let position = view.read::<Position>()?;
            for row in rows.iter().map(|&row| row as usize) {
                let (f, v) = forces[row - all.start];
                force += f;
                viscous += v;
                torque += (position[row].0 - self.about.unwrap_or_default()).cross(f);
            }
        }
        Ok(match self.about {
            None => [force.to_array(), viscous.to_array()].concat(),
            Some(_) => torque.to_array().to_vec(),
        })
    }
}
