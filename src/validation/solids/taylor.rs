//! Taylor bars: measurements of the impacting body.

use anyhow::{Context, Result, ensure};
use meshless_engine::glam::DVec3;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, DeformationGradient, PlasticStrain, Position, ReferencePosition};

use crate::measure::{Balance, run};

/// The shape of a bar at the end of a run.
pub struct BarShape {
    /// Extent along the axis, m.
    pub length: f64,
    /// Maximum distance of its surface from the axis, m.
    pub radius: f64,
    /// Maximum plastic strain of a particle.
    pub plastic_strain: f64,
    /// Energy balance.
    pub balance: Balance,
}

/// Runs a bar to the end; its axis is `axis` through the origin.
pub fn impact(simulation: &mut Simulation, axis: DVec3) -> Result<BarShape> {
    let balance = run(simulation, |_| Ok(()))?;
    measure(simulation, axis, balance)
}

/// The surface is half a spacing from the outermost particles and moves by their deformation gradients.
fn measure(simulation: &Simulation, axis: DVec3, balance: Balance) -> Result<BarShape> {
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
    Ok(BarShape { length: high - low, radius, plastic_strain, balance })
}

/// Positions of two lines of points of the surface along the bar, which have probes in the scene: one in a
/// plane of the lattice and the axis, one between two such planes.
pub fn sides(simulation: &Simulation) -> Result<[Vec<DVec3>; 2]> {
    Ok([side(simulation, "along_axis")?, side(simulation, "between_axes")?])
}

fn side(simulation: &Simulation, probe: &str) -> Result<Vec<DVec3>> {
    let shown = simulation.measure(probe)?;
    ensure!(shown.len().is_multiple_of(3), "the probe `{probe}` does not show places in space");
    Ok(shown.chunks(3).map(|place| DVec3::new(place[0].1, place[1].1, place[2].1)).collect())
}

/// Distance of a point from the axis of the bar, z, m.
pub fn distance_from_axis(point: &DVec3) -> f64 {
    point.truncate().length()
}

/// Mean of the maximum distances of lines from the axis, m.
pub fn largest_radius(sides: &[Vec<DVec3>]) -> f64 {
    let largest = |side: &Vec<DVec3>| side.iter().map(distance_from_axis).fold(0.0, f64::max);
    sides.iter().map(largest).sum::<f64>() / sides.len() as f64
}
