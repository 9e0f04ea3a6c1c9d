//! The lattice of a wall. Where its cells miss the cavity that is cut out of it, they are adapted to end at the cavity.
//!
//! A fluid in the cavity has its own lattice. Cells that divide only the outer box of the wall leave a gap of up to half a spacing at the cavity, or overlap the fluid. A gap of a
//! sixteenth of a spacing makes the pressure on the floor of a tank 4 % too large, because the column of water sinks by that much and is compressed.

use super::region::Aabb;

/// Round-off, over the spacing.
const SAME: f64 = 1e-6;
/// Part of a cell by which cells that divide the wall may miss the cavity: it makes 2 % of the pressure on a floor.
const MISFIT: f64 = 0.03;

/// The box that cells of a wall divide evenly: along each axis the cavity, where both of its ends are inside of the wall; from its end on in whole spacings \[m\], where one is; and the wall, where
/// none is. Nothing, where cells that divide the wall end near the cavity anyway.
pub(super) fn frame(wall: &Aabb, cavity: &Aabb, spacing: f64, axes: usize) -> Option<Aabb> {
    let mut frame = *wall;
    let mut fits = true;
    for k in 0..axes {
        let is_inside = |x: f64| x > wall.min[k] + SAME * spacing && x < wall.max[k] - SAME * spacing;
        let whole = |length: f64| (length / spacing).round().max(1.0) * spacing;
        let side = wall.max[k] - wall.min[k];
        let cell = side / (side / spacing).round().max(1.0);
        for x in [cavity.min[k], cavity.max[k]].into_iter().filter(|x| is_inside(*x)) {
            let cells = (x - wall.min[k]) / cell;
            fits &= (cells - cells.round()).abs() < MISFIT;
        }
        (frame.min[k], frame.max[k]) = match (is_inside(cavity.min[k]), is_inside(cavity.max[k])) {
            (true, true) => (cavity.min[k], cavity.max[k]),
            (true, false) => (cavity.min[k], cavity.min[k] + whole(wall.max[k] - cavity.min[k])),
            (false, true) => (cavity.max[k] - whole(cavity.max[k] - wall.min[k]), cavity.max[k]),
            (false, false) => (wall.min[k], wall.max[k]),
        };
    }
    (!fits).then_some(frame)
}
