//! Neighbour lists in the current configuration, with a skin, so that they are valid for several steps.

use std::ops::Range;

use glam::DVec3;

use crate::neighbors::{Cloud, FirstOfCloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::parallel::{BlockSum, Maximum, sum_over_blocks};
use crate::symmetry::{Ghosts, Repeat};
use crate::world::BodyId;

/// Skin over the support radius before motion is known.
const FIRST_SKIN: f64 = 0.1;
/// Bounds of the skin over the support radius; the upper one gives way to what a step needs.
const SKINS: Range<f64> = 0.02..0.2;

/// A body of the lists.
pub(super) struct EulerianBody {
    pub id: BodyId,
    /// Its rows in the phase.
    pub rows: Range<usize>,
    /// Support radius, m.
    pub support: f64,
    /// Whether its supports follow the deformation.
    pub follows: bool,
    /// Whether they are no spheres any more.
    pub is_stretched: bool,
    /// A bound of their longest half axis over the support radius, now and from the next step on.
    pub longest: f64,
    /// Its symmetry planes and periods.
    pub repeats: Vec<Repeat>,
    /// Whether it touches itself: particles from elsewhere in the body are then no neighbours.
    pub touches_itself: bool,
}

/// The lists of all bodies of the phase, which are in the order of their rows.
#[derive(Default)]
pub(super) struct EulerianLists {
    pub bodies: Vec<EulerianBody>,
    /// The ghosts of pairs within support and skin.
    pub ghosts: Ghosts,
    /// Packed rows of the neighbours of each row, ascending.
    pub pairs: NeighborList,
    /// The same before particles from elsewhere are left out, where a body touches itself.
    pub uncut: NeighborList,
    /// Places that the lists were built from, m.
    built_from: Vec<DVec3>,
    skin: ListSkin,
    search: NeighborSearch,
    places: Vec<DVec3>,
}

impl EulerianLists {
    /// Lists of bodies, to be built by the first update.
    pub fn new(bodies: Vec<EulerianBody>) -> Self {
        Self { bodies, ..Self::default() }
    }

    /// Rebuilds the lists if a pair that is not in them may have come within the support, at the end of the
    /// step or in the middle of it, and says whether it did. The particles have moved with `velocity`, m/s,
    /// for `dt`, s.
    ///
    /// # Errors
    /// The body whose places have no neighbours that could be found.
    pub fn update(
        &mut self,
        position: &[DVec3],
        velocity: &[DVec3],
        dt: f64,
    ) -> Result<bool, (BodyId, NeighborError)> {
        let is_first = self.built_from.len() != position.len();
        let Self { skin, built_from, bodies, .. } = self;
        let is_stale = is_first
            || bodies.iter().any(|body| {
                let rows = body.rows.clone();
                let moved =
                    body.farthest((&built_from[rows.clone()], &position[rows]), |before, now| now - before);
                // What is not a number is far, too.
                moved.is_nan() || moved > 0.5 * skin.width * body.support
            });
        if is_stale {
            if !is_first {
                skin.adapt();
            }
            // Between builds the middle of a step is covered by its ends.
            for body in bodies.iter() {
                let velocity = &velocity[body.rows.clone()];
                let moved = body.farthest((velocity, velocity), |v, _| v * dt);
                skin.width = skin.width.max(moved / body.support);
            }
            self.build(position)?;
        }
        self.skin.steps += 1;
        Ok(is_stale)
    }

    /// Lets the next update build the lists.
    pub fn forget(&mut self) {
        self.built_from.clear();
    }

    fn build(&mut self, position: &[DVec3]) -> Result<(), (BodyId, NeighborError)> {
        self.built_from.clear();
        let skin = self.skin.width;
        self.ghosts = Ghosts::new(position.len());
        self.pairs.clear();
        for body in &self.bodies {
            let (repeats, reach) = body.repeats_at(skin, &position[body.rows.clone()]);
            let ghost_rows = self.ghosts.add(body.rows.clone(), position, reach, &repeats);
            self.places.clear();
            self.places.extend_from_slice(&position[body.rows.clone()]);
            self.places.extend(ghost_rows.clone().map(|row| self.ghosts.place(position, row)));
            let cloud = Cloud::uniform(&self.places, body.support * body.longest);
            let first = FirstOfCloud { cloud, targets: body.rows.len() };
            let found = self.search.append(first, skin * body.support, &Periodic::NONE, &mut self.pairs);
            found.map_err(|error| (body.id, error))?;
            // Ghosts have numbers behind those of the real rows of the body.
            let row_of = |number: u32| {
                let number = number as usize;
                let ghost = number.checked_sub(body.rows.len());
                ghost.map_or(body.rows.start + number, |ghost| ghost_rows.start + ghost) as u32
            };
            self.pairs.renumber_from(body.rows.start, row_of);
        }
        self.built_from.extend_from_slice(position);
        if self.bodies.iter().any(|body| body.touches_itself) {
            self.uncut.clone_from(&self.pairs);
        }
        Ok(())
    }
}

/// The skin of the lists and their age. Results do not depend on it.
struct ListSkin {
    /// Over the support radius.
    width: f64,
    /// Steps since the last build.
    steps: u64,
}

impl Default for ListSkin {
    fn default() -> Self {
        Self { width: FIRST_SKIN, steps: 0 }
    }
}

impl ListSkin {
    /// Chooses the skin s of the next lists by how long the last ones were valid. Of the instructions of a
    /// step, looking at the particles in the skin takes a share of 0.45 s, and a build as many as 0.8 steps
    /// (measured in space): with a motion of r support radii per step the sum `0.45 s + 0.8 r / s` is to be
    /// least.
    fn adapt(&mut self) {
        let motion = self.width / self.steps.max(1) as f64;
        let width = (0.8 / 0.45 * motion).sqrt();
        *self = Self { width: width.clamp(SKINS.start, SKINS.end), steps: 0 };
    }
}

impl EulerianBody {
    /// Length of the longest way of a particle. A body that flies takes its lists along; at a symmetry plane
    /// it meets its image, which goes the other way.
    fn farthest(&self, rows: (&[DVec3], &[DVec3]), way: impl Fn(DVec3, DVec3) -> DVec3 + Sync) -> f64 {
        let is_mirrored = self.repeats.iter().any(|repeat| matches!(repeat, Repeat::Mirror { .. }));
        type Rows<'a> = (&'a [DVec3], &'a [DVec3]);
        let along = if is_mirrored {
            DVec3::ZERO
        } else {
            let all: Extent = sum_over_blocks(rows, &|_, (before, now): Rows<'_>| {
                let ways = before.iter().zip(now).map(|(before, now)| way(*before, *now));
                ways.fold(Extent::default(), |all, u| Extent(all.0.min(u), all.1.max(u)))
            });
            0.5 * (all.0 + all.1)
        };
        let farthest: Maximum = sum_over_blocks(rows, &|_, (before, now): Rows<'_>| {
            let ways = before.iter().zip(now).map(|(before, now)| way(*before, *now));
            Maximum::of(ways.map(|u| (u - along).length_squared()))
        });
        farthest.0.sqrt()
    }

    /// Symmetry planes and periods of the body at its present position, and the distance from a side within
    /// which its ghosts have their sources, m: a body that fills a period moves along with it, and its sides
    /// may deform.
    fn repeats_at(&self, skin: f64, position: &[DVec3]) -> (Vec<Repeat>, f64) {
        let mut reach = self.support * (self.longest + skin);
        if self.repeats.is_empty() {
            return (Vec::new(), reach);
        }
        let bounds = position.iter().fold(Extent::default(), |all, x| Extent(all.0.min(*x), all.1.max(*x)));
        let moved = self.repeats.iter().map(|repeat| match *repeat {
            Repeat::Period { axis, length, .. } => {
                let beyond = bounds.1[axis] - bounds.0[axis] - length;
                reach = reach.max(self.support * (self.longest + skin) + beyond);
                Repeat::Period { axis, min: bounds.0[axis], length }
            }
            mirror @ Repeat::Mirror { .. } => mirror,
        });
        (moved.collect(), reach)
    }
}

/// Lower and upper corner of a box.
#[derive(Clone, Copy)]
struct Extent(DVec3, DVec3);

impl Default for Extent {
    fn default() -> Self {
        Self(DVec3::INFINITY, DVec3::NEG_INFINITY)
    }
}

impl BlockSum for Extent {
    fn add(&mut self, next: &Self) {
        *self = Self(self.0.min(next.0), self.1.max(next.1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> Vec<DVec3> {
        (0..200).map(|k| DVec3::new((k % 20) as f64, (k / 20) as f64, 0.0)).collect()
    }

    fn lists(repeats: Vec<Repeat>) -> EulerianLists {
        EulerianLists::new(vec![EulerianBody {
            id: BodyId(0),
            rows: 0..200,
            support: 2.6,
            follows: false,
            is_stretched: false,
            longest: 1.0,
            repeats,
            touches_itself: false,
        }])
    }

    /// Pairs closer than the support, by brute force.
    fn close(position: &[DVec3], i: usize) -> Vec<u32> {
        let near = |j: &usize| *j != i && (position[*j] - position[i]).length() < 2.6;
        (0..position.len()).filter(near).map(|j| j as u32).collect()
    }

    #[test]
    fn no_pair_within_the_support_is_missed_between_builds() {
        let (mut position, mut lists, still) = (cloud(), lists(Vec::new()), [DVec3::ZERO; 200]);
        let mut builds = 0;
        for step in 0..60 {
            for (k, x) in position.iter_mut().enumerate() {
                *x += DVec3::new(
                    0.3 + 0.02 * (0.7 * k as f64).sin(),
                    0.02 * (1.3 * (k + step) as f64).cos(),
                    0.0,
                );
            }
            builds += usize::from(lists.update(&position, &still, 0.0).expect("lists"));
            for i in 0..position.len() {
                let row = lists.pairs.row(i);
                assert!(row.is_sorted() && close(&position, i).iter().all(|j| row.contains(j)), "row {i}");
            }
        }
        // It flies by 18 spacings, and is stirred by less than one.
        assert!((2..20).contains(&builds), "{builds} builds");
    }

    #[test]
    fn a_body_that_comes_near_a_symmetry_plane_meets_its_image() {
        let mut lists = lists(vec![Repeat::Mirror { axis: 0, at: -4.0 }]);
        let (mut position, still) = (cloud(), [DVec3::ZERO; 200]);
        lists.update(&position, &still, 0.0).expect("lists");
        assert!(lists.ghosts.is_empty());
        position.iter_mut().for_each(|x| x.x -= 3.5);
        assert!(lists.update(&position, &still, 0.0).expect("lists"));
        let ghosts = lists.pairs.row(0).iter().filter(|&&j| j >= 200).count();
        assert!(ghosts > 0 && lists.ghosts.len() >= 30, "{ghosts} of {}", lists.ghosts.len());
    }

    #[test]
    fn the_skin_costs_the_least_for_the_motion_that_it_has_seen() {
        for motion in [0.0004, 0.002, 0.007, 0.02] {
            let cost = |width: f64| 0.45 * width + 0.8 * motion / width;
            let mut skin = ListSkin::default();
            for _ in 0..20 {
                skin.steps = (skin.width / motion).ceil() as u64;
                skin.adapt();
            }
            let least = (4..=40).map(|k| cost(0.005 * f64::from(k))).fold(f64::MAX, f64::min);
            assert!(cost(skin.width) < 1.05 * least, "{motion}: {} {least}", skin.width);
        }
    }

    #[test]
    fn a_pair_that_was_close_in_the_middle_of_a_fast_step_is_listed() {
        let (mut position, mut lists, mut velocity) = (cloud(), lists(Vec::new()), [DVec3::ZERO; 200]);
        // At rest for long the skin is narrow.
        for step in 0..4000 {
            position[7].y = 0.3 * f64::from(step % 2000) / 2000.0;
            lists.update(&position, &velocity, 0.0).expect("lists");
        }
        assert!(lists.skin.width < 0.03, "{}", lists.skin.width);
        let middle = position.clone();
        for (k, x) in position.iter_mut().enumerate() {
            velocity[k].x = if k % 2 == 0 { 0.5 } else { -0.5 };
            *x += 0.5 * velocity[k];
        }
        assert!(lists.update(&position, &velocity, 1.0).expect("lists"));
        for i in 0..position.len() {
            let row = lists.pairs.row(i);
            assert!(close(&middle, i).iter().all(|j| row.contains(j)), "row {i}");
        }
    }
}
