//! The bonds from which the equations for the shares follow.

use glam::DVec3;

use super::alike::Kinds;
use super::body::HeldBody;
use super::lattice::{BondLattice, Placed};
use super::prism::SideParticles;
use super::zone::Zone;
use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::symmetry::{Ghosts, Repeat};

/// How far b of a particle depends on others, over the support radius: on its neighbours and on the
/// neighbours of these. Particles of a side are up to a spacing away from their places in the lattice.
const SEEN: f64 = 2.01;
/// Number of particles for each that stands for its kind below which all are taken.
const MANY: usize = 20;

/// The bonds around those particles that have an equation and stand for their kind.
pub(super) struct Lattices {
    /// The lattice as it is.
    pub now: BondLattice,
    /// The lattice before particles were put onto sides, with its mirror image behind those sides beside
    /// which the body is no prism; none where there are no such sides.
    pub mirrored: Option<BondLattice>,
    /// Whether along each axis the body is a prism beside all sides.
    is_prism: [bool; 3],
}

impl Lattices {
    /// None where bonds cannot be computed.
    pub fn of(body: &HeldBody<'_>, zone: &Zone, kinds: &Kinds) -> Option<Self> {
        let plan = body.plan;
        let place = |k: u32| plan.sites[k as usize].position;
        let with_equation = zone.equations.iter().map(|own| own.0).filter(|at| kinds.is_typical(*at));
        let centers = with_equation.map(|at| place(zone.asked[at as usize])).collect();
        let now: Vec<DVec3> = zone.seen.iter().map(|&k| place(k)).collect();
        let is_near = near(body, &now, centers)?;
        let near = |places: &[DVec3]| -> Vec<Placed> {
            let all = zone.seen.iter().copied().zip(places.iter().copied());
            all.zip(&is_near).filter(|(_, is_near)| **is_near).map(|(own, _)| own).collect()
        };
        let mut before = now.clone();
        for (k, way) in plan.sides.iter().flat_map(|side| &side.moved) {
            if let Ok(at) = zone.seen.binary_search(k) {
                // Two conditions may hold one side.
                let axis = way.abs().max_position();
                before[at][axis] = now[at][axis] - way[axis];
            }
        }
        let (mut repeats, mut is_prism) = (body.repeats.to_vec(), [true; 3]);
        for side in &plan.sides {
            let (axis, at) = side.plane;
            let mirror = Repeat::Mirror { axis, at };
            let beside = SideParticles { side, places: &before, depth: zone.depth_beside(body, side) };
            if !repeats.contains(&mirror) && !beside.is_prism(body) {
                is_prism[axis] = false;
                repeats.push(mirror);
            }
        }
        let mirrored = if is_prism == [true; 3] {
            None
        } else {
            Some(BondLattice::new(body, &near(&before), &repeats)?)
        };
        Some(Self { now: BondLattice::new(body, &near(&now), body.repeats)?, mirrored, is_prism })
    }

    /// The lattice with the mirror images by which a stress along a direction is to be balanced; none where
    /// it is to be in balance by itself.
    pub fn mirrored_along(&self, normal: DVec3) -> Option<&BondLattice> {
        self.mirrored.as_ref().filter(|_| !self.is_prism[normal.abs().max_position()])
    }
}

/// Which particles are so near to one of some places that the balance there depends on them.
fn near(body: &HeldBody<'_>, own: &[DVec3], places: Vec<DVec3>) -> Option<Vec<bool>> {
    if MANY * places.len() > own.len() {
        return Some(vec![true; own.len()]);
    }
    let mut ghosts = Ghosts::new(own.len());
    let radius = SEEN * body.support + body.plan.spacing;
    let rows = ghosts.add(0..own.len(), own, radius, body.repeats);
    let all: Vec<DVec3> = own.iter().copied().chain(rows.map(|row| ghosts.place(own, row))).collect();
    let (mut lists, mut is_near) = (NeighborList::default(), vec![false; own.len()]);
    let (targets, sources) = (Cloud::uniform(&places, radius), Cloud::uniform(&all, radius));
    NeighborSearch::default().between(targets, sources, 0.0, &Periodic::NONE, &mut lists).ok()?;
    for row in (0..places.len()).flat_map(|k| lists.row(k)) {
        is_near[ghosts.source(*row as usize)] = true;
    }
    Some(is_near)
}
