//! Planes, lines and places in a periodic domain. What leaves the domain on one side enters on the other: an
//! oblique plane or line goes on there, and what lies beside a period counts where its image is.

use glam::DVec3;

use crate::neighbors::Periodic;
use crate::shapes::{Region, images_near};

/// Rise of a plane over a period, over the spacing, below which it is parallel to the axis.
const PARALLEL: f64 = 0.5;
/// Sine of the angle between a line and the periodic axes below which it runs along them.
const ALONG: f64 = 1e-6;

/// Share of the places `foot + cell` that a region or one of its images contains; images along the axes
/// whose `lengths`, m, are not zero.
pub fn contained_share(
    region: &dyn Region,
    foot: DVec3,
    cell: impl ExactSizeIterator<Item = DVec3> + Clone,
    lengths: DVec3,
) -> f64 {
    // Half a period farther, as rounding must not matter: the region says what is in it.
    let reach = 0.5 * lengths.max_element();
    let bounds = region.bounds();
    let images = |place| images_near(&bounds, place, lengths, reach);
    let extent = cell.clone().map(DVec3::length).fold(0.0, f64::max);
    let distance = images(foot).map(|image| region.distance(image)).fold(f64::INFINITY, f64::min);
    if distance.abs() > extent {
        // All of them are on one side of the boundary.
        return if distance < 0.0 { 1.0 } else { 0.0 };
    }
    let places = cell.len();
    let contained = cell.filter(|x| images(foot + *x).any(|image| region.contains(image))).count();
    contained as f64 / places as f64
}

/// The period, m, over which a plane with that unit normal goes on into the next image: of several axes that
/// it crosses the one nearest to the normal, so that it has one period of the others. Zero if it crosses
/// none.
pub fn crossed_period(normal: DVec3, periodic: &Periodic, spacing: f64) -> DVec3 {
    let lengths = periodic.lengths();
    let crosses = |axis: &usize| (normal[*axis] * lengths[*axis]).abs() > PARALLEL * spacing;
    let nearest = (0..3)
        .filter(crosses)
        .reduce(|best, axis| if normal[axis].abs() > normal[best].abs() { axis } else { best });
    nearest.map_or(DVec3::ZERO, |axis| lengths * DVec3::AXES[axis])
}

/// Shifts, m, by which images of particles may come near a line along `up`, a unit vector. `far` is the
/// vector from the foot of the line to a particle in the nearest image; its greatest height counts. A line
/// along periodic axes alone has no end, and only nearest images.
pub fn shifts_to_line(
    up: DVec3,
    far: impl Iterator<Item = DVec3>,
    reach: f64,
    periodic: &Periodic,
) -> Vec<DVec3> {
    let (axes, lengths) = (periodic.axes(), periodic.lengths());
    let steepest = (0..3).filter(|&axis| !axes[axis]).max_by(|&a, &b| up[a].abs().total_cmp(&up[b].abs()));
    let mut shifts = vec![DVec3::ZERO];
    let Some(steepest) = steepest.filter(|&axis| periodic.any() && up[axis].abs() > ALONG) else {
        return shifts;
    };
    let top = far.map(|offset| offset[steepest] / up[steepest]).fold(0.0, f64::max) + reach;
    for axis in (0..3).filter(|&axis| axes[axis]) {
        let (way, length) = (top * up[axis], lengths[axis]);
        if way.abs() + reach <= 0.5 * length {
            continue;
        }
        let low = ((way.min(0.0) - reach) / length - 0.5).ceil() as i64;
        let high = ((way.max(0.0) + reach) / length + 0.5).floor() as i64;
        let along = |shift: DVec3| (low..=high).map(move |k| shift + DVec3::AXES[axis] * (k as f64 * length));
        shifts = shifts.into_iter().flat_map(along).collect();
    }
    shifts
}
