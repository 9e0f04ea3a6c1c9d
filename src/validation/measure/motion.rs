//! The motion of a material point, and the momentum of bodies.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{
    BodyId, DeformationGradient, Force, Mass, Position, ReferencePosition, Velocity,
};

/// The body of that name.
pub fn body(simulation: &Simulation, name: &str) -> Result<BodyId> {
    let bodies = simulation.world().bodies();
    let k = bodies.iter().position(|body| body.name == name);
    Ok(BodyId(k.with_context(|| format!("the scene has no body `{name}`"))?))
}

/// A material point that need not be a particle: the nearest particle moves it by its deformation gradient.
/// Equally near particles are averaged, so that a symmetric motion is measured symmetrically.
pub struct MaterialPoint {
    body: BodyId,
    rows: Vec<usize>,
    point: DVec3,
}

impl MaterialPoint {
    /// The point of a body with the position `point` in the reference configuration.
    pub fn new(simulation: &Simulation, body: BodyId, point: DVec3) -> Result<Self> {
        let (view, rows) = simulation.world().body_view(body);
        let reference = view.read::<ReferencePosition>()?;
        let distance = |row: usize| reference[row].0.distance(point);
        let least = rows.clone().map(distance).min_by(f64::total_cmp).context("the body has no particle")?;
        let margin = 1e-6 * simulation.world().body(body).spacing;
        Ok(Self { body, rows: rows.filter(|&row| distance(row) < least + margin).collect(), point })
    }

    /// Current position, m.
    pub fn position(&self, simulation: &Simulation) -> Result<DVec3> {
        let (view, _) = simulation.world().body_view(self.body);
        let reference = view.read::<ReferencePosition>()?;
        let gradient = view.read::<DeformationGradient>()?;
        let position = view.read::<Position>()?;
        let carried = |&row: &usize| position[row].0 + gradient[row].0 * (self.point - reference[row].0);
        Ok(self.rows.iter().map(carried).sum::<DVec3>() / self.rows.len() as f64)
    }

    /// Reaction of the condition that holds its particles, N: minus the force of the bonds.
    pub fn force(&self, simulation: &Simulation) -> Result<DVec3> {
        let (view, _) = simulation.world().body_view(self.body);
        let force = view.read::<Force>()?;
        Ok(self.rows.iter().map(|&row| -force[row].0).sum())
    }

    /// Displacement, m.
    pub fn displacement(&self, simulation: &Simulation) -> Result<DVec3> {
        Ok(self.position(simulation)? - self.point)
    }
}

/// Bound on the change of momentum of a flow per second by rounding in single precision, N: 3e-9 of the
/// magnitudes of the pressure forces of all pairs with 32 k particles. The errors of different particles are
/// independent, so that the bound falls with the root of their number.
pub fn rounded_forces(simulation: &Simulation) -> f64 {
    let cloud = simulation.resources().get::<FlowCloud>();
    let records = cloud.records();
    let of = |i: usize| {
        let mut sum = 0.0;
        cloud.for_each_neighbor(i, |near| {
            let pressure = (records[i].pressure() + records[near.row].pressure()).abs();
            sum += near.volume * near.weight * near.distance * pressure;
        });
        cloud.volume(i) * sum
    };
    let forces: f64 = (0..cloud.fluid).map(of).sum();
    3e-9 * (32_768.0 / cloud.fluid as f64).sqrt() * forces
}

/// Momentum of the particles of some bodies, kg m/s.
pub fn momentum(simulation: &Simulation, bodies: impl IntoIterator<Item = BodyId>) -> Result<DVec3> {
    let mut total = DVec3::ZERO;
    for body in bodies {
        let (view, rows) = simulation.world().body_view(body);
        let (mass, velocity) = (view.read::<Mass>()?, view.read::<Velocity>()?);
        total += rows.map(|row| mass[row].0 * velocity[row].0).sum::<DVec3>();
    }
    Ok(total)
}
