//! The renormalised gradient of the density: exact for a linear field, at a surface as well.

use std::ops::Range;

use meshless_engine::correction::FourMoments;
use meshless_engine::formulations::fluid::{FLOW_RECORDS, FlowCloud, RowPass, keep_rows};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{FourLanes, Vector};
use meshless_engine::plugin::SimBuilder;
use meshless_engine::schedule::{Mode, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Density};

meshless_engine::column! {
    /// Renormalised gradient of the density of a fluid.
    pub struct DensityGradient(DVec3) = "density_gradient", "grad rho", "kg/m^4";
}

/// Adds the column and the system that fills it, once density and volume are those of the end of the step.
pub fn add(bodies: BodySet, sim: &mut SimBuilder<'_>) {
    keep_rows(sim);
    sim.add_column_to::<DensityGradient>(&bodies);
    sim.add_system(
        System::new(Stage::Boundary, "density_gradient", Gradient { bodies: bodies.clone() })
            .on_bodies(bodies)
            .after_any("wall_pressure")
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_near::<Density>()
            .writes::<DensityGradient>(),
    );
}

struct Gradient {
    bodies: BodySet,
}

impl Run for Gradient {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let cloud = step.resources.get::<FlowCloud>();
        for id in self.bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            let density = view.read::<Density>()?;
            let mut gradient = view.write::<DensityGradient>()?;
            let pass = GradientPass { cloud: &cloud, rows: rows.clone(), density: &density };
            cloud.for_each_row(rows.start, &mut gradient[rows], &pass);
        }
        Ok(())
    }
}

/// The pass over the particles of one body.
struct GradientPass<'a> {
    cloud: &'a FlowCloud,
    rows: Range<usize>,
    density: &'a [Density],
}

impl RowPass for GradientPass<'_> {
    type Output = DensityGradient;

    #[inline(always)]
    fn row<A: FourLanes>(&self, a: A, i: usize) -> DensityGradient {
        let own = self.density[i].0;
        let mut moment = FourMoments::new(a);
        let mut sum = Vector::zero(a);
        for near in self.cloud.fours(a, i, &self.rows) {
            let weight = near.volume * near.weight;
            moment.add(weight, near.x_ij);
            sum = near.x_ij.mul_add(weight * (near.number(|j| self.density[j].0) - own), sum);
        }
        let inverse = moment.sum().inverse();
        DensityGradient(inverse.map_or(DVec3::ZERO, |inverse| inverse * sum.sum()))
    }
}
