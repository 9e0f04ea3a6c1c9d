//! Thickness of bodies beside a fluid.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::linalg::{Eigen, Sym3};
use crate::neighbors::{Cloud, NeighborList, Periodic};
use crate::plugin::{BodyPlan, SetupError};

/// Part of the particles of a body that may sit where it is thinner than the support: sharp edges have some.
const THIN_SHARE: f64 = 0.05;
/// Distance within which the neighbours of a particle tell whether it is an outermost one, over the spacing.
const BESIDE: f64 = 1.6;
/// Cosine of the angle from the outward direction within which an outermost particle has no such neighbour.
const OUTWARD: f64 = 0.5;
/// Depth of a part that has two sides, beyond where the body is thick, over the support.
const DEPTH: f64 = 1.5;

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
    periodic: Periodic,
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
        Ok(Self { positions, spacing, periodic: *periodic, support, neighbors, values })
    }

    /// Where the fluid would see through a wall; none where that is but its edges, no deeper than that many
    /// supports.
    pub fn thin(&self, edges: f64) -> Option<Thin> {
        let thin = || (0..self.positions.len()).filter(|&i| self.is_thin(i));
        let is_widespread = thin().count() as f64 > THIN_SHARE * self.positions.len() as f64;
        let found = Thin { is_widespread, ..self.thinnest(thin())? };
        (is_widespread || self.has_fins(&self.thin_parts(), edges)).then_some(found)
    }

    /// Where the body, or a part of it, is a sheet, whose sides have a pressure of their own each: no ball as
    /// wide as the support fits within one and a half supports. An edge of 25 degrees or more is none in a
    /// body of any size: there is one pressure around its tip, which fills little of the kernels of the
    /// fluid. If that did not see the other side, it would be drawn to the tip and leave it as a jet.
    pub fn sheet(&self) -> Option<Thin> {
        if !(0..self.positions.len()).any(|i| self.is_thin(i)) {
            return None;
        }
        let parts = self.thin_parts();
        let found = self.thinnest((0..parts.len()).filter(|&i| parts[i] && self.is_thin(i)))?;
        self.has_fins(&parts, DEPTH).then_some(found)
    }

    fn thinnest(&self, particles: impl Iterator<Item = usize>) -> Option<Thin> {
        let thinnest = particles.min_by(|&a, &b| self.values[a].total_cmp(&self.values[b]))?;
        Some(Thin { thickness: self.values[thinnest], at: self.positions[thinnest], is_widespread: false })
    }

    /// Whether a thin part ends farther from the thick part than that many supports: 1.5 are those of a fin
    /// or an edge below some 25 degrees, two those of a fin or an edge below 20.
    fn has_fins(&self, parts: &[bool], supports: f64) -> bool {
        let start = |is_thin: &bool| if *is_thin { f64::INFINITY } else { 0.0 };
        let mut distances: Vec<f64> = parts.iter().map(start).collect();
        let has_thin = |i: &usize| !parts[*i] && self.neighbors.row(*i).iter().any(|&j| parts[j as usize]);
        // The bits of numbers above zero rise with them.
        let mut waiting: BinaryHeap<_> = (0..parts.len()).filter(has_thin).map(|i| (Reverse(0), i)).collect();
        while let Some((Reverse(bits), i)) = waiting.pop() {
            let distance = f64::from_bits(bits);
            if distance > distances[i] {
                continue;
            }
            for j in self.near(i, self.support) {
                let farther = distance + self.from(i, j).length();
                if farther < distances[j].min(supports * self.support) {
                    distances[j] = farther;
                    waiting.push((Reverse(farther.to_bits()), j));
                }
            }
        }
        distances.contains(&f64::INFINITY)
    }

    fn is_thin(&self, i: usize) -> bool {
        self.values[i] < self.support - 0.25 * self.spacing
    }

    /// Whether each particle is in a thin part of the body: in no ball as wide as the support that lies
    /// inside of it. Where a fin meets a hull the thickness at a particle would not tell.
    pub fn thin_parts(&self) -> Vec<bool> {
        let particles = (0..self.positions.len()).into_par_iter();
        let outermost: Vec<bool> = particles.clone().map(|i| self.is_outermost(i)).collect();
        let radius = 0.5 * self.support;
        // An outermost particle is half a spacing below the surface, and the middle of the ball up to half a
        // spacing from a particle.
        let depth = radius - self.spacing;
        let is_deep = |i: usize| !outermost[i] && self.near(i, depth).all(|j| !outermost[j]);
        let is_core: Vec<bool> = particles.map(|i| !self.is_thin(i) && is_deep(i)).collect();
        let mut thin = vec![true; self.positions.len()];
        for i in (0..thin.len()).filter(|&i| is_core[i]) {
            thin[i] = false;
            self.near(i, radius + 0.5 * self.spacing).for_each(|j| thin[j] = false);
        }
        thin
    }

    /// Whether a particle has no neighbour beside it in the direction away from all of them.
    fn is_outermost(&self, i: usize) -> bool {
        let beside = || self.near(i, BESIDE * self.spacing).map(|j| self.from(i, j));
        let outward = -beside().sum::<DVec3>().normalize_or_zero();
        outward != DVec3::ZERO && beside().all(|x| x.dot(outward) < OUTWARD * x.length())
    }

    /// Neighbours within a radius up to the support, but for the particle itself.
    fn near(&self, i: usize, radius: f64) -> impl Iterator<Item = usize> + '_ {
        let others = self.neighbors.row(i).iter().map(|&j| j as usize).filter(move |&j| j != i);
        others.filter(move |&j| self.from(i, j).length() < radius)
    }

    /// From one particle to another, m.
    fn from(&self, i: usize, j: usize) -> DVec3 {
        self.periodic.minimal_image(self.positions[j] - self.positions[i])
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

    /// A body beside a fluid of a support of 5.2 of its spacings.
    fn of(shape: &str) -> Thickness {
        beside(shape, "Regular", 5.2)
    }

    /// A body in that lattice beside a fluid of that support, over its spacing.
    fn beside(shape: &str, lattice: &str, support: f64) -> Thickness {
        let sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"wood": NeoHookean(density: 500.0, young: 1.0e6, poisson: 0.3)}},
                bodies: [(name: "boat", material: "wood", spacing: 1.0, formulation: TotalLagrangian, shape: {shape}, lattice: {lattice})],
                time: (end: 1.0))"#
        ));
        let (view, rows) = sim.world().body_view(BodyId(0));
        let places = view.read::<ReferencePosition>().expect("places");
        let positions = places[rows].iter().map(|x| x.0).collect();
        Thickness::at(positions, 1.0, support, &Periodic::NONE).expect("neighbours")
    }

    /// A hull with a keel of 4 particles.
    fn keel(length: f64) -> String {
        format!("Union([Box(min: (-24, 0), max: (24, 16)), Box(min: (-2, {}), max: (2, 0))])", -length)
    }

    #[test]
    fn a_keel_is_thin_and_its_hull_is_not() {
        let boat = of(&keel(18.0));
        let parts = boat.thin_parts();
        for (place, is_thin) in boat.positions.iter().zip(parts) {
            // Half of the support and a spacing around the root may count as hull.
            if place.y > 0.0 || place.y < -3.6 {
                assert_eq!(is_thin, place.y < 0.0, "{place}");
            }
        }
        assert!(
            boat.thin(2.0).is_some_and(|thin| (thin.thickness - 4.0).abs() < 0.5),
            "a keel of 3.5 supports"
        );
        assert!(of("Box(min: (-24, 0), max: (24, 16))").thin(2.0).is_none(), "a hull alone");
        assert!(
            of("Polygon(points: [(0, 0), (40, 23), (-40, 23)])").thin(2.0).is_none(),
            "a wedge of 120 degrees"
        );
        assert!(
            of("Polygon(points: [(0, 0), (14, 24), (-14, 24)])").thin(2.0).is_none(),
            "one of 60 degrees"
        );
    }

    #[test]
    fn keels_and_thin_bodies_are_sheets_and_edges_are_not() {
        assert!([18.0, 14.0, 10.0].iter().all(|&length| of(&keel(length)).sheet().is_some()), "keels");
        assert!(of("Box(min: (0, 0), max: (24, 4))").sheet().is_some(), "a plate");
        assert!(of("Box(min: (0, 0), max: (3, 3))").sheet().is_some(), "a rod");
        let is_sheet = |angle: f64, length: f64, lattice: &str, support: f64| {
            let half = length * (0.5 * angle).to_radians().tan();
            let wedge =
                format!("Polygon(points: [(0, 0), ({length:?}, {half:?}), ({length:?}, {:?})])", -half);
            beside(&wedge, lattice, support).sheet().is_some()
        };
        for (length, support) in [(60.0, 5.2), (25.0, 5.2), (60.0, 2.6)] {
            for lattice in ["Regular", "BodyFitted()"] {
                let is_sheet = |angle| is_sheet(angle, length, lattice, support);
                assert!(support < 5.0 || is_sheet(20.0), "{length} {support} {lattice}");
                assert!(
                    [30.0, 45.0, 60.0, 80.0, 100.0].iter().all(|&angle| !is_sheet(angle)),
                    "{length} {support} {lattice}"
                );
            }
        }
    }
}
