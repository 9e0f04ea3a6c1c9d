//! Body-fitted packings: a regular lattice inside, and layers that follow the boundary near it, made uniform
//! by Lloyd's method with the outermost layer fixed at half a spacing from the boundary.

use glam::DVec3;
use rayon::prelude::*;

use super::cells::Packing;
use super::region::{Aabb, Region};
use super::site::{Content, Site};
use super::tiling::Tiling;
use super::voronoi;

/// Depth of the moving particles, and of the particles whose Voronoi cells are computed, in spacings.
const MOVING: f64 = 3.5;
const MEASURED: f64 = 6.0;
/// Maximum depth of the outermost layer, initially and in later steps, in spacings.
const FIRST_LAYER: [f64; 2] = [1.0, 0.75];
/// Samples along each side of a cell in two and three dimensions, for a step of Lloyd's method and for the
/// volumes.
const STEP_SAMPLES: [usize; 2] = [6, 3];
const VOLUME_SAMPLES: [usize; 2] = [12, 6];
/// Step of the finite differences of the direction to the boundary, in spacings.
const STEP: f64 = 1e-5;

/// The particles near the boundary of a region.
struct Band<'a> {
    region: &'a dyn Region,
    depth: f64,
}

impl Region for Band<'_> {
    fn distance(&self, point: DVec3) -> f64 {
        let distance = self.region.distance(point);
        distance.max(-distance - self.depth)
    }

    fn bounds(&self) -> Aabb {
        self.region.bounds()
    }

    fn volume(&self) -> Option<f64> {
        None
    }
}

/// The lattice points in `region`, with those near its boundary moved by `iterations` steps of Lloyd's method
/// to nearly uniform cells. The outermost ones are half a spacing from the boundary. Particles inside have
/// the volume of a lattice cell; the sum of all volumes is `volume`.
pub(super) fn sites(content: Content<'_>, mut points: Vec<DVec3>, iterations: u32) -> Vec<Site> {
    let Content { region, volume, spacing, axes } = content;
    let frame = region.frame();
    let lattice = Tiling::new(&frame, &region.bounds(), Packing::Centered.cell(spacing, axes), axes);
    let cell_volume = lattice.cell_volume();
    let depth_of = |point: &DVec3| -region.distance(*point) / spacing;
    let moves: Vec<bool> = points.par_iter().map(|point| depth_of(point) < MOVING).collect();
    let band = Band { region, depth: MEASURED * spacing };
    let bounds = region.bounds();
    let tiling = Tiling::new(&bounds, &bounds, DVec3::splat(spacing), axes);
    let settle = |point: &mut DVec3, limit: f64| {
        if depth_of(point) < limit {
            *point = in_first_layer(region, *point, spacing, axes);
        }
    };
    let moving = points.par_iter_mut().zip(&moves).filter(|(_, moves)| **moves);
    moving.for_each(|(point, _)| settle(point, FIRST_LAYER[0]));
    for _ in 0..iterations {
        let cells = voronoi::moments(&band, &tiling, &points, STEP_SAMPLES[axes - 2]);
        let moving = points.par_iter_mut().zip(cells).zip(&moves).filter(|(_, moves)| **moves);
        moving.for_each(|((point, cell), _)| {
            let centroid = cell.first / cell.volume;
            // The centroid of a non-convex cell at a hole or a notch may be outside.
            if cell.volume > 0.0 && region.contains(centroid) {
                *point = centroid;
            }
            settle(point, FIRST_LAYER[1]);
        });
    }
    let cells = voronoi::moments(&band, &tiling, &points, VOLUME_SAMPLES[axes - 2]);
    let inside = moves.iter().filter(|moves| !**moves).count();
    let measured: f64 =
        cells.iter().zip(&moves).filter(|(_, moves)| **moves).map(|(cell, _)| cell.volume).sum();
    let factor = if measured > 0.0 { (volume - inside as f64 * cell_volume) / measured } else { 1.0 };
    let site = |((position, cell), moves): ((DVec3, voronoi::CellMoments), &bool)| Site {
        position,
        volume: if *moves { factor * cell.volume } else { cell_volume },
    };
    let sites = points.into_iter().zip(cells).zip(&moves).map(site);
    sites.filter(|site| site.volume > 0.0).collect()
}

/// The position half a spacing from the boundary, for a point near it.
fn in_first_layer(region: &dyn Region, point: DVec3, spacing: f64, axes: usize) -> DVec3 {
    let step = STEP * spacing;
    let mut place = point;
    // Distances of combinations are not exact away from the boundary; the second step corrects the remainder
    // of the first.
    for _ in 0..2 {
        let slope = |k: usize| {
            let ahead = region.distance(place + step * DVec3::AXES[k]);
            ahead - region.distance(place - step * DVec3::AXES[k])
        };
        let outward = (0..axes).map(|k| slope(k) * DVec3::AXES[k]).sum::<DVec3>().normalize_or_zero();
        place -= (region.distance(place) + 0.5 * spacing) * outward;
    }
    // The point stays where the body is too thin.
    if region.distance(place) < -0.25 * spacing { place } else { point }
}
