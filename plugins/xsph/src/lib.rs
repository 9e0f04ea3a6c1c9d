//! XSPH: fluid particles move with a velocity between their own and the mean around them.
//!
//! `dx_i/dt = v_i + epsilon sum_j V_j W_ij (v_ij - L_i x_ij)` over the neighbours of the same body, with the
//! velocity gradient `L_i = (sum_j V_j w_ij v_ij (x) x_ij) M_i^-1`, `M_i = sum_j V_j w_ij x_ij (x) x_ij`.
//! Velocities and forces do not change; densities follow the displacements.
//!
//! Inside of a fluid this is the mean velocity of XSPH, because `sum_j V_j W_ij x_ij` vanishes there. Beside
//! walls and surfaces it does not: the plain mean would carry particles into a wall that the flow meets, and
//! out of a body that turns, while the density follows the flow alone.

use std::ops::Range;

use meshless_engine::correction::{add_gradient, add_moment, moment_of};
use meshless_engine::formulations::fluid::{
    DensityShift, DisplacementAccount, FLOW_RECORDS, FlowCloud, NearPairs, Repayment, RowPass, RowSums,
    displace,
};
use meshless_engine::glam::DVec3;
use meshless_engine::materials::ParameterError;
use meshless_engine::parallel::{Arithmetic, Vector};
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{Mode, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Density, Mass, Position, Removed, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Minimum determinant of M_i in units of `(tr M_i / d)^d`: neighbours that are nearly on a line, in spray,
/// give no velocity gradient across it.
const MIN_SPREAD: f64 = 0.1;

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
        sim.add_column_to::<DensityShift>(&bodies);
        sim.leave_note(DisplacementAccount { bodies: bodies.clone(), name: Self::NAME });
        let gravity = sim.gravity();
        let work = XsphSystem {
            epsilon: self.epsilon,
            gravity,
            bodies: bodies.clone(),
            moves: Vec::new(),
            dilations: Vec::new(),
            repayment: Repayment::default(),
            sums: RowSums::default(),
        };
        sim.add_system(
            System::new(Stage::PostStep, Self::NAME, work)
                .on_bodies(bodies)
                .after_any("local_damping")
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads_near::<Velocity>()
                .writes::<Velocity>()
                .reads::<Mass>()
                .reads::<Density>()
                .reads::<Removed>()
                .adds::<DensityShift>()
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
    dilations: Vec<f64>,
    repayment: Repayment,
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
            let plane = cloud.plane();
            let pass = Mean { rows: rows.clone(), velocity: &velocity, plane, factor };
            cloud.for_each_row(rows.start, &mut self.moves, &mut self.sums, &pass);
            drop(velocity);
            self.dilations.resize(rows.len(), 0.0);
            let pass = Dilation { cloud, rows: rows.clone(), moves: &self.moves };
            cloud.for_each_row(rows.start, &mut self.dilations, &mut self.sums, &pass);
            let (density, mut shift) = (view.read::<Density>()?, view.write::<DensityShift>()?);
            for (row, dilation) in rows.zip(&self.dilations) {
                shift[row].0 -= density[row].0 * dilation / (1.0 + 0.5 * dilation);
            }
            drop((density, shift));
            self.repayment.pay(step, cloud, id, Xsph::NAME)?;
            displace(step, id, &self.moves, self.gravity, Xsph::NAME)?;
        }
        Ok(())
    }
}

/// The pass over the particles of one body.
struct Mean<'a> {
    rows: Range<usize>,
    velocity: &'a [Velocity],
    plane: bool,
    factor: f64,
}

impl RowPass<1, 8> for Mean<'_> {
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
        [xx, yy, zz, along_x, along_y, along_z, middle, sum]: &mut [Vector<A>; 8],
    ) {
        let (weight, share, v_ij) = (near.volume * near.weight, near.volume * near.kernel, *other - *own);
        add_moment([xx, yy, zz], weight, near.x_ij);
        add_gradient([along_x, along_y, along_z], weight, near.x_ij, v_ij);
        *middle = near.x_ij.mul_add(share, *middle);
        *sum = v_ij.mul_add(share, *sum);
    }

    #[inline(always)]
    fn output(&self, _: usize, &[xx, yy, zz, along_x, along_y, along_z, middle, sum]: &[DVec3; 8]) -> DVec3 {
        let moment = moment_of([xx, yy, zz], self.plane);
        let linear = moment.inverse_above(MIN_SPREAD).map_or(DVec3::ZERO, |inverse| {
            let middle = inverse * middle;
            DVec3::new(along_x.dot(middle), along_y.dot(middle), along_z.dot(middle))
        });
        (sum - linear) * self.factor
    }
}

/// The pass that computes the change of volume over the volume by the displacements, `sum_j V_j (dx_j - dx_i)
/// . grad_i W` halfway along them, over the body itself: what a wall does against displacements toward it is
/// no work of its, and would feed the flow.
struct Dilation<'a> {
    cloud: &'a FlowCloud,
    rows: Range<usize>,
    moves: &'a [DVec3],
}

impl RowPass<1, 1> for Dilation<'_> {
    type Output = f64;

    fn among(&self) -> Range<usize> {
        self.rows.clone()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [self.moves[row - self.rows.start]]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [sum]: &mut [Vector<A>; 1],
    ) {
        sum.x += near.dilation(&self.cloud.kernel, *own, *other);
    }

    #[inline(always)]
    fn output(&self, _: usize, [sum]: &[DVec3; 1]) -> f64 {
        sum.x
    }
}
