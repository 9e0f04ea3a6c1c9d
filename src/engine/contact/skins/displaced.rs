//! Bound of the approach of two sets of vertices.

use glam::DVec3;

/// Vertices of a side that have moved.
#[derive(Clone, Copy)]
pub(super) struct Displaced<'a> {
    /// Their numbers.
    pub vertices: &'a [u32],
    /// Where all vertices of the side were, m.
    pub before: &'a [DVec3],
    /// Where they are, m.
    pub now: &'a [DVec3],
}

/// A bound of how much closer any two vertices of both sides have come, m; not a number if a place is none.
/// What all have moved in common does not count.
pub(super) fn approach(sides: [Displaced<'_>; 2]) -> f64 {
    let [first, second] = [range(sides[0]), range(sides[1])];
    let (least, most) = (first.0.min(second.0), first.1.max(second.1));
    let middle = 0.5 * (least + most);
    if middle.is_nan() || !middle.is_finite() {
        return f64::NAN;
    }
    let farthest = |(least, most): (DVec3, DVec3)| (middle - least).abs().max((most - middle).abs()).length();
    farthest(first) + farthest(second)
}

/// Minimum and maximum components of the displacements of a side; not finite if one of them is no number.
fn range(Displaced { vertices, before, now }: Displaced<'_>) -> (DVec3, DVec3) {
    let (mut least, mut most, mut sum) = (DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO);
    for &vertex in vertices {
        let moved = now[vertex as usize] - before[vertex as usize];
        (least, most, sum) = (least.min(moved), most.max(moved), sum + moved);
    }
    if sum.is_finite() { (least, most) } else { (DVec3::NEG_INFINITY, DVec3::INFINITY) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_common_motion_does_not_count_and_what_is_no_number_does() {
        let before = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let moved = |by: [DVec3; 3]| [0, 1, 2].map(|k| before[k] + by[k]);
        let of = |first: [DVec3; 3], second: [DVec3; 3]| {
            let [first, second] = [first, second].map(moved);
            approach([
                Displaced { vertices: &[0, 2], before: &before, now: &first },
                Displaced { vertices: &[1, 2], before: &before, now: &second },
            ])
        };
        let both = DVec3::new(3.0, -2.0, 1.0);
        assert!(of([both; 3], [both; 3]) < 1e-12);
        let nearer = of([both; 3], [both - 0.4 * DVec3::X; 3]);
        assert!((nearer - 0.4).abs() < 1e-12, "{nearer}");
        // Vertices that are not named may be anywhere.
        assert!(of([both, DVec3::NAN, both], [both; 3]) < 1e-12);
        assert!(of([both, both, DVec3::NAN], [both; 3]).is_nan());
    }
}
