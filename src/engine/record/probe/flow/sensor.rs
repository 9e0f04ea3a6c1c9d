//! The reading of a pressure sensor in a wall: the mean, over points of its face, of the pressure that a
//! particle of the wall would have there.
//!
//! `p = (sum_f p_f W - sum_f (g + b_f) . rho_f x_f W) / max(sum_f W, 0.8 (1/2 - sum_w W))`, sums in front of
//! the face, with x_f from the point and loads b_f on the fluid (Adami, Hu, Adams, J. Comput. Phys. 231
//! (2012) 7057-7075, eq. 27; W stands for the kernel times the volume). A fluid at rest fills the space that
//! walls leave in front of the point, `1/2 - sum_w W`. In a jet or a splash, where less than four fifths of
//! it is filled, the dry part of the face has no pressure.

use glam::DVec3;

use crate::formulations::fluid::{BoundarySurface, FlowCloud, FlowParticle, Role};
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::world::{Column, MissingColumn, Position, World};

/// Part of the place in front of a point that a fluid without gaps fills at least.
const FILLED: f64 = 0.8;
/// Minimum part of the place in front of a point for which there is a pressure.
const MIN_FILLING: f64 = 1e-6;

/// A face in a wall.
pub struct SensorGauge {
    /// Points of the face, each for an equal part of it.
    pub(super) points: Vec<DVec3>,
    /// Unit vector out of the face, into the fluid.
    pub(super) normal: DVec3,
    pub(super) gravity: DVec3,
}

impl SensorGauge {
    /// A face about `at`: points on a line in two dimensions, on rings of equal area in three.
    pub(super) fn new(at: DVec3, diameter: f64, normal: DVec3, gravity: DVec3, plane: bool) -> Self {
        let points = if diameter == 0.0 {
            vec![at]
        } else if plane {
            let along = DVec3::new(-normal.y, normal.x, 0.0) * diameter;
            (0..8).map(|k| at + along * ((f64::from(k) + 0.5) / 8.0 - 0.5)).collect()
        } else {
            let (a, b) = normal.any_orthonormal_pair();
            let ring = |k: i32| 0.5 * diameter * ((f64::from(k) + 0.5) / 3.0).sqrt();
            let on = |(k, m): (i32, i32)| {
                let angle = std::f64::consts::TAU * (f64::from(m) + 0.5 * f64::from(k)) / 8.0;
                at + ring(k) * (a * angle.cos() + b * angle.sin())
            };
            (0..3).flat_map(|k| (0..8).map(move |m| (k, m))).map(on).collect()
        };
        Self { points, normal, gravity }
    }

    /// Mean over the points of the face, Pa.
    fn pressure(&self, cloud: &FlowCloud) -> f64 {
        let reach = cloud.kernel.support;
        let near = |i: &usize| {
            let record = &cloud.records()[*i];
            let is_near =
                |point: &DVec3| cloud.offset(*point, record.position()).length_squared() < reach * reach;
            record.volume() > 0.0 && self.points.iter().any(is_near)
        };
        let fluid: Vec<usize> = (0..cloud.fluid).filter(near).collect();
        // A thin body is there twice.
        let once = cloud.groups.iter().enumerate().filter(|(k, group)| {
            group.fluid().is_none() && cloud.groups[..*k].last().is_none_or(|last| last.body != group.body)
        });
        let walls: Vec<usize> = once.flat_map(|(_, group)| group.cloud.clone()).filter(near).collect();
        let sum: f64 = self.points.iter().map(|&point| self.at(cloud, [&fluid, &walls], point)).sum();
        sum / self.points.len() as f64
    }

    fn at(&self, cloud: &FlowCloud, [fluid, walls]: [&[usize]; 2], point: DVec3) -> f64 {
        let share = |i: &usize| {
            let record = &cloud.records()[*i];
            let x = cloud.offset(point, record.position());
            let is_in_front = x.dot(self.normal) > 0.0;
            if is_in_front { record.volume() * cloud.kernel.value(x.length()) } else { 0.0 }
        };
        let left = 0.5 - walls.iter().map(share).sum::<f64>();
        let (mut total, mut sum) = (0.0, 0.0);
        for &i in fluid {
            let record = &cloud.records()[i];
            let x = cloud.offset(point, record.position());
            if x.dot(self.normal) > 0.0 {
                let weight = record.volume() * cloud.kernel.value(x.length());
                total += weight;
                sum += weight * record.pressure();
                sum -= weight * self.density(cloud, record) * (self.gravity + cloud.load(i)).dot(x);
            }
        }
        let place = total.max(FILLED * left);
        let pressure = if place > MIN_FILLING { sum / place } else { 0.0 };
        // What the wall around the point does: without suction its pressure is not below zero.
        let suction = nearest_surface(cloud, walls, point).is_none_or(|surface| surface.suction);
        if suction { pressure } else { pressure.max(0.0) }
    }

    fn density(&self, cloud: &FlowCloud, record: &FlowParticle) -> f64 {
        let state = cloud.groups.iter().find_map(|group| group.fluid());
        state.map_or(0.0, |state| state.density + record.pressure() / state.sound_speed.powi(2))
    }
}

/// The surface of the boundary particle that is nearest to a point.
fn nearest_surface(cloud: &FlowCloud, walls: &[usize], point: DVec3) -> Option<BoundarySurface> {
    let distance = |i: &usize| cloud.offset(point, cloud.records()[*i].position()).length_squared();
    let nearest = *walls.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let group = cloud.groups.iter().find(|group| group.cloud.contains(&nearest))?;
    if let Role::Boundary(surface) = group.role { Some(surface) } else { None }
}

/// The pressure that a small sensor at a point shows, Pa; `normal` is the unit vector out of its face.
pub fn pressure_on_face(cloud: &FlowCloud, at: DVec3, normal: DVec3, gravity: DVec3) -> f64 {
    SensorGauge::new(at, 0.0, normal, gravity, true).pressure(cloud)
}

impl Measure for SensorGauge {
    fn columns(&self) -> Vec<(String, &'static str)> {
        vec![("pressure".to_owned(), "Pa")]
    }

    fn of_nothing(&self) -> Option<f64> {
        Some(0.0)
    }

    fn needs(&self) -> Vec<&'static str> {
        vec![Position::NAME]
    }

    fn read(&self, _: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let Some(cloud) = FlowCloud::whole(resources) else { return Ok(vec![f64::NAN]) };
        Ok(vec![self.pressure(&cloud)])
    }
}
