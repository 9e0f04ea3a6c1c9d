//! Images of bodies in contact, across periodic sides and symmetry planes.
//!
//! Across a periodic side the nearest image counts. Across symmetry planes the particles of the first body
//! touch mirror images of those of the second: a force on the first acts mirrored, with opposite sign, on the
//! source of the image. Of the two pairs of the whole problem, one is the mirror image of the other, and one
//! lies in the half that is computed.

use crate::symmetry::{Map, MirrorPlane, Repeat, maps_of};
use crate::world::BodyId;

/// The images of the second body that the first one may touch, beginning with that body itself: mirrored by
/// each plane that cuts both, and by planes at right angles together.
pub(super) fn mirrors(planes: &[MirrorPlane], first: BodyId, second: BodyId) -> Vec<Map> {
    let cuts = |plane: &&MirrorPlane| plane.bodies.contains(first) && plane.bodies.contains(second);
    maps_of(&planes.iter().filter(cuts).map(Repeat::from).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::world::BodySet;

    #[test]
    fn two_planes_make_three_images_and_a_third_body_none() {
        let plane = |axis, at, bodies: &[usize]| {
            let bodies = BodySet::new(bodies.iter().map(|k| BodyId(*k)));
            MirrorPlane { axis, at, bodies }
        };
        let planes = [plane(0, 1.0, &[0, 1]), plane(1, 0.0, &[0, 1, 2]), plane(0, 5.0, &[0])];
        let x = DVec3::new(0.25, 3.0, 7.0);
        let places = |first, second| {
            let mirrors = mirrors(&planes, BodyId(first), BodyId(second));
            mirrors.iter().map(|mirror| mirror.place(x)).collect::<Vec<_>>()
        };
        let expected = [(0.25, 3.0), (1.75, 3.0), (0.25, -3.0), (1.75, -3.0)];
        assert_eq!(places(0, 1), expected.map(|(x, y)| DVec3::new(x, y, 7.0)));
        assert_eq!(places(1, 2).len(), 2);
        // Opposite planes of one body have no images of images.
        assert_eq!(places(0, 0).len(), 6);
        assert_eq!(Map::IDENTITY.place(x), x);
    }
}
