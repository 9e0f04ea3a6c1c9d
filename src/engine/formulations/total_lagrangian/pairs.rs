//! The bonds of a total-Lagrangian body as pairs for pair terms.

use super::bonds::Bonds;
use super::formulation::PackedRows;
use super::images::Images;
use super::rows::Site;
use crate::kernels::Kernel;
use crate::pair::{Pair, PairRows, PairSource};
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, PhaseId, SupportRadius};

/// Gives pair terms the bonds of the phase.
pub(super) struct BondPairs {
    pub phase: PhaseId,
}

impl PairSource for BondPairs {
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let packed = step.resources.get::<PackedRows>();
        let support = step.world.phase(self.phase).read::<SupportRadius>()?;
        let Some((_, kernel)) = packed.kernels.iter().find(|(id, _)| *id == body) else { return Ok(()) };
        let PackedRows { bonds, images, sites, .. } = &*packed;
        run(&BodyPairs { bonds, images, sites, support: &support, kernel })
    }
}

struct BodyPairs<'a> {
    bonds: &'a Bonds,
    images: &'a Images,
    sites: &'a [Site],
    support: &'a [SupportRadius],
    kernel: &'a Kernel,
}

impl PairRows for BodyPairs<'_> {
    fn row(&self, i: usize, with_kernel: bool, pairs: &mut Vec<Pair>) {
        let site = self.sites[i];
        let volume_i = site.reference.0[3];
        pairs.clear();
        // Removed particles have no volume, and no pairs.
        let present = |(j, _): &(usize, f32)| site.is_present() && self.sites[*j].is_present();
        pairs.extend(self.bonds.row(i).filter(present).map(|(j, weight)| {
            let other = self.sites[j];
            let mirror = self.images.mirror(j);
            let j = self.images.source(j);
            let reference_x_ij = other.reference.minus(site.reference).xyz();
            let x_ij = reference_x_ij + other.displacement.minus(site.displacement).xyz();
            let reference_distance = reference_x_ij.length();
            let support = 0.5 * (self.support[i].0 + self.support[j].0);
            let kernel = if with_kernel {
                self.kernel.w(reference_distance, self.kernel.smoothing_length(support))
            } else {
                f64::NAN
            };
            Pair {
                x_ij,
                distance: x_ij.length(),
                reference_x_ij,
                reference_distance,
                weight: f64::from(weight),
                kernel,
                support,
                volume_i,
                volume_j: other.reference.0[3],
                row_j: j as u32,
                mirror,
            }
        }));
    }
}
