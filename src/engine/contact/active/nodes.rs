//! The particles of a body in contact in a step. The motion of their neighbourhoods is computed once for
//! each, and every particle sums the forces of its contacts in their order.

use glam::{DMat3, DVec3};

use super::contacts::Numbers;
use super::filter::BLOCKS_OF_TEST;
use crate::contact::bodies::Members;
use crate::contact::response::PairKey;
use crate::parallel::{Maximum, Picked, for_each_block, for_each_block_in_tasks, sum_over_blocks};
use crate::solids::{HeatCapacity, LocalMotion, SolidPhase};
use crate::world::{Force, Temperature};

/// In the place of a number in the list for particles that no candidate names.
const NONE: u32 = u32::MAX;

/// Which particle of a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::contact) enum ContactEnd {
    First,
    Second,
}

/// Force of a contact on one of its particles.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct NodeLoad {
    /// Force on the particle, N, and on which point beside it, in the reference configuration, m.
    pub force: DVec3,
    pub arm: DVec3,
    /// A force at the particle itself, N.
    pub beside: DVec3,
    /// Stiffness over mass, 1/s2.
    pub stiffness: f64,
    /// Heat, J.
    pub heat: f64,
}

/// The particles of a body that may touch: those that candidates name.
pub(in crate::contact) struct ContactNodes {
    /// Number in the lists of every particle of the body.
    numbers: Vec<u32>,
    /// Ascending.
    nodes: Vec<u32>,
    /// Where the ends of each begin.
    starts: Vec<u32>,
    /// Of every particle its candidates, ascending: twice their number, and one more where it is the second
    /// one.
    ends: Vec<u32>,
    local_motions: Vec<LocalMotion>,
    /// Sum of the forces on each, N.
    forces: Vec<DVec3>,
    /// Sums of f (x) A of forces on points A beside it, N m.
    couples: Vec<DMat3>,
    /// Sums of stiffness over mass of the contacts of each, 1/s2: a bound on the square of a frequency
    /// (Gershgorin).
    stiffness: Vec<f64>,
    /// Heat received by each in the step, J.
    heat: Vec<f64>,
}

impl ContactNodes {
    /// None of that many particles.
    pub fn new(particles: usize) -> Self {
        Self {
            numbers: vec![NONE; particles],
            nodes: Vec::new(),
            starts: Vec::new(),
            ends: Vec::new(),
            local_motions: Vec::new(),
            forces: Vec::new(),
            couples: Vec::new(),
            stiffness: Vec::new(),
            heat: Vec::new(),
        }
    }

    /// Allocates memory for that many candidates.
    pub fn reserve(&mut self, candidates: usize) {
        fn reserve_total<V>(list: &mut Vec<V>, count: usize) {
            list.reserve(count.saturating_sub(list.len()));
        }
        reserve_total(&mut self.ends, 2 * candidates);
        let count = (2 * candidates).min(self.numbers.len());
        reserve_total(&mut self.nodes, count);
        reserve_total(&mut self.starts, count + 1);
        reserve_total(&mut self.local_motions, count);
        reserve_total(&mut self.forces, count);
        reserve_total(&mut self.couples, count);
        reserve_total(&mut self.stiffness, count);
        reserve_total(&mut self.heat, count);
    }

    /// Takes in the particles of a new list of candidates, which stand at these ends.
    pub fn renew(&mut self, candidates: &[PairKey], ends: &[ContactEnd]) {
        if self.ends.capacity() < ends.len() * candidates.len() {
            self.reserve(2 * candidates.len());
        }
        let Self { numbers, nodes, starts, ends: sorted, .. } = self;
        nodes.drain(..).for_each(|node| numbers[node as usize] = NONE);
        let at = |key: &PairKey, end: ContactEnd| if end == ContactEnd::First { key.0 } else { key.1 };
        for node in candidates.iter().flat_map(|key| ends.iter().map(move |&end| at(key, end))) {
            let count = &mut numbers[node as usize];
            if *count == NONE {
                *count = 0;
                nodes.push(node);
            }
            *count += 1;
        }
        nodes.sort_unstable();
        starts.clear();
        let mut start = 0;
        for (number, &node) in (0..).zip(&*nodes) {
            starts.push(start);
            start += std::mem::replace(&mut numbers[node as usize], number);
        }
        sorted.resize(start as usize, 0);
        for (candidate, key) in (0..).zip(candidates) {
            for &end in ends {
                // The start of each particle moves to its end, where the next one starts.
                let place = &mut starts[numbers[at(key, end) as usize] as usize];
                sorted[*place as usize] = 2 * candidate + u32::from(end == ContactEnd::Second);
                *place += 1;
            }
        }
        starts.insert(0, 0);
        self.local_motions.resize(self.nodes.len(), LocalMotion::default());
    }

    /// The ends of a particle, by its number in the lists.
    fn ends(&self, number: usize) -> &[u32] {
        &self.ends[self.starts[number] as usize..self.starts[number + 1] as usize]
    }

    /// Computes the local motions of the nodes in contact, and their velocities if requested.
    pub fn look(&mut self, members: &Members<'_>, contacts: &Numbers, moving: bool) {
        let mut local_motions = std::mem::take(&mut self.local_motions);
        let all = &*self;
        for_each_block_in_tasks(
            BLOCKS_OF_TEST,
            &mut local_motions[..],
            &mut Vec::new(),
            &|first, found: &mut [LocalMotion]| {
                for (number, found) in (first..).zip(found) {
                    if all.ends(number).iter().any(|end| contacts.of(end / 2).is_some()) {
                        *found = members.local_motion(all.nodes[number] as usize, moving);
                    }
                }
            },
        );
        self.local_motions = local_motions;
    }

    /// The local_motions of a particle that touches.
    pub fn local_motion(&self, node: u32) -> &LocalMotion {
        &self.local_motions[self.numbers[node as usize] as usize]
    }

    /// Sums the forces of the contacts on every particle; `load` gives the force of one on the particle at
    /// that end.
    pub fn add_up(&mut self, contacts: &Numbers, load: &(impl Fn(usize, ContactEnd) -> NodeLoad + Sync)) {
        let count = self.nodes.len();
        let (mut forces, mut couples) = (std::mem::take(&mut self.forces), std::mem::take(&mut self.couples));
        let (mut stiffness, mut heat) = (std::mem::take(&mut self.stiffness), std::mem::take(&mut self.heat));
        forces.resize(count, DVec3::ZERO);
        couples.resize(count, DMat3::ZERO);
        stiffness.resize(count, 0.0);
        heat.resize(count, 0.0);
        let all = &*self;
        let rows = (&mut forces[..], &mut couples[..], &mut stiffness[..], &mut heat[..]);
        type Rows<'a> = (&'a mut [DVec3], &'a mut [DMat3], &'a mut [f64], &'a mut [f64]);
        for_each_block(rows, &mut Vec::new(), &|first, (forces, couples, stiffness, heats): Rows<'_>| {
            for k in 0..forces.len() {
                let (mut force, mut couple, mut stiff, mut heat) = (DVec3::ZERO, DMat3::ZERO, 0.0, 0.0);
                for end in all.ends(first + k) {
                    let Some(number) = contacts.of(end / 2) else { continue };
                    let load =
                        load(number, if end % 2 == 0 { ContactEnd::First } else { ContactEnd::Second });
                    let NodeLoad { force: push, arm, .. } = load;
                    force += push + load.beside;
                    couple += DMat3::from_cols(push * arm.x, push * arm.y, push * arm.z);
                    stiff += load.stiffness;
                    heat += load.heat;
                }
                (forces[k], couples[k], stiffness[k], heats[k]) = (force, couple, stiff, heat);
            }
        });
        (self.forces, self.couples, self.stiffness, self.heat) = (forces, couples, stiffness, heat);
    }

    /// Stiffness over mass of the contacts of a particle that touches, 1/s2.
    pub fn stiffness(&self, node: u32) -> f64 {
        self.stiffness[self.numbers[node as usize] as usize]
    }

    /// The largest stiffness over mass of the contacts of a particle, 1/s2.
    pub fn stiffest(&self) -> f64 {
        sum_over_blocks(&self.stiffness[..], &|_, stiffness: &[f64]| Maximum::of(stiffness.iter().copied())).0
    }

    /// Adds what acts on the neighbourhoods; `first` is the first row of the body.
    pub fn add_couples(&self, solid: &mut dyn SolidPhase, first: usize) {
        solid.add_couples(first, &self.nodes, &self.couples);
    }

    /// Warms the particles of a body, of those heat capacities, by what friction has given them.
    pub fn warm(&self, capacity: &HeatCapacity<'_>, temperature: &mut [Temperature]) {
        for (&node, heat) in self.nodes.iter().zip(&self.heat).filter(|(_, heat)| **heat != 0.0) {
            capacity.warm(node as usize, *heat, temperature);
        }
    }

    /// Adds what acts on the particles of a body.
    pub fn add_forces(&self, force: &mut [Force]) {
        let rows = (Picked::new(&self.nodes, force), &self.forces[..]);
        sum_over_blocks(rows, &|_, (mut rows, pushes): (Picked<'_, Force>, &[DVec3])| {
            // Nothing is added to those that do not touch, not even zero, which might change a sign.
            for (k, push) in pushes.iter().enumerate().filter(|(_, push)| **push != DVec3::ZERO) {
                rows.row(k).0 += *push;
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_knows_its_candidates_at_either_end() {
        let candidates = [(1, 4), (1, 9), (3, 4), (4, 4), (9, 1)];
        let mut contact_nodes = ContactNodes::new(10);
        contact_nodes.renew(&[(0, 8), (8, 2)], &[ContactEnd::First]);
        for (ends, expected) in [
            (&[ContactEnd::First][..], vec![(1, vec![0, 2]), (3, vec![4]), (4, vec![6]), (9, vec![8])]),
            (&[ContactEnd::Second], vec![(1, vec![9]), (4, vec![1, 5, 7]), (9, vec![3])]),
            (
                &[ContactEnd::First, ContactEnd::Second],
                vec![(1, vec![0, 2, 9]), (3, vec![4]), (4, vec![1, 5, 6, 7]), (9, vec![3, 8])],
            ),
        ] {
            contact_nodes.renew(&candidates, ends);
            let found: Vec<_> = contact_nodes
                .nodes
                .iter()
                .zip(0..)
                .map(|(&node, k)| (node, contact_nodes.ends(k).to_vec()))
                .collect();
            assert_eq!(found, expected);
            assert!(
                expected.iter().zip(0..).all(|((node, _), k)| contact_nodes.numbers[*node as usize] == k)
            );
            assert_eq!(
                contact_nodes.numbers.iter().filter(|&&number| number != NONE).count(),
                expected.len()
            );
        }
    }
}
