//! Diffusion of the density of Eulerian solids (Mohseni-Mofidi and Bierwisch 2020, eq. 21).
//!
//! `d ln V_i/dt = -(2 delta h c / s_i) sum_j V_j w_ij [(s_j - s_i) - (g_i + g_j) . x_ij / 2]` with the density over that of the start, `s = 1 / det F`, and `c = sqrt(K / rho_0)`.
//! The gradient g is that of fluids; the paper has none. Without it, bending, which is a linear field of pressure, would be diffused away.

use meshless_engine::bytemuck;
use meshless_engine::correction::MomentMatrix;
use meshless_engine::formulations::eulerian::DilatationRate;
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::for_each_block;
use meshless_engine::plugin::{SetupError, SimBuilder};
use meshless_engine::schedule::{Run, Stage, Step, StepError, System};
use meshless_engine::solids::SolidPhase;
use meshless_engine::world::{
    BodyId, BodySet, DeformationGradient, Position, ReferenceVolume, Removed, SupportRadius,
};

use crate::Model;

/// Share of the step at which the explicit update of the density becomes unstable.
const SAFETY: f64 = 0.5;

/// Adds the system that finds the rates at the end of each step of the bodies.
pub fn add(bodies: &BodySet, model: Model, delta: f64, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    let mut diffusers = Vec::new();
    for body in bodies.iter() {
        let plan = sim.body(body);
        let bulk = plan.solid_law()?.elastic().bulk;
        let speed = (bulk / plan.material.density).sqrt();
        diffusers.push(Diffuser { body, speed: 2.0 * delta * speed });
    }
    sim.add_column_to::<DilatationRate>(bodies);
    let corrected = model == Model::Antuono;
    let axes = sim.dimension().count();
    let diffusion =
        Diffusion { diffusers, corrected, axes, rows: Vec::new(), gradients: Vec::new(), rates: Vec::new() };
    let phases = sim.phases_of(bodies);
    sim.add_system(
        System::new(Stage::PostStep, "density_diffusion", diffusion)
            .on_phases(phases)
            .by_body()
            .reads::<Position>()
            .reads::<SupportRadius>()
            .reads::<ReferenceVolume>()
            .reads::<DeformationGradient>()
            .reads::<Removed>()
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

/// Volume, m3, zero for a removed particle, and density over that of the start.
#[derive(Clone, Copy, Default)]
struct Row {
    volume: f64,
    density: f64,
}

struct Diffusion {
    diffusers: Vec<Diffuser>,
    corrected: bool,
    axes: usize,
    /// Of all rows of the phase of a body.
    rows: Vec<Row>,
    gradients: Vec<DVec3>,
    /// Rate of ln V, and the sum of the weights that limits the step, 1/s, of the rows of a body.
    rates: Vec<(f64, f64)>,
}

impl Run for Diffusion {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for k in 0..self.diffusers.len() {
            let diffuser = self.diffusers[k];
            if step.turn.is_due(step.world, diffuser.body) {
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
        let (volume, removed) = (view.read::<ReferenceVolume>()?, view.read::<Removed>()?);
        let deformation = view.read::<DeformationGradient>()?;
        self.rows.resize(volume.len(), Row::default());
        self.gradients.resize(volume.len(), DVec3::ZERO);
        self.rates.resize(rows.len(), (0.0, 0.0));
        for row in rows.clone() {
            let stretch = deformation[row].0.determinant();
            let there = removed[row] == Removed::NO && stretch > 0.0;
            self.rows[row] = if there {
                Row { volume: volume[row].0 * stretch, density: 1.0 / stretch }
            } else {
                Row::default()
            };
        }
        let Self { rows: all, gradients, rates, corrected, axes, .. } = self;
        let pairs =
            Pairs { solid: &*solid, position: bytemuck::cast_slice(&position), rows: all, axes: *axes };
        if *corrected {
            for_each_block(
                &mut gradients[rows.clone()],
                &mut Vec::new(),
                &|first, gradients: &mut [DVec3]| {
                    gradients
                        .iter_mut()
                        .zip(rows.start + first..)
                        .for_each(|(g, row)| *g = pairs.gradient(row));
                },
            );
        }
        for_each_block(&mut rates[..], &mut Vec::new(), &|first, rates: &mut [(f64, f64)]| {
            rates
                .iter_mut()
                .zip(rows.start + first..)
                .for_each(|(rate, row)| *rate = pairs.rate(row, gradients));
        });
        let mut out = view.write::<DilatationRate>()?;
        let mut fastest = 0.0f64;
        for (row, (rate, weight)) in rows.zip(&*rates) {
            out[row].0 = strength * rate;
            fastest = fastest.max(strength * weight);
        }
        drop((out, solid));
        if fastest > 0.0 {
            let name = &step.world.body(body).name;
            step.limits.propose(SAFETY / fastest, format_args!("density diffusion in `{name}`"));
        }
        Ok(())
    }
}

/// The pairs of a body.
struct Pairs<'a> {
    solid: &'a dyn SolidPhase,
    position: &'a [DVec3],
    rows: &'a [Row],
    axes: usize,
}

impl Pairs<'_> {
    /// Calls `f` with the row of every neighbour, the signs of the axes of its mirror image, the pair vector and V_j w_ij.
    fn of(&self, row: usize, mut f: impl FnMut(usize, DVec3, DVec3, f64)) {
        let ghosts = self.solid.ghosts();
        if self.rows[row].volume > 0.0 {
            self.solid.neighbors(row, &mut |j, weight| {
                let source = ghosts.source(j);
                let signs = ghosts.mirror(j).unwrap_or(DVec3::ONE);
                f(source, signs, ghosts.pair(self.position, row, j), self.rows[source].volume * weight);
            });
        }
    }

    /// The renormalised gradient of the density, 1/m; zero where the neighbours have none.
    fn gradient(&self, row: usize) -> DVec3 {
        let (mut moment, mut sum) = (MomentMatrix::new(self.axes), DVec3::ZERO);
        self.of(row, |j, _, x, weight| {
            moment.add(weight, x);
            sum += weight * (self.rows[j].density - self.rows[row].density) * x;
        });
        moment.inverse().map_or(DVec3::ZERO, |inverse| inverse * sum)
    }

    /// The rate of ln V over the strength, and that at which a density comes to those around it, 1/m2.
    fn rate(&self, row: usize, gradients: &[DVec3]) -> (f64, f64) {
        let own = self.rows[row].density;
        let (mut sum, mut weights) = (0.0, 0.0);
        self.of(row, |j, signs, x, weight| {
            let slope = 0.5 * (gradients[row] + gradients[j] * signs).dot(x);
            sum += weight * (self.rows[j].density - own - slope);
            weights += weight;
        });
        if own > 0.0 { (-sum / own, weights) } else { (0.0, 0.0) }
    }
}
