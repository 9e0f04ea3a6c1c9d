//! The supports of particles: spheres, or ellipsoids that follow the deformation.
//!
//! Where a material is squeezed flat, spheres keep only the neighbours above and below. The foot of a copper
//! bar then runs apart, the more so the finer the lattice. The ellipsoids are those of updated-Lagrangian
//! bodies, [`Ellipsoid::following`], and stay as they are until those of the present deformation are well
//! apart from them: between two changes the weights depend on positions alone, and a small oscillation
//! changes none.

use std::ops::RangeInclusive;

use glam::{DMat3, DVec3};

use super::lists::EulerianBody;
use crate::column;
use crate::formulations::bonded::{Ellipsoid, SeenEllipsoid};
use crate::linalg::{Eigen, Sym3};
use crate::notation::quantity;
use crate::parallel::{for_each_own_block, share_rows, sum_over_own_blocks};
use crate::plugin::FOLLOWED;
use crate::schedule::{Step, raise_warning};
use crate::solids::fill_rows;
use crate::symmetry::Ghosts;
use crate::world::{Damage, DeformationGradient};

column! {
    /// Metric of distances in the kernel.
    pub struct SupportMetric(Sym3) = "support_metric", "G", "1";
}

/// Account of what changes as supports do.
pub(crate) const SUPPORT_CHANGE: &str = "support_change";

/// Steps between two looks at the deformation.
pub(super) const EVERY: u64 = 16;
/// Logarithmic change of the half axes of a particle from which on all of its body are renewed: that of a
/// stretch by 1.35 at constant volume.
const CHANGE: f64 = 0.15;
/// Half axis over the stretch along it, at least: it covers two stretched spacings at the usual support. With
/// two thirds, metal sheared to three lost most of its stress.
const LEAST_SHARE: f64 = 0.82;
/// Bounds of the half axes: sheared much farther, a body has other neighbours than its first ones, and an
/// ellipsoid of these would reach across all of it.
const AXES: RangeInclusive<f64> = 1.0 / 3.0..=6.0;
/// Share of the particles of a body beyond these bounds that is worth a warning.
const BEYOND: f64 = 0.02;

/// The supports of a phase.
#[derive(Default)]
pub(super) struct Supports {
    /// Of real rows and ghosts; empty while all are spheres.
    seen: Vec<SeenEllipsoid>,
    /// Of real rows; empty while all are spheres.
    own: Vec<Ellipsoid>,
    /// Whether the column has been read.
    pub is_loaded: bool,
    /// Whether the column has other ones from this step on.
    pub is_renewed: bool,
}

impl Supports {
    /// Those of a body, of the rows of the phase; empty where they are spheres.
    pub fn of(&self, body: &EulerianBody) -> &[SeenEllipsoid] {
        if body.is_stretched { &self.seen } else { &[] }
    }

    /// That of a row, if it is no sphere.
    pub fn ellipsoid(&self, body: &EulerianBody, row: usize) -> Option<&Ellipsoid> {
        if body.is_stretched { self.own.get(row) } else { None }
    }

    /// Takes over what the column holds.
    pub fn load(&mut self, metric: &[SupportMetric], bodies: &mut [EulerianBody], ghosts: &Ghosts) {
        (self.is_loaded, self.is_renewed) = (true, false);
        if metric.iter().any(|own| own.0 != Sym3::IDENTITY) {
            self.own.resize(metric.len(), Ellipsoid::SPHERE);
            fill_rows(&mut self.own, 0, |row| Ellipsoid::new(metric[row].0));
            self.fill(ghosts);
        } else {
            self.own.clear();
            self.seen.clear();
        }
        for body in bodies {
            let rows = body.rows.clone();
            body.is_stretched = metric[rows.clone()].iter().any(|own| own.0 != Sym3::IDENTITY);
            let axes = self.own.get(rows).unwrap_or_default().iter().map(|own| own.longest);
            body.longest = axes.fold(1.0, f64::max);
        }
    }

    /// Fills what neighbours read, of ghosts as well.
    pub fn fill(&mut self, ghosts: &Ghosts) {
        if self.own.is_empty() {
            return;
        }
        let Self { seen, own, .. } = self;
        seen.clear();
        seen.extend(own.iter().map(|own| SeenEllipsoid::of(own, 0.0)));
        seen.resize(own.len() + ghosts.len(), SeenEllipsoid::default());
        ghosts.fill(seen, |ghost, own| own.image(ghost.map.signs));
    }

    /// Puts the ellipsoids of the present deformation into the column, for the bodies in which they are far
    /// from those that are there. Says whether there is such a body.
    pub fn renew(
        &mut self,
        bodies: &mut [EulerianBody],
        metric: &mut [SupportMetric],
        deformation: &[DeformationGradient],
        damage: Option<&[Damage]>,
    ) -> bool {
        for body in bodies.iter_mut().filter(|body| body.follows) {
            let rows = body.rows.clone();
            let own = &mut metric[rows.clone()];
            let target =
                |row: usize| target(&deformation[row].0, damage.is_some_and(|own| own[row].0 >= 1.0));
            let is_far = |k: usize, own: &SupportMetric| change(&own.0, &target(rows.start + k)) > CHANGE;
            let far: f64 = sum_over_own_blocks(&*own, &|first, own: &[SupportMetric]| {
                own.iter().enumerate().filter(|(k, own)| is_far(first + k, own)).count() as f64
            });
            if far == 0.0 {
                continue;
            }
            for_each_own_block(&mut *own, &mut Vec::new(), &|first, own: &mut [SupportMetric]| {
                own.iter_mut().enumerate().for_each(|(k, own)| own.0 = target(rows.start + first + k));
            });
            share_rows(own);
            body.longest = body.longest.max(longest(own));
            self.is_renewed = true;
        }
        self.is_renewed
    }
}

/// G of a particle. What has failed flows as a liquid does, and is followed no longer.
fn target(f: &DMat3, is_failed: bool) -> Sym3 {
    if is_failed {
        return Sym3::IDENTITY;
    }
    let axis = |stretch: f64| stretch.powf(FOLLOWED).max(LEAST_SHARE * stretch);
    let bounded = |axis: f64| axis.clamp(*AXES.start(), *AXES.end());
    Eigen::new(&Sym3::gram(f.transpose())).map(|square| bounded(axis(square.sqrt())).powi(-2))
}

/// Says of every body whose supports follow it how many of its particles are stretched farther than they do.
pub(super) fn warn(
    bodies: &[EulerianBody],
    deformation: &[DeformationGradient],
    damage: Option<&[Damage]>,
    step: &mut Step<'_>,
) {
    let farthest = AXES.end() / LEAST_SHARE;
    let is_beyond = |row: usize| {
        let is_failed = damage.is_some_and(|own| own[row].0 >= 1.0);
        !is_failed && Sym3::gram(deformation[row].0).trace() > farthest * farthest
    };
    for body in bodies.iter().filter(|body| body.follows) {
        let own = &deformation[body.rows.clone()];
        let count = sum_over_own_blocks(own, &|first, own: &[DeformationGradient]| {
            let rows = body.rows.start + first..;
            rows.zip(own).filter(|(row, _)| is_beyond(*row)).count() as f64
        });
        let all = sum_over_own_blocks(own, &|_, own: &[DeformationGradient]| own.len() as f64);
        if count <= BEYOND * all {
            continue;
        }
        let name = &step.world.body(body.id).name;
        let begin = format!("the supports of Eulerian body `{name}` follow its deformation no farther:");
        let time = step.clock.time;
        raise_warning(step.warnings, &begin, count as usize, || {
            format!(
                "of its {all} particles are stretched to more than {farthest:.1} times their length at {}; their stresses may be far too \
                 small: `support_follows: false` keeps spheres, which can be sheared farther on a regular lattice, and the plugin \
                 `failure` lets the material part",
                quantity(time, "s")
            )
        });
    }
}

/// Logarithmic distance of two ellipsoids: the norm of the logarithms of the half axes of one in the
/// coordinates in which the other one is a sphere, for small ones; more for large ones.
fn change(before: &Sym3, after: &Sym3) -> f64 {
    let beyond = before.inverse().double_dot(after) + after.inverse().double_dot(before) - 6.0;
    0.5 * beyond.max(0.0).sqrt()
}

/// A bound of the longest half axis of some ellipsoids.
fn longest(metric: &[SupportMetric]) -> f64 {
    metric.iter().map(|own| Ellipsoid::new(own.0).longest).fold(1.0, f64::max)
}

/// Length of a vector as an ellipsoid measures it, m.
pub(super) fn length_in(ellipsoid: Option<&Ellipsoid>, r: DVec3) -> f64 {
    ellipsoid.map_or(r.length(), |own| r.dot(own.tensor.to_matrix() * r).max(0.0).sqrt())
}
