//! The renormalised gradient of the density: exact for a linear field, at a surface as well.

use meshless_engine::correction::MomentMatrix;
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::for_each_block;
use meshless_engine::plugin::SimBuilder;
use meshless_engine::schedule::{Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Density};

meshless_engine::column! {
    /// Renormalised gradient of the density of a fluid.
    pub struct DensityGradient(DVec3) = "density_gradient", "grad rho", "kg/m^4";
}

/// Adds the column and the system that fills it, once density and volume are those of the end of the step.
pub fn add(bodies: BodySet, sim: &mut SimBuilder<'_>) {
    sim.add_column_to::<DensityGradient>(&bodies);
    let phases = sim.phases_of(&bodies);
    sim.add_system(
        System::new(Stage::Boundary, "density_gradient", Gradient { bodies })
            .on_phases(phases)
            .reads::<Density>()
            .writes::<DensityGradient>(),
    );
}

struct Gradient {
    bodies: BodySet,
}

impl Run for Gradient {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let cloud: &FlowCloud = &cloud;
        let dimension = step.world.dimension().count();
        for id in self.bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            let density = view.read::<Density>()?;
            let density: &[Density] = &density;
            let mut gradient = view.write::<DensityGradient>()?;
            for_each_block(&mut gradient[rows.clone()], &mut Vec::new(), &|first, block: &mut [_]| {
                for (k, gradient) in block.iter_mut().enumerate() {
                    let i = rows.start + first + k;
                    let mut moment = MomentMatrix::new(dimension);
                    let mut sum = DVec3::ZERO;
                    cloud.for_each_neighbor(i, |near| {
                        if rows.contains(&near.row) {
                            let weight = near.volume * near.weight;
                            moment.add(weight, near.x_ij);
                            sum += near.x_ij * (weight * (density[near.row].0 - density[i].0));
                        }
                    });
                    *gradient =
                        DensityGradient(moment.inverse().map_or(DVec3::ZERO, |inverse| inverse * sum));
                }
            });
        }
        Ok(())
    }
}
