//! Periodic images of a place near a region. A body may start across a side of a periodic domain, and what
//! moves leaves the domain: neither a place nor a shape need lie inside of it.

use std::ops::RangeInclusive;

use glam::DVec3;

use super::Aabb;

/// Images of a place to each side of it in which an unbounded region is looked for.
const AROUND: f64 = 2.0;

/// The images of a place within `reach`, m, of a box; `lengths`, m, are those of the periods, zero along axes
/// that have none. Along an axis without such an image it is the one nearest to the middle of the box.
pub fn images_near(
    bounds: &Aabb,
    place: DVec3,
    lengths: DVec3,
    reach: f64,
) -> impl Iterator<Item = DVec3> + use<> {
    let [x, y, z] = [0, 1, 2].map(|axis| periods(bounds, place, lengths, reach, axis));
    let image = move |x, y, z| place + lengths * DVec3::new(x, y, z);
    x.flat_map(move |x| {
        let z = z.clone();
        y.clone().flat_map(move |y| z.clone().map(move |z| image(x as f64, y as f64, z as f64)))
    })
}

/// The periods by which the images are shifted along an axis.
fn periods(bounds: &Aabb, place: DVec3, lengths: DVec3, reach: f64, axis: usize) -> RangeInclusive<i64> {
    let length = lengths[axis];
    if length == 0.0 {
        return 0..=0;
    }
    let over_length = |end: f64, otherwise: f64| if end.is_finite() { end / length } else { otherwise };
    let low = over_length(bounds.min[axis] - reach - place[axis], -AROUND);
    let high = over_length(bounds.max[axis] + reach - place[axis], AROUND);
    let (first, last) = (low.ceil() as i64, high.floor() as i64);
    if first <= last {
        return first..=last;
    }
    let nearest = (0.5 * (low + high)).round() as i64;
    nearest..=nearest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(x: f64, lengths: DVec3, reach: f64) -> Vec<f64> {
        let bounds = Aabb { min: DVec3::new(-0.1, 0.0, 0.0), max: DVec3::new(0.2, 1.0, 0.0) };
        images_near(&bounds, DVec3::new(x, 0.5, 0.0), lengths, reach).map(|image| image.x).collect()
    }

    #[test]
    fn images_are_those_near_the_box_or_the_nearest_one() {
        let lengths = DVec3::new(1.0, 0.0, 0.0);
        for (x, reach, wanted) in [
            (0.05, 0.02, vec![0.05]),
            (0.95, 0.02, vec![-0.05]),
            (7.89, 0.02, vec![-0.11]),
            (-3.79, 0.02, vec![0.21]),
            // Neither is near; the middle of the box is at 0.05.
            (0.5, 0.02, vec![0.5]),
            (0.6, 0.02, vec![-0.4]),
            (0.55, 0.36, vec![-0.45, 0.55]),
        ] {
            let images = found(x, lengths, reach);
            let is_it = |(found, wanted): (&f64, &f64)| (found - wanted).abs() < 1e-12;
            assert!(images.len() == wanted.len(), "{x}: {images:?}");
            assert!(images.iter().zip(&wanted).all(is_it), "{x}: {images:?}");
        }
        assert_eq!(found(7.9, DVec3::ZERO, 0.02), [7.9]);
    }

    #[test]
    fn an_unbounded_region_is_looked_for_around_the_place() {
        let everything = Aabb::everything(2);
        let images: Vec<DVec3> =
            images_near(&everything, DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), 0.1).collect();
        assert_eq!(images, [-2.0, -1.0, 0.0, 1.0, 2.0].map(|x| DVec3::new(x, 0.0, 0.0)));
    }
}
