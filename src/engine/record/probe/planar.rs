//! Probes of plane scenes: the columns that are zero in every plane motion are left out.

use super::gauge::Gauge;
use super::measure::Measure;
use crate::schedule::Resources;
use crate::world::{MissingColumn, World};

/// A gauge without the columns out of the plane.
pub(super) struct Planar {
    gauge: Gauge,
    kept: Vec<usize>,
}

impl Planar {
    /// The gauge of a plane scene.
    pub fn of(gauge: Gauge) -> Gauge {
        let columns = gauge.columns();
        let kept: Vec<usize> = (0..columns.len()).filter(|&k| is_in_plane(&columns[k])).collect();
        if kept.len() == columns.len() || kept.is_empty() {
            return gauge;
        }
        Gauge::Measure(Box::new(Self { gauge, kept }))
    }
}

/// Units of what turns about an axis.
const AXIAL: [&str; 3] = ["N m", "1/s", "rad/s"];

/// Torques and rates of rotation turn about z, all other vectors lie in the plane; of a tensor zz stays.
fn is_in_plane((name, unit): &(String, &'static str)) -> bool {
    let component = name.split(' ').next().unwrap_or(name);
    let component = component.rsplit(['.', '_']).next().unwrap_or(component);
    match component {
        "x" | "y" => !AXIAL.contains(unit),
        "z" => AXIAL.contains(unit),
        "xz" | "yz" | "zx" | "zy" => false,
        _ => true,
    }
}

impl Measure for Planar {
    fn columns(&self) -> Vec<(String, &'static str)> {
        let columns = self.gauge.columns();
        self.kept.iter().map(|&k| columns[k].clone()).collect()
    }

    fn needs(&self) -> Vec<&'static str> {
        self.gauge.needs()
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let values = self.gauge.read(world, resources)?;
        Ok(self.kept.iter().map(|&k| values[k]).collect())
    }
}
