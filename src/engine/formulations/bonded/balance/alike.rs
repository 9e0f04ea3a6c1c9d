//! Particles beside a side with equal neighbourhoods: they carry the same share.
//!
//! Two particles are alike where distances, volumes and conditions are the same up to a number of neighbours
//! away: each gets a label from those of its neighbours at their distances, some times over. Far from the
//! edges of a side there is one kind of particle in every layer; where a lattice is irregular every particle
//! is a kind of its own.

use glam::DVec3;
use rayon::prelude::*;

use super::body::HeldBody;
use super::labels::{LENGTH, mix};
use super::zone::Zone;
use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::symmetry::Ghosts;

/// How many neighbours away particles are compared: twelve spacings of a cubic lattice, over which the effect
/// of an edge on shares falls to 1e-3.
const LEVELS: usize = 6;
/// The kinds of the particles of a zone.
pub(super) struct Kinds {
    /// Kind of each of them.
    pub of: Vec<u32>,
    /// Of each kind: how many particles are of it.
    pub counts: Vec<u32>,
    /// Of each kind: the one of these that stands for all.
    typical: Vec<u32>,
}

impl Kinds {
    /// Those of a zone whose neighbours are listed.
    pub fn of(zone: &Zone, lists: &ZoneParticles) -> Self {
        let mut labels = zone.labels.clone();
        for _ in 0..LEVELS {
            labels = lists.next(&labels);
        }
        let mut known = labels.clone();
        known.sort_unstable();
        known.dedup();
        let kind = |label: &u64| known.binary_search(label).unwrap_or_default() as u32;
        let of: Vec<u32> = labels.par_iter().map(kind).collect();
        let mut counts = vec![0; known.len()];
        of.iter().for_each(|kind| counts[*kind as usize] += 1);
        let typical = lists.typical(&of, &counts);
        Self { of, counts, typical }
    }

    /// Kind of a particle of the body, if something is asked of it in the zone.
    pub fn of_particle(&self, zone: &Zone, number: u32) -> Option<u32> {
        zone.place_of(number).map(|at| self.of[at as usize])
    }

    /// Whether a particle stands for its kind.
    pub fn is_typical(&self, at: u32) -> bool {
        self.typical[self.of[at as usize] as usize] == at
    }

    /// Root of the number of particles of the kind of a particle.
    pub fn weight(&self, at: u32) -> f64 {
        f64::from(self.counts[self.of[at as usize] as usize]).sqrt()
    }
}

/// The particles of which a zone asks something, with those neighbours of each that are among them.
pub(super) struct ZoneParticles {
    /// Of each row, ghosts included: the particle that it is or images.
    source: Vec<u32>,
    lists: NeighborList,
    /// Of every pair of the lists: what tells its length from others.
    lengths: Vec<u32>,
    /// Number of particles without ghosts.
    count: usize,
}

impl ZoneParticles {
    /// None where neighbours cannot be found.
    pub fn of(body: &HeldBody<'_>, zone: &Zone) -> Option<Self> {
        let own: Vec<DVec3> = zone.asked.iter().map(|&k| body.plan.sites[k as usize].position).collect();
        let mut ghosts = Ghosts::new(own.len());
        let rows = ghosts.add(0..own.len(), &own, body.support, body.repeats);
        let position: Vec<DVec3> =
            own.iter().copied().chain(rows.clone().map(|row| ghosts.place(&own, row))).collect();
        let source = (0..rows.end).map(|row| ghosts.source(row) as u32).collect();
        let mut lists = NeighborList::default();
        let cloud = Cloud::uniform(&position, body.support);
        NeighborSearch::default().within(cloud, 0.0, &Periodic::NONE, &mut lists).ok()?;
        let mut lengths = vec![0; lists.pairs()];
        let per_length = 1.0 / (LENGTH * body.plan.spacing);
        for i in 0..lists.rows() {
            for (length, j) in lengths[lists.range(i)].iter_mut().zip(lists.row(i)) {
                *length = (position[*j as usize].distance(position[i]) * per_length).round() as u32;
            }
        }
        Some(Self { source, lists, lengths, count: own.len() })
    }

    /// Labels that know one neighbour more.
    fn next(&self, labels: &[u64]) -> Vec<u64> {
        let label = |i: usize| {
            let row = self.lists.row(i).iter().zip(&self.lengths[self.lists.range(i)]);
            let of_pair = |(j, length): (&u32, &u32)| {
                mix(labels[self.source[*j as usize] as usize] ^ (u64::from(*length) << 32))
            };
            mix(row.map(of_pair).fold(labels[i], u64::wrapping_add))
        };
        (0..labels.len()).into_par_iter().map(label).collect()
    }

    /// Of each kind that one whose neighbours are of the most frequent kinds, of equal ones the first: others
    /// are at the edge of their kind.
    fn typical(&self, of: &[u32], counts: &[u32]) -> Vec<u32> {
        let frequency = |i: usize| -> u64 {
            let neighbors = self.lists.row(i).iter().map(|j| of[self.source[*j as usize] as usize]);
            neighbors.map(|kind| u64::from(counts[kind as usize])).sum()
        };
        let frequencies: Vec<u64> = (0..self.count).into_par_iter().map(frequency).collect();
        let mut best: Vec<Option<u32>> = vec![None; counts.len()];
        for (i, kind) in (0..).zip(of) {
            let best = &mut best[*kind as usize];
            if best.is_none_or(|other| frequencies[other as usize] < frequencies[i as usize]) {
                *best = Some(i);
            }
        }
        best.into_iter().flatten().collect()
    }
}
