//! Triangles on the surface of any region of space, including combinations whose parts intersect: dual contouring (Ju, Losasso, Schaefer and
//! Warren, ACM Trans. Graph. 21, 2002).
//!
//! Every grid cell that the surface crosses contains a vertex, at the point nearest to the tangent planes at the intersections of the surface with the edges of the
//! cell. This holds on smooth surfaces, on sharp edges and in corners. Every grid edge that the surface cuts joins the vertices of the four cells
//! around it.

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use super::Facets;
use crate::linalg::{Eigen, Sym3};
use crate::shapes::region::{Aabb, Region};
use crate::shapes::tiling::Tiling;

/// Halvings that find where an edge of the grid is cut.
const HALVINGS: usize = 34;
/// Step of the differences that give the normal, over the length of a cell.
const STEP: f64 = 1e-5;
/// Eigenvalue over the largest one, below which tangent planes do not say where the vertex is in that direction.
const FLAT: f64 = 0.05;

/// The surface of `region` in triangles of about `length`; none if it has no end.
pub(super) fn of_region(region: &dyn Region, length: f64) -> Option<Facets> {
    let bounds = region.bounds();
    if !bounds.is_bounded() {
        return None;
    }
    // Planes of the grid stand half a cell away from the sides of the box, which are often faces of the shape.
    let cell = bounds.extent() / (bounds.extent() / length).round().max(DVec3::ONE);
    let frame = Aabb { min: bounds.min - 0.5 * cell, max: bounds.max + 0.5 * cell };
    let grid = Tiling::new(&frame, &frame, cell, 3);
    let blocks = grid.blocks(region, 4, 4);
    let cells: Vec<[usize; 3]> =
        blocks.iter().filter(|block| !block.inside).flat_map(|block| block.cells()).collect();
    let vertices: Vec<Option<DVec3>> = cells.par_iter().map(|&cell| vertex(region, &grid, cell)).collect();
    let mut points = Vec::new();
    let mut numbers = BTreeMap::new();
    for (cell, place) in cells.iter().zip(vertices) {
        if let Some(place) = place {
            numbers.insert(*cell, points.len() as u32);
            points.push(place);
        }
    }
    let mut corners = Vec::new();
    for cell in cells.iter().filter(|cell| numbers.contains_key(*cell)) {
        for axis in 0..3 {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let step = |by: &[usize]| {
                let mut other = *cell;
                by.iter().for_each(|&k| other[k] += 1);
                other
            };
            let around =
                [*cell, step(&[u]), step(&[u, v]), step(&[v])].map(|cell| numbers.get(&cell).copied());
            let [Some(a), Some(b), Some(c), Some(d)] = around else { continue };
            let ends = [step(&[u, v]), step(&[u, v, axis])].map(|node| is_inside(region, &grid, node));
            let quad = match ends {
                [true, false] => [a, b, c, d],
                [false, true] => [a, d, c, b],
                _ => continue,
            };
            corners.extend(halves(region, &points, quad));
        }
    }
    (!corners.is_empty()).then_some(Facets { axes: 3, points, corners })
}

fn is_inside(region: &dyn Region, grid: &Tiling, node: [usize; 3]) -> bool {
    region.distance(grid.point(node, DVec3::ZERO)) < 0.0
}

/// The vertex of a cell, if the surface cuts its edges.
fn vertex(region: &dyn Region, grid: &Tiling, cell: [usize; 3]) -> Option<DVec3> {
    let node = |k: usize| [0, 1, 2].map(|axis| cell[axis] + (k >> axis & 1));
    let inside: [bool; 8] = std::array::from_fn(|k| is_inside(region, grid, node(k)));
    let mut cuts: Vec<(DVec3, DVec3)> = Vec::new();
    for k in 0..8 {
        for axis in (0..3).filter(|axis| k >> axis & 1 == 0) {
            let other = k | 1 << axis;
            if inside[k] != inside[other] {
                let (within, without) = if inside[k] { (k, other) } else { (other, k) };
                let ends = [within, without].map(|k| grid.point(node(k), DVec3::ZERO));
                cuts.push(cut(region, ends, grid.cell.min_element()));
            }
        }
    }
    if cuts.is_empty() {
        return None;
    }
    let middle = cuts.iter().map(|cut| cut.0).sum::<DVec3>() / cuts.len() as f64;
    let (mut squares, mut right) = (Sym3::ZERO, DVec3::ZERO);
    for (at, normal) in &cuts {
        squares += Sym3::dyad(*normal);
        right += normal.dot(at - middle) * *normal;
    }
    let Eigen { values, vectors } = Eigen::new(&squares);
    let known = (0..3).filter(|&k| values[k] > FLAT * values.z);
    let shift: DVec3 = known.map(|k| vectors.col(k).dot(right) / values[k] * vectors.col(k)).sum();
    let (low, high) = (grid.point(cell, DVec3::ZERO), grid.point(cell, DVec3::ONE));
    Some((middle + shift).clamp(low, high))
}

/// Where the surface cuts an edge, from its end inside to that outside, and the normal there.
fn cut(region: &dyn Region, [mut inside, mut outside]: [DVec3; 2], cell: f64) -> (DVec3, DVec3) {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if region.distance(middle) < 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    let at = 0.5 * (inside + outside);
    let slope =
        |axis: DVec3| region.distance(at + STEP * cell * axis) - region.distance(at - STEP * cell * axis);
    let normal = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
    (at, normal.normalize_or_zero())
}

/// Two triangles of four vertices, parted along the diagonal that is nearer to the surface.
fn halves(region: &dyn Region, points: &[DVec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let away = |p: u32, q: u32| region.distance(0.5 * (points[p as usize] + points[q as usize])).abs();
    let (first, second) = (away(a, c), away(b, d));
    if first <= second + 1e-12 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}
