//! Facets on the surface of any region, including combinations whose parts intersect or join smoothly, by
//! dual contouring (Ju, Losasso, Schaefer and Warren, ACM Trans. Graph. 21, 2002).
//!
//! Every grid cell that the surface crosses contains a vertex, at the least-squares point of the tangent
//! planes at the intersections of the surface with the edges of the cell. This is accurate on smooth
//! surfaces, on sharp edges and in corners. Every grid edge that the surface cuts joins the vertices of the
//! four cells around it, in two dimensions those of the two cells beside it.

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use super::Facets;
use crate::linalg::{Eigen, Sym3};
use crate::shapes::region::{Aabb, Region};
use crate::shapes::tiling::Tiling;

/// Bisections that locate the intersection of the surface with a grid edge.
const HALVINGS: usize = 34;
/// Step of the finite differences of the normal, over the length of a cell.
const STEP: f64 = 1e-5;
/// Distance below which a point is on the surface of a part, over the length of a cell.
const ON: f64 = 1e-9;
/// Ratio of an eigenvalue to the largest one, below which the tangent planes do not determine the vertex
/// along its eigenvector.
const FLAT: f64 = 0.05;

/// The surface of `region` in facets of about `length`; `None` if it is unbounded, or if two pieces of an
/// outline cross one cell.
pub(super) fn of_region(region: &dyn Region, axes: usize, length: f64) -> Option<Facets> {
    let bounds = region.bounds();
    if !bounds.is_bounded() {
        return None;
    }
    // Grid planes are half a cell away from the sides of the bounding box, because these are often faces of
    // the shape.
    let cell = bounds.extent() / (bounds.extent() / length).round().max(DVec3::ONE);
    let frame = Aabb { min: bounds.min - 0.5 * cell, max: bounds.max + 0.5 * cell };
    let grid = Tiling::new(&frame, &frame, cell, axes);
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
    let net = Net { region, grid: &grid, numbers: &numbers };
    let cells = cells.iter().filter(|cell| numbers.contains_key(*cell));
    let corners: Vec<[u32; 3]> = if axes == 2 {
        cells.flat_map(|cell| net.lines(*cell)).collect()
    } else {
        cells.flat_map(|cell| net.quads(*cell)).flat_map(|quad| halves(region, &points, quad)).collect()
    };
    let facets = Facets { axes, points, corners };
    (!facets.corners.is_empty() && (axes == 3 || facets.is_closed_line())).then_some(facets)
}

/// The vertices of the cells that the surface crosses.
struct Net<'a> {
    region: &'a dyn Region,
    grid: &'a Tiling,
    numbers: &'a BTreeMap<[usize; 3], u32>,
}

impl Net<'_> {
    /// Orientation of the surface on the cell edge along `axis` from the corner with the largest `across`
    /// coordinates: whether the edge leaves the region or enters it.
    fn leaves(&self, cell: [usize; 3], across: &[usize], axis: usize) -> Option<bool> {
        let corner = beyond(cell, across);
        let ends = [corner, beyond(corner, &[axis])].map(|node| is_inside(self.region, self.grid, node));
        (ends[0] != ends[1]).then_some(ends[0])
    }

    /// The vertices around the edges at the upper corner of a cell, counter-clockwise seen from outside.
    fn quads(&self, cell: [usize; 3]) -> impl Iterator<Item = [u32; 4]> {
        (0..3).filter_map(move |axis| {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let leaves = self.leaves(cell, &[u, v], axis)?;
            let number = |by: &[usize]| self.numbers.get(&beyond(cell, by)).copied();
            let (a, b, c, d) = (number(&[])?, number(&[u])?, number(&[u, v])?, number(&[v])?);
            Some(if leaves { [a, b, c, d] } else { [a, d, c, b] })
        })
    }

    /// The segments through the edges at the upper corner of a cell, with the outside to their right.
    fn lines(&self, cell: [usize; 3]) -> impl Iterator<Item = [u32; 3]> {
        (0..2).filter_map(move |axis| {
            let across = 1 - axis;
            let leaves = self.leaves(cell, &[across], axis)?;
            let (a, b) = (*self.numbers.get(&cell)?, *self.numbers.get(&beyond(cell, &[across]))?);
            Some(if leaves == (axis == 0) { [a, b, b] } else { [b, a, a] })
        })
    }
}

/// The next cell or node along the given axes.
fn beyond(mut index: [usize; 3], axes: &[usize]) -> [usize; 3] {
    axes.iter().for_each(|&axis| index[axis] += 1);
    index
}

fn is_inside(region: &dyn Region, grid: &Tiling, node: [usize; 3]) -> bool {
    holds(region, grid.point(node, DVec3::ZERO), smallest(grid))
}

/// Whether a point is inside. Points on a common face of two parts are strictly inside neither, so
/// surrounding points decide.
fn holds(region: &dyn Region, x: DVec3, cell: f64) -> bool {
    let distance = region.distance(x);
    if distance.abs() > ON * cell {
        return distance < 0.0;
    }
    let around = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    around.into_iter().all(|axis| region.distance(x + STEP * cell * axis) <= ON * cell)
}

/// The shortest side of a cell \[m\].
fn smallest(grid: &Tiling) -> f64 {
    (0..grid.axes).map(|axis| grid.cell[axis]).fold(f64::INFINITY, f64::min)
}

/// The vertex of a cell whose edges the surface intersects.
fn vertex(region: &dyn Region, grid: &Tiling, cell: [usize; 3]) -> Option<DVec3> {
    let node = |k: usize| [0, 1, 2].map(|axis| cell[axis] + (k >> axis & 1));
    let inside: [bool; 8] = std::array::from_fn(|k| k < 1 << grid.axes && is_inside(region, grid, node(k)));
    let mut cuts: Vec<(DVec3, DVec3)> = Vec::new();
    for k in 0..1 << grid.axes {
        for axis in (0..grid.axes).filter(|axis| k >> axis & 1 == 0) {
            let other = k | 1 << axis;
            if inside[k] != inside[other] {
                let (within, without) = if inside[k] { (k, other) } else { (other, k) };
                let ends = [within, without].map(|k| grid.point(node(k), DVec3::ZERO));
                cuts.push(cut(region, ends, smallest(grid)));
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

/// Intersection of the surface with an edge from an inner to an outer node, and the normal there.
fn cut(region: &dyn Region, [mut inside, mut outside]: [DVec3; 2], cell: f64) -> (DVec3, DVec3) {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if holds(region, middle, cell) {
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

/// Two triangles of four vertices, divided along the diagonal that is nearer to the surface.
fn halves(region: &dyn Region, points: &[DVec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let away = |p: u32, q: u32| region.distance(0.5 * (points[p as usize] + points[q as usize])).abs();
    let (first, second) = (away(a, c), away(b, d));
    if first <= second + 1e-12 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}
