//! Taylor bars: what is measured of the body that hits a wall.

use anyhow::{Context, Result};
use meshless_engine::glam::DVec3;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, DeformationGradient, PlasticStrain, Position, ReferencePosition};

use crate::measure::{Balance, run};

/// The shape of a bar at the end of a run.
pub struct Shape {
    /// Extent along the axis, m.
    pub length: f64,
    /// Largest distance of its surface from the axis, m.
    pub radius: f64,
    /// Largest plastic strain of a particle.
    pub plastic_strain: f64,
    /// Energy balance.
    pub balance: Balance,
}

/// Runs a bar to the end; its axis is `axis` through the origin.
pub fn impact(simulation: &mut Simulation, axis: DVec3) -> Result<Shape> {
    let balance = run(simulation, |_| Ok(()))?;
    measure(simulation, axis, balance)
}

/// The surface is half a spacing from the outermost particles, carried by their deformation gradients.
fn measure(simulation: &Simulation, axis: DVec3, balance: Balance) -> Result<Shape> {
    let (view, rows) = simulation.world().body_view(BodyId(0));
    let (position, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
    let gradient = view.read::<DeformationGradient>()?;
    let strain = view.read::<PlasticStrain>()?;
    let body = simulation.world().body(BodyId(0));
    let half = 0.5 * body.spacing;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut radius, mut plastic_strain) = (0.0f64, 0.0f64);
    for row in rows.clone() {
        let outward = reference[row].0 - axis * reference[row].0.dot(axis);
        for side in [-1.0, 1.0] {
            let end = (position[row].0 + gradient[row].0 * axis * (side * half)).dot(axis);
            (low, high) = (low.min(end), high.max(end));
        }
        let rim = position[row].0 + gradient[row].0 * outward.normalize_or_zero() * half;
        radius = radius.max((rim - axis * rim.dot(axis)).length());
        plastic_strain = plastic_strain.max(strain[row].0);
    }
    (low < high).then_some(()).context("the bar has no extent")?;
    Ok(Shape { length: high - low, radius, plastic_strain, balance })
}
