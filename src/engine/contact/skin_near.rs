//! Which facets of a skin may touch a tool, found again when the bodies may have moved by the skin of the search.

use glam::DVec3;

use crate::parallel::for_each_block;
use crate::rigid::RigidBody;
use crate::skins::{Skin, SkinView};

/// Gap over the spacing up to which a facet is a candidate.
const NEAR: f64 = 1.5;
/// Gap that is left when the candidates are found again: a facet is one for some steps before it touches.
pub(super) const MARGIN: f64 = 0.5;
/// Speed of a point of a skin over the largest one of particles, at most: its weights add up to one, and some are negative.
pub(super) const FASTER: f64 = 3.0;

/// The facets near a tool.
pub(super) struct NearTool {
    /// How far the bodies may still move until there are others, m.
    left: f64,
    places: Vec<(u32, DVec3, f64)>,
    /// The facets near the tool, ascending.
    pub facets: Vec<u32>,
}

impl NearTool {
    /// None yet, with room for all of a skin.
    pub fn new(skin: &Skin) -> Self {
        let (vertices, facets) = (skin.vertices(), skin.facets.corners.len());
        Self { left: 0.0, places: Vec::with_capacity(vertices), facets: Vec::with_capacity(facets) }
    }

    /// Takes in a step of that length, s, with largest speeds of skin and tool, m/s. Says whether the facets have to be found again.
    pub fn is_old(&mut self, speeds: [f64; 2], dt: f64) -> bool {
        self.left -= (FASTER * speeds[0] + speeds[1]) * dt;
        // What is not a number must not keep old candidates.
        self.left.is_nan() || self.left <= 0.0
    }

    /// Finds the facets near the tool.
    pub fn find(&mut self, skin: &Skin, view: &SkinView<'_>, tool: &RigidBody) {
        let vertices = (0..skin.vertices() as u32).map(|vertex| (vertex, DVec3::ZERO, 0.0));
        self.places.clear();
        self.places.extend(vertices);
        for_each_block(&mut self.places[..], &mut Vec::new(), &|_, places: &mut [(u32, DVec3, f64)]| {
            for (vertex, place, distance) in places {
                *place = view.place(*vertex);
                *distance = tool.surface.closest(tool.reference(*place)).signed_distance;
            }
        });
        let near = NEAR * skin.spacing;
        self.left = f64::INFINITY;
        self.facets.clear();
        for facet in 0..skin.facets.corners.len() as u32 {
            let [a, b, c] = skin.facets.corners[facet as usize].map(|vertex| self.places[vertex as usize]);
            // No point of a facet is farther from all its corners than that.
            let size = a.1.distance(b.1).max(b.1.distance(c.1)).max(c.1.distance(a.1));
            let gap = a.2.min(b.2).min(c.2) - 0.6 * size;
            if gap < near {
                self.facets.push(facet);
            } else {
                self.left = self.left.min(gap);
            }
        }
        self.left -= MARGIN * skin.spacing;
    }
}
