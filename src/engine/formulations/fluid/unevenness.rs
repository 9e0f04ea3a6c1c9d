//! Rows and lattices that have broken up: friction between uneven particles is too large.
//!
//! `h |sum_j V_j w_ij x_ij|` over all neighbours is zero where particles are even. In channels, cavities and vortices at Reynolds numbers of 50 to 1000 its root mean square is 0.042
//! to 0.054 once their rows have broken up, and then a channel has lost a tenth of its flux; with `particle_shifting` it is 0.013 to 0.015, and in flows that stay in rows below 0.005.

use super::cloud::FlowCloud;
use super::density::DensityShift;
use super::near::RowPass;
use super::surroundings::smallest_eigenvalue;
use crate::correction::FourMoments;
use crate::parallel::{Arithmetic, Vector};
use crate::schedule::Step;

/// Smallest eigenvalue of the moment matrix above which a particle is inside the fluid.
const INSIDE: f64 = 0.75;
/// Share of the particles that have to be inside: a flow with a free surface is left alone.
const CONFINED: f64 = 0.95;
/// Root mean square of the first moment times h that is worth a warning.
const UNEVEN: f64 = 0.03;

/// Watches the particles of viscous flows without a free surface.
#[derive(Debug, Default)]
pub(super) struct Unevenness {
    /// Groups that the user has been warned of.
    pub told: Vec<bool>,
}

impl Unevenness {
    /// Looks at all fluids that nothing shifts.
    pub fn look(&mut self, cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
        self.told.resize(cloud.groups.len(), false);
        // Friction without spin is that of fluids whose viscosity hardly matters.
        if !cloud.viscosities.spin {
            return;
        }
        for (group, told) in cloud.groups.iter().zip(&mut self.told) {
            let is_shifted = || step.world.phase(group.phase).has::<DensityShift>();
            if group.fluid().is_none() || *told || is_shifted() {
                continue;
            }
            scratch.clear();
            scratch.resize(group.cloud.len(), None);
            cloud.for_each_row(group.cloud.start, scratch, &FirstMoments(cloud));
            let Some(mean) = root_mean_square(scratch).map(|mean| mean * cloud.kernel.smoothing_length())
            else {
                continue;
            };
            if mean <= UNEVEN {
                continue;
            }
            *told = true;
            step.warnings.push(format!(
                "the particles of `{}` have become uneven by {:.6e} s (first moment times h {mean:.3}): friction between them is too large, a channel loses a tenth of its \
                 flux; give it `plugins: [density_diffusion(), particle_shifting()]`, or start it with a pressure of some rho v^2",
                step.world.body(group.body).name,
                step.clock.time
            ));
        }
    }
}

/// Root mean square of the first moments, 1/m; none for a flow with a free surface.
fn root_mean_square(squares: &[Option<f64>]) -> Option<f64> {
    let inside = squares.iter().flatten().count() as f64;
    let mean = squares.iter().flatten().sum::<f64>() / inside;
    (inside > CONFINED * squares.len() as f64).then(|| mean.sqrt())
}

/// The square of the first moment of a particle, 1/m2; none near a surface.
struct FirstMoments<'a>(&'a FlowCloud);

impl RowPass for FirstMoments<'_> {
    type Output = Option<f64>;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> Option<f64> {
        let cloud = self.0;
        let (mut moment, mut first) = (FourMoments::new(a), Vector::zero(a));
        for near in cloud.fours(a, i, &cloud.everything()) {
            let weight = near.volume * near.weight;
            moment.add(weight, near.x_ij);
            first = near.x_ij.mul_add(weight, first);
        }
        let is_inside = cloud.records[i].volume() > 0.0
            && smallest_eigenvalue(moment.sum().matrix(), A::AXES == 2) > INSIDE;
        is_inside.then(|| first.sum().length_squared())
    }
}
