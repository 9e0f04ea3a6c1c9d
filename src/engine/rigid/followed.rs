//! Functions of time that move rigid bodies, and steps that follow them.
//!
//! A rigid body alone has no stability limit: its steps are long, and what a load or a prescribed motion does
//! within one of them would be lost.

use glam::DVec3;

use crate::scene::Expression;
use crate::schedule::{Clock, Step};
use crate::world::BodyId;

/// A function of time in a load on a rigid body or in its prescribed motion; conditions add it with
/// [`SimBuilder::extend`](crate::plugin::SimBuilder::extend).
pub struct MovingFunction {
    /// Body; one of several if the function is the same at all places.
    pub body: BodyId,
    /// The function.
    pub value: Expression,
    /// Place at which it counts, m.
    pub place: DVec3,
}

/// Share of its change in the whole run by which a function may change in one step.
const CHANGE: f64 = 1.0 / 16.0;
/// Times of a run at which the change in the whole run is looked at.
const TIMES: u32 = 1024;
/// Shortest step in which a function of time is followed, over the duration of the run: a jump is met in a
/// step of this length.
pub const SHORTEST_FOLLOWED: f64 = 1e-7;
/// Factor by which steps may grow: so far ahead is looked.
const GROWTH: f64 = 1024.0;

/// How far ahead of a step functions of time are looked at, s.
pub fn looked_ahead(clock: &Clock) -> f64 {
    if clock.dt > 0.0 { GROWTH * clock.dt } else { f64::INFINITY }
}

/// The change of a function at a place, m, in a run until `end`, s; in the unit of its value.
pub fn change_in_run(value: &Expression, place: DVec3, end: f64) -> f64 {
    let times = (0..=TIMES).map(|k| end * f64::from(k) / f64::from(TIMES));
    let values = times.map(|t| value.eval(place, t));
    let [low, high] =
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    // Times may miss all there is, such as one short pulse.
    let [low, high] = if high > low { [low, high] } else { value.range_over_time(place, [0.0, end]) };
    high - low
}

/// The functions that change.
pub(super) struct FollowedFunctions {
    /// Each with the largest change in one step.
    functions: Vec<(MovingFunction, f64)>,
    /// Duration of the run, s.
    end: f64,
}

impl FollowedFunctions {
    pub fn new(functions: Vec<MovingFunction>, end: f64) -> Self {
        let changing = functions.into_iter().filter(|function| function.value.depends_on_time());
        let functions = changing.map(|function| {
            let change = CHANGE * change_in_run(&function.value, function.place, end);
            (function, change)
        });
        Self { functions: functions.filter(|(_, change)| *change > 0.0 && change.is_finite()).collect(), end }
    }

    /// Proposes the longest step, of at most `longest`, s, in which no function changes by more than its
    /// share. Where bounds of the values are unknown, nothing is proposed.
    pub fn propose(&self, longest: f64, step: &mut Step<'_>) {
        let t = step.clock.end();
        for (function, change) in &self.functions {
            let changes = |dt: f64| {
                let [low, high] = function.range([t, t + dt]);
                high - low > *change && (high - low).is_finite()
            };
            let mut dt = longest.min(looked_ahead(&step.clock));
            while changes(dt) && dt > SHORTEST_FOLLOWED * self.end {
                dt = (0.5 * dt).max(SHORTEST_FOLLOWED * self.end);
            }
            if dt < longest {
                let name = &step.world.body(function.body).name;
                step.limits.propose(dt, format_args!("change of what moves `{name}`"));
            }
        }
    }
}

impl MovingFunction {
    fn range(&self, times: [f64; 2]) -> [f64; 2] {
        self.value.range_over_time(self.place, times)
    }
}
