//! The part of a skin that may soon come near another body.

use crate::skins::Skin;

/// Gap over the spacing, beyond that of facets that are near, up to which facets belong to the region.
const BEYOND: f64 = 6.0;

/// Facets and their vertices, both ascending.
pub(in crate::contact) struct SkinRegion {
    /// How far the bodies may still move until other facets are near, m.
    pub left: f64,
    pub facets: Vec<u32>,
    pub vertices: Vec<u32>,
}

impl SkinRegion {
    /// None yet, with capacity for all of a skin.
    pub fn new(skin: &Skin) -> Self {
        let (vertices, facets) = (skin.vertices() * skin.facets.axes * 3, skin.facets.corners.len());
        Self { left: 0.0, facets: Vec::with_capacity(facets), vertices: Vec::with_capacity(vertices) }
    }

    /// Whether it has to be chosen again.
    pub fn is_old(&self) -> bool {
        self.left.is_nan() || self.left <= 0.0
    }

    /// Makes it the whole skin.
    pub fn take_all(&mut self, skin: &Skin) {
        self.facets.clear();
        self.facets.extend(0..skin.facets.corners.len() as u32);
        self.vertices.clear();
        self.vertices.extend(0..skin.vertices() as u32);
    }

    /// Chooses the facets by their minimum distance from the other body, m: those closer than `near`, m, are
    /// searched.
    pub fn choose(&mut self, skin: &Skin, near: f64, gap: impl Fn(u32) -> f64) {
        let within = near + BEYOND * skin.spacing;
        self.left = f64::INFINITY;
        self.facets.clear();
        for facet in 0..skin.facets.corners.len() as u32 {
            let gap = gap(facet);
            if gap < within {
                self.facets.push(facet);
            } else {
                self.left = self.left.min(gap - near);
            }
        }
        self.vertices.clear();
        self.vertices.extend(self.facets.iter().flat_map(|&facet| skin.corners_of(facet)));
        self.vertices.sort_unstable();
        self.vertices.dedup();
    }
}
