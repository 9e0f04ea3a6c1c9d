//! Forces of contacts with a surface on both sides, and their sum on rigid bodies.

use glam::DVec3;

use crate::contact::bodies::ContactSides;
use crate::contact::response::PairKey;
use crate::parallel::BlockSum;
use crate::rigid::{RigidBody, Wrench};
use crate::world::sum_by_row;

/// Force of a contact on both sides.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct NodePush {
    /// From the node to where it is pushed, in the reference configuration, m.
    pub arm: DVec3,
    /// Where the surface is pushed, m.
    pub place: DVec3,
    /// From there to where the node is pushed: zero, or a period.
    pub shift: DVec3,
    /// Force on the node, N.
    pub force: DVec3,
    /// Couple on the body of the node and, opposite, on the other one, N m.
    pub couple: DVec3,
    /// The place of a particle, m, and a force on it and, opposite, on the other body there, because the
    /// normal turns as it moves, N.
    pub center: DVec3,
    pub turning: DVec3,
    /// Heat of friction in the step, J.
    pub heat: f64,
    /// Stiffness over the mass of the node and of the body with the surface, 1/s2.
    pub stiffness: [f64; 2],
}

/// Forces of contacts on the bodies of both sides, about their centres, and the sums of their stiffness over
/// mass, 1/s2.
#[derive(Clone, Copy, Default)]
struct Pushes {
    on: [Wrench; 2],
    stiffness: [f64; 2],
}

impl BlockSum for Pushes {
    fn add(&mut self, next: &Self) {
        for side in 0..2 {
            self.on[side].add(&next.on[side]);
            self.stiffness[side] += next.stiffness[side];
        }
    }
}

/// Adds the forces to the rigid bodies, exactly opposite to those on the other side, at one place; `count` is
/// the number of nodes. Returns the sums of stiffness over mass of both sides, 1/s2.
pub(super) fn push<T: Sync>(
    sides: &ContactSides,
    met: &[(PairKey, T)],
    pushes: &[NodePush],
    count: usize,
    bodies: &mut [RigidBody],
) -> [f64; 2] {
    let of = |id| bodies.iter().position(|body: &RigidBody| body.id == id);
    let both = [of(sides.first), of(sides.second)];
    let middle = both.map(|k| k.map_or(DVec3::ZERO, |k| bodies[k].state.center));
    let of_contact = |k: usize| {
        let NodePush { place, center, shift, force, couple, turning, stiffness, .. } = pushes[k];
        let mut sum = Pushes { stiffness, ..Pushes::default() };
        sum.on[0].push(place + shift - middle[0], force);
        sum.on[1].push(place - middle[1], -force);
        sum.on[1].push(center - middle[1], -turning);
        sum.on[0].torque += couple;
        sum.on[1].torque -= couple;
        sum
    };
    let Pushes { on, stiffness } = sum_by_row(count, pushes.len(), &|k| met[k].0.0 as usize, &of_contact);
    for (k, on) in both.into_iter().zip(on) {
        if let Some(k) = k {
            bodies[k].push(&on);
        }
    }
    stiffness
}
