//! The bonds of a total-Lagrangian body as pairs for pair terms.

use glam::DVec3;

use super::bonds::Bonds;
use super::formulation::PackedRows;
use super::images::Images;
use super::rows::Site;
use crate::kernels::Kernel;
use crate::pair::{FourVectors, PairReads, PairRow, PairRows, PairSource};
use crate::parallel::{Arithmetic, HotLoop, Lanes4, Vector, run_hot_on};
use crate::scene::Dimension;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, PhaseId, SupportRadius, Velocity};

/// Gives pair terms the bonds of the phase.
pub(super) struct BondPairs {
    pub phase: PhaseId,
}

impl PairSource for BondPairs {
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        reads: PairReads,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let packed = step.resources.get::<PackedRows>();
        let view = step.world.phase(self.phase);
        let support = view.read::<SupportRadius>()?;
        let velocity = if reads.velocity { Some(view.read::<Velocity>()?) } else { None };
        let Some((_, kernel)) = packed.kernels.iter().find(|(id, _)| *id == body) else { return Ok(()) };
        let PackedRows { bonds, images, sites, .. } = &*packed;
        let plane = step.world.dimension() == Dimension::Two;
        let velocity = velocity.as_deref();
        run(&BodyPairs {
            bonds,
            images,
            sites,
            support: &support,
            velocity,
            kernel,
            with_kernel: reads.kernel,
            plane,
        })
    }
}

struct BodyPairs<'a> {
    bonds: &'a Bonds,
    images: &'a Images,
    sites: &'a [Site],
    support: &'a [SupportRadius],
    /// Velocities, where they are read.
    velocity: Option<&'a [Velocity]>,
    kernel: &'a Kernel,
    with_kernel: bool,
    plane: bool,
}

impl PairRows for BodyPairs<'_> {
    fn row(&self, i: usize, row: &mut PairRow) {
        run_hot_on(self.plane, Fill { pairs: self, i, row });
    }
}

/// Fills the row of one particle.
struct Fill<'a> {
    pairs: &'a BodyPairs<'a>,
    i: usize,
    row: &'a mut PairRow,
}

impl HotLoop for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self, a: A) {
        let Self { pairs, i, row } = self;
        let &BodyPairs { bonds, images, sites, support, velocity, kernel, with_kernel, .. } = pairs;
        let site = &sites[i];
        row.volume_i = site.reference.0[3];
        let list =
            if site.is_present() { bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize } else { 0..0 };
        let (neighbors, weights) = (&bonds.neighbors[list.clone()], &bonds.weights[list]);
        let imaged = !images.is_empty();
        let room = row.room(neighbors.len(), true, imaged);
        for (n, pairs) in room.pairs.iter_mut().enumerate() {
            let lanes = 4 * n..(4 * n + 4).min(neighbors.len());
            let mut four = [i; 4];
            let mut weight = Lanes4::ZERO;
            for (lane, bond) in lanes.enumerate() {
                four[lane] = neighbors[bond] as usize;
                weight.0[lane] = f64::from(weights[bond]);
            }
            let [j, k, l, m] = four;
            let of = [&sites[j], &sites[k], &sites[l], &sites[m]];
            let place = a.transpose([of[0].reference, of[1].reference, of[2].reference, of[3].reference]);
            let moved =
                a.transpose([of[0].displacement, of[1].displacement, of[2].displacement, of[3].displacement]);
            let (mut x, mut then) = ([Lanes4::ZERO; 3], [Lanes4::ZERO; 3]);
            for axis in 0..A::AXES {
                then[axis] = a.minus(place[axis], Lanes4::splat(site.reference.0[axis]));
                let u = a.minus(moved[axis], Lanes4::splat(site.displacement.0[axis]));
                x[axis] = a.plus(then[axis], u);
            }
            if imaged {
                four = four.map(|j| images.source(j));
                room.mirrors[n] = [j, k, l, m].map(|j| images.mirror(j).unwrap_or(DVec3::ONE));
            }
            let [j, k, l, m] = four;
            if let Some(v) = velocity {
                let mut of = [v[j].0, v[k].0, v[l].0, v[m].0];
                if imaged {
                    let signs = &room.mirrors[n];
                    of = [of[0] * signs[0], of[1] * signs[1], of[2] * signs[2], of[3] * signs[3]];
                }
                let Vector { x, y, z } = Vector::from_rows(a, of);
                let own = v[i].0;
                pairs.velocity = [
                    a.minus(x.lanes(), Lanes4::splat(own.x)),
                    a.minus(y.lanes(), Lanes4::splat(own.y)),
                    a.minus(z.lanes(), Lanes4::splat(own.z)),
                ];
            }
            let other = Lanes4([support[j].0, support[k].0, support[l].0, support[m].0]);
            let radius = a.scale(0.5, a.plus(Lanes4::splat(support[i].0), other));
            // Removed particles, and lanes without a neighbour, have neither weight nor volume.
            let present = a.where_below(Lanes4::ZERO, weight, place[3]);
            let weight = a.where_below(Lanes4::ZERO, present, weight);
            let reference = FourVectors { vector: then, length: length(a, then) };
            room.reference[n] = reference;
            pairs.current = FourVectors { vector: x, length: length(a, x) };
            pairs.weight = weight;
            pairs.support = radius;
            pairs.volume_j = present;
            if with_kernel {
                for lane in 0..4 {
                    let h = kernel.smoothing_length(radius.0[lane]);
                    let value = kernel.w(reference.length.0[lane], h);
                    pairs.kernel.0[lane] = if present.0[lane] > 0.0 { value } else { 0.0 };
                }
            }
            room.rows[n] = [four[0] as u32, four[1] as u32, four[2] as u32, four[3] as u32];
        }
    }
}

/// Lengths of four vectors, above zero.
#[inline(always)]
fn length<A: Arithmetic>(a: A, vector: [Lanes4; 3]) -> Lanes4 {
    let square = Vector::new(a, vector).length_squared().lanes();
    a.sqrt(a.larger(square, Lanes4::splat(f64::MIN_POSITIVE)))
}
