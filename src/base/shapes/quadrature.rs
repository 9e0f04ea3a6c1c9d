//! Volume and moments of a region by counting cells, for shapes without a closed form.

use glam::DVec3;
use rayon::prelude::*;

use super::moments::Moments;
use super::region::Region;
use super::tiling::{CellBox, Tiling};
use crate::linalg::Sym3;

/// Cells along the longest side in two and in three dimensions.
const CELLS: [f64; 2] = [4096.0, 512.0];

/// The same for moments, whose error is some 1e-4.
const MOMENT_CELLS: [f64; 2] = [1024.0, 128.0];

/// Volume of `region` \[m³\], in two dimensions area \[m²\]: the closed form where there is one. Otherwise
/// cells much smaller than the region, of at most half a `spacing`, are counted. A cell at the boundary
/// counts by the fraction behind a plane at its signed distance, so that the error decreases with the square
/// of the cell size.
pub(super) fn volume(region: &dyn Region, spacing: f64, axes: usize) -> f64 {
    if let Some(volume) = region.volume() {
        return volume;
    }
    let bounds = region.bounds();
    let longest = bounds.extent().max_element();
    if longest == 0.0 {
        return 0.0;
    }
    let size = (longest / CELLS[axes - 2]).min(0.5 * spacing).max(longest / (4.0 * CELLS[axes - 2]));
    let tiling = Tiling::new(&bounds, &bounds, DVec3::splat(size), axes);
    let blocks = tiling.blocks(region, leaf(axes), usize::MAX);
    let cells_of = |block: &CellBox| {
        if block.inside {
            return block.len() as f64;
        }
        block.cells().map(|cell| share_of(&tiling, cell, region)).sum::<f64>()
    };
    // The sum is in the order of blocks, independent of threads.
    let cells: Vec<f64> = blocks.par_iter().map(cells_of).collect();
    cells.iter().sum::<f64>() * tiling.cell_volume()
}

/// Volume, centre and second moments of a bounded `region` by counting cells, those at the boundary in part.
pub fn counted_moments(region: &dyn Region, axes: usize) -> Moments {
    let bounds = region.bounds();
    let size = bounds.extent().max_element() / MOMENT_CELLS[axes - 2];
    let tiling = Tiling::new(&bounds, &bounds, DVec3::splat(size), axes);
    let blocks = tiling.blocks(region, leaf(axes), leaf(axes));
    let middle = bounds.center();
    let sums_of = |block: &CellBox| {
        let mut sums = (0.0, DVec3::ZERO, Sym3::ZERO);
        for cell in block.cells() {
            let share = if block.inside { 1.0 } else { share_of(&tiling, cell, region) };
            let mut arm = tiling.point(cell, DVec3::splat(0.5)) - middle;
            (axes..3).for_each(|k| arm[k] = 0.0);
            sums = (sums.0 + share, sums.1 + share * arm, sums.2 + Sym3::dyad(arm) * share);
        }
        sums
    };
    let parts: Vec<_> = blocks.par_iter().map(sums_of).collect();
    let (mut cells, mut first, mut second) = (0.0, DVec3::ZERO, Sym3::ZERO);
    for part in parts {
        (cells, first, second) = (cells + part.0, first + part.1, second + part.2);
    }
    let arm = first / cells;
    let of_cell = Sym3::from_diagonal(tiling.cell * tiling.cell / 12.0) * cells;
    let second = (second + Sym3::dyad(arm) * -cells + of_cell) * tiling.cell_volume();
    Moments { volume: cells * tiling.cell_volume(), center: middle + arm, second }
}

/// Cells along a side of a block.
fn leaf(axes: usize) -> usize {
    if axes == 2 { 32 } else { 8 }
}

/// The share of a cell that is in the region: that behind a plane at its signed distance.
fn share_of(tiling: &Tiling, cell: [usize; 3], region: &dyn Region) -> f64 {
    let width = tiling.cell.max_element();
    (0.5 - region.distance(tiling.point(cell, DVec3::splat(0.5))) / width).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;
    use std::path::Path;

    use super::*;
    use crate::shapes::Shape;
    use crate::space::Dimension;

    /// Volume, place of the centre along x and moment of inertia about the axis along z through it.
    fn found(text: &str, dimension: Dimension) -> [f64; 3] {
        let shape: Shape = ron::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let region = shape.region(dimension, Path::new("."), "shape").unwrap_or_else(|e| panic!("{e:?}"));
        let Moments { volume, center, second } = counted_moments(&*region, dimension.count());
        let m = second.to_matrix();
        [volume, center.x, m.x_axis.x + m.y_axis.y]
    }

    #[test]
    fn moments_of_cut_and_joined_shapes_are_those_of_their_closed_forms() {
        let half = PI * 0.01 / 2.0;
        let middle = 4.0 * 0.1 / (3.0 * PI);
        let (disc, hole) = (PI * 0.01, PI * 0.0009);
        let bored = disc - hole;
        let aside = -hole * 0.04 / bored;
        let about_bored = 0.5 * disc * 0.01 - hole * (0.5 * 0.0009 + 0.0016) - bored * aside * aside;
        for (text, dimension, expected) in [
            (
                "Intersection([Sphere(center: (0, 0), radius: 0.1), Box(min: (0, -1), max: (1, 1))])",
                Dimension::Two,
                [half, middle, half * (0.5 * 0.01 - middle * middle)],
            ),
            (
                "Scale(shape: Sphere(center: (0.3, 0), radius: 0.1), by: (2, 1), about: (0.3, 0))",
                Dimension::Two,
                [0.02 * PI, 0.3, 0.02 * PI * 0.05 / 4.0],
            ),
            (
                "Scale(shape: Sphere(center: (0, 0, 0), radius: 0.1), by: (2, 1, 1))",
                Dimension::Three,
                [0.008 * PI / 3.0, 0.0, 0.008 * PI / 3.0 * 0.05 / 5.0],
            ),
            (
                "Difference(Cylinder(from: (0, 0, 0), to: (0, 0, 0.1), radius: 0.1), Cylinder(from: (0.04, 0, -1), to: (0.04, 0, 1), radius: 0.03))",
                Dimension::Three,
                [0.1 * bored, aside, 0.1 * about_bored],
            ),
        ] {
            let found = found(text, dimension);
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() <= 1e-3 * expected.abs() + 1e-5,
                    "{text}: {found} {expected}"
                );
            }
        }
    }
}
