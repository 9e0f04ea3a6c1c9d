//! Triangles on balls, cylinders and tubes.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use glam::DVec3;

use super::Facets;

/// Minimum number of vertices around a circle.
const FEWEST: usize = 12;

/// A cube with faces of n x n cells at equal angles, projected onto a sphere whose triangles enclose the
/// volume of the ball.
pub(super) fn sphere(center: DVec3, radius: f64, length: f64) -> Facets {
    let n = ((FRAC_PI_2 * radius / length).round() as usize).max(3);
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    let mut numbers = BTreeMap::new();
    let mut number = |node: [usize; 3]| {
        *numbers.entry(node).or_insert_with(|| {
            let tangent = node.map(|k| (FRAC_PI_2 * k as f64 / n as f64 - FRAC_PI_4).tan());
            points.push(DVec3::from_array(tangent).normalize());
            points.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [0, n] {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                    let mut node = [0; 3];
                    (node[axis], node[u], node[v]) = (side, i, j);
                    number(node)
                });
                let halves = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                corners.extend(halves.map(|[p, q, r]| if side == 0 { [p, r, q] } else { [p, q, r] }));
            }
        }
    }
    let unit = Facets { axes: 3, points, corners };
    let six_volumes = |facet: &[u32; 3]| {
        let [a, b, c] = facet.map(|k| unit.points[k as usize]);
        a.cross(b).dot(c)
    };
    let volume = unit.corners.iter().map(six_volumes).sum::<f64>() / 6.0;
    let radius = radius * (2.0 / 3.0 * TAU / volume).cbrt();
    unit.moved(|x| center + radius * x)
}

/// A cylinder, or a tube with a bore; its circles are polygons of equal area, with corners slightly outside.
pub(super) fn cylinder(from: DVec3, to: DVec3, inner: f64, outer: f64, length: f64) -> Facets {
    let axis = to - from;
    let (u, v) = axis.normalize().any_orthonormal_pair();
    let layers = (axis.length() / length).round().max(1.0) as usize;
    let count = |radius: f64| ((TAU * radius / length).round() as usize).max(FEWEST);
    let mut mesh = Facets { axes: 3, ..Facets::default() };
    let ring = |mesh: &mut Facets, along: f64, radius: f64| -> Vec<u32> {
        let count = count(radius);
        let angle = TAU / count as f64;
        let radius = radius * (angle / angle.sin()).sqrt();
        let first = mesh.points.len() as u32;
        mesh.points.extend((0..count).map(|k| {
            let (sin, cos) = (angle * k as f64).sin_cos();
            from + along * axis + radius * (cos * u + sin * v)
        }));
        (first..first + count as u32).collect()
    };
    let mut wall = |radius: f64, is_bore: bool| -> [Vec<u32>; 2] {
        let rings: Vec<Vec<u32>> =
            (0..=layers).map(|layer| ring(&mut mesh, layer as f64 / layers as f64, radius)).collect();
        for pair in rings.windows(2) {
            stitch(&mut mesh.corners, &pair[0], &pair[1], is_bore);
        }
        [rings[0].clone(), rings[layers].clone()]
    };
    let outside = wall(outer, false);
    let inside = if inner > 0.0 { Some(wall(inner, true)) } else { None };
    for (end, along) in [0.0, 1.0].into_iter().enumerate() {
        let parts = ((outer - inner) / length).round().max(1.0) as usize;
        let mut last = outside[end].clone();
        for part in 1..parts {
            let radius = outer - (outer - inner) * part as f64 / parts as f64;
            let next = ring(&mut mesh, along, radius);
            stitch(&mut mesh.corners, &last, &next, end == 0);
            last = next;
        }
        let center = match &inside {
            Some(bore) => bore[end].clone(),
            None => {
                mesh.points.push(from + along * axis);
                vec![mesh.points.len() as u32 - 1]
            }
        };
        stitch(&mut mesh.corners, &last, &center, end == 0);
    }
    mesh
}

/// Joins two rings of any numbers of vertices, which begin at the same angle, by triangles; the second may be
/// a single point. The triangles face outward where the second ring of a cylinder is above the first one, or
/// inside of it at its upper end; in other cases they must be `turned`.
fn stitch(corners: &mut Vec<[u32; 3]>, first: &[u32], second: &[u32], turned: bool) {
    let (n, m) = (first.len(), if second.len() > 1 { second.len() } else { 0 });
    let at = |ring: &[u32], k: usize| ring[k % ring.len()];
    let (mut i, mut j) = (0, 0);
    while i < n || j < m {
        // The ring whose next vertex has the smaller angle advances.
        let next_of_first = j == m || (i < n && (i + 1) * m <= (j + 1) * n);
        let triangle = if next_of_first {
            i += 1;
            [at(first, i - 1), at(first, i), at(second, j)]
        } else {
            j += 1;
            [at(first, i), at(second, j), at(second, j - 1)]
        };
        corners.push(if turned { [triangle[0], triangle[2], triangle[1]] } else { triangle });
    }
}
