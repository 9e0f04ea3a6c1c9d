//! Diffusion of the density of Eulerian solids (Mohseni-Mofidi and Bierwisch 2020, eq. 21).
//!
//! `d ln V_i/dt = -(2 delta h c / s_i) sum_j V_j w_ij [(s_j - s_i) - (g_i + g_j) . x_ij / 2]` with the
//! density over that of the start, `s = 1 / det F`, and `c = sqrt(K / rho_0)`. The gradient g is that of
//! fluids; the paper has none. Without it, bending, which is a linear field of pressure, would be diffused
//! away.
//!
//! A failed particle bears no tension. Where it is open, `s < 1`, it counts with s = 1, the density without
//! pressure: otherwise what is intact beside debris would be expanded towards the density of a void.

use meshless_engine::bytemuck;
use meshless_engine::correction::MomentMatrix;
use meshless_engine::formulations::eulerian::DilatationRate;
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Maximum, for_each_block};
use meshless_engine::plugin::{SetupError, SimBuilder};
use meshless_engine::schedule::{Access, Mode, Run, Stage, Step, StepError, System};
use meshless_engine::solids::{PACKED_SOLID, PresentPair, PresentPairs, PresentVolumes, fill_rows};
use meshless_engine::world::{
    BodyId, BodySet, Column, ColumnSet, Damage, DeformationGradient, Position, ReferenceVolume, Removed,
    SupportRadius,
};

use crate::Model;

/// Share of the step at which the explicit update of the density becomes unstable.
const SAFETY: f64 = 0.5;

/// Adds the system that finds the rates at the end of each step of the bodies.
pub fn add(bodies: &BodySet, model: Model, delta: f64, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    let mut diffusers = Vec::new();
    let mut state = ColumnSet::default();
    for body in bodies.iter() {
        let plan = sim.body(body);
        let law = plan.solid_law()?;
        law.state(&mut state);
        let bulk = law.elastic().bulk;
        let speed = (bulk / plan.material.density).sqrt();
        diffusers.push(Diffuser { body, speed: 2.0 * delta * speed });
    }
    sim.add_column_to::<DilatationRate>(bodies);
    let corrected = model == Model::Antuono;
    let axes = sim.dimension().count();
    let diffusion = Diffusion {
        diffusers,
        corrected,
        axes,
        volumes: PresentVolumes::default(),
        densities: Vec::new(),
        gradients: Vec::new(),
        sums: Vec::new(),
    };
    let phases = sim.phases_of(bodies);
    let damage = state.get(Damage::NAME).map(|_| Access { column: Damage::NAME, mode: Mode::ReadsNear });
    sim.add_system(
        System::new(Stage::PostStep, "density_diffusion", diffusion)
            .touches_all(damage)
            .on_phases(phases)
            .by_body()
            .reads_near::<Position>()
            .touches(PACKED_SOLID, Mode::ReadsNear)
            .reads::<SupportRadius>()
            .reads_near::<ReferenceVolume>()
            .reads_near::<DeformationGradient>()
            .reads_near::<Removed>()
            .adds::<DilatationRate>(),
    );
    Ok(())
}

/// A body, and 2 delta c, m/s.
#[derive(Clone, Copy)]
struct Diffuser {
    body: BodyId,
    speed: f64,
}

struct Diffusion {
    diffusers: Vec<Diffuser>,
    corrected: bool,
    axes: usize,
    volumes: PresentVolumes,
    /// Density over that of the start, and its gradient, 1/m, of all rows of the phase of a body.
    densities: Vec<f64>,
    gradients: Vec<DVec3>,
    sums: Vec<Maximum>,
}

impl Run for Diffusion {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for k in 0..self.diffusers.len() {
            let diffuser = self.diffusers[k];
            if step.part.is_due(step.world, diffuser.body) {
                self.diffuse(diffuser, step)?;
            }
        }
        Ok(())
    }
}

impl Diffusion {
    fn diffuse(&mut self, Diffuser { body, speed }: Diffuser, step: &mut Step<'_>) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(body);
        let Some(solid) = step.resources.solid(step.world.body(body).phase) else { return Ok(()) };
        let position = view.read::<Position>()?;
        // 2 delta h c, m2/s
        let strength = speed * 0.5 * view.read::<SupportRadius>()?[rows.start].0;
        let deformation = view.read::<DeformationGradient>()?;
        let deformation = &deformation[..];
        let damage = if view.has::<Damage>() { Some(view.read_near::<Damage>()?) } else { None };
        let damage: &[Damage] = damage.as_deref().unwrap_or_default();
        let has_failed = |row: usize| damage.get(row).is_some_and(|damage| damage.0 >= 1.0);
        let Self { volumes, densities, gradients, sums, .. } = self;
        let volumes = volumes.of_body(&view, &rows)?;
        densities.resize(volumes.len(), 0.0);
        gradients.resize(volumes.len(), DVec3::ZERO);
        fill_rows(&mut densities[rows.clone()], rows.start, |row| {
            if volumes[row] <= 0.0 {
                return 0.0;
            }
            let density = 1.0 / deformation[row].0.determinant();
            if has_failed(row) { density.max(1.0) } else { density }
        });
        let pairs = PresentPairs { solid: &*solid, position: bytemuck::cast_slice(&position), volumes };
        let field = DensityField { pairs, densities, axes: self.axes };
        if self.corrected {
            fill_rows(&mut gradients[rows.clone()], rows.start, |row| field.gradient(row));
        }
        let mut out = view.write::<DilatationRate>()?;
        let own = &mut out[rows.clone()];
        let fastest = for_each_block(own, sums, &|first, own: &mut [DilatationRate]| {
            let rates = own.iter_mut().zip(rows.start + first..).map(|(out, row)| {
                let (rate, weight) = field.rate(row, gradients);
                out.0 = strength * rate;
                strength * weight
            });
            Maximum::of(rates)
        });
        drop((out, solid));
        if fastest.0 > 0.0 {
            let name = &step.world.body(body).name;
            step.limits.propose(SAFETY / fastest.0, format_args!("density diffusion in `{name}`"));
        }
        Ok(())
    }
}

/// The density of a body.
struct DensityField<'a> {
    pairs: PresentPairs<'a>,
    /// Over that of the start.
    densities: &'a [f64],
    axes: usize,
}

impl DensityField<'_> {
    /// Calls `f` with every neighbour of a row that is there.
    fn of(&self, row: usize, f: impl FnMut(PresentPair)) {
        if self.pairs.volumes[row] > 0.0 {
            self.pairs.of(row, f);
        }
    }

    /// The renormalised gradient of the density, 1/m; zero where the neighbours have none.
    fn gradient(&self, row: usize) -> DVec3 {
        let (mut moment, mut sum) = (MomentMatrix::new(self.axes), DVec3::ZERO);
        self.of(row, |PresentPair { row: j, x_ij, weight, .. }| {
            moment.add(weight, x_ij);
            sum += weight * (self.densities[j] - self.densities[row]) * x_ij;
        });
        moment.inverse().map_or(DVec3::ZERO, |inverse| inverse * sum)
    }

    /// The rate of ln V over the strength, and that at which a density comes to those around it, 1/m2.
    fn rate(&self, row: usize, gradients: &[DVec3]) -> (f64, f64) {
        let own = self.densities[row];
        let (mut sum, mut weights) = (0.0, 0.0);
        self.of(row, |PresentPair { row: j, signs, x_ij, weight }| {
            let slope = 0.5 * (gradients[row] + gradients[j] * signs).dot(x_ij);
            sum += weight * (self.densities[j] - own - slope);
            weights += weight;
        });
        if own > 0.0 { (-sum / own, weights) } else { (0.0, 0.0) }
    }
}
