//! Skins of Eulerian bodies: the shares of carriers follow the deformation.
//!
//! Where such a body is compressed strongly, kernels extend over many layers of particles, and a uniform
//! stress is in equilibrium with a load on the surface only if the load is distributed over as many layers,
//! about like the kernel. With the initial shares the outermost layer alone would carry it, with a multiple
//! of the stress of the next layer; at the foot of a Taylor bar it was squeezed out. The share of a carrier
//! thus depends on the present distance of the vertex from it:
//!
//! ```text
//! x = sum_j s_j y_j ,   y_j = x_j + F_j (X - X_j) ,   s_j ~ (1 - d_j/R)^3 ,   d_j = |F_j (X - X_j)| ,   sum s_j = 1
//! ```
//!
//! Where supports are ellipsoids that follow the deformation part of the way, so do these distances:
//! `d_j = |X - X_j|^(5/16) |F_j (X - X_j)|^(11/16)`.
//!
//! The transpose has the change of the shares with F: a force f on a vertex is s_j f on the particles, and
//! the couples `[s_j f + (f . u_j) g_j] (x) (X - X_j)` with `u_j = y_j - x` and g_j the slope of the share
//! along `F_j (X - X_j)`. In the undeformed state the shares are those of Lagrangian bodies. For particles
//! that have been moved onto a held side, distances and slopes are relative to the middle of their cells.

use glam::{DMat3, DVec3};

use super::columns::SkinView;
use super::vertex::{End, Vertex};
use crate::parallel::for_each_block;

/// Share of a carrier in a vertex in this step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FollowingShare {
    pub(super) share: f64,
    /// u_j, m.
    away: DVec3,
    /// g_j, 1/m.
    slope: DVec3,
    /// From the middle of the cell of the carrier to the vertex in the reference configuration, m.
    middle: DVec3,
}

/// Finds the shares at the ends of a patch.
pub(super) fn follow(view: &SkinView<'_>, ends: &[End], now: &[Vertex], out: &mut [FollowingShare]) {
    let distances = view.distances();
    for_each_block((out, ends), &mut Vec::new(), &|_, (out, ends): (&mut [FollowingShare], &[End])| {
        for (out, end) in out.iter_mut().zip(ends) {
            let vertex = &now[end.vertex as usize];
            let (place, [middle, now]) = view.carried_by(end.particle, end.map, end.arm);
            let (reference, present) = (middle.length(), now.length());
            let distance = distances.between(reference, present);
            *out = FollowingShare {
                share: vertex.scale.share(distance),
                away: view.back(end.map, place - vertex.place),
                slope: now * (vertex.scale.slope(distance) * distances.slope(reference, present)),
                middle,
            };
        }
    });
}

/// The force, N, and the couple, N m, on a particle at these ends. `force` gives that on the vertex of an
/// end, as the particle sees it.
pub(super) fn on_particle(
    ends: &[End],
    shares: &[FollowingShare],
    force: impl Fn(&End) -> DVec3,
) -> (DVec3, DMat3) {
    let mut sum = (DVec3::ZERO, DMat3::ZERO);
    for (end, of) in ends.iter().zip(shares) {
        let f = force(end);
        let shared = of.share * f;
        sum.0 += shared;
        sum.1 += outer(shared, end.arm) + outer(of.slope * f.dot(of.away), of.middle);
    }
    sum
}

/// a (x) b
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
