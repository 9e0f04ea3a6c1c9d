//! Where the facets of a skin are in a step, with balls around them.

use glam::DVec3;

use crate::parallel::Lanes4;
use crate::skins::Patch;

/// Where the facets of a patch are in this step.
#[derive(Default)]
pub(super) struct FacetPlaces {
    /// Where the vertices are, m; segments have two, and the last one twice.
    pub corners: Vec<[DVec3; 3]>,
    /// A ball around each: its centre, and how far the facet reaches from there, with something for
    /// round-off, m.
    pub balls: Vec<Lanes4>,
}

impl FacetPlaces {
    /// None yet, with capacity for that many facets.
    pub fn with_capacity(count: usize) -> Self {
        Self { corners: Vec::with_capacity(count), balls: Vec::with_capacity(count) }
    }

    /// Computes where some facets of a patch are; there is a row for every facet of the skin.
    pub fn locate(&mut self, patch: &Patch, facets: &[u32]) {
        let (axes, count) = (patch.skin.facets.axes, patch.skin.facets.corners.len());
        self.corners.resize(count, [DVec3::ZERO; 3]);
        self.balls.resize(count, Lanes4::ZERO);
        for &facet in facets {
            let corners = patch.places(facet);
            let [a, b, c] = corners;
            let center = if axes == 2 { 0.5 * (a + b) } else { (a + b + c) / 3.0 };
            // One by one: a mapped array would be called.
            let farthest =
                a.distance_squared(center).max(b.distance_squared(center)).max(c.distance_squared(center));
            self.corners[facet as usize] = corners;
            self.balls[facet as usize] = Lanes4::new(center, farthest.sqrt() * (1.0 + 1e-9));
        }
    }

    /// Where the point with these shares of the vertices of a facet is, m.
    #[inline(always)]
    pub fn point(&self, facet: u32, shares: [f64; 3]) -> DVec3 {
        point(&self.corners[facet as usize], shares)
    }
}

/// The point of a facet with these shares of its vertices, m.
#[inline(always)]
pub(super) fn point(corners: &[DVec3; 3], shares: [f64; 3]) -> DVec3 {
    shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2]
}
