//! The lattice of a wall. Where its cells miss the cavity that is cut out of it, they are adapted to end at
//! the cavity.
//!
//! A fluid in the cavity has its own lattice. Cells that divide only the outer box of the wall leave a gap of
//! up to half a spacing at the cavity, or overlap the fluid. A gap of a sixteenth of a spacing makes the
//! pressure on the floor of a tank 4 % too large, because the column of water sinks by that much and is
//! compressed.

use super::region::Aabb;

/// Round-off, over the spacing.
const SAME: f64 = 1e-6;
/// Part of a cell by which cells that divide the wall may miss the cavity: it makes 2 % of the pressure on a
/// floor.
const MISFIT: f64 = 0.03;

/// The box that cells of a wall divide evenly, where the cavities that are cut out of it have these `faces`
/// \[m\]: along each axis that between the outermost faces inside of the wall; from the one that there is on
/// in whole spacings; and the wall, where there is none. Nothing, where cells that divide the wall end near
/// the cavities anyway, or where no cells end at all of them.
pub(super) fn frame(wall: &Aabb, faces: &[Vec<f64>; 3], spacing: f64, axes: usize) -> Option<Aabb> {
    let mut frame = *wall;
    let mut fits = true;
    for k in 0..axes {
        let (min, max) = (wall.min[k], wall.max[k]);
        let inside = |x: &f64| *x > min + SAME * spacing && *x < max - SAME * spacing;
        let inside: Vec<f64> = faces[k].iter().copied().filter(inside).collect();
        let whole = |length: f64| (length / spacing).round().max(1.0) * spacing;
        let ends_at_all = |low: f64, high: f64| {
            let cell = (high - low) / ((high - low) / spacing).round().max(1.0);
            let cells = |x: &f64| (x - low) / cell;
            inside.iter().map(cells).all(|cells| (cells - cells.round()).abs() < MISFIT)
        };
        fits &= ends_at_all(min, max);
        let low = inside.iter().copied().fold(f64::INFINITY, f64::min);
        let high = inside.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (frame.min[k], frame.max[k]) = if low < high {
            (low, high)
        } else if low == high {
            (low, low + whole(max - low))
        } else {
            (min, max)
        };
        if !ends_at_all(frame.min[k], frame.max[k]) {
            return None;
        }
    }
    (!fits).then_some(frame)
}
