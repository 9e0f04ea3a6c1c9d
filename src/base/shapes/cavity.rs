//! The lattice of a wall. Its cells are fitted to the faces of the cavity where they would not end there.
//!
//! A fluid in the cavity has its own lattice. Cells that divide only the outer box of the wall leave a gap of
//! up to half a spacing at the cavity, or overlap the fluid. A gap of a sixteenth of a spacing increases the
//! pressure on the floor of a tank by 4 %, because the column of water sinks by the gap and is compressed.

use super::region::Aabb;

/// Round-off, over the spacing.
const SAME: f64 = 1e-6;
/// Tolerated distance of cell faces from the face of the cavity, over the size of a cell; its error of the
/// pressure on a floor is 2 %.
pub(super) const MISFIT: f64 = 0.03;

/// The box that the cells of a wall divide evenly, where its cavities have these `faces` \[m\]. Along each
/// axis it extends between the outermost faces inside the wall; from a single face in whole spacings; and
/// over the wall without a face. `None` where the cells of the wall end near the cavities already, or where
/// no cells end at all cavities.
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
