//! Refinement of triangles to a maximum edge length; prisms over polygons.

use std::collections::BTreeMap;

use glam::DVec2;

use super::Facets;

/// Maximum number of bisection passes, which shorten edges a thousandfold.
const ROUNDS: usize = 10;

/// Bisects all edges longer than `longest` \[m\], until there are none. The mesh stays conforming.
pub(super) fn refined(mut mesh: Facets, longest: f64) -> Facets {
    for _ in 0..ROUNDS {
        let mut middles: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let Facets { points, corners, .. } = &mut mesh;
        for triangle in corners.iter() {
            for k in 0..3 {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                let [p, q] = [a, b].map(|end| points[end as usize]);
                if p.distance(q) > longest {
                    middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                        points.push(0.5 * (p + q));
                        points.len() as u32 - 1
                    });
                }
            }
        }
        if middles.is_empty() {
            return mesh;
        }
        let middle = |a: u32, b: u32| middles.get(&[a.min(b), a.max(b)]).copied();
        *corners = corners.iter().flat_map(|triangle| parts(*triangle, &middle)).collect();
    }
    mesh
}

/// Subdivision of a triangle at the midpoints of its bisected edges.
fn parts([a, b, c]: [u32; 3], middle: &impl Fn(u32, u32) -> Option<u32>) -> Vec<[u32; 3]> {
    match (middle(a, b), middle(b, c), middle(c, a)) {
        (None, None, None) => vec![[a, b, c]],
        (Some(p), Some(q), Some(r)) => vec![[a, p, r], [p, b, q], [r, q, c], [p, q, r]],
        (Some(p), None, None) => vec![[a, p, c], [p, b, c]],
        (Some(p), Some(q), None) => vec![[a, p, c], [p, q, c], [p, b, q]],
        // One or two of the other edges: the triangle is rotated to one of the cases above.
        _ => parts([b, c, a], middle),
    }
}

/// The prism over a polygon; `None` if the polygon cannot be triangulated.
pub(super) fn prism(polygon: &[(f64, f64)], from: f64, to: f64) -> Option<Facets> {
    let mut corners: Vec<DVec2> = polygon.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    let n = corners.len();
    let area = |corners: &[DVec2]| -> f64 { (0..n).map(|k| corners[k].perp_dot(corners[(k + 1) % n])).sum() };
    if area(&corners) < 0.0 {
        corners.reverse();
    }
    let points =
        [from, to].iter().flat_map(|z| corners.iter().map(move |corner| corner.extend(*z))).collect();
    let mut triangles = Vec::new();
    for [a, b, c] in ears(&corners)? {
        triangles.push([a, c, b]);
        triangles.push([a, b, c].map(|k| k + n as u32));
    }
    for k in 0..n as u32 {
        let next = (k + 1) % n as u32;
        let [c, d] = [next, k].map(|k| k + n as u32);
        triangles.extend([[k, next, c], [k, c, d]]);
    }
    Some(Facets { axes: 3, points, corners: triangles })
}

/// Triangulation of a counter-clockwise polygon by ear clipping.
fn ears(corners: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let mut left: Vec<u32> = (0..corners.len() as u32).collect();
    let mut triangles = Vec::new();
    let at = |k: u32| corners[k as usize];
    while left.len() > 3 {
        let n = left.len();
        let is_ear = |k: &usize| {
            let [a, b, c] = [left[(k + n - 1) % n], left[*k], left[(k + 1) % n]];
            let turn = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
            let holds = |&other: &u32| {
                let x = at(other);
                ![a, b, c].contains(&other)
                    && turn(at(a), at(b), x) >= 0.0
                    && turn(at(b), at(c), x) >= 0.0
                    && turn(at(c), at(a), x) >= 0.0
            };
            turn(at(a), at(b), at(c)) > 0.0 && !left.iter().any(holds)
        };
        let ear = (0..n).find(is_ear)?;
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    Some(triangles)
}
