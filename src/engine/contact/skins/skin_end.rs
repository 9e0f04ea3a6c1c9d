//! Where a skin ends, at symmetry planes.

use super::foot::Foot;
use crate::contact::bodies::ContactSides;
use crate::skins::Patch;

/// Distance from a symmetry plane over the spacing, up to which a point lies on it.
const ON_PLANE: f64 = 1e-6;

/// How much of a point with that foot counts: half of one on a symmetry plane, and nothing of one behind it,
/// which is the image of another. Along periodic axes a skin has no end.
pub(super) fn share_at_end(patch: &Patch, sides: &ContactSides, foot: &Foot) -> f64 {
    let skin = &patch.skin;
    let (axes, corners) = (skin.facets.axes, skin.corners_of(foot.facet));
    let reference = |vertex: u32| skin.facets.points[vertex as usize];
    let mut share = 1.0f64;
    for k in (0..axes).filter(|&k| foot.shares[k] == 0.0) {
        let side = || (0..axes).filter(|&other| other != k).map(|other| corners[other]);
        let first = corners[(k + 1) % axes];
        let is_of = |facet: &&u32| side().all(|vertex| skin.corners_of(**facet).contains(&vertex));
        if skin.facets_at(first).iter().filter(is_of).count() > 1 {
            continue;
        }
        // Planes are across an axis.
        let mut outward = reference(first) - reference(corners[k]);
        if axes == 3 {
            let along = (reference(corners[(k + 2) % 3]) - reference(first)).normalize_or_zero();
            outward = outward.reject_from_normalized(along);
        }
        let axis = outward.abs().max_position();
        if sides.periodic.axes()[axis] {
            continue;
        }
        let beyond = outward[axis].signum() * (foot.x - patch.vertex(first).place)[axis];
        let on_plane = ON_PLANE * skin.spacing;
        share *= if beyond > on_plane {
            0.0
        } else if beyond < -on_plane {
            1.0
        } else {
            0.5
        };
    }
    share
}
