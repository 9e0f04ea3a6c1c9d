//! What displacements do to the volume of particles, and the density that follows.

use std::ops::Range;

use meshless_engine::formulations::fluid::{DensityShift, FlowCloud, RowPass};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Arithmetic, Number};
use meshless_engine::schedule::{Step, StepError};
use meshless_engine::world::{BodyId, Density};

use crate::surface::Place;

/// Change of volume over volume, `sum_j V_j (dx_j - dx_i) . grad_i W` halfway along the displacements of all fluid particles; what bounds the
/// fluid stays. At their start the sum would be too large, and the mean density would creep downwards. None near a free surface, which lets
/// the fluid be as large as it is.
pub struct Dilation<'a> {
    pub cloud: &'a FlowCloud,
    pub moves: &'a [DVec3],
    pub places: &'a [Place],
}

impl RowPass for Dilation<'_> {
    type Output = f64;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> f64 {
        let Self { cloud, moves, places } = *self;
        if places[i] != Place::Inside {
            return 0.0;
        }
        let own = moves[i];
        let mut sum = Number::zero(a);
        for near in cloud.fours(a, i, &cloud.everything()) {
            let apart = near.vector(|j| moves.get(j).copied().unwrap_or(DVec3::ZERO) - own);
            let x_ij = apart.mul_add(Number::splat(a, 0.5), near.x_ij);
            let weight = Number::new(a, cloud.kernel.weights(a, x_ij.length_squared().sqrt().lanes()));
            sum += near.volume * weight * apart.dot(x_ij);
        }
        sum.sum()
    }
}

/// Lets the density of a body follow by continuity.
pub fn follow(step: &Step<'_>, cloud: &FlowCloud, id: BodyId, dilation: &[f64]) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(id);
    let density = view.read::<Density>()?;
    let mut shift = view.write::<DensityShift>()?;
    let pass = Following { cloud, rows: rows.clone(), dilation, density: &density };
    cloud.for_each_row(rows.start, &mut shift[rows], &pass);
    Ok(())
}

/// The changes of density, for the change of volume smoothed by the kernel: `sum_j V_j W_ij theta_j + (1 - sum_j V_j W_ij) theta_i` has the volume of
/// theta. The scale of single particles is left out, as sound there would be, and takes energy of the flow.
struct Following<'a> {
    cloud: &'a FlowCloud,
    rows: Range<usize>,
    dilation: &'a [f64],
    density: &'a [Density],
}

impl RowPass for Following<'_> {
    type Output = DensityShift;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> DensityShift {
        let own = self.dilation[i];
        let mut sum = Number::zero(a);
        for near in self.cloud.fours(a, i, &self.rows) {
            sum += near.volume * near.kernel * (near.number(|j| self.dilation[j]) - own);
        }
        let dilation = own + sum.sum();
        DensityShift(-self.density[i].0 * dilation / (1.0 + 0.5 * dilation))
    }
}
