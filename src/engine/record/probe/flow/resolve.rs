//! Probes of flows of a scene, resolved to measurements.

use glam::DVec3;

use super::carrier::GaugeCarrier;
use super::flux::FluxGauge;
use super::level::LevelGauge;
use super::reaction::ReactionGauge;
use super::sensor::SensorGauge;
use crate::plugin::{BodyKind, Selection, SimBuilder};
use crate::record::probe::direction::direction;
use crate::record::probe::measure::Measure;
use crate::scene::{self, Dimension, Problem, Quantity};

/// The gauge behind a quantity of a flow; none for other quantities. `selected` is what the probe selects.
pub fn resolve(
    k: usize,
    probe: &scene::Probe,
    selected: impl Fn() -> Result<Selection, Vec<Problem>>,
    sim: &SimBuilder<'_>,
) -> Result<Option<Box<dyn Measure>>, Vec<Problem>> {
    let at = probe.at.map_or(DVec3::ZERO, |point| point.0);
    let problem = |field: &str, message: &str, help: &str| {
        let path = format!("probes[{k}].quantity{field}");
        vec![Problem::at_path(path, message.to_owned()).help(help)]
    };
    let unit = |vector, field| direction(k, field, vector, sim);
    let gauge: Box<dyn Measure> = match &probe.quantity {
        Quantity::WaterLevel { along } => {
            let up = match along {
                Some(along) => unit(*along, "along")?,
                None => (-sim.gravity()).try_normalize().ok_or_else(|| {
                    problem("", "without gravity there is no direction up", "give the direction as `along`")
                })?,
            };
            Box::new(LevelGauge::new(at, up, along.is_some()).following(carrier(k, probe, at, sim)?))
        }
        Quantity::PressureSensor { diameter, normal } => {
            let normal = unit(*normal, "normal")?;
            if !(*diameter >= 0.0 && diameter.is_finite()) {
                return Err(problem(
                    ".diameter",
                    "`diameter` must be at least 0",
                    "give it in m, 0 for a point",
                ));
            }
            let plane = sim.dimension() == Dimension::Two;
            let sensor = SensorGauge::new(at, *diameter, normal, sim.gravity(), plane);
            Box::new(sensor.following(carrier(k, probe, at, sim)?))
        }
        Quantity::Flux { normal, within } => {
            let normal = unit(*normal, "normal")?;
            let within = within.as_ref().map(|shape| {
                let path = format!("probes[{k}].quantity.within");
                shape.region(sim.dimension(), sim.folder(), &path)
            });
            let within = within.transpose().map_err(|error| {
                let problem = Problem::at_path(error.path.clone(), error.message());
                vec![problem.help("give a shape of the scene's dimension")]
            })?;
            let plane = sim.dimension() == Dimension::Two;
            Box::new(FluxGauge::new(at, normal, within, plane))
        }
        Quantity::FluidForce => Box::new(ReactionGauge { selection: selected()?, about: None }),
        Quantity::FluidTorque { about } => {
            Box::new(ReactionGauge { selection: selected()?, about: Some(about.0) })
        }
        _ => return Ok(None),
    };
    if !sim.bodies().iter().any(|body| body.kind == BodyKind::Fluid) {
        return Err(problem("", "there is no fluid to measure", "add a body with `formulation: Fluid`"));
    }
    Ok(Some(gauge))
}

/// What carries a gauge along; none if it stays where it is.
fn carrier(
    k: usize,
    probe: &scene::Probe,
    at: DVec3,
    sim: &SimBuilder<'_>,
) -> Result<Option<GaugeCarrier>, Vec<Problem>> {
    let Some(name) = &probe.follows else { return Ok(None) };
    let Some(body) = sim.bodies().iter().find(|body| body.name == *name) else {
        // Reported by the checks of the scene.
        return Err(Vec::new());
    };
    let problem = |message: String, help: &str| {
        vec![Problem::at_path(format!("probes[{k}].follows"), message).help(help)]
    };
    if body.kind == BodyKind::Fluid {
        return Err(problem(
            format!("body `{name}` is a fluid, whose points mix"),
            "name a wall or a body, or leave `follows` out to measure at a point of space",
        ));
    }
    let carrier = GaugeCarrier::of(body, at, sim.dimension().count());
    let help = "a body that carries a gauge needs particles in all directions from each other";
    carrier.map(Some).ok_or_else(|| problem(format!("body `{name}` has too few particles to turn"), help))
}
