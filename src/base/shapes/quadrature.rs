//! Volume of a region by counting cells, for shapes without a closed form.

use rayon::prelude::*;

use super::region::Region;
use super::tiling::Tiling;

/// Cells along the longest side in two and in three dimensions.
const CELLS: [f64; 2] = [4096.0, 512.0];

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
    let tiling = Tiling::new(&bounds, &bounds, glam::DVec3::splat(size), axes);
    let width = tiling.cell.max_element();
    let blocks = tiling.blocks(region, if axes == 2 { 32 } else { 8 }, usize::MAX);
    let cells_of = |block: &super::tiling::CellBox| {
        if block.inside {
            return block.len() as f64;
        }
        let part = |cell| {
            (0.5 - region.distance(tiling.point(cell, glam::DVec3::splat(0.5))) / width).clamp(0.0, 1.0)
        };
        block.cells().map(part).sum::<f64>()
    };
    // The sum is in the order of blocks, independent of threads.
    let cells: Vec<f64> = blocks.par_iter().map(cells_of).collect();
    cells.iter().sum::<f64>() * tiling.cell_volume()
}
