//! The outline of a combination of shapes: the pieces of the outlines of its parts that separate the inside
//! of the combination from the outside.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{Facets, directed_area};
use crate::shapes::region::Region;

/// Offset of the inside test from a segment, over the length of the segments; it exceeds the distance of a
/// segment from its curve.
const BESIDE: f64 = 0.1;
/// Fraction of the usual length below which segments are discarded and end points are merged.
const SHORTEST: f64 = 0.2;
/// Bisections that locate the intersection with a segment.
const HALVINGS: usize = 40;

/// The inner side of a line.
#[derive(Clone, Copy, PartialEq, Eq)]
enum InnerSide {
    Left,
    Right,
    No,
}

/// The outline of `region` from those of its parts; `None` if it is not closed.
pub(super) fn boundary(parts: &Facets, region: &dyn Region, length: f64) -> Option<Facets> {
    let mut lines: Vec<[DVec3; 2]> = Vec::new();
    for facet in 0..parts.corners.len() {
        let [a, b, _] = parts.ends(facet);
        for (line, kept) in pieces([a, b], region, length) {
            let line = if kept == InnerSide::Left { line } else { [line[1], line[0]] };
            let middle = |line: &[DVec3; 2]| 0.5 * (line[0] + line[1]);
            let is_double =
                |other: &[DVec3; 2]| middle(other).distance(middle(&line)) < 0.5 * SHORTEST * length;
            if kept != InnerSide::No
                && line[0].distance(line[1]) > SHORTEST * length
                && !lines.iter().any(is_double)
            {
                lines.push(line);
            }
        }
    }
    welded(&lines, SHORTEST * length)
}

/// The pieces of a segment, which has one intersection at most.
fn pieces([a, b]: [DVec3; 2], region: &dyn Region, length: f64) -> Vec<([DVec3; 2], InnerSide)> {
    let normal = directed_area(2, &[a, b, b]).normalize_or_zero() * (BESIDE * length);
    let kept = |s: f64| {
        let x = a.lerp(b, s);
        match (region.distance(x - normal) < 0.0, region.distance(x + normal) < 0.0) {
            (true, false) => InnerSide::Left,
            (false, true) => InnerSide::Right,
            _ => InnerSide::No,
        }
    };
    let (mut low, mut high) = (1e-6, 1.0 - 1e-6);
    let (first, last) = (kept(low), kept(high));
    if first == last {
        return vec![([a, b], kept(0.5))];
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if kept(middle) == first {
            low = middle;
        } else {
            high = middle;
        }
    }
    let cut = a.lerp(b, 0.5 * (low + high));
    vec![([a, cut], first), ([cut, b], last)]
}

/// Joins lines at common end points to closed outlines.
fn welded(lines: &[[DVec3; 2]], tolerance: f64) -> Option<Facets> {
    let mut points: Vec<DVec3> = Vec::new();
    let mut cells: BTreeMap<(i64, i64), Vec<u32>> = BTreeMap::new();
    let mut number = |x: DVec3| {
        let cell = (x / (2.0 * tolerance)).floor();
        let cell = (cell.x as i64, cell.y as i64);
        let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (cell.0 + i, cell.1 + j)));
        let known = near.filter_map(|cell| cells.get(&cell)).flatten().copied();
        let nearest =
            known.min_by(|&p, &q| points[p as usize].distance(x).total_cmp(&points[q as usize].distance(x)));
        if let Some(found) = nearest.filter(|&found| points[found as usize].distance(x) < tolerance) {
            return found;
        }
        points.push(x);
        cells.entry(cell).or_default().push(points.len() as u32 - 1);
        points.len() as u32 - 1
    };
    let corners: Vec<[u32; 3]> = lines
        .iter()
        .map(|line| line.map(&mut number))
        .filter(|[a, b]| a != b)
        .map(|[a, b]| [a, b, b])
        .collect();
    let facets = Facets { axes: 2, points, corners };
    (!facets.corners.is_empty() && facets.is_closed_line()).then_some(facets)
}
