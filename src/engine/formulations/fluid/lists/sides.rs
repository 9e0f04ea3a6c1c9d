//! Bodies that are somewhere thinner than the support of the fluid: fluid particles on their two sides do not
//! interact there.
//!
//! Such a body is in the cloud twice, once for each side, with a pressure of its own for either. A fluid
//! particle interacts with the copy of its side, with the whole thickness of the body. The side follows from
//! the sign of n_j . x_ji, with the current normal n_j of the deformed body. Pairs of fluid particles through
//! the body, in at one face and out at the other, are left out; those across the corner of a free end are
//! not, as nothing would fill the part of the kernel that they do. Both are decided where the lists are
//! built, in the same way for i and j, so that every force keeps its opposite.

use std::collections::BinaryHeap;
use std::ops::Range;

use glam::DVec3;

use super::thickness::{Thickness, axes};
use crate::neighbors::{NeighborList, Periodic};
use crate::plugin::BodyPlan;
use crate::world::Removed;

/// A line between two particles crosses a body within this distance of one of its particles, over their
/// spacing.
const REACH: f64 = 0.8;
/// Difference of two distances that is round-off, over the spacing.
const EQUAL: f64 = 1e-9;

/// A thin body and its two copies in the cloud.
#[derive(Clone, Debug)]
pub struct ThinBody {
    /// Rows of the copies for the side of the normal and for the other.
    pub copies: [Range<usize>; 2],
    spacing: f64,
    frames: Vec<SurfaceFrame>,
    /// Whether a particle is on the face to the side of the normal, and on the other; neither if it has been
    /// removed.
    faces: Vec<[bool; 2]>,
    /// Whether a particle has been removed.
    removed: Vec<bool>,
    /// Initial positions, m, and neighbours in the thin parts.
    sites: Vec<DVec3>,
    neighbors: NeighborList,
}

/// Neighbours before and behind a particle along the two directions of the mid-surface, as numbers in the
/// body.
#[derive(Clone, Debug)]
struct SurfaceFrame {
    along: [u32; 2],
    /// None in two dimensions, where the other direction is that of z.
    across: Option<[u32; 2]>,
    /// The two directions in the initial configuration, over the spacing, 1/m.
    directions: [DVec3; 2],
    /// One or minus one, so that normals of neighbours point to one side.
    sign: f64,
}

impl ThinBody {
    /// The body with its copies in the cloud; `thickness` is that without periods.
    pub fn new(body: &BodyPlan, copies: [Range<usize>; 2], thickness: Thickness, plane: bool) -> Self {
        let sites: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
        let thin = thickness.thin_parts();
        let mut list = thickness.neighbors;
        // Where the body is thick it has no mid-surface, normals are zero, and all sides see the first copy.
        list.retain(|i, j| thin[i] && thin[j as usize]);
        let mut frames: Vec<SurfaceFrame> = (0..sites.len())
            .map(|i| {
                let axes = axes(list.row(i).iter().map(|&j| sites[j as usize] - sites[i]), plane);
                SurfaceFrame {
                    along: [i as u32; 2],
                    across: (!plane).then_some([i as u32; 2]),
                    directions: [axes.col(1), axes.col(2)].map(|axis| axis / body.spacing),
                    sign: 1.0,
                }
            })
            .collect();
        let removed = vec![false; sites.len()];
        frames.iter_mut().enumerate().for_each(|(i, frame)| frame.span(i, &sites, list.row(i), &removed));
        let normals: Vec<DVec3> = frames.iter().map(|frame| frame.normal(|k| sites[k])).collect();
        orient(&mut frames, &normals, &list);
        let faces = vec![[false; 2]; sites.len()];
        let mut thin = Self { copies, spacing: body.spacing, frames, faces, removed, sites, neighbors: list };
        thin.find_faces();
        thin
    }

    /// Takes note of the particles that have been removed, and says how many they are in the thin parts. What
    /// was below them is the face now.
    pub fn take_out(&mut self, removed: &[Removed]) -> u64 {
        let mut has_changed = false;
        for (known, now) in self.removed.iter_mut().zip(removed) {
            has_changed |= std::mem::replace(known, *now != Removed::NO) != *known;
        }
        if has_changed {
            let Self { frames, removed, sites, neighbors, .. } = self;
            for (i, frame) in frames.iter_mut().enumerate() {
                frame.span(i, sites, neighbors.row(i), removed);
            }
            self.find_faces();
        }
        let gone = self.removed.iter().enumerate().filter(|(_, removed)| **removed);
        gone.map(|(i, _)| u64::from(!self.neighbors.row(i).is_empty())).sum()
    }

    /// Finds the particles on the faces: no neighbour is straight above them, or below.
    fn find_faces(&mut self) {
        let Self { spacing, frames, faces, removed, sites, neighbors, .. } = self;
        for (i, faces) in faces.iter_mut().enumerate() {
            *faces = [!removed[i]; 2];
            let normal = frames[i].normal(|k| sites[k]).normalize_or_zero();
            for &j in neighbors.row(i).iter().filter(|&&j| !removed[j as usize]) {
                let x = sites[j as usize] - sites[i];
                let height = x.dot(normal);
                if (x - height * normal).length() < REACH * *spacing {
                    faces[0] &= height < 0.5 * *spacing;
                    faces[1] &= height > -0.5 * *spacing;
                }
            }
        }
    }

    /// Number in the body of row `j` of the cloud, if it is of one of the copies.
    pub fn particle(&self, j: usize) -> Option<usize> {
        self.copies.iter().find(|copy| copy.contains(&j)).map(|copy| j - copy.start)
    }

    /// The row of particle `k` in the copy that a fluid particle in some direction from it sees, from the
    /// positions of the cloud.
    pub fn copy_seen(&self, k: usize, direction: DVec3, position: impl Fn(usize) -> DVec3) -> usize {
        let is_behind = self.normal(k, position).dot(direction) < 0.0;
        self.copies[usize::from(is_behind)].start + k
    }

    /// Normal at particle `k`, of any length, from the positions of the cloud.
    fn normal(&self, k: usize, position: impl Fn(usize) -> DVec3) -> DVec3 {
        self.frames[k].normal(|j| position(self.copies[0].start + j))
    }
}

impl SurfaceFrame {
    /// Takes, of particle `i` and its neighbours that are there, those farthest along the two directions.
    fn span(&mut self, i: usize, sites: &[DVec3], neighbors: &[u32], removed: &[bool]) {
        let farthest = |direction: DVec3| {
            let lead = |j: u32| (sites[j as usize] - sites[i]).dot(direction);
            let better = |best: u32, &j: &u32| if lead(j) > lead(best) + EQUAL { j } else { best };
            neighbors.iter().filter(|&&j| !removed[j as usize]).fold(i as u32, better)
        };
        let [along, across] = self.directions.map(|axis| [farthest(-axis), farthest(axis)]);
        self.along = along;
        self.across = self.across.map(|_| across);
    }

    fn normal(&self, position: impl Fn(usize) -> DVec3) -> DVec3 {
        let between = |[from, to]: [u32; 2]| position(to as usize) - position(from as usize);
        self.sign * between(self.along).cross(self.across.map_or(DVec3::Z, between))
    }
}

/// Turns the normals of neighbours to one side: from each particle that is known to the one that is most
/// parallel to it.
fn orient(frames: &mut [SurfaceFrame], normals: &[DVec3], list: &NeighborList) {
    let mut known = vec![false; frames.len()];
    let mut waiting = BinaryHeap::new();
    for start in 0..frames.len() {
        waiting.push((0, start, start));
        while let Some((_, i, j)) = waiting.pop() {
            if std::mem::replace(&mut known[j], true) {
                continue;
            }
            frames[j].sign = if (frames[i].sign * normals[i]).dot(normals[j]) < 0.0 { -1.0 } else { 1.0 };
            for &k in list.row(j) {
                let cosine = normals[j].normalize_or_zero().dot(normals[k as usize].normalize_or_zero());
                // The bits of numbers above zero rise with them.
                waiting.push((cosine.abs().to_bits(), j, k as usize));
            }
        }
    }
}

/// Decides which pairs of the lists see each other.
pub struct Sides<'a> {
    pub thin: &'a [ThinBody],
    pub positions: &'a [DVec3],
    pub periodic: &'a Periodic,
    /// Number of fluid particles.
    pub fluid: usize,
}

impl Sides<'_> {
    /// Whether fluid particle `i` sees particle `j` of the cloud; `walls` holds the boundary particles near
    /// fluid particles, seen or not.
    pub fn sees(&self, i: usize, j: usize, walls: &NeighborList) -> bool {
        if j < self.fluid {
            return i == j || !self.thin.iter().any(|body| self.hides(body, i.min(j), i.max(j), walls));
        }
        for body in self.thin {
            if let Some(k) = body.particle(j) {
                return body.copy_seen(k, self.from(j, i), |row| self.positions[row]) == j;
            }
        }
        true
    }

    /// From one particle to another, m.
    fn from(&self, j: usize, i: usize) -> DVec3 {
        self.periodic.minimal_image(self.positions[i] - self.positions[j])
    }

    /// Whether the line between two fluid particles passes through both faces of a body.
    fn hides(&self, body: &ThinBody, i: usize, k: usize, walls: &NeighborList) -> bool {
        let mut passed = [false; 2];
        for &j in walls.row(i).iter().chain(walls.row(k)) {
            let j = j as usize;
            if !body.copies[0].contains(&j) {
                continue;
            }
            let faces = body.faces[j - body.copies[0].start];
            if faces != [false; 2] && self.crosses(body, j, i, k) {
                passed = [passed[0] || faces[0], passed[1] || faces[1]];
            }
        }
        passed == [true; 2]
    }

    /// Whether that line passes beside particle `j` of the body.
    fn crosses(&self, body: &ThinBody, j: usize, i: usize, k: usize) -> bool {
        let normal = body.normal(j - body.copies[0].start, |row| self.positions[row]);
        let (first, second) = (self.from(j, i), self.from(j, k));
        let (a, b) = (normal.dot(first), normal.dot(second));
        (a >= 0.0) != (b >= 0.0) && (first + a / (a - b) * (second - first)).length() < REACH * body.spacing
    }
}
