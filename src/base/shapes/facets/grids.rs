//! Triangles on the surfaces of three-dimensional shapes.

use std::path::Path;

use glam::DVec3;

use super::{Facets, coarse, contour, refine, round};
use crate::shapes::check::ShapeCheck;
use crate::shapes::mesh;
use crate::shapes::rings::Rings;
use crate::shapes::shape::Shape;
use crate::shapes::transform::turned;
use crate::space::Dimension;

/// Ratio of the number of triangles of a mesh to that of its remeshed surface, above which it is too fine to
/// be carried by particles.
const FINEST: f64 = 16.0;

/// The surface of a shape: exact where its parts are disjoint or nested, else by dual contouring.
pub(super) fn of_shape(shape: &Shape, folder: &Path, length: f64) -> Option<Facets> {
    if let Some(facets) = exact(shape, folder, length) {
        return Some(facets);
    }
    let is_combination = matches!(shape, Shape::Union(_) | Shape::Difference(..) | Shape::Intersection(_));
    let region = is_combination.then(|| shape.region(Dimension::Three, folder, "shape"))?.ok()?;
    contour::of_region(&*region, 3, length)
}

/// The surface of a primitive shape, and of combinations whose parts are disjoint or nested.
fn exact(shape: &Shape, folder: &Path, length: f64) -> Option<Facets> {
    let check = ShapeCheck { dimension: Dimension::Three, folder, path: "shape" };
    Some(match shape {
        Shape::Box { min, max } => block(min.0, max.0, length),
        Shape::Sphere { center, radius } => round::sphere(center.0, *radius, length),
        Shape::Shell { center, inner, outer } => shell(center.0, *inner, *outer, length),
        Shape::Cylinder { from, to, radius } => round::cylinder(from.0, to.0, 0.0, *radius, length),
        Shape::Tube { from, to, inner, outer } => round::cylinder(from.0, to.0, *inner, *outer, length),
        Shape::Extrusion { polygon, from, to } => {
            triangles(refine::prism(polygon, *from, *to)?, 1.2 * length)
        }
        Shape::Mesh { file, scale } => {
            let (points, corners) = mesh::load(folder, file, *scale).ok()?.into_triangles();
            let mesh = Facets { axes: 3, points, corners };
            let area: f64 = (0..mesh.corners.len()).map(|facet| mesh.normal_and_measure(facet).1).sum();
            if mesh.corners.len() as f64 > FINEST * area / (length * length) {
                return None;
            }
            triangles(mesh, 1.2 * length)
        }
        Shape::Union(shapes) => {
            shape.surface(Dimension::Three, folder, "shape").ok()?;
            let mut all = Facets { axes: 3, ..Facets::default() };
            for part in shapes {
                all.join(&of_shape(part, folder, length)?, false);
            }
            all
        }
        Shape::Difference(whole, hole) => {
            let region = shape.region(Dimension::Three, folder, "shape").ok()?;
            match region.rings() {
                Some(Rings::Shells { center, inner, outer }) => {
                    return Some(shell(center, inner, outer, length));
                }
                Some(Rings::Axial { from, to, inner, outer }) => {
                    return Some(round::cylinder(from, to, inner, outer, length));
                }
                _ => {}
            }
            shape.surface(Dimension::Three, folder, "shape").ok()?;
            let mut outer = of_shape(whole, folder, length)?;
            outer.join(&of_shape(hole, folder, length)?, true);
            outer
        }
        Shape::Translate { shape, by } => of_shape(shape, folder, length)?.moved(|x| x + by.0),
        Shape::Rotate { shape, axis, angle_degrees, about } => {
            let (turn, about) = check.turn(*axis, *angle_degrees, *about).ok()?;
            of_shape(shape, folder, length)?.moved(|x| turned(turn, about, x))
        }
        Shape::Scale { shape, by, about } => {
            let (by, about) = check.scale(*by, *about).ok()?;
            of_shape(shape, folder, length / by.max_element())?.moved(|x| about + by * (x - about))
        }
        _ => return None,
    })
}

/// The triangles of a mesh, refined to edges no longer than the given length, m, and coarsened where it is
/// flat.
fn triangles(mesh: Facets, longest: f64) -> Facets {
    coarse::coarsened(refine::refined(mesh, longest), longest)
}

fn shell(center: DVec3, inner: f64, outer: f64, length: f64) -> Facets {
    let mut shell = round::sphere(center, outer, length);
    shell.join(&round::sphere(center, inner, length), true);
    shell
}

/// The six faces of a box, each a grid, with shared vertices along common edges.
fn block(min: DVec3, max: DVec3, length: f64) -> Facets {
    let counts = ((max - min) / length).round().max(DVec3::ONE).to_array().map(|count| count as usize);
    let mut points = Vec::new();
    let mut corners = Vec::new();
    let mut numbers = std::collections::BTreeMap::new();
    let mut number = |node: [usize; 3]| {
        *numbers.entry(node).or_insert_with(|| {
            let part = [0, 1, 2].map(|axis| node[axis] as f64 / counts[axis] as f64);
            points.push(min + (max - min) * DVec3::from_array(part));
            points.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [0, counts[axis]] {
            for (i, j) in (0..counts[u]).flat_map(|i| (0..counts[v]).map(move |j| (i, j))) {
                let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                    let mut node = [0; 3];
                    (node[axis], node[u], node[v]) = (side, i, j);
                    number(node)
                });
                // Alternating diagonals prefer no direction.
                let halves = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                corners.extend(halves.map(|[p, q, r]| if side == 0 { [p, r, q] } else { [p, q, r] }));
            }
        }
    }
    Facets { axes: 3, points, corners }
}
