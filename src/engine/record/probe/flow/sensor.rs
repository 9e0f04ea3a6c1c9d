//! The reading of a pressure sensor in a wall: the mean, over points of its face, of the pressure that a
//! particle of the wall would have there.
//!
//! `p = (sum_f p_f W - sum_f (g + b_f) . rho_f x_f W) / max(sum_f W, 0.8 (1/2 - sum_w W))`, sums in front of
//! the face, with x_f from the point and loads b_f on the fluid (Adami, Hu, Adams, J. Comput. Phys. 231
//! (2012) 7057-7075, eq. 27; W stands for the kernel times the volume). A fluid at rest fills the space that
//! walls leave in front of the point, `1/2 - sum_w W`. In a jet or a splash, where less than four fifths of
//! it is filled, the dry part of the face has no pressure.
//!
//! A sensor that moves along subtracts the acceleration a_w of its wall from g. The pressure of the nearest
//! particle of the wall contains it, `p_w = (sum_f p_f W - sum_f (g + b_f - a_w) . rho_f x_f W) / sum_f W`
//! with x_f from that particle, and gives its part along the normal.

use glam::DVec3;

use super::carrier::{GaugeCarrier, GaugeFrame};
use super::nearest::nearest;
use super::watch::WallWatch;
use crate::formulations::fluid::{BoundarySurface, FlowCloud, Role};
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::world::{BodyId, MissingColumn, World};

/// Part of the place in front of a point that a fluid without gaps fills at least.
const FILLED: f64 = 0.8;
/// Minimum part of the place in front of a point for which there is a pressure.
const MIN_FILLING: f64 = 1e-6;

/// The face of a sensor.
struct SensorFace {
    /// Its points, each for an equal part of it.
    points: Vec<DVec3>,
    /// Unit vector out of it, into the fluid.
    normal: DVec3,
}

impl SensorFace {
    /// A face about `at`: points on a line in two dimensions, on rings of equal area in three.
    fn new(at: DVec3, diameter: f64, normal: DVec3, plane: bool) -> Self {
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
        Self { points, normal }
    }

    /// The face about `at` as a body has carried it along.
    fn carried(&self, at: DVec3, by: &GaugeFrame) -> Self {
        let points = self.points.iter().map(|point| by.point(point - at)).collect();
        Self { points, normal: by.normal(self.normal) }
    }
}

/// A pressure sensor.
pub struct SensorGauge {
    at: DVec3,
    face: SensorFace,
    gravity: DVec3,
    /// What carries it along; without it the sensor stays where it is.
    carrier: Option<GaugeCarrier>,
    watch: WallWatch,
}

/// What a sensor is read with: the cloud, and its rows of fluids and of walls near the face.
struct NearFace<'a> {
    cloud: &'a FlowCloud,
    face: &'a SensorFace,
    fluid: Vec<usize>,
    walls: Vec<usize>,
    /// That of the wall, m/s2.
    acceleration: DVec3,
}

impl SensorGauge {
    /// A sensor that stays where it is.
    pub(super) fn new(at: DVec3, diameter: f64, normal: DVec3, gravity: DVec3, plane: bool) -> Self {
        let face = SensorFace::new(at, diameter, normal, plane);
        Self { at, face, gravity, carrier: None, watch: WallWatch::default() }
    }

    /// The same, carried along.
    pub(super) fn following(self, carrier: Option<GaugeCarrier>) -> Self {
        Self { carrier, ..self }
    }

    /// Mean over the points of the face, Pa.
    fn pressure(&self, near: &NearFace<'_>) -> f64 {
        let points = &near.face.points;
        points.iter().map(|&point| self.at(near, point)).sum::<f64>() / points.len() as f64
    }

    fn at(&self, near: &NearFace<'_>, point: DVec3) -> f64 {
        let NearFace { cloud, face, fluid, walls, acceleration } = near;
        let share = |i: &usize| {
            let record = &cloud.records()[*i];
            let x = cloud.offset(point, record.position());
            let is_in_front = x.dot(face.normal) > 0.0;
            if is_in_front { record.volume() * cloud.kernel.value(x.length()) } else { 0.0 }
        };
        let left = 0.5 - walls.iter().map(share).sum::<f64>();
        let (mut total, mut sum) = (0.0, 0.0);
        for &i in fluid {
            let record = &cloud.records()[i];
            let x = cloud.offset(point, record.position());
            if x.dot(face.normal) > 0.0 {
                let weight = record.volume() * cloud.kernel.value(x.length());
                total += weight;
                sum += weight * cloud.pressure(i);
                let field = self.gravity + cloud.load(i) - acceleration;
                sum -= weight * density(cloud, i) * field.dot(x);
            }
        }
        let place = total.max(FILLED * left);
        let pressure = if place > MIN_FILLING { sum / place } else { 0.0 };
        // What the wall around the point does: without suction its pressure is not below zero.
        let suction = nearest_surface(cloud, walls, point).is_none_or(|surface| surface.suction);
        if suction { pressure } else { pressure.max(0.0) }
    }

    /// Acceleration of the wall around the face along its normal; zero where the wall has no pressure.
    fn acceleration(&self, near: &NearFace<'_>) -> DVec3 {
        let NearFace { cloud, face, walls, .. } = near;
        let middle = face.points.iter().sum::<DVec3>() / face.points.len() as f64;
        let Some(nearest) = nearest(cloud, walls, middle) else { return DVec3::ZERO };
        let row = cloud.row_facing(nearest, face.normal);
        let wall = &cloud.records()[row];
        let (mut total, mut pressure, mut moment) = (0.0, 0.0, 0.0);
        for i in 0..cloud.fluid {
            let record = &cloud.records()[i];
            let x = cloud.offset(wall.position(), record.position());
            let weight = record.volume() * cloud.kernel.value(x.length());
            if weight > 0.0 && cloud.row_facing(row, x) == row {
                let mass = density(cloud, i) * x;
                total += weight;
                pressure += weight * (cloud.pressure(i) - (self.gravity + cloud.load(i)).dot(mass));
                moment += weight * mass.dot(face.normal);
            }
        }
        if cloud.pressure(row) == 0.0 || total < MIN_FILLING || moment <= 0.0 {
            return DVec3::ZERO;
        }
        face.normal * ((cloud.pressure(row) * total - pressure) / moment)
    }
}

/// Density of a particle of a fluid, kg/m3.
fn density(cloud: &FlowCloud, i: usize) -> f64 {
    let group = cloud.groups.iter().find(|group| group.cloud.contains(&i));
    let state = group.and_then(|group| group.fluid());
    state.map_or(0.0, |state| state.density + cloud.pressure(i) / state.sound_speed.powi(2))
}

impl<'a> NearFace<'a> {
    fn new(cloud: &'a FlowCloud, face: &'a SensorFace) -> Self {
        let reach = cloud.kernel.support;
        let near = |i: &usize| {
            let record = &cloud.records()[*i];
            let is_near =
                |point: &DVec3| cloud.offset(*point, record.position()).length_squared() < reach * reach;
            record.volume() > 0.0 && face.points.iter().any(is_near)
        };
        let fluid = (0..cloud.fluid).filter(near).collect();
        let walls = cloud.boundaries_once().filter(near).collect();
        Self { cloud, face, fluid, walls, acceleration: DVec3::ZERO }
    }
}

/// The surface of the boundary particle that is nearest to a point.
fn nearest_surface(cloud: &FlowCloud, walls: &[usize], point: DVec3) -> Option<BoundarySurface> {
    let nearest = nearest(cloud, walls, point)?;
    let group = cloud.groups.iter().find(|group| group.cloud.contains(&nearest))?;
    if let Role::Boundary(surface) = group.role { Some(surface) } else { None }
}

/// The pressure that a small sensor at a point shows, Pa; `normal` is the unit vector out of its face.
pub fn pressure_on_face(cloud: &FlowCloud, at: DVec3, normal: DVec3, gravity: DVec3) -> f64 {
    let sensor = SensorGauge::new(at, 0.0, normal, gravity, true);
    sensor.pressure(&NearFace::new(cloud, &sensor.face))
}

impl Measure for SensorGauge {
    fn columns(&self) -> Vec<(String, &'static str)> {
        vec![("pressure".to_owned(), "Pa")]
    }

    fn of_nothing(&self) -> Option<f64> {
        Some(0.0)
    }

    fn needs(&self) -> Vec<&'static str> {
        GaugeCarrier::NEEDS.to_vec()
    }

    fn left_by(&self) -> Option<BodyId> {
        self.watch.left()
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let Some(cloud) = FlowCloud::whole(resources) else { return Ok(vec![f64::NAN]) };
        let Some(carrier) = &self.carrier else {
            let near = NearFace::new(&cloud, &self.face);
            self.watch.look(&cloud, &near.walls, self.at, self.face.normal);
            return Ok(vec![self.pressure(&near)]);
        };
        let Some(carried) = carrier.carried(world)? else { return Ok(vec![f64::NAN]) };
        let face = self.face.carried(self.at, &carried);
        let mut near = NearFace::new(&cloud, &face);
        near.acceleration = self.acceleration(&near);
        Ok(vec![self.pressure(&near)])
    }
}
