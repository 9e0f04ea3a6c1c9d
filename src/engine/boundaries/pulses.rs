//! Pulses of loads and of prescribed motion, and steps that do not go over them.
//!
//! A condition acts at the times at which steps end. A push that comes and goes within one step acts not at
//! all, or for all of the step. Rigid bodies follow every change
//! ([`MovingFunction`](crate::rigid::MovingFunction)); bodies that deform, fluids and walls have shorter
//! steps, and where a function only rises or only falls within one, as a ramp or a jump does, its course is
//! met half a step early or late at most. So steps become shorter only ahead of a function that turns back.

use glam::DVec3;

use super::part::Part;
use crate::plugin::{BodyKind, SimBuilder};
use crate::rigid::{SHORTEST_FOLLOWED, change_in_run, looked_ahead};
use crate::scene::Expression;
use crate::schedule::{Run, Stage, Step, StepError, System};
use crate::world::{BodyId, BodySet};

/// Steps within which no function turns back.
const STEPS: f64 = 16.0;
/// Share of its change in the whole run by which a function turns back.
const SHARE: f64 = 0.25;

/// A function of time at a place of a body.
struct Watched {
    body: BodyId,
    value: Expression,
    /// m.
    place: DVec3,
    /// What counts as turning back, in the unit of the value.
    back: f64,
}

/// The functions of a condition.
struct Pulses {
    condition: &'static str,
    functions: Vec<Watched>,
    /// Duration of the run, s.
    end: f64,
}

/// Lets steps be so short that the functions of a condition do not turn back within them, at some places of
/// every body. Rigid bodies are left out.
pub(super) fn watch(
    condition: &'static str,
    functions: &[Expression],
    places: impl IntoIterator<Item = (BodyId, DVec3)>,
    sim: &mut SimBuilder<'_>,
) {
    let end = sim.scene().time.end;
    let mut watched: Vec<Watched> = Vec::new();
    for (body, place) in places.into_iter().filter(|(body, _)| sim.body(*body).kind != BodyKind::Rigid) {
        let is_first = watched.last().is_none_or(|function| function.body != body);
        for value in functions.iter().filter(|value| value.depends_on_time()) {
            let back = SHARE * change_in_run(value, place, end);
            if (is_first || value.depends_on_place()) && back > 0.0 && back.is_finite() {
                watched.push(Watched { body, value: value.clone(), place, back });
            }
        }
    }
    if watched.is_empty() {
        return;
    }
    let phases = sim.phases_of(&BodySet::new(watched.iter().map(|function| function.body)));
    let pulses = Pulses { condition, functions: watched, end };
    let label = format!("pulses of {condition}");
    sim.add_system(System::new(Stage::FinalIntegrate, label, pulses).on_phases(phases).by_body());
}

/// Some places of every part of a condition.
pub(super) fn places_of(parts: &[Part]) -> impl Iterator<Item = (BodyId, DVec3)> {
    parts.iter().flat_map(|part| some_of(&part.points).map(|place| (part.body, place)))
}

/// The first, the middle and the last of some places.
pub(super) fn some_of<T: Copy>(places: &[T]) -> impl Iterator<Item = T> {
    let last = places.len().saturating_sub(1);
    [0, last / 2, last].into_iter().take(places.len()).map(|k| places[k])
}

impl Run for Pulses {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let t = step.clock.end();
        let ahead = looked_ahead(&step.clock);
        for function in &self.functions {
            if !step.part.is_due(step.world, function.body) {
                continue;
            }
            // Halves of the duration, so that the step does not depend on the steps before.
            let mut dt = self.end;
            while dt > ahead {
                dt *= 0.5;
            }
            let longest = dt;
            while dt > SHORTEST_FOLLOWED * self.end
                && function.turns_back([t, (t + STEPS * dt).min(self.end)])
            {
                dt *= 0.5;
            }
            if dt < longest {
                let (what, name) = (self.condition, &step.world.body(function.body).name);
                step.limits.propose(dt, format_args!("pulse of {what} on `{name}`"));
            }
        }
        Ok(())
    }
}

impl Watched {
    /// Whether the function rises and falls between two times, s.
    fn turns_back(&self, times: [f64; 2]) -> bool {
        let [low, high] = self.value.range_over_time(self.place, times);
        let [first, last] = times.map(|t| self.value.eval(self.place, t));
        let back = high - low - (last - first).abs();
        back.is_finite() && back > self.back
    }
}
