//! The renormalised gradient of the density: exact for a linear field, at a surface as well.

use std::ops::Range;

use meshless_engine::correction::{add_moment, moment_of};
use meshless_engine::formulations::fluid::{FLOW_RECORDS, FlowCloud, NearPairs, RowPass, RowSums};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Arithmetic, Vector};
use meshless_engine::plugin::SimBuilder;
use meshless_engine::schedule::{Mode, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Density};

meshless_engine::column! {
    /// Renormalised gradient of the density of a fluid.
    pub struct DensityGradient(DVec3) = "density_gradient", "grad rho", "kg/m^4";
}

/// Adds the column and the system that fills it, once density and volume are those of the end of the step.
pub fn add(bodies: BodySet, sim: &mut SimBuilder<'_>) {
    sim.add_column_to::<DensityGradient>(&bodies);
    let gradient = Gradient { bodies: bodies.clone(), sums: RowSums::default() };
    sim.add_system(
        System::new(Stage::Boundary, "density_gradient", gradient)
            .on_bodies(bodies)
            .after_any("wall_pressure")
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .reads_near::<Density>()
            .writes::<DensityGradient>(),
    );
}

struct Gradient {
    bodies: BodySet,
    sums: RowSums,
}

impl Run for Gradient {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let cloud = step.resources.get::<FlowCloud>();
        for id in self.bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            let density = view.read_near::<Density>()?;
            let mut gradient = view.write::<DensityGradient>()?;
            let at_rest = cloud.state(id).map_or(0.0, |state| state.density);
            let pass = DensityGradientPass { cloud: &cloud, rows: rows.clone(), density: &density, at_rest };
            cloud.for_each_row(rows.start, &mut gradient[rows], &mut self.sums, &pass);
        }
        Ok(())
    }
}

/// The pass over the particles of one body.
struct DensityGradientPass<'a> {
    cloud: &'a FlowCloud,
    rows: Range<usize>,
    density: &'a [Density],
    /// Density at zero pressure, kg/m3: what all have in common.
    at_rest: f64,
}

impl RowPass<1, 4> for DensityGradientPass<'_> {
    type Output = DensityGradient;

    fn among(&self) -> Range<usize> {
        self.rows.clone()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [DVec3::new(self.density[row].0 - self.at_rest, 0.0, 0.0)]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [xx, yy, zz, sum]: &mut [Vector<A>; 4],
    ) {
        let weight = near.volume * near.weight;
        add_moment([xx, yy, zz], weight, near.x_ij);
        *sum = near.x_ij.mul_add(weight * (other.x - own.x), *sum);
    }

    #[inline(always)]
    fn output(&self, _: usize, &[xx, yy, zz, sum]: &[DVec3; 4]) -> DensityGradient {
        let inverse = moment_of([xx, yy, zz], self.cloud.plane()).inverse();
        DensityGradient(inverse.map_or(DVec3::ZERO, |inverse| inverse * sum))
    }
}
