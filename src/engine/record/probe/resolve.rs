//! Probes of a scene: what each measures, found among bodies, fields and accounts.

use std::sync::Arc;

use super::energies::EnergyColumns;
use super::flow;
use super::measure::Measure;
use super::particles::ParticleGauge;
use super::point::PointGauge;
use super::torque::TorqueGauge;
use crate::fields::{ChosenField, FieldTable};
use crate::plugin::{BodyKind, Selection, SetupError, SimBuilder};
use crate::scene::{self, Problem, Quantity, Select};
use crate::schedule::Resources;
use crate::world::{BodyId, BodySet, MissingColumn, World};

/// What a probe measures with.
pub enum Gauge {
    /// Mean or sum over particles.
    Particles(ParticleGauge),
    /// Interpolation at a point.
    Point(PointGauge),
    /// Torque of the forces on particles.
    Torque(TorqueGauge),
    /// What is measured of a flow.
    Flow(Box<dyn Measure>),
    /// Accounts of the energy ledger.
    Energies(EnergyColumns),
}

/// A probe of the scene, ready to measure.
pub struct Probe {
    /// Name.
    pub name: String,
    /// Time between two samples, s.
    pub interval: f64,
    /// What it measures with.
    pub gauge: Gauge,
}

impl Gauge {
    /// Name and unit of what it measures; none for energies, whose accounts open in the run.
    pub fn columns(&self) -> Vec<(String, &'static str)> {
        if let Self::Torque(_) = self {
            return ["x", "y", "z"].map(|axis| (axis.to_owned(), "N m")).to_vec();
        }
        if let Self::Flow(gauge) = self {
            return gauge.columns();
        }
        let Some(field) = self.field() else { return Vec::new() };
        field.column_names().into_iter().map(|name| (name, field.unit())).collect()
    }

    /// Names of the particle columns that it reads.
    pub fn needs(&self) -> Vec<&'static str> {
        match self {
            Self::Torque(_) => TorqueGauge::NEEDS.to_vec(),
            Self::Flow(gauge) => gauge.needs(),
            _ => self.field().map(ChosenField::needs).unwrap_or_default(),
        }
    }

    /// Measures; nothing for energies.
    ///
    /// # Errors
    /// A column is missing.
    pub fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        match self {
            Self::Particles(gauge) => gauge.read(world, resources),
            Self::Point(gauge) => gauge.read(world, resources),
            Self::Torque(gauge) => gauge.read(world),
            Self::Flow(gauge) => gauge.read(world, resources),
            Self::Energies(_) => Ok(Vec::new()),
        }
    }

    fn field(&self) -> Option<&ChosenField> {
        match self {
            Self::Particles(gauge) => Some(&gauge.field),
            Self::Point(gauge) => Some(&gauge.field),
            Self::Torque(_) | Self::Flow(_) | Self::Energies(_) => None,
        }
    }
}

impl Probe {
    /// Finds what the probe of the scene means.
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
            return Ok(Self::new(probe, Gauge::Flow(gauge), sim));
        }
        let gauge = match field_name(&probe.quantity) {
            None if probe.quantity == Quantity::Torque => Gauge::Torque(TorqueGauge { selection: on()? }),
            Some(name) => field_gauge(k, probe, name, sim, table)?,
            None => Gauge::Energies(energies(k, probe.on.as_ref(), sim)?),
        };
        Ok(Self::new(probe, gauge, sim))
    }

    /// A warning of a probe that measures nothing.
    pub fn warning(&self, sim: &SimBuilder<'_>) -> Option<String> {
        match &self.gauge {
            Gauge::Point(gauge) => gauge.warning(&self.name, sim.bodies()),
            _ => None,
        }
    }

    fn new(probe: &scene::Probe, gauge: Gauge, sim: &SimBuilder<'_>) -> Self {
        Self { name: probe.name.clone(), interval: sim.scene().probe_interval(probe), gauge }
    }
}

/// The field behind a quantity; none behind what is measured otherwise.
fn field_name(quantity: &Quantity) -> Option<&str> {
    match quantity {
        Quantity::Displacement => Some("displacement"),
        Quantity::Position => Some("position"),
        Quantity::Velocity => Some("velocity"),
        // The force column holds all that acts on a particle except its constraint: what it exerts on what holds it.
        Quantity::Force => Some("force"),
        Quantity::Field(name) => Some(name),
        _ => None,
    }
}

fn field_gauge(
    k: usize,
    probe: &scene::Probe,
    name: &str,
    sim: &SimBuilder<'_>,
    table: &Arc<FieldTable>,
) -> Result<Gauge, Vec<Problem>> {
    let choose = |bodies: &BodySet, all| {
        table.choose(name, bodies, all).map_err(|problem| {
            let place = match &probe.quantity {
                Quantity::Field(_) => format!("probes[{k}].quantity[0]"),
                _ => format!("probes[{k}].quantity"),
            };
            vec![Problem { at: scene::Place::Path(place), ..*problem }]
        })
    };
    let Some(on) = &probe.on else {
        // The particles of walls have the pressure that the fluid beside them is to feel, which is not that at their places.
        let all = || sim.bodies().iter();
        let flows = all().any(|body| body.kind == BodyKind::Fluid);
        let bodies = all().filter(|body| !(flows && body.kind == BodyKind::Boundary)).map(|body| body.id);
        let bodies = BodySet::new(bodies);
        let at = probe.at.map_or(glam::DVec3::ZERO, |point| point.0);
        return Ok(Gauge::Point(PointGauge { at, field: choose(&bodies, false)?, periodic: sim.periodic() }));
    };
    let selection = select(k, on, sim)?;
    let field = choose(&BodySet::new(selection.parts.iter().map(|(id, _)| *id)), true)?;
    Ok(Gauge::Particles(ParticleGauge { selection, field, sum: probe.quantity == Quantity::Force }))
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

fn select(k: usize, on: &Select, sim: &SimBuilder<'_>) -> Result<Selection, Vec<Problem>> {
    sim.select(on, "on").map_err(|error| match error {
        SetupError::Parameter { field, message, help } => {
            vec![Problem::at_path(format!("probes[{k}].{field}"), message).help(help)]
        }
        SetupError::Problems(problems) => problems,
    })
}
