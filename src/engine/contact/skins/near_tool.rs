//! Facets of a skin that may touch a tool, searched again when the bodies may have moved by the skin of the
//! search.
//!
//! The search covers a region of the skin, which is searched again when the bodies may have moved a few
//! spacings.

use glam::DVec3;

use super::region::SkinRegion;
use crate::contact::bodies::ContactSides;
use crate::parallel::{Picked, for_each_block};
use crate::rigid::RigidBody;
use crate::skins::{Skin, SkinView};

/// Gap over the spacing up to which a facet is a candidate.
const NEAR: f64 = 1.5;
/// Gap that is left when the candidates are found again: a facet is one for some steps before it touches.
pub(super) const MARGIN: f64 = 0.5;
/// Speed of a point of a skin over the largest one of particles, at most, both relative to a velocity of the
/// body: its weights add up to one, and some are negative.
pub(super) const FASTER: f64 = 3.0;

/// The facets near a tool.
pub(super) struct NearTool {
    /// How far the bodies may still move until there are others, m.
    left: f64,
    region: SkinRegion,
    /// Where the vertices are, m, and how far from the tool.
    places: Vec<(DVec3, f64)>,
    /// The facets near the tool, ascending.
    pub facets: Vec<u32>,
}

impl NearTool {
    /// None yet, with capacity for all of a skin.
    pub fn new(skin: &Skin) -> Self {
        let (vertices, facets) = (skin.vertices(), skin.facets.corners.len());
        let places = vec![(DVec3::ZERO, f64::INFINITY); vertices];
        Self { left: 0.0, region: SkinRegion::new(skin), places, facets: Vec::with_capacity(facets) }
    }

    /// Takes in a step of that length, s, with largest speeds of skin and tool, m/s. Says whether the facets
    /// have to be found again.
    pub fn is_old(&mut self, speeds: [f64; 2], dt: f64) -> bool {
        let way = (FASTER * speeds[0] + speeds[1]) * dt;
        self.left -= way;
        self.region.left -= way;
        // What is not a number must not keep old candidates.
        self.left.is_nan() || self.left <= 0.0
    }

    /// Has all facets searched again.
    pub fn forget(&mut self) {
        (self.left, self.region.left) = (0.0, 0.0);
    }

    /// Finds the facets near the tool.
    pub fn find(&mut self, skin: &Skin, view: &SkinView<'_>, sides: &ContactSides, tool: &RigidBody) {
        let near = NEAR * skin.spacing;
        if self.region.is_old() {
            self.region.take_all(skin);
            self.look(view, sides, tool);
            let places = &self.places;
            self.region.choose(skin, near, |facet| gap(skin, places, facet));
        } else {
            self.look(view, sides, tool);
        }
        self.left = self.region.left + near;
        self.facets.clear();
        for &facet in &self.region.facets {
            let gap = gap(skin, &self.places, facet);
            if gap < near {
                self.facets.push(facet);
            } else {
                self.left = self.left.min(gap);
            }
        }
        self.left -= MARGIN * skin.spacing;
    }

    /// Computes the positions of the vertices of the region.
    fn look(&mut self, view: &SkinView<'_>, sides: &ContactSides, tool: &RigidBody) {
        let rows = Picked::new(&self.region.vertices, &mut self.places);
        type Rows<'a> = Picked<'a, (DVec3, f64)>;
        for_each_block(rows, &mut Vec::new(), &|_, mut rows: Rows<'_>| {
            view.places(rows.numbers(), &mut |k, place, _| {
                *rows.row(k) = (place, sides.closest(place, tool).signed_distance);
            });
        });
    }
}

/// How far a facet is from the tool at least, m: no point of it is farther from all its corners than 0.6
/// times its longest side.
fn gap(skin: &Skin, places: &[(DVec3, f64)], facet: u32) -> f64 {
    let [a, b, c] = skin.facets.corners[facet as usize].map(|vertex| places[vertex as usize]);
    let size = a.0.distance(b.0).max(b.0.distance(c.0)).max(c.0.distance(a.0));
    a.1.min(b.1).min(c.1) - 0.6 * size
}
