//! The points with which a rigid body touches others.

use glam::DVec3;

use super::inertia::sphere_of;
use crate::scene::Dimension;
use crate::shapes::{Shape, Site, Surface};

/// The points with which a rigid body touches the surfaces of other rigid bodies.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// Their places in the reference configuration, m.
    pub points: Vec<DVec3>,
    /// Radius of the sphere about each, m: that of a body that is one sphere, else zero.
    pub radius: f64,
    /// Distance between them, m.
    pub spacing: f64,
}

impl Nodes {
    /// The centre of a sphere or disc. Of other shapes the corners, points on the edges of boxes, and the outermost
    /// particles, moved to the surface.
    pub(super) fn new(
        shape: &Shape,
        surface: &dyn Surface,
        sites: &[Site],
        spacing: f64,
        dimension: Dimension,
    ) -> Self {
        if let Some((center, radius)) = sphere_of(shape) {
            return Self { points: vec![center], radius, spacing: 2.0 * radius };
        }
        let mut points = edges(shape, spacing, dimension);
        for site in sites {
            let nearest = surface.closest(site.position);
            if nearest.signed_distance.abs() < 0.75 * spacing {
                points.push(nearest.point);
            }
        }
        Self { points, radius: 0.0, spacing }
    }

    /// Radius of the body if it is one sphere, m.
    pub fn sphere(&self) -> Option<f64> {
        (self.radius > 0.0).then_some(self.radius)
    }
}

/// Corners of a shape, and points on its straight edges.
fn edges(shape: &Shape, spacing: f64, dimension: Dimension) -> Vec<DVec3> {
    let moved = |shape: &Shape, to: &dyn Fn(DVec3) -> DVec3| {
        edges(shape, spacing, dimension).into_iter().map(to).collect()
    };
    match shape {
        Shape::Box { min, max } => edges_of_box(min.0, max.0, spacing, dimension),
        Shape::Polygon { points } => points.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect(),
        Shape::Extrusion { polygon, from, to } => {
            polygon.iter().flat_map(|&(x, y)| [DVec3::new(x, y, *from), DVec3::new(x, y, *to)]).collect()
        }
        Shape::Translate { shape, by } => moved(shape, &|x| x + by.0),
        Shape::Rotate { shape, axis, angle_degrees, about } => {
            let turn = glam::DQuat::from_axis_angle(axis.0.normalize(), angle_degrees.to_radians());
            moved(shape, &|x| about.0 + turn * (x - about.0))
        }
        Shape::Scale { shape, by, about } => moved(shape, &|x| about.0 + by.0 * (x - about.0)),
        Shape::Union(shapes) => shapes.iter().flat_map(|shape| edges(shape, spacing, dimension)).collect(),
        Shape::Difference(whole, _) => edges(whole, spacing, dimension),
        _ => Vec::new(),
    }
}

fn edges_of_box(min: DVec3, max: DVec3, spacing: f64, dimension: Dimension) -> Vec<DVec3> {
    let axes = dimension.count();
    let corner =
        |n: usize| DVec3::from_array(std::array::from_fn(|k| if n >> k & 1 == 0 { min[k] } else { max[k] }));
    let mut points: Vec<DVec3> = (0..1 << axes).map(corner).collect();
    for axis in (0..axes).filter(|_| dimension == Dimension::Three) {
        let parts = ((max[axis] - min[axis]) / spacing).round().max(1.0) as usize;
        for start in (0..8).filter(|n| n >> axis & 1 == 0) {
            points.extend((1..parts).map(|part| {
                let mut point = corner(start);
                point[axis] += (max[axis] - min[axis]) * part as f64 / parts as f64;
                point
            }));
        }
    }
    points
}
