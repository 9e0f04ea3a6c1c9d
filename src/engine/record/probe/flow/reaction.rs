//! Force and torque of the fluids on a selection.

use glam::DVec3;

use crate::formulations::fluid::{FlowCloud, Reaction};
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
        let mut sum = Reaction::default();
        let cloud = FlowCloud::whole(resources);
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (view, all) = world.body_view(*body);
            let Some(cloud) = &cloud else { continue };
            let position = view.read::<Position>()?;
            let (position, about) = (&position[all.clone()], self.about.unwrap_or_default());
            if rows.len() < all.len() {
                let mut is_part = vec![false; all.len()];
                rows.iter().for_each(|&row| is_part[row as usize - all.start] = true);
                if let Some(part) = cloud.reaction_on_part(*body, &is_part, position, about) {
                    sum.add(&part);
                    continue;
                }
            }
            let Some(forces) = cloud.forces_on(*body) else { continue };
            sum.add(&sum_by_row(all.len(), rows.len(), &|k| rows[k] as usize - all.start, &|k| {
                let row = rows[k] as usize - all.start;
                let (force, viscous) = forces[row];
                Reaction { force, viscous, torque: (position[row].0 - about).cross(force) }
            }));
        }
        let Reaction { force, viscous, torque } = sum;
        Ok(match self.about {
            None => [force.to_array(), viscous.to_array()].concat(),
            Some(_) => torque.to_array().to_vec(),
        })
    }
}
