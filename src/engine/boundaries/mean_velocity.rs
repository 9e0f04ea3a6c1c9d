//! Flows driven at a constant mean velocity: a channel with a constant flux.
//!
//! A uniform force per volume f acts along the controlled axes, as a pressure gradient does: where densities
//! differ, a force per mass would carry the heavier body along. With the mean velocity u(n) of all bodies
//! together at the end of a step, weighted by mass, and their mean density rho, `f(n) = f(n-1) + rho ((U -
//! u(n)) / (k^2 dt) - 2 (u(n) - u(n-1)) / (k dt))`: deviations decay like those of a critically damped
//! oscillator, within some k steps.

use std::collections::BTreeMap;

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::load;
use super::load_law::LoadLaw;
use super::part::Part;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::{BodyKind, Plugin, Selection, SetupError, SimBuilder};
use crate::scene::{PerAxis, Select};
use crate::schedule::{Run, Shared, Stage, Step, StepError, System};
use crate::world::{BodyId, BodySet, Mass, ReferenceVolume, Removed, Velocity};

/// Keeps the mean velocity of bodies, weighted by mass, by a force per volume that is the same for all of
/// their particles: the pressure gradient of a channel with a constant flux. Its work is in the account
/// `mean_velocity`.
///
/// A suspension in a periodic channel: `MeanVelocity(bodies: ["water", "grain*"], value: (1.0, None))`. A
/// body in the flow that is not among `bodies` does not feel this gradient: the drag that a probe shows lacks
/// the power of that account over the velocity, times the share of the body in the volume of the flow (2 to
/// 4 % of the drag of cylinders in channels). A channel that is not part of a repeating array has an inlet
/// and an outlet: `RelaxationZone`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeanVelocity {
    /// Fluids and rigid bodies, whose mean is taken together; `"grain*"` stands for all bodies whose names
    /// begin with `grain`.
    pub bodies: Vec<String>,
    /// Velocity along each axis \[m/s\]; `None` leaves an axis unconstrained.
    pub value: PerAxis<f64>,
}

/// Steps within which a deviation decays.
const STEPS: f64 = 10.0;

impl Plugin for MeanVelocity {
    const NAME: &'static str = "MeanVelocity";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = self.selection(sim)?;
        let wanted = self.wanted(sim)?;
        self.only_once(&selection, sim)?;
        let controlled = [0, 1, 2].map(|axis| f64::from(u8::from(self.value.0[axis].is_some())));
        let force = sim.share(DrivingForce::default());
        let bodies: Vec<BodyId> = selection.parts.iter().map(|(id, _)| *id).collect();
        let phases = sim.phases_of(&BodySet::new(bodies.iter().copied()));
        let axes = DVec3::from_array(controlled);
        let measure = MeasureFlow { bodies, wanted, axes, state: ControlState::default(), force };
        sim.add_system(
            System::new(Stage::PreStep, "mean_velocity_control", measure)
                .on_phases(phases)
                .in_long_steps()
                .reads::<Velocity>()
                .reads::<Mass>()
                .reads::<ReferenceVolume>()
                .reads::<Removed>(),
        );
        load::apply("mean_velocity", Uniform(force), &selection, sim, System::reads::<ReferenceVolume>);
        Ok(())
    }
}

impl MeanVelocity {
    fn selection(&self, sim: &SimBuilder<'_>) -> Result<Selection, SetupError> {
        let mut all = Selection::default();
        for (k, name) in self.bodies.iter().enumerate() {
            let field = format!("bodies[{k}]");
            let select = Select { body: Some(name.clone()), ..Select::default() };
            let found = sim.select_at_start(&select, &field).map_err(|error| match error {
                SetupError::Parameter { message, help, .. } => {
                    SetupError::Parameter { field: field.clone(), message, help }
                }
                other @ SetupError::Problems(_) => other,
            })?;
            for (id, rows) in found.parts {
                let body = sim.body(id);
                if !matches!(body.kind, BodyKind::Fluid | BodyKind::Rigid) {
                    let message = format!("body `{}` is neither a fluid nor rigid", body.name);
                    let help = "solids and walls are moved by `Velocity`";
                    return Err(SetupError::parameter(field, message, help));
                }
                if all.parts.iter().all(|(known, _)| *known != id) {
                    all.parts.push((id, rows));
                }
            }
        }
        if all.parts.is_empty() {
            let help = "name fluids or rigid bodies";
            return Err(SetupError::parameter("bodies", "no body is named", help));
        }
        all.parts.sort_by_key(|(id, _)| *id);
        Ok(all)
    }

    /// Two mean velocities of one body along one axis would drive it against each other.
    fn only_once(&self, selection: &Selection, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let bodies = selection.parts.iter().map(|(id, _)| *id);
        let axes: Vec<usize> = (0..3).filter(|&axis| self.value.0[axis].is_some()).collect();
        let all = bodies.flat_map(|id| axes.iter().map(move |&axis| (id, axis)));
        take_mean_velocities(all, Self::NAME, "bodies", sim)
    }

    fn wanted(&self, sim: &SimBuilder<'_>) -> Result<DVec3, SetupError> {
        let value = &self.value.0;
        let help = "give a velocity along at least one axis of the scene, such as `(1.0, None)`";
        if value.iter().all(Option::is_none) {
            return Err(SetupError::parameter("value", "no axis has a value", help));
        }
        for axis in 0..3 {
            let (given, entry) = (value[axis], format!("value[{axis}]"));
            if given.is_some() && axis >= sim.dimension().count() {
                return Err(SetupError::parameter(entry, "a two-dimensional scene has no axis z", help));
            }
            if given.is_some_and(|value| !value.is_finite()) {
                return Err(SetupError::parameter(entry, "the velocity must be finite", help));
            }
        }
        Ok(DVec3::from_array(value.map(Option::unwrap_or_default)))
    }
}

/// Conditions that keep the mean velocity of a body along an axis.
#[derive(Default)]
struct Driven(BTreeMap<(BodyId, usize), &'static str>);

/// Takes the mean velocities of bodies along axes for a condition `by`; `field` is its parameter, for errors.
///
/// # Errors
/// One of them is taken. Several zones may lead one flow.
pub(super) fn take_mean_velocities(
    all: impl Iterator<Item = (BodyId, usize)>,
    by: &'static str,
    field: &str,
    sim: &mut SimBuilder<'_>,
) -> Result<(), SetupError> {
    let mut driven: Driven = sim.take_extensions().pop().unwrap_or_default();
    for (id, axis) in all {
        let taken = driven.0.insert((id, axis), by);
        if let Some(other) = taken.filter(|other| *other == MeanVelocity::NAME || by == MeanVelocity::NAME) {
            let (body, along) = (&sim.body(id).name, ["x", "y", "z"][axis]);
            let message = format!("body `{body}` has a mean velocity along {along} already, by a `{other}`");
            let help = "leave the axis or the body to one of them";
            return Err(SetupError::parameter(field, message, help));
        }
    }
    sim.leave_note(driven);
    Ok(())
}

/// The part that a checkpoint keeps.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
struct ControlState {
    /// Force per volume, N/m3.
    force: DVec3,
    /// Mean velocity at the end of the last step, m/s; none before the first.
    last: Option<DVec3>,
}

/// The force per volume of this step, N/m3, for the system that applies it.
#[derive(Clone, Copy, Default)]
struct DrivingForce(DVec3);

#[derive(Clone, Copy, Default)]
struct Moving {
    momentum: DVec3,
    mass: f64,
    volume: f64,
}

impl BlockSum for Moving {
    fn add(&mut self, next: &Self) {
        self.momentum += next.momentum;
        self.mass += next.mass;
        self.volume += next.volume;
    }
}

/// Measures the mean velocity, and sets the force of the step that begins.
struct MeasureFlow {
    bodies: Vec<BodyId>,
    wanted: DVec3,
    /// 1 along controlled axes, else 0.
    axes: DVec3,
    state: ControlState,
    force: Shared<DrivingForce>,
}

impl Run for MeasureFlow {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut moving = Moving::default();
        for &body in &self.bodies {
            let (view, rows) = step.world.body_view(body);
            let (velocity, mass) = (view.read::<Velocity>()?, view.read::<Mass>()?);
            let (volume, removed) = (view.read::<ReferenceVolume>()?, view.read::<Removed>()?);
            let masses = (&mass[rows.clone()], &volume[rows.clone()]);
            let all = (&velocity[rows.clone()], masses, &removed[rows]);
            type Rows<'a> = (&'a [Velocity], (&'a [Mass], &'a [ReferenceVolume]), &'a [Removed]);
            moving.add(&sum_over_blocks(all, &|_, (velocity, (mass, volume), removed): Rows<'_>| {
                let mut sum = Moving::default();
                for (k, velocity) in velocity.iter().enumerate().filter(|(k, _)| removed[*k] == Removed::NO) {
                    let (mass, volume) = (mass[k].0, volume[k].0);
                    sum.add(&Moving { momentum: mass * velocity.0, mass, volume });
                }
                sum
            }));
        }
        let dt = step.clock.dt;
        if moving.mass > 0.0 && dt > 0.0 {
            let (mean, state) = (moving.momentum / moving.mass, &mut self.state);
            let change = mean - state.last.unwrap_or(mean);
            let correction = (self.wanted - mean) / (STEPS * STEPS) - 2.0 * change / STEPS;
            state.force += self.axes * correction * (moving.mass / moving.volume) / dt;
            state.last = Some(mean);
        }
        step.resources.of_mut(self.force).0 = self.state.force;
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.state).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok(state) = postcard::from_bytes(state) else { return false };
        self.state = state;
        true
    }
}

/// The force per volume, the same for all particles.
struct Uniform(Shared<DrivingForce>);

impl LoadLaw for Uniform {
    fn forces(&self, _: usize, part: &Part, step: &Step<'_>, out: &mut Vec<DVec3>) -> Result<(), StepError> {
        let force = step.resources.of(self.0).0;
        let volume = step.world.body_view(part.body).0.read::<ReferenceVolume>()?;
        out.clear();
        out.extend(part.rows.iter().map(|&row| force * volume[row as usize].0));
        Ok(())
    }

    fn is_constant(&self, _: &Part) -> bool {
        false
    }
}
