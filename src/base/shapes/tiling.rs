//! Cells that tile a region, for regular lattices, numerical volumes and neighbour look-ups.

use glam::DVec3;

use super::region::{Aabb, Region};

/// A uniform grid. In two dimensions it has one layer of zero height at z = 0.
pub(super) struct Tiling {
    /// Minimum corner of the cell with index 0 \[m\].
    origin: DVec3,
    /// Index of the first cell along each axis: negative where the grid extends below `origin`.
    first: [i64; 3],
    /// Number of cells along each axis.
    pub counts: [usize; 3],
    /// Sides of a cell \[m\]; z is 0 in two dimensions.
    pub cell: DVec3,
    pub axes: usize,
}

/// A box of cells, `low <= index < high`, that is not entirely outside a region.
pub(super) struct CellBox {
    pub low: [usize; 3],
    pub high: [usize; 3],
    /// All of it is inside the region.
    pub inside: bool,
}

impl Tiling {
    /// Cells of about the size `spacing` that divide `frame` evenly and extend until they cover `bounds`.
    pub fn new(frame: &Aabb, bounds: &Aabb, spacing: DVec3, axes: usize) -> Self {
        let mut tiling = Self { origin: frame.min, first: [0; 3], counts: [1; 3], cell: DVec3::ZERO, axes };
        for k in 0..axes {
            let side = frame.max[k] - frame.min[k];
            let cell = side / (side / spacing[k]).round().max(1.0);
            // The small number prevents round-off from adding a layer of cells where both ends coincide.
            let first = ((bounds.min[k] - frame.min[k]) / cell + 1e-6).floor();
            let last = ((bounds.max[k] - frame.min[k]) / cell - 1e-6).ceil();
            tiling.cell[k] = cell;
            tiling.first[k] = first as i64;
            tiling.counts[k] = (last - first).max(1.0) as usize;
        }
        tiling
    }

    /// Volume of a cell \[m³\], in two dimensions its area \[m²\].
    pub fn cell_volume(&self) -> f64 {
        (0..self.axes).map(|k| self.cell[k]).product()
    }

    /// The point of cell `index` at the given fractions of its sides (0.5: the centre) \[m\].
    #[inline]
    pub fn point(&self, index: [usize; 3], part: DVec3) -> DVec3 {
        let along = |first: i64, index: usize| (first + index as i64) as f64;
        let [x, y, z] = index;
        let cells = DVec3::new(along(self.first[0], x), along(self.first[1], y), along(self.first[2], z));
        self.origin + (cells + part) * self.cell
    }

    /// Number of the cell, counted along x, then y, then z.
    pub fn number(&self, [x, y, z]: [usize; 3]) -> u128 {
        let [row, column, _] = self.counts;
        (z as u128 * column as u128 + y as u128) * row as u128 + x as u128
    }

    /// Number of layers, rows or columns of cells between this cell and the origin of the frame.
    pub fn steps_from_origin(&self, index: [usize; 3]) -> [i64; 3] {
        [0, 1, 2].map(|k| self.first[k] + index[k] as i64)
    }

    /// The cell that contains `point`, or the nearest one.
    pub fn index(&self, point: DVec3) -> [usize; 3] {
        [0, 1, 2].map(|k| {
            if k >= self.axes {
                return 0;
            }
            let cells = ((point[k] - self.origin[k]) / self.cell[k]).floor() - self.first[k] as f64;
            (cells.max(0.0) as usize).min(self.counts[k] - 1)
        })
    }

    /// Blocks of at most `leaf` cells per side that contain all cells which touch the region. Blocks inside
    /// may have up to `inside_leaf` cells per side. Their order is fixed and spatially coherent.
    pub fn blocks(&self, region: &dyn Region, leaf: usize, inside_leaf: usize) -> Vec<CellBox> {
        let side = self.counts.iter().copied().max().unwrap_or(1).next_power_of_two();
        let mut splitting = Splitting { tiling: self, region, leaf, inside_leaf, blocks: Vec::new() };
        splitting.split([0; 3], side, false);
        splitting.blocks
    }
}

/// The recursion that finds blocks.
struct Splitting<'a> {
    tiling: &'a Tiling,
    region: &'a dyn Region,
    /// Maximum number of cells per side, of all blocks and of those inside.
    leaf: usize,
    inside_leaf: usize,
    blocks: Vec<CellBox>,
}

impl Splitting<'_> {
    fn split(&mut self, low: [usize; 3], side: usize, known_inside: bool) {
        let tiling = self.tiling;
        if (0..3).any(|k| low[k] >= tiling.counts[k]) {
            return;
        }
        let high = [0, 1, 2].map(|k| (low[k] + side).min(tiling.counts[k]));
        let mut inside = known_inside;
        if !inside {
            let (start, end) = (tiling.point(low, DVec3::ZERO), tiling.point(high, DVec3::ZERO));
            let reach = 0.5 * (end - start).length();
            let center = 0.5 * (start + end);
            let distance = self.region.distance(center);
            if distance > reach * (1.0 + 1e-9) + self.region.tolerance() {
                return;
            }
            inside = distance < -reach;
        }
        if side <= if inside { self.inside_leaf.max(self.leaf) } else { self.leaf } {
            self.blocks.push(CellBox { low, high, inside });
            return;
        }
        let half = side / 2;
        for child in 0..1 << tiling.axes {
            let start = [0, 1, 2].map(|k| low[k] + half * (child >> k & 1));
            self.split(start, half, inside);
        }
    }
}

impl CellBox {
    /// The cells of the block, with x as the fastest index.
    pub fn cells(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let (low, high) = (self.low, self.high);
        (low[2]..high[2])
            .flat_map(move |z| (low[1]..high[1]).flat_map(move |y| (low[0]..high[0]).map(move |x| [x, y, z])))
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        (0..3).map(|k| self.high[k] - self.low[k]).product()
    }
}
