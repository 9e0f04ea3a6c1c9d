//! Loads by `surface` that reach a side held along its normal alone.

use crate::plugin::BodyPlan;
use crate::shapes::directed_area;
use crate::skins::Skin;

/// A facet counts as across a side if no more of its normal is along that of the side.
const ACROSS: f64 = 0.7;

/// The warning of a load on these facets of a body, if one of them ends at such a side.
pub(super) fn warning(label: &str, body: &BodyPlan, skin: &Skin, facets: &[u32]) -> Option<String> {
    let (axes, tolerance) = (skin.facets.axes, 1e-6 * skin.spacing);
    let reaches = |facet: u32, (axis, at): (usize, f64)| {
        let [a, b, c] = skin.facets.corners[facet as usize].map(|vertex| skin.facets.points[vertex as usize]);
        let normal = directed_area(axes, &[a, b, c]).normalize_or_zero();
        normal[axis].abs() < ACROSS && [a, b, c].iter().any(|x| (x[axis] - at).abs() < tolerance)
    };
    let side = body.sides.iter().find(|side| facets.iter().any(|&facet| reaches(facet, side.plane)))?;
    side.reached_by(&format!("the {label} on the surface of body `{}`", body.name))
}
