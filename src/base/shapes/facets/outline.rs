//! Outlines of two-dimensional shapes.

use std::f64::consts::TAU;
use std::path::Path;

use glam::DVec3;

use super::{Facets, contour, cut};
use crate::shapes::check::ShapeCheck;
use crate::shapes::region::Aabb;
use crate::shapes::shape::Shape;
use crate::shapes::transform::turned;
use crate::space::Dimension;

/// Minimum number of segments of a circle.
const FEWEST: usize = 12;

/// The outline of a shape.
pub(super) fn of_shape(shape: &Shape, folder: &Path, length: f64) -> Option<Facets> {
    let region = shape.region(Dimension::Two, folder, "shape").ok()?;
    let bounds = region.bounds();
    if !bounds.is_bounded() {
        return None;
    }
    if shape.surface(Dimension::Two, folder, "shape").is_ok() {
        match shape {
            Shape::Union(parts) => {
                let mut all = Facets { axes: 2, ..Facets::default() };
                for part in parts {
                    all.join(&of_shape(part, folder, length)?, false);
                }
                return Some(all);
            }
            Shape::Difference(whole, hole) => {
                let mut outer = of_shape(whole, folder, length)?;
                outer.join(&of_shape(hole, folder, length)?, true);
                return Some(outer);
            }
            _ => {}
        }
    }
    let leaves = leaves(shape, &bounds, length)?;
    if is_single(shape) {
        return Some(leaves);
    }
    // Where curves join smoothly, as at rounded corners, points beside them do not determine the outline.
    cut::boundary(&leaves, &*region, length).or_else(|| contour::of_region(&*region, 2, length))
}

/// Whether a shape is not a combination.
fn is_single(shape: &Shape) -> bool {
    match shape {
        Shape::Union(_) | Shape::Difference(..) | Shape::Intersection(_) => false,
        Shape::Translate { shape, .. } | Shape::Rotate { shape, .. } | Shape::Scale { shape, .. } => {
            is_single(shape)
        }
        _ => true,
    }
}

/// The complete outlines of all parts of a shape.
fn leaves(shape: &Shape, within: &Aabb, length: f64) -> Option<Facets> {
    let check = ShapeCheck { dimension: Dimension::Two, folder: Path::new(""), path: "shape" };
    let all = |shapes: &mut dyn Iterator<Item = &Shape>| {
        let mut sum = Facets { axes: 2, ..Facets::default() };
        for shape in shapes {
            sum.join(&leaves(shape, within, length)?, false);
        }
        Some(sum)
    };
    Some(match shape {
        Shape::Box { min, max } => {
            let (a, b) = (min.0, max.0);
            polygon(&[a, DVec3::new(b.x, a.y, 0.0), b, DVec3::new(a.x, b.y, 0.0)], length)
        }
        Shape::Polygon { points } => {
            let mut corners: Vec<DVec3> = points.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
            if twice_area(&corners) < 0.0 {
                corners.reverse();
            }
            polygon(&corners, length)
        }
        Shape::Sphere { center, radius } => circle(center.0, *radius, length),
        Shape::Ring { center, inner, outer } => {
            let mut ring = circle(center.0, *outer, length);
            ring.join(&circle(center.0, *inner, length), true);
            ring
        }
        Shape::HalfSpace { point, normal } => {
            let normal = normal.0.normalize();
            let along = DVec3::new(-normal.y, normal.x, 0.0);
            let half = within.extent().length();
            let middle = within.center() - (within.center() - point.0).dot(normal) * normal;
            segments(&[middle - half * along, middle + half * along], length)
        }
        Shape::Union(shapes) | Shape::Intersection(shapes) => all(&mut shapes.iter())?,
        Shape::Difference(whole, hole) => all(&mut [&**whole, &**hole].into_iter())?,
        Shape::Translate { shape, by } => {
            leaves(shape, &moved_back(within, |x| x - by.0), length)?.moved(|x| x + by.0)
        }
        Shape::Rotate { shape, axis, angle_degrees, about } => {
            let (turn, about) = check.turn(*axis, *angle_degrees, *about).ok()?;
            let within = moved_back(within, |x| turned(turn.inverse(), about, x));
            leaves(shape, &within, length)?.moved(|x| turned(turn, about, x))
        }
        Shape::Scale { shape, by, about } => {
            let (by, about) = check.scale(*by, *about).ok()?;
            let within = moved_back(within, |x| about + (x - about) / by);
            let length = length / by.truncate().max_element();
            leaves(shape, &within, length)?.moved(|x| about + by * (x - about))
        }
        _ => return None,
    })
}

fn moved_back(bounds: &Aabb, to: impl Fn(DVec3) -> DVec3) -> Aabb {
    Aabb::around(bounds.corners().map(to))
}

fn twice_area(corners: &[DVec3]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| (*a - corners[0]).cross(*b - corners[0]).z).sum()
}

/// A closed counter-clockwise polygon.
fn polygon(corners: &[DVec3], length: f64) -> Facets {
    let mut closed = corners.to_vec();
    closed.push(corners[0]);
    let mut facets = segments(&closed, length);
    let last = facets.points.len() as u32 - 1;
    facets.points.pop();
    for end in facets.corners.iter_mut().flatten().filter(|end| **end == last) {
        *end = 0;
    }
    facets
}

/// An open line through these points.
fn segments(points: &[DVec3], length: f64) -> Facets {
    let mut fine = vec![points[0]];
    for ends in points.windows(2) {
        let parts = ((ends[1] - ends[0]).length() / length).round().max(1.0) as usize;
        fine.extend((1..=parts).map(|part| ends[0].lerp(ends[1], part as f64 / parts as f64)));
    }
    let corners = (1..fine.len() as u32).map(|k| [k - 1, k, k]).collect();
    Facets { axes: 2, points: fine, corners }
}

/// A circle, as a polygon of equal area with corners slightly outside.
fn circle(center: DVec3, radius: f64, length: f64) -> Facets {
    let count = ((TAU * radius / length).round() as usize).max(FEWEST);
    let angle = TAU / count as f64;
    let radius = radius * (angle / angle.sin()).sqrt();
    let point = |k: usize| {
        let (sin, cos) = (angle * k as f64).sin_cos();
        center + radius * DVec3::new(cos, sin, 0.0)
    };
    let next = |k: usize| ((k + 1) % count) as u32;
    Facets {
        axes: 2,
        points: (0..count).map(point).collect(),
        corners: (0..count).map(|k| [k as u32, next(k), next(k)]).collect(),
    }
}
