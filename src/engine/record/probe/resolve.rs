//! Probes of a scene, resolved to bodies, fields and accounts.

use std::sync::Arc;

use super::energies::EnergyColumns;
use super::flow;
use super::gauge::{Gauge, at_probe};
use super::place::{ProbePlace, gauge_at};
use super::planar::Planar;
use super::relative::RelativeGauge;
use super::torque::TorqueGauge;
use super::wear;
use crate::fields::FieldTable;
use crate::plugin::{BodyKind, Selection, SimBuilder};
use crate::scene::{self, Dimension, Problem, Quantity, Select};
use crate::world::{BodyId, BodySet};

/// A probe of the scene, ready to measure.
#[derive(Clone)]
pub struct ResolvedProbe {
    /// Name.
    pub name: String,
    /// Time between two samples, s.
    pub interval: f64,
    /// Whether the user knows that it may find nothing.
    pub may_be_empty: bool,
    /// Whether samples are means over the time since the last one.
    pub mean: bool,
    /// The instrument.
    pub gauge: Arc<Gauge>,
}

impl ResolvedProbe {
    /// Resolves a probe of the scene.
    ///
    /// # Errors
    /// An empty selection, a field that is not there, energies of a part of a body.
    pub fn resolve(
        k: usize,
        probe: &scene::Probe,
        sim: &SimBuilder<'_>,
        table: &Arc<FieldTable>,
    ) -> Result<Self, Vec<Problem>> {
        let on = || select(k, &probe.on.clone().unwrap_or_default(), sim);
        if let Some(gauge) = flow::resolve(k, probe, on, sim)? {
            return Ok(Self::new(probe, Gauge::Measure(gauge), sim));
        }
        if let Some(gauge) = wear::resolve(k, probe, on, sim)? {
            return Ok(Self::new(probe, Gauge::Measure(gauge), sim));
        }
        if matches!(probe.quantity, Quantity::Force | Quantity::Torque | Quantity::Moment { .. })
            && probe.on.as_ref().is_some_and(|on| on.surface.is_none())
        {
            refuse_part_of_rigid(k, &on()?, sim)?;
        }
        let gauge = match field_name(&probe.quantity) {
            None if probe.quantity == Quantity::Torque => {
                Gauge::Torque(TorqueGauge { selection: on()?, about: None })
            }
            None if let Quantity::Moment { about } = &probe.quantity => {
                Gauge::Torque(TorqueGauge { selection: on()?, about: Some(about.0) })
            }
            Some(name) => field_gauge(k, probe, name, sim, table)?,
            None if probe.mean => {
                let message = "energies have no mean over time: their accounts are sums over the run";
                let problem = Problem::at_path(format!("probes[{k}].mean"), message);
                return Err(vec![problem.help("leave `mean` out")]);
            }
            None => Gauge::Energies(energies(k, probe.on.as_ref(), sim)?),
        };
        Ok(Self::new(probe, gauge, sim))
    }

    fn new(probe: &scene::Probe, gauge: Gauge, sim: &SimBuilder<'_>) -> Self {
        let interval = sim.scene().probe_interval(probe);
        let gauge = if sim.dimension() == Dimension::Two { Planar::of(gauge) } else { gauge };
        let scene::Probe { may_be_empty, mean, .. } = *probe;
        Self { name: probe.name.clone(), interval, may_be_empty, mean, gauge: Arc::new(gauge) }
    }
}

/// The field behind a quantity; none behind what is measured otherwise.
fn field_name(quantity: &Quantity) -> Option<&str> {
    match quantity {
        Quantity::Displacement => Some("displacement"),
        Quantity::Position | Quantity::Distance => Some("position"),
        Quantity::Velocity => Some("velocity"),
        // The force column holds all that acts on a particle except its constraint: what it exerts on what
        // holds it.
        Quantity::Force => Some("force"),
        Quantity::Field(name) => Some(name),
        _ => None,
    }
}

/// The gauge of a field at the place of a probe, relative to a second one if the scene names one.
fn field_gauge(
    k: usize,
    probe: &scene::Probe,
    name: &str,
    sim: &SimBuilder<'_>,
    table: &Arc<FieldTable>,
) -> Result<Gauge, Vec<Problem>> {
    let path = match &probe.quantity {
        Quantity::Field(_) => format!("probes[{k}].quantity[0]"),
        _ => format!("probes[{k}].quantity"),
    };
    let field = |bodies: &BodySet, all| {
        let found = table.choose(name, bodies, all);
        found.map_err(|problem| vec![Problem { at: scene::SourcePlace::Path(path.clone()), ..*problem }])
    };
    let first = gauge_at(&ProbePlace::of(k, probe), &field, sim)?;
    let Some(to) = &probe.relative_to else { return Ok(first) };
    let second = gauge_at(&ProbePlace::of_second(k, probe, to), &field, sim)?;
    let distance = probe.quantity == Quantity::Distance;
    Ok(Gauge::Measure(Box::new(RelativeGauge { first, second, distance })))
}

fn energies(k: usize, on: Option<&Select>, sim: &SimBuilder<'_>) -> Result<EnergyColumns, Vec<Problem>> {
    let named = |id: BodyId| (id, sim.body(id).name.clone());
    let Some(on) = on else {
        return Ok(EnergyColumns::of_bodies(sim.bodies().iter().map(|body| named(body.id)).collect()));
    };
    let selection = select(k, on, sim)?;
    if let Some((id, rows)) = selection.parts.iter().find(|(id, rows)| rows.len() < sim.body(*id).sites.len())
    {
        let body = sim.body(*id);
        let message = format!(
            "the selection holds {} of the {} particles of body `{}`, and energies are kept for whole bodies",
            rows.len(),
            body.sites.len(),
            body.name
        );
        let problem = Problem::at_path(format!("probes[{k}].on"), message);
        return Err(vec![problem.help("select by `body` alone, or leave `on` out for all bodies")]);
    }
    Ok(EnergyColumns::of_bodies(selection.parts.iter().map(|(id, _)| named(*id)).collect()))
}

/// Forces on a rigid body act on all of it: those of its particles follow from its acceleration, and their
/// sum over a part is not what acts there.
fn refuse_part_of_rigid(k: usize, selection: &Selection, sim: &SimBuilder<'_>) -> Result<(), Vec<Problem>> {
    let is_part = |(id, rows): &&(BodyId, Vec<u32>)| {
        sim.body(*id).kind == BodyKind::Rigid && rows.len() < sim.body(*id).sites.len()
    };
    let Some((id, rows)) = selection.parts.iter().find(is_part) else { return Ok(()) };
    let body = sim.body(*id);
    let message = format!(
        "the selection holds {} of the {} particles of the rigid body `{}`, and forces act on a rigid body as a whole",
        rows.len(),
        body.sites.len(),
        body.name
    );
    let help = "select all of the body; a part whose force is wanted is a body of its own";
    Err(vec![Problem::at_path(format!("probes[{k}].on"), message).help(help)])
}

fn select(k: usize, on: &Select, sim: &SimBuilder<'_>) -> Result<Selection, Vec<Problem>> {
    sim.select_at_start(on, "on").map_err(|error| at_probe(k, error))
}
