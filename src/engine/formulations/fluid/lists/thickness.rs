//! Thickness of bodies beside a fluid.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::linalg::{Eigen, Sym3};
use crate::neighbors::{Cloud, NeighborList, Periodic};
use crate::plugin::{BodyPlan, SetupError};

/// Part of the particles of a body that may sit where it is thinner than the support: sharp edges have some.
const THIN_SHARE: f64 = 0.05;
/// Share of the most neighbours within half of the support that a particle has in the middle of a ball which
/// lies inside of the body.
const FULL: f64 = 0.9;

/// Where a body is thinner than the support.
pub struct Thin {
    /// Minimum thickness, m.
    pub thickness: f64,
    /// Where that is, m.
    pub at: DVec3,
    /// Whether it is more than edges and fins.
    pub is_widespread: bool,
}

/// The thickness of a body at its particles.
pub struct Thickness {
    positions: Vec<DVec3>,
    spacing: f64,
    /// Support radius of the fluid, m.
    pub support: f64,
    /// Neighbours within the support.
    pub neighbors: NeighborList,
    /// Extent of the neighbours along the axis in which they are closest together, m.
    values: Vec<f64>,
}

impl Thickness {
    /// That of a body beside a fluid of that support, m.
    pub fn of(body: &BodyPlan, support: f64, periodic: &Periodic) -> Result<Self, SetupError> {
        let positions = body.sites.iter().map(|site| site.position).collect();
        Self::at(positions, body.spacing, support, periodic)
    }

    fn at(
        positions: Vec<DVec3>,
        spacing: f64,
        support: f64,
        periodic: &Periodic,
    ) -> Result<Self, SetupError> {
        let neighbors = NeighborList::reference(Cloud::uniform(&positions, support), periodic)
            .map_err(|error| SetupError::internal(&error))?;
        let plane = positions.iter().all(|x| x.z == positions[0].z);
        let thickness = |i: usize| {
            let row = || {
                let to = |&j: &u32| periodic.minimal_image(positions[j as usize] - positions[i]);
                neighbors.row(i).iter().map(to)
            };
            let across = axes(row(), plane).col(0);
            let (low, high) =
                row().map(|x| x.dot(across)).fold((0.0, 0.0), |(a, b): (f64, f64), x| (a.min(x), b.max(x)));
            high - low + spacing
        };
        let values = (0..positions.len()).into_par_iter().map(thickness).collect();
        Ok(Self { positions, spacing, support, neighbors, values })
    }

    /// Where the fluid sees through the body; none where that is but its edges, no deeper than that many
    /// supports.
    pub fn thin(&self, edges: usize) -> Option<Thin> {
        let thin = || (0..self.positions.len()).filter(|&i| self.is_thin(i));
        let thinnest = thin().min_by(|&a, &b| self.values[a].total_cmp(&self.values[b]))?;
        let is_widespread = thin().count() as f64 > THIN_SHARE * self.positions.len() as f64;
        let found = Thin { thickness: self.values[thinnest], at: self.positions[thinnest], is_widespread };
        (is_widespread || self.has_fins(edges)).then_some(found)
    }

    /// Whether a thin part ends farther from the thick part than that many supports: one is that of a fin or
    /// an edge below some 40 degrees, two that of a fin or an edge below 20.
    fn has_fins(&self, supports: usize) -> bool {
        let mut is_known: Vec<bool> = self.thin_parts().iter().map(|is_thin| !is_thin).collect();
        let mut front: Vec<usize> = (0..is_known.len()).filter(|&i| is_known[i]).collect();
        for _ in 0..supports {
            let mut next = Vec::new();
            for &j in front.iter().flat_map(|&i| self.neighbors.row(i)) {
                if !std::mem::replace(&mut is_known[j as usize], true) {
                    next.push(j as usize);
                }
            }
            front = next;
        }
        is_known.contains(&false)
    }

    fn is_thin(&self, i: usize) -> bool {
        self.values[i] < self.support - 0.25 * self.spacing
    }

    /// Whether each particle is in a thin part of the body: in no ball as wide as the support that lies
    /// inside of it. Where a fin meets a hull the thickness at a particle would not tell.
    pub fn thin_parts(&self) -> Vec<bool> {
        let radius = 0.5 * self.support;
        let near = |i: usize, radius: f64| {
            let within =
                move |j: &&u32| (self.positions[**j as usize] - self.positions[i]).length() <= radius;
            self.neighbors.row(i).iter().filter(within)
        };
        let particles = (0..self.positions.len()).into_par_iter();
        let counts: Vec<usize> = particles.map(|i| near(i, radius).count()).collect();
        let full = FULL * counts.iter().copied().max().unwrap_or(0) as f64;
        let is_core = |i: usize| !self.is_thin(i) && counts[i] as f64 >= full;
        let mut thin = vec![true; self.positions.len()];
        for i in (0..thin.len()).filter(|&i| is_core(i)) {
            thin[i] = false;
            near(i, radius + 0.5 * self.spacing).for_each(|&j| thin[j as usize] = false);
        }
        thin
    }
}

/// Axes along which some vectors spread, the smallest one first; in a plane that of z last.
pub fn axes(vectors: impl Iterator<Item = DVec3>, plane: bool) -> DMat3 {
    let spread = vectors.fold(Sym3::ZERO, |sum, x| sum + Sym3::dyad(x));
    // In a plane the third axis has no spread: it is not a side of the body.
    let spread = if plane { Sym3 { zz: 2.0 * (spread.xx + spread.yy) + 1.0, ..spread } } else { spread };
    Eigen::new(&spread).vectors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formulations::fluid::tests::simulation;
    use crate::world::{BodyId, ReferencePosition};

    /// A hull with a keel of 4 particles, or a wedge, beside a fluid of a support of 5.2 of their spacings.
    fn of(shape: &str) -> Thickness {
        let sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"wood": NeoHookean(density: 500.0, young: 1.0e6, poisson: 0.3)}},
                bodies: [(name: "boat", material: "wood", spacing: 1.0, formulation: TotalLagrangian, shape: {shape})],
                time: (end: 1.0))"#
        ));
        let (view, rows) = sim.world().body_view(BodyId(0));
        let places = view.read::<ReferencePosition>().expect("places");
        let positions = places[rows].iter().map(|x| x.0).collect();
        Thickness::at(positions, 1.0, 5.2, &Periodic::NONE).expect("neighbours")
    }

    #[test]
    fn a_keel_is_thin_and_its_hull_is_not() {
        let keel = |length: f64| {
            format!("Union([Box(min: (-24, 0), max: (24, 16)), Box(min: (-2, {}), max: (2, 0))])", -length)
        };
        let boat = of(&keel(18.0));
        let parts = boat.thin_parts();
        for (place, is_thin) in boat.positions.iter().zip(parts) {
            // Half of the support and a spacing around the root may count as hull.
            if place.y > 0.0 || place.y < -3.6 {
                assert_eq!(is_thin, place.y < 0.0, "{place}");
            }
        }
        assert!(
            boat.thin(1).is_some_and(|thin| (thin.thickness - 4.0).abs() < 0.5),
            "a keel of 3.5 supports"
        );
        assert!(of("Box(min: (-24, 0), max: (24, 16))").thin(1).is_none(), "a hull alone");
        assert!(
            of("Polygon(points: [(0, 0), (40, 23), (-40, 23)])").thin(1).is_none(),
            "a wedge of 120 degrees"
        );
        assert!(of("Polygon(points: [(0, 0), (14, 24), (-14, 24)])").thin(1).is_none(), "one of 60 degrees");
    }
}
