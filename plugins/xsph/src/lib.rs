//! XSPH: fluid particles move with a velocity between their own and the mean around them.
//!
//! `dx_i/dt = v_i + epsilon sum_j V_j W_ij v_ij` over the neighbours of the same body. Velocities and forces
//! do not change.

use std::ops::Range;

use meshless_engine::formulations::fluid::{FLOW_RECORDS, FlowCloud, NearPairs, RowPass, RowSums, displace};
use meshless_engine::glam::DVec3;
use meshless_engine::materials::ParameterError;
use meshless_engine::parallel::{Arithmetic, Vector};
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{Mode, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Mass, Position, Removed, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<Xsph>();
}

/// Moves fluid particles with the mean velocity around them, so that they keep their order and do not pass
/// through each other.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Xsph {
    /// Share epsilon of the mean velocity, 0 to 1.
    pub epsilon: f64,
}

impl Default for Xsph {
    fn default() -> Self {
        Self { epsilon: 0.5 }
    }
}

impl Plugin for Xsph {
    const NAME: &'static str = "xsph";
    const REFERENCE: &'static str = "XSPH: J. J. Monaghan, J. Comput. Phys. 82 (1989) 1-15";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        if !(0.0..=1.0).contains(&self.epsilon) {
            let message = format!("`epsilon` must be from 0 to 1, found {}", self.epsilon);
            return Err(ParameterError::new("epsilon", message, "0.5 is usual").into());
        }
        let bodies = sim.scope_of(BodyKind::Fluid)?;
        if self.epsilon == 0.0 || bodies.is_empty() {
            return Ok(());
        }
        let gravity = sim.gravity();
        let work = XsphSystem {
            epsilon: self.epsilon,
            gravity,
            bodies: bodies.clone(),
            moves: Vec::new(),
            sums: RowSums::default(),
        };
        sim.add_system(
            System::new(Stage::PostStep, Self::NAME, work)
                .on_bodies(bodies)
                .after_any("local_damping")
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads_near::<Velocity>()
                .reads::<Mass>()
                .reads::<Removed>()
                .adds::<Position>(),
        );
        Ok(())
    }
}

struct XsphSystem {
    epsilon: f64,
    gravity: DVec3,
    bodies: BodySet,
    moves: Vec<DVec3>,
    sums: RowSums,
}

impl Run for XsphSystem {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let cloud: &FlowCloud = &cloud;
        let factor = self.epsilon * step.clock.dt;
        for id in self.bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            self.moves.resize(rows.len(), DVec3::ZERO);
            let velocity = view.read_near::<Velocity>()?;
            let pass = Mean { rows: rows.clone(), velocity: &velocity, factor };
            cloud.for_each_row(rows.start, &mut self.moves, &mut self.sums, &pass);
            displace(step, id, &self.moves, self.gravity, Xsph::NAME)?;
        }
        Ok(())
    }
}

/// The pass over the particles of one body.
struct Mean<'a> {
    rows: Range<usize>,
    velocity: &'a [Velocity],
    factor: f64,
}

impl RowPass<1, 1> for Mean<'_> {
    type Output = DVec3;

    fn among(&self) -> Range<usize> {
        self.rows.clone()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [self.velocity[row].0]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [sum]: &mut [Vector<A>; 1],
    ) {
        *sum = (*other - *own).mul_add(near.volume * near.kernel, *sum);
    }

    #[inline(always)]
    fn output(&self, _: usize, [sum]: &[DVec3; 1]) -> DVec3 {
        *sum * self.factor
    }
}
