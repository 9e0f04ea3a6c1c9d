//! Volume of fluid that passes a plane.
//!
//! `Q = sum_j V_j v_j.n max(0, 1 - |d_j| / b) / b` with the distance d_j from the plane and b twice the
//! spacing: the mean over the layers of particles near the plane, which for evenly spread particles is that
//! in the plane. An oblique plane goes on in the images of a periodic domain. Of a part of a plane, a
//! particle at its border counts with the share of its width, one spacing, that is in this part.

use glam::DVec3;

use super::images::{contained_share, crossed_period};
use crate::formulations::fluid::FlowCloud;
use crate::parallel::sum_over_blocks;
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::shapes::Region;
use crate::world::{Column, Density, Mass, MissingColumn, Position, Removed, Velocity, World};

/// Half of the width of the layer that counts, over the spacing of the fluid.
const WIDTH: f64 = 2.0;
/// Points along the width of a particle, in a plane and in space, which tell the share of it in a part.
const POINTS: [i32; 2] = [16, 8];

/// A part of a plane.
pub struct FluxGauge {
    at: DVec3,
    /// Unit normal.
    normal: DVec3,
    within: Option<Box<dyn Region>>,
    /// Places in the plane within the width of a particle, over that.
    cell: Vec<DVec3>,
}

impl FluxGauge {
    /// A gauge of that part of the plane through `at`, all of it without a part; `plane` says that the scene
    /// is in two dimensions.
    pub(super) fn new(at: DVec3, normal: DVec3, within: Option<Box<dyn Region>>, plane: bool) -> Self {
        let along = |axis: DVec3, points: i32| {
            (0..points).map(move |k| axis * ((f64::from(k) + 0.5) / f64::from(points) - 0.5))
        };
        let cell = if plane {
            along(DVec3::new(-normal.y, normal.x, 0.0), POINTS[0]).collect()
        } else {
            let (one, other) = normal.any_orthonormal_pair();
            along(one, POINTS[1]).flat_map(|x| along(other, POINTS[1]).map(move |y| x + y)).collect()
        };
        Self { at, normal, within, cell }
    }
}

impl Measure for FluxGauge {
    fn columns(&self) -> Vec<(String, &'static str)> {
        vec![("flux".to_owned(), "m3/s")]
    }

    fn of_nothing(&self) -> Option<f64> {
        Some(0.0)
    }

    fn needs(&self) -> Vec<&'static str> {
        vec![Position::NAME, Velocity::NAME]
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let Some(cloud) = resources.try_get::<FlowCloud>() else { return Ok(vec![f64::NAN]) };
        let (cloud, mut flux) = (&*cloud, 0.0);
        for group in cloud.groups.iter().filter(|group| group.fluid().is_some()) {
            let view = world.phase(group.phase);
            let (position, velocity) = (view.read::<Position>()?, view.read::<Velocity>()?);
            let (mass, density) = (view.read::<Mass>()?, view.read::<Density>()?);
            let removed = view.read::<Removed>()?;
            let spacing = world.body(group.body).spacing;
            let (width, period) = (WIDTH * spacing, crossed_period(self.normal, cloud.periodic(), spacing));
            let (rise, others) = (period.dot(self.normal), cloud.periodic().lengths() - period);
            let (mass, density, velocity) = (&mass[..], &density[..], &velocity[..]);
            let of_row = |(row, x): (usize, &Position)| {
                let offset = cloud.offset(self.at, x.0);
                let distance = offset.dot(self.normal);
                let images = if rise == 0.0 {
                    0..=0
                } else {
                    let (one, other) = ((-width - distance) / rise, (width - distance) / rise);
                    one.min(other).ceil() as i64..=one.max(other).floor() as i64
                };
                let share_of = |k: i64| {
                    let (image, distance) = (offset + k as f64 * period, distance + k as f64 * rise);
                    let share = (1.0 - distance.abs() / width) / width;
                    let foot = self.at + image - self.normal * distance;
                    let part = |region: &dyn Region| {
                        contained_share(region, foot, self.cell.iter().map(|x| *x * spacing), others)
                    };
                    if share > 0.0 { share * self.within.as_deref().map_or(1.0, part) } else { 0.0 }
                };
                let speed = velocity[row].0.dot(self.normal);
                mass[row].0 / density[row].0 * speed * images.map(share_of).sum::<f64>()
            };
            let (start, removed) = (group.rows.start, &removed[..]);
            flux += sum_over_blocks(&position[group.rows.clone()], &|first, rows: &[Position]| {
                let rows = (start + first..).zip(rows).filter(|(row, _)| removed[*row] == Removed::NO);
                rows.map(of_row).sum::<f64>()
            });
        }
        Ok(vec![flux])
    }
}
