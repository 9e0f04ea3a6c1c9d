//! Particles on the cells of a lattice: square, cubic and hexagonal.

use glam::DVec3;
use rayon::prelude::*;

use super::error::FillErrorKind;
use super::region::{Aabb, Region};
use super::tiling::{CellBox, Tiling};

/// Maximum fraction of particles in sections of one layer; round and sharp bodies have some at tips and
/// edges.
const MAX_THIN_PART: f64 = 0.1;

/// Position of a particle in its cell.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Packing {
    /// At the centre: square or cubic lattice.
    Centered,
    /// Shifted from row to row and layer to layer: triangular lattice, hexagonal close packing.
    Hexagonal,
}

impl Packing {
    /// Sides \[m\] of a cell with the volume of a cube (square) of side `spacing` \[m\].
    pub fn cell(self, spacing: f64, axes: usize) -> DVec3 {
        let sides = match (self, axes) {
            (Self::Centered, _) => [1.0, 1.0, 1.0],
            // Equilateral triangles of side a have a row distance of sqrt(3)/2 a.
            (Self::Hexagonal, 2) => {
                let a = (2.0 / 3f64.sqrt()).sqrt();
                [a, a * 0.75f64.sqrt(), 1.0]
            }
            // Close-packed spheres of diameter a have a volume of a^3 / sqrt(2) each and a layer distance of
            // sqrt(2/3) a.
            (Self::Hexagonal, _) => {
                let a = 2f64.sqrt().cbrt();
                [a, a * 0.75f64.sqrt(), a * (2.0 / 3.0f64).sqrt()]
            }
        };
        spacing * DVec3::from_array(sides)
    }

    /// Position of the particle as fractions of the sides of its cell. Rows alternate by half a cell along x;
    /// in three dimensions layer B lies over the gaps of layer A, offset by half a cell along x and a third
    /// along y. The whole is centred in the box.
    fn part(self, tiling: &Tiling, index: [usize; 3]) -> DVec3 {
        if self == Self::Centered {
            return DVec3::splat(0.5);
        }
        let [_, row, layer] = tiling.steps_from_origin(index);
        let x = if (row + layer).rem_euclid(2) == 0 { 0.25 } else { 0.75 };
        if tiling.axes == 2 {
            return DVec3::new(x, 0.5, 0.5);
        }
        DVec3::new(x, if layer.rem_euclid(2) == 0 { 1.0 / 3.0 } else { 2.0 / 3.0 }, 0.5)
    }
}

/// The lattice points of `packing` in `region` with cells that divide `frame`, in a spatially coherent order.
///
/// # Errors
/// No point is inside, or the body is thinner than two particles: either its frame is, or more than a tenth
/// of the points are in sections of a single layer.
pub(super) fn points(
    region: &dyn Region,
    frame: &Aabb,
    packing: Packing,
    spacing: f64,
    axes: usize,
) -> Result<Vec<DVec3>, FillErrorKind> {
    let bounds = region.bounds();
    let sides = ["x", "y", "z"].into_iter().zip(bounds.extent().to_array()).take(axes);
    for (direction, thickness) in sides.chain(region.walls()) {
        if (thickness / spacing).round() < 2.0 {
            return Err(FillErrorKind::Thin { direction, thickness, spacing });
        }
    }
    let tiling = Tiling::new(frame, &bounds, packing.cell(spacing, axes), axes);
    let tolerance = region.tolerance();
    let leaf = if axes == 2 { 32 } else { 8 };
    let blocks = tiling.blocks(region, leaf, leaf);
    let sites_of = |block: &CellBox| {
        let mut points = Vec::with_capacity(block.len());
        let mut thin = [0usize; 3];
        for cell in block.cells() {
            let point = tiling.point(cell, packing.part(&tiling, cell));
            let distance = if block.inside { f64::NEG_INFINITY } else { region.distance(point) };
            if distance > tolerance {
                continue;
            }
            points.push(point);
            for k in 0..axes {
                thin[k] +=
                    usize::from(distance > -tiling.cell[k] && is_sheet(region, point, tiling.cell, k, axes));
            }
        }
        (points, thin)
    };
    let found: Vec<(Vec<DVec3>, [usize; 3])> = blocks.par_iter().map(sites_of).collect();
    let mut points = Vec::with_capacity(found.iter().map(|(points, _)| points.len()).sum());
    let mut thin = [0; 3];
    for (more, more_thin) in found {
        points.extend(more);
        (0..3).for_each(|k| thin[k] += more_thin[k]);
    }
    if points.is_empty() {
        return Err(FillErrorKind::NoParticle(spacing));
    }
    let worst = (0..axes).max_by_key(|&k| (thin[k], 3 - k)).unwrap_or(0);
    if thin[worst] as f64 > MAX_THIN_PART * points.len() as f64 {
        let sheet = points.iter().find(|&&point| is_sheet(region, point, tiling.cell, worst, axes));
        let thickness = sheet.map_or(spacing, |&point| chord(region, point, tiling.cell, worst));
        return Err(FillErrorKind::Thin { direction: ["x", "y", "z"][worst], thickness, spacing });
    }
    Ok(points)
}

/// Whether both neighbours of `point` along axis `k` are outside, and also those of its two neighbours along
/// another axis. This is an extended single layer, not the tip of a round body.
fn is_sheet(region: &dyn Region, point: DVec3, cell: DVec3, k: usize, axes: usize) -> bool {
    let step = |k: usize| cell[k] * DVec3::AXES[k];
    let single = |point: DVec3| !region.contains(point + step(k)) && !region.contains(point - step(k));
    let layer = |point: DVec3| region.contains(point) && single(point);
    single(point) && (0..axes).any(|m| m != k && layer(point + step(m)) && layer(point - step(m)))
}

/// Length inside the region along axis `k` through a point whose neighbours along that axis are outside
/// \[m\].
fn chord(region: &dyn Region, point: DVec3, cell: DVec3, k: usize) -> f64 {
    let reach = |direction: f64| {
        let (mut inside, mut outside) = (0.0, cell[k]);
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            let there = region.contains(point + direction * middle * DVec3::AXES[k]);
            if there { inside = middle } else { outside = middle }
        }
        inside
    };
    reach(-1.0) + reach(1.0)
}
