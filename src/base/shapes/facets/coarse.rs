//! Removes vertices where triangles of a flat part are needlessly small, such as the slivers left by the
//! bisection of long triangle fans.

use glam::DVec3;

use super::Facets;

/// An edge is short below this fraction of the maximum edge length.
const SHORT: f64 = 0.5;
/// Square of the sine of the angle between normals up to which triangles lie in one plane; files have seven
/// digits.
const FLAT: f64 = 1e-10;
/// Minimum quality of a good triangle: twice its area over the square of its longest edge, which is 0.5 for
/// half a square.
const GOOD: f64 = 0.4;
/// Maximum number of passes of vertex removal; a pass skips the neighbours of removed vertices.
const ROUNDS: usize = 20;

/// Removes vertices of flat parts that are closer to another one than half of `longest` \[m\]. No edge may
/// become longer than `longest`, and no triangle may be inverted or become thinner than the thinnest before.
/// The geometry of the surface is unchanged.
pub(super) fn coarsened(mut mesh: Facets, longest: f64) -> Facets {
    for _ in 0..ROUNDS {
        let around = triangles_at_vertices(&mesh);
        let mut is_still = vec![true; mesh.points.len()];
        let mut has_gone = false;
        for vertex in 0..mesh.points.len() as u32 {
            let star = &around[vertex as usize];
            let ring = ring(&mesh, star, vertex);
            if !is_still[vertex as usize] || !ring.iter().all(|other| is_still[*other as usize]) {
                continue;
            }
            let Some(onto) = target(&mesh, &around, vertex, &ring, longest) else { continue };
            for &triangle in star {
                let corners = &mut mesh.corners[triangle as usize];
                corners.iter_mut().filter(|corner| **corner == vertex).for_each(|corner| *corner = onto);
            }
            ring.iter().for_each(|other| is_still[*other as usize] = false);
            is_still[vertex as usize] = false;
            has_gone = true;
        }
        if !has_gone {
            break;
        }
        mesh.corners.retain(|[a, b, c]| a != b && b != c && c != a);
    }
    without_unused(mesh)
}

fn triangles_at_vertices(mesh: &Facets) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); mesh.points.len()];
    for (triangle, corners) in (0..).zip(&mesh.corners) {
        corners.iter().for_each(|&vertex| around[vertex as usize].push(triangle));
    }
    around
}

/// The vertices that share an edge with the given one.
fn ring(mesh: &Facets, star: &[u32], vertex: u32) -> Vec<u32> {
    let corners = star.iter().flat_map(|&triangle| mesh.corners[triangle as usize]);
    let mut ring: Vec<u32> = corners.filter(|&corner| corner != vertex).collect();
    ring.sort_unstable();
    ring.dedup();
    ring
}

/// The target vertex of the edge collapse that removes a vertex of a flat part, if it is to be removed.
fn target(mesh: &Facets, around: &[Vec<u32>], vertex: u32, ring: &[u32], longest: f64) -> Option<u32> {
    let star = &around[vertex as usize];
    // A closed fan has as many vertices around it as triangles.
    if star.len() != ring.len() || star.len() < 3 {
        return None;
    }
    let area = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.points[corner as usize]);
        (b - a).cross(c - a)
    };
    let of_star = |k: &u32| area(mesh.corners[*k as usize]);
    let normal = star.iter().map(of_star).sum::<DVec3>().normalize_or_zero();
    let is_flat = |area: DVec3| area.cross(normal).length_squared() <= FLAT * area.length_squared();
    if !star.iter().map(of_star).all(|area| area.dot(normal) > 0.0 && is_flat(area)) {
        return None;
    }
    let at = |corner: u32| mesh.points[corner as usize];
    let place = at(vertex);
    let nearest = ring.iter().map(|&other| at(other).distance(place)).fold(f64::INFINITY, f64::min);
    if nearest >= SHORT * longest {
        return None;
    }
    let quality = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(at);
        let square = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        (area(corners).dot(normal) / square, square)
    };
    let thinnest = star.iter().map(|&k| quality(mesh.corners[k as usize]).0).fold(GOOD, f64::min);
    let mut best: Option<(f64, u32)> = None;
    for &onto in ring {
        let common = self::ring(mesh, &around[onto as usize], onto);
        if common.iter().filter(|other| ring.binary_search(other).is_ok()).count() != 2 {
            continue;
        }
        let kept = star.iter().map(|&k| mesh.corners[k as usize]).filter(|corners| !corners.contains(&onto));
        let moved = kept.map(|corners| corners.map(|corner| if corner == vertex { onto } else { corner }));
        let worst = moved.map(quality).try_fold(f64::INFINITY, |worst, (quality, square)| {
            (quality >= thinnest && square <= longest * longest).then(|| worst.min(quality))
        });
        if let Some(worst) = worst.filter(|worst| best.is_none_or(|best| *worst > best.0)) {
            best = Some((worst, onto));
        }
    }
    best.map(|best| best.1)
}

fn without_unused(mut mesh: Facets) -> Facets {
    let mut number = vec![None; mesh.points.len()];
    let mut points = Vec::new();
    for corner in mesh.corners.iter_mut().flatten() {
        let place = mesh.points[*corner as usize];
        *corner = *number[*corner as usize].get_or_insert_with(|| {
            points.push(place);
            points.len() as u32 - 1
        });
    }
    mesh.points = points;
    mesh
}
