//! Disorder of particles: deviation of their positions from their deformation gradients.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, DeformationGradient, Position, ReferencePosition, SupportRadius};

/// The pairs of a body within the kernel support of the reference configuration.
pub struct Disorder {
    body: BodyId,
    pairs: Vec<(u32, u32)>,
}

impl Disorder {
    /// Finds the pairs of a body.
    pub fn new(simulation: &Simulation, body: BodyId) -> Result<Self> {
        Self::within(simulation, body, |_| true)
    }

    /// Finds the pairs of the particles of a body whose reference position is chosen.
    pub fn within(simulation: &Simulation, body: BodyId, chosen: impl Fn(DVec3) -> bool) -> Result<Self> {
        let (view, rows) = simulation.world().body_view(body);
        let reference = view.read::<ReferencePosition>()?;
        let support = view.read::<SupportRadius>()?;
        let mut order: Vec<usize> = rows.filter(|&row| chosen(reference[row].0)).collect();
        order.sort_by(|&a, &b| reference[a].0.x.total_cmp(&reference[b].0.x));
        let mut pairs = Vec::new();
        for (k, &i) in order.iter().enumerate() {
            for &j in &order[k + 1..] {
                let apart = reference[j].0 - reference[i].0;
                let reach = 0.5 * (support[i].0 + support[j].0);
                if apart.x >= reach {
                    break;
                }
                if apart.length() < reach {
                    pairs.extend([(i as u32, j as u32), (j as u32, i as u32)]);
                }
            }
        }
        Ok(Self { body, pairs })
    }

    /// Number of neighbours of a particle, on average.
    pub fn mean_neighbors(&self, simulation: &Simulation) -> f64 {
        self.pairs.len() as f64 / simulation.world().body(self.body).rows.len() as f64
    }

    /// Root mean square of |F X - x| / |X| over all pairs: below 0.05 particles are ordered, above 0.3 they
    /// are not.
    pub fn measure(&self, simulation: &Simulation) -> Result<f64> {
        let mut sum = 0.0;
        self.visit(simulation, |apart, expected, actual| {
            sum += (expected - actual).length_squared() / apart.length_squared();
        })?;
        Ok((sum / self.pairs.len() as f64).sqrt())
    }

    /// Minimum |x| / |F X| of all pairs: below one half, particles are closer than their deformation
    /// gradients imply.
    pub fn closest(&self, simulation: &Simulation) -> Result<f64> {
        let mut least = f64::INFINITY;
        self.visit(simulation, |_, expected, actual| {
            least = least.min(actual.length_squared() / expected.length_squared());
        })?;
        Ok(least.sqrt())
    }

    /// Calls a function with X, F X and x of every pair.
    fn visit(&self, simulation: &Simulation, mut each: impl FnMut(DVec3, DVec3, DVec3)) -> Result<()> {
        let (view, _) = simulation.world().body_view(self.body);
        let reference = view.read::<ReferencePosition>()?;
        let position = view.read::<Position>()?;
        let gradient = view.read::<DeformationGradient>()?;
        for &(i, j) in &self.pairs {
            let (i, j) = (i as usize, j as usize);
            let apart = reference[j].0 - reference[i].0;
            each(apart, gradient[i].0 * apart, position[j].0 - position[i].0);
        }
        Ok(())
    }
}
