//! Particle shifting (delta-plus-SPH): moves fluid particles a little from where they are dense to where they are sparse.
//!
//! `dx_i = -2 h v_max dt sum_j V_j (1 + 0.2 (W_ij / W(dp))^4) w_ij x_ij` over fluid and walls (Sun et al. 2017, eq. 20, with the step of this
//! engine in place of their Courant number). Near a free surface only the part along the surface is kept, at the surface
//! nothing; where that is tells the smallest eigenvalue lambda of the moment matrix `sum_j V_j w_ij x_ij (x) x_ij`.
//!
//! The flow crowds particles and the shifting spreads them: a density that only the flow changes would creep upwards. So it takes part,
//! `drho_i = rho_i dx_i . sum_j c_j V_j w_ij x_ij` with c_j = 2 for fluids, 1 for walls, which is what the flow gains in the mean (see also P. N. Sun, A. Colagrossi, S. Marrone, M. Antuono, A. M. Zhang, Comput. Methods Appl. Mech.
//! Engrg. 348 (2019) 912-934).

mod surface;

use meshless_engine::formulations::fluid::{FlowCloud, Group, RowPass, SmallestEigenvalue, displace};
use meshless_engine::glam::DVec3;
use meshless_engine::materials::ParameterError;
use meshless_engine::parallel::{Arithmetic, Vector, for_each_block};
use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{AccountKind, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodyId, BodySet, Density, Mass, Position, Removed, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<ParticleShifting>();
}

/// Keeps the particles of fluids evenly spread, so that flows with stagnation points form no gaps and threads.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ParticleShifting {
    /// Strength over that of the source.
    pub strength: f64,
}

impl Default for ParticleShifting {
    fn default() -> Self {
        Self { strength: 6.0 }
    }
}

impl Plugin for ParticleShifting {
    const NAME: &'static str = "particle_shifting";
    const REFERENCE: &'static str = "particle shifting: P. N. Sun, A. Colagrossi, S. Marrone, A. M. Zhang, Comput. Methods Appl. Mech. Engrg. 315 (2017) 25-49";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        ParameterError::require_not_negative("strength", self.strength)?;
        let bodies = sim.scope_of("Fluid");
        if self.strength == 0.0 || bodies.is_empty() {
            return Ok(());
        }
        let phases = sim.phases_of(&bodies);
        let work = Shifting {
            strength: self.strength,
            gravity: sim.gravity(),
            bodies,
            lambda: Vec::new(),
            moves: Vec::new(),
            shifts: Vec::new(),
            sums: Vec::new(),
        };
        sim.add_system(
            System::new(Stage::PostStep, Self::NAME, work)
                .on_phases(phases)
                .reads::<Velocity>()
                .reads::<Mass>()
                .writes::<Density>()
                .adds::<Position>(),
        );
        Ok(())
    }
}

/// Largest displacement of a step over the spacing.
const LARGEST: f64 = 0.05;
/// Strength of the part that keeps close particles apart, with the fourth power of their kernel.
const CLOSE: f64 = 0.2;

struct Shifting {
    strength: f64,
    gravity: DVec3,
    bodies: BodySet,
    /// Smallest eigenvalues of the moment matrices, row by row of the fluid.
    lambda: Vec<f64>,
    moves: Vec<DVec3>,
    shifts: Vec<Shift>,
    sums: Vec<f64>,
}

impl Run for Shifting {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let cloud: &FlowCloud = &cloud;
        self.lambda.resize(cloud.fluid, 0.0);
        cloud.for_each_row(0, &mut self.lambda, &SmallestEigenvalue(cloud));
        for id in self.bodies.clone().iter() {
            self.shift(step, cloud, id)?;
            displace(step, id, &self.moves, self.gravity, ParticleShifting::NAME)?;
            self.spread(step, cloud, id)?;
        }
        Ok(())
    }
}

impl Shifting {
    fn shift(&mut self, step: &Step<'_>, cloud: &FlowCloud, id: BodyId) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(id);
        let spacing = step.world.body(id).spacing;
        let velocity = view.read::<Velocity>()?;
        let fastest = velocity[rows.clone()].iter().map(|v| v.0.length_squared()).fold(0.0, f64::max).sqrt();
        let factor = -2.0 * self.strength * cloud.kernel.smoothing_length() * fastest * step.clock.dt;
        let pass = Moves {
            cloud,
            lambda: &self.lambda,
            factor,
            usual: 1.0 / cloud.kernel.value(spacing),
            largest: LARGEST * spacing,
        };
        self.shifts.resize(rows.len(), Shift::default());
        cloud.for_each_row(rows.start, &mut self.shifts, &pass);
        self.moves.clear();
        self.moves.extend(self.shifts.iter().map(|shift| shift.by));
        Ok(())
    }

    /// Changes the density, and books the energy of compression that this takes.
    fn spread(&mut self, step: &mut Step<'_>, cloud: &FlowCloud, id: BodyId) -> Result<(), StepError> {
        let Some(state) = cloud.groups.iter().find(|group| group.body == id).and_then(Group::fluid) else {
            return Ok(());
        };
        let (view, rows) = step.world.body_view(id);
        let mut density = view.write::<Density>()?;
        let (mass, removed) = (view.read::<Mass>()?, view.read::<Removed>()?);
        let energy = |rho| state.eos.energy(rho, state.density, state.sound_speed);
        let slices = (&mut density[rows.clone()], &self.shifts[..], &mass[rows.clone()], &removed[rows]);
        type Rows<'a> = (&'a mut [Density], &'a [Shift], &'a [Mass], &'a [Removed]);
        let taken =
            for_each_block(slices, &mut self.sums, &|_, (density, shifts, mass, removed): Rows<'_>| {
                let mut taken = 0.0;
                for k in (0..density.len()).filter(|&k| removed[k] == Removed::NO) {
                    let before = density[k].0;
                    density[k].0 = before * (1.0 + shifts[k].strain);
                    taken += mass[k].0 * (energy(before) - energy(density[k].0));
                }
                taken
            });
        let account = step.ledger.account(ParticleShifting::NAME, AccountKind::Dissipated);
        step.ledger.add(account, id, taken);
        Ok(())
    }
}

/// What is done to a particle.
#[derive(Clone, Copy, Debug, Default)]
struct Shift {
    /// Displacement, m.
    by: DVec3,
    /// Change of the density over the density.
    strain: f64,
}

/// The displacements of the particles of one body.
struct Moves<'a> {
    cloud: &'a FlowCloud,
    lambda: &'a [f64],
    factor: f64,
    /// One over the kernel at the spacing.
    usual: f64,
    /// Largest displacement, m.
    largest: f64,
}

impl RowPass for Moves<'_> {
    type Output = Shift;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> Shift {
        if self.lambda[i] < surface::AT_SURFACE {
            return Shift::default();
        }
        let (mut sum, mut crowding) = (Vector::zero(a), Vector::zero(a));
        let fluids = self.cloud.fluid;
        for near in self.cloud.fours(a, i, &self.cloud.everything()) {
            let weight = near.volume * near.weight;
            let close = 1.0 + CLOSE * (near.kernel * self.usual).squared().squared();
            sum = near.x_ij.mul_add(weight * close, sum);
            crowding =
                near.x_ij.mul_add(weight * near.number(|j| if j < fluids { 2.0 } else { 1.0 }), crowding);
        }
        let mut by = sum.sum() * self.factor;
        if self.lambda[i] < surface::INSIDE {
            let normal = surface::normal(a, self.cloud, self.lambda, i);
            by -= normal * normal.dot(by);
        }
        let by = by.clamp_length_max(self.largest);
        Shift { by, strain: by.dot(crowding.sum()) }
    }
}
