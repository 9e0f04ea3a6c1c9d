//! The motion of fluids in relaxation zones.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::field::{VectorField, not_finite};
use super::zone_box::ZoneBox;
use crate::notation::{quantity, quantity_to};
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::schedule::{AccountKind, Run, Shared, Step, StepError, replace_warning};
use crate::world::{BodyId, Mass, Mobility, Position, Velocity};

/// Name of the condition.
pub(super) const NAME: &str = "RelaxationZone";
/// Account of the energy that zones supply, and label of their system.
pub(super) const ACCOUNT: &str = "relaxation_zone";

/// All zones of a scene.
pub(super) struct FlowZones(pub Vec<FlowZone>);

/// A zone.
pub(super) struct FlowZone {
    /// Fluids.
    pub bodies: Vec<BodyId>,
    /// Where it is, and how strong.
    pub place: ZoneBox,
    /// Mass of these fluids at the start, kg.
    pub mass: f64,
    /// Velocity, m/s, and 1 along the axes that have one, else 0.
    pub field: VectorField,
    pub axes: DVec3,
    /// Rate at the end of the zone, 1/s.
    pub rate: f64,
    /// Speed of sound of its fastest fluid, m/s.
    pub sound: f64,
    /// Time within which the uniform force follows, s.
    pub settling: f64,
    /// 1 along the axes on which it acts, else 0.
    pub driven: DVec3,
}

/// State of a zone, which a checkpoint keeps.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct ZoneState {
    /// Uniform force per mass that follows the deviation, m/s2.
    force: DVec3,
    /// Uniform force per mass that accelerates all of the fluid as the velocity grows, m/s2.
    growth: DVec3,
    /// Mean deviation of the last times, m/s.
    deviation: DVec3,
}

/// Mean deviation after the force has settled, over the mean speed, that is worth a warning.
const DEVIATES: f64 = 0.05;
/// Deviation at the start over the speed of sound that is worth a warning: the change of density by the
/// sound wave that it sends out.
const JUMP: f64 = 0.02;
/// Times of settling before anything is said.
const SETTLED: f64 = 10.0;

/// Sums over the particles in a zone, weighted by mass and strength.
#[derive(Clone, Copy, Default)]
struct InZone {
    deviation: DVec3,
    /// Growth of the velocity that is given, m/s2.
    growth: DVec3,
    speed: f64,
    weight: f64,
    /// Gain of kinetic energy, J.
    energy: f64,
    /// The first place at which the velocity that is given is not finite, and the velocity.
    broken: Option<(DVec3, DVec3)>,
}

impl BlockSum for InZone {
    fn add(&mut self, next: &Self) {
        self.deviation += next.deviation;
        self.growth += next.growth;
        self.speed += next.speed;
        self.weight += next.weight;
        self.energy += next.energy;
        self.broken = self.broken.or(next.broken);
    }
}

impl FlowZone {
    /// Leads one body for a step that ends at `time`.
    fn lead(&self, body: BodyId, force: DVec3, step: &Step<'_>) -> Result<InZone, StepError> {
        let (dt, time) = (step.clock.dt, step.clock.end());
        let grows = self.field.depends_on_time();
        let (view, rows) = step.world.body_view(body);
        let (position, mass) = (view.read::<Position>()?, view.read::<Mass>()?);
        let mobility = view.read::<Mobility>()?;
        let mut velocity = view.write::<Velocity>()?;
        let fixed = (&position[rows.clone()], &mass[rows.clone()], &mobility[rows.clone()]);
        type Rows<'a> = (&'a mut [Velocity], &'a [Position], &'a [Mass], &'a [Mobility]);
        let slices = (&mut velocity[rows], fixed.0, fixed.1, fixed.2);
        let sum = sum_over_blocks(slices, &|_, (velocity, position, mass, mobility): Rows<'_>| {
            let mut sum = InZone::default();
            for (k, v) in velocity.iter_mut().enumerate() {
                let strength = self.place.strength(position[k].0);
                // A removed particle has no mobility.
                if strength == 0.0 || mobility[k].0 == DVec3::ZERO {
                    continue;
                }
                let place = self.place.image(position[k].0);
                let value = self.field.at(place, time);
                if !value.is_finite() {
                    sum.broken = sum.broken.or(Some((place, value)));
                    continue;
                }
                let before = if grows { self.field.at(place, time - dt) } else { value };
                let deviation = self.axes * (value - v.0);
                // Exact for any rate: no limit of the time step follows from the zone.
                let share = -(-self.rate * strength * dt).exp_m1();
                let next = v.0 + share * deviation + (1.0 - share) * strength * dt * force;
                let (m, weight) = (mass[k].0, mass[k].0 * strength);
                sum.add(&InZone {
                    deviation: weight * deviation,
                    growth: weight / dt * (value - before),
                    speed: weight * (self.axes * value).length(),
                    weight,
                    energy: 0.5 * m * (next.length_squared() - v.0.length_squared()),
                    broken: None,
                });
                v.0 = next;
            }
            sum
        });
        match sum.broken {
            None => Ok(sum),
            Some((place, value)) => Err(not_finite(place, value, time, NAME)),
        }
    }

    /// Whether both move one column of fluid along one axis.
    fn moves_with(&self, other: &Self) -> bool {
        self.driven.dot(other.driven) > 0.0 && self.bodies.iter().any(|body| other.bodies.contains(body))
    }

    /// Adjusts the uniform force after a step; the zone moves a share of the column of fluid.
    fn adjust(&self, state: &mut ZoneState, sum: &InZone, share_of_column: f64, step: &mut Step<'_>) {
        if sum.weight == 0.0 || self.driven == DVec3::ZERO {
            return;
        }
        let share = step.clock.dt / self.settling;
        let deviation = self.driven * sum.deviation / sum.weight;
        if step.clock.step == 1 && deviation.length() > JUMP * self.sound {
            step.warnings.push(format!(
                "the flow in a `{NAME}` starts {} off its velocity, which sends out a sound wave that changes the density by {:.0} %: start with that velocity, by an `InitialVelocity` or the \
                 `velocity` of the body, or let it grow slowly",
                quantity_to(deviation.length(), "m/s", 2),
                100.0 * deviation.length() / self.sound
            ));
        }
        state.force += self.rate * share * deviation;
        // The force on the zone moves the whole column of fluid.
        state.growth = self.driven * sum.growth / sum.weight * (share_of_column * self.mass / sum.weight);
        state.deviation += share.min(1.0) * (deviation - state.deviation);
        let (deviation, speed) = (state.deviation.length(), sum.speed / sum.weight);
        if step.clock.end() > SETTLED * self.settling && deviation > DEVIATES * speed && speed > 0.0 {
            let begin = format!("a `{NAME}` does not hold its velocity");
            let text = format!(
                "{begin}: its mean deviates by {} from {} at {}; does the flow that it asks for fit through the rest of the domain?",
                quantity_to(deviation, "m/s", 2),
                quantity_to(speed, "m/s", 3),
                quantity(step.clock.end(), "s")
            );
            replace_warning(step.warnings, &begin, text);
        }
    }
}

/// Leads the flow in all zones.
pub(super) struct ZoneFlow {
    zones: Shared<FlowZones>,
    states: Vec<ZoneState>,
}

impl ZoneFlow {
    pub fn new(zones: Shared<FlowZones>) -> Self {
        Self { zones, states: Vec::new() }
    }
}

impl Run for ZoneFlow {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let kinetic = step.ledger.account("kinetic", AccountKind::Stored);
        let supplied = step.ledger.account(ACCOUNT, AccountKind::Supplied);
        let resources = step.resources;
        let zones = &resources.of(self.zones).0;
        self.states.resize(zones.len(), ZoneState::default());
        for (zone, state) in zones.iter().zip(&mut self.states) {
            let mut all = InZone::default();
            for &body in &zone.bodies {
                let sum = zone.lead(body, state.force + state.growth, step)?;
                step.ledger.add(kinetic, body, sum.energy);
                step.ledger.add(supplied, body, sum.energy);
                all.add(&sum);
            }
            let sharing = zones.iter().filter(|other| other.moves_with(zone)).count();
            zone.adjust(state, &all, 1.0 / sharing.max(1) as f64, step);
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.states).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok(states) = postcard::from_bytes(state) else { return false };
        self.states = states;
        true
    }
}
