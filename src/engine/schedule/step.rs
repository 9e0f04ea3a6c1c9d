//! The interface of a running system, and its errors.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::ledger::Ledger;
use super::limits::TimeStepLimits;
use super::resources::Resources;
use super::step_part::StepPart;
use crate::notation::{quantity, quantity_to};
use crate::scene::Item;
use crate::world::{MissingColumn, Undeclared, World};

/// Where the run is in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Time at the start of the step, s.
    pub time: f64,
    /// Length of the step, s.
    pub dt: f64,
    /// Number of steps done before this one.
    pub step: u64,
}

impl Clock {
    /// Time at the end of the step, s.
    pub fn end(&self) -> f64 {
        self.time + self.dt
    }

    /// Time at mid-step, s.
    pub fn middle(&self) -> f64 {
        self.time + 0.5 * self.dt
    }
}

/// Interface of a running system: the columns, shared data, the clock, the ledger, the limits of the next
/// time step.
pub struct Step<'s> {
    /// Columns and bodies.
    pub world: &'s World,
    /// Lists and tables that systems share.
    pub resources: &'s Resources,
    /// Time and step.
    pub clock: Clock,
    /// Energy ledger.
    pub ledger: &'s mut Ledger,
    /// Limits of the next time step.
    pub limits: &'s mut TimeStepLimits,
    /// Warnings for the user; repeated at the end of the run.
    pub warnings: &'s mut Vec<String>,
    /// Which part of the step this is: a system that is [`by_body`](super::System::by_body) asks it for the
    /// bodies that are due.
    pub part: StepPart<'s>,
    /// Set it to end the run after this step; the text says why.
    pub stop: &'s mut Option<String>,
}

/// Why a step cannot go on.
#[derive(Debug, Error)]
pub enum StepError {
    /// A system needs a column that the phase does not have.
    #[error(transparent)]
    MissingColumn(#[from] MissingColumn),
    /// A system touches a column that it has not declared.
    #[error(transparent)]
    Undeclared(#[from] Undeclared),
    /// A particle has left the range of what makes sense.
    #[error("{what} at particle {particle} of body `{body}`, step {step}, time {}{detail}", quantity_to(*.time, "s", 6))]
    Unstable {
        /// The error.
        what: String,
        /// Number of the particle in its body.
        particle: usize,
        /// Body.
        body: String,
        /// Step.
        step: u64,
        /// Time, s.
        time: f64,
        /// The cause, if known; empty, or starting with `: `.
        detail: String,
    },
    /// The bodies hold far more energy than they were given.
    #[error(
        "the stored energy has grown to {}, more than {factor} times the {} present at the start or supplied since, at step {step}, \
         time {}; most of it is `{account}` energy of body `{body}`: the run is unstable, a smaller time step or a damping may help{advice}",
        quantity(*.stored, "J"),
        quantity(*.available, "J"),
        quantity_to(*.time, "s", 6)
    )]
    EnergyGrowth {
        /// Energy stored now, J.
        stored: f64,
        /// Largest factor that is taken for sound.
        factor: f64,
        /// Energy at the start and supplied since, J.
        available: f64,
        /// Account with the largest energy of one body.
        account: String,
        /// That body.
        body: String,
        /// Step.
        step: u64,
        /// Time, s.
        time: f64,
        /// Further advice; empty, or starting with `; `.
        advice: String,
    },
    /// An output of the run could not be written.
    #[error("{0}")]
    Output(String),
    /// A system of a plugin failed.
    #[error("system `{system}` failed: {message}")]
    System {
        /// Label of the system.
        system: String,
        /// The error.
        message: String,
    },
    /// A system of a plugin failed that an item of the scene has added.
    #[error("{error}")]
    OfItem {
        /// The item.
        item: Item,
        /// The error.
        error: Box<StepError>,
    },
}

impl StepError {
    /// The same with the item of the scene that has added the system.
    pub(super) fn of(self, item: Option<&Item>) -> Self {
        match (self, item) {
            (error @ Self::System { .. }, Some(item)) => {
                Self::OfItem { item: item.clone(), error: Box::new(error) }
            }
            (error, _) => error,
        }
    }

    /// The same with the known cause, which starts with `: `.
    #[must_use]
    pub fn with_detail(mut self, text: &str) -> Self {
        if let Self::Unstable { detail, .. } = &mut self {
            text.clone_into(detail);
        }
        self
    }

    /// The same where steps are too long, which `why` tells: whatever has failed, it is for that.
    #[must_use]
    pub(crate) fn of_long_steps(mut self, why: &str) -> Self {
        match &mut self {
            Self::Unstable { detail, .. } => *detail = format!(": {why}"),
            Self::EnergyGrowth { advice, .. } => *advice = format!("; {why}"),
            _ => {}
        }
        self
    }
}

/// Warns of something that has grown: in the place of the warning that begins alike, if there is one.
pub fn replace_warning(warnings: &mut Vec<String>, begin: &str, text: String) {
    match warnings.iter_mut().find(|warning| warning.starts_with(begin)) {
        Some(warning) => *warning = text,
        None => warnings.push(text),
    }
}

/// Warns of a number that has grown, with `begin`, the number and `rest`: in the place of the warning that
/// begins alike, if that has a smaller number. Warnings are in checkpoints, so that a resumed run goes on.
pub fn raise_warning(warnings: &mut Vec<String>, begin: &str, number: usize, rest: impl FnOnce() -> String) {
    let told = warnings.iter().find_map(|warning| warning.strip_prefix(begin)).and_then(|rest| {
        let number = rest.split_whitespace().next()?;
        number.parse::<usize>().ok()
    });
    if told.is_none_or(|told| told < number) {
        replace_warning(warnings, begin, format!("{begin} {number} {}", rest()));
    }
}

impl Step<'_> {
    /// The error of a particle that has left the range of what makes sense; `particle` is its number in the
    /// body.
    pub fn unstable(&self, what: &str, body: crate::world::BodyId, particle: usize) -> StepError {
        StepError::Unstable {
            what: what.to_owned(),
            particle,
            body: self.world.body(body).name.clone(),
            step: self.clock.step,
            time: self.clock.time,
            detail: String::new(),
        }
    }
}
