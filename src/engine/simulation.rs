//! A simulation: the world, the schedule, the clock, and the loop over steps.

use std::collections::BTreeMap;

use thiserror::Error;

use crate::notation::{number, quantity};
use crate::ranks::{self, Cut};
use crate::record::probe::ResolvedProbe;
use crate::record::{Output, StateHash};
use crate::scene::{self, Problem, Scene, Source};
use crate::schedule::{
    Clock, Ledger, Limit, Resources, Schedule, Shared, Stage, Step, StepError, StepPart, TimeStepLimits,
};
use crate::world::{MissingColumn, PhaseId, World};

mod checkpoint;
mod closing;
mod inputs;
mod long_steps;
mod sub_steps;
mod summary;
mod uniform_motion;

pub use checkpoint::{Checkpoint, RestoreError, SaveError};
pub use summary::{Outcome, Summary};

use inputs::Inputs;
use sub_steps::SubSteps;
use uniform_motion::UniformMotion;

/// A simulation that is ready to run.
pub struct Simulation {
    world: World,
    resources: Resources,
    schedule: Schedule,
    clock: Clock,
    end: f64,
    step_rule: scene::StepRule,
    ledger: Ledger,
    uniform_motion: UniformMotion,
    limits: TimeStepLimits,
    next_limit: Option<Limit>,
    /// The first limit of this program, s.
    first_dt: f64,
    sub_steps: SubSteps,
    stop: Option<String>,
    warnings: Vec<String>,
    references: Vec<String>,
    started: bool,
    output: Option<Shared<Output>>,
    probes: Vec<ResolvedProbe>,
    checkpoint_at_end: bool,
    source: Source,
    title: String,
    sound_speeds: Vec<Option<f64>>,
    parameters: BTreeMap<String, f64>,
    inputs: Inputs,
    failure: Option<String>,
    pace: summary::Throughput,
}

/// Parts of a simulation.
pub(crate) struct SimulationParts {
    pub world: World,
    pub resources: Resources,
    pub schedule: Schedule,
    /// Phases that take sub-steps in the steps of the rest.
    pub sub_cycled: Vec<PhaseId>,
    /// The output; none if it writes nothing.
    pub output: Option<Shared<Output>>,
    /// Probes of the scene.
    pub probes: Vec<ResolvedProbe>,
    /// The text of its scene.
    pub source: Source,
    pub warnings: Vec<String>,
    pub references: Vec<String>,
    /// Speed of sound of each body, m/s.
    pub sound_speeds: Vec<Option<f64>>,
    /// Axes along which there are symmetry planes.
    pub mirrored: [bool; 3],
}

/// Why a time step cannot be chosen.
#[derive(Debug, Error)]
pub enum RunError {
    /// A system failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// No system proposes a limit, and the scene asks for an adaptive step.
    #[error("nothing limits the time step; give `time: (step: Fixed(dt))`")]
    NoLimit,
    /// A checkpoint could not be written.
    #[error(transparent)]
    Checkpoint(#[from] SaveError),
    /// An output of the run could not be written.
    #[error(transparent)]
    Record(#[from] crate::record::RecordError),
    /// Ranks compute what must be equal, and it is not.
    #[error(
        "ranks have different energies after step {step}: a fault of the program, or of a machine; please report it"
    )]
    Diverged {
        /// Number of steps done.
        step: u64,
    },
    /// The step has become too small to go on.
    #[error("the time step has fallen to {}, limited by {by}: the run would never finish", quantity(*.dt, "s"))]
    StepTooSmall {
        /// Proposed step, s.
        dt: f64,
        /// Name of the limit.
        by: String,
    },
    /// No program does as many steps.
    #[error(
        "the run must take fewer than {} steps, found {} of {}, limited by {by}",
        number(MAX_STEPS), number(end / dt), quantity(*.dt, "s")
    )]
    TooManySteps {
        /// Proposed step, s.
        dt: f64,
        /// Name of the limit.
        by: String,
        /// End of the run, s.
        end: f64,
    },
}

impl RunError {
    /// Whether the output of the run could not be written: of several ranks, only the first finds that out.
    pub fn is_of_output(&self) -> bool {
        matches!(self, Self::Checkpoint(_) | Self::Record(_) | Self::Step(StepError::Output(_)))
    }

    /// The problem of the scene that the error comes from; none if its values could be right and none of its
    /// items has failed.
    pub fn problem(&self) -> Option<Problem> {
        match self {
            Self::TooManySteps { .. } => Some(Problem::at_path("time.end", self.to_string())),
            Self::Step(StepError::OfItem { item, error }) => Some(item.problem("", error.to_string(), "")),
            _ => None,
        }
    }
}

/// Minimum step, as a share of the whole duration, of a run whose step shrinks.
const MIN_STEP: f64 = 1e-12;
/// The step of such a run over the first one, at most.
const SHRUNK: f64 = 1e-3;
/// Steps between two checks whether ranks are ready together.
const STEPS_BETWEEN_CUTS: u64 = 50;
/// Steps between two checks whether all ranks have the same energies.
const STEPS_BETWEEN_LOOKS: u64 = 16;
/// Steps that no run takes.
const MAX_STEPS: f64 = 1e15;

impl Simulation {
    pub(crate) fn new(parts: SimulationParts, scene: &Scene) -> Self {
        let SimulationParts {
            world,
            resources,
            schedule,
            sub_cycled,
            output,
            probes,
            source,
            warnings,
            references,
            sound_speeds,
            mirrored,
        } = parts;
        Self {
            ledger: Ledger::new(world.bodies().len()),
            uniform_motion: UniformMotion::new(scene.gravity.0, mirrored),
            world,
            resources,
            schedule,
            clock: Clock::default(),
            end: scene.time.end,
            step_rule: scene.time.step.clone(),
            limits: TimeStepLimits::default(),
            next_limit: None,
            first_dt: 0.0,
            sub_steps: SubSteps::new(sub_cycled, &scene.time),
            stop: None,
            warnings,
            references,
            started: false,
            output,
            probes,
            checkpoint_at_end: scene.record.checkpoint_at_end,
            inputs: Inputs::of(&source, scene.parameter_values()),
            source,
            title: scene.title.clone(),
            sound_speeds,
            parameters: scene.parameter_values(),
            failure: None,
            pace: summary::Throughput::default(),
        }
    }

    /// Current value of a probe of the scene: name and value of each of its columns; nothing for energies,
    /// and if no probe has the name.
    ///
    /// # Errors
    /// A column is missing.
    pub fn measure(&self, probe: &str) -> Result<Vec<(String, f64)>, MissingColumn> {
        let Some(probe) = self.probes.iter().find(|known| known.name == probe) else { return Ok(Vec::new()) };
        let values = probe.gauge.read(&self.world, &self.resources)?;
        Ok(probe.gauge.columns().into_iter().map(|(name, _)| name).zip(values).collect())
    }

    /// Columns and bodies.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Shared data of systems.
    pub fn resources(&self) -> &Resources {
        &self.resources
    }

    /// The systems in their order.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// Speed of sound in the undeformed material of each body, m/s: of longitudinal waves in solids, c_0 in
    /// fluids. None for walls.
    pub fn sound_speeds(&self) -> &[Option<f64>] {
        &self.sound_speeds
    }

    /// Values of the parameters of the scene.
    pub fn parameters(&self) -> &BTreeMap<String, f64> {
        &self.parameters
    }

    /// Time and step.
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// Time at which the run ends, s.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Energy ledger.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// The limit of the next step.
    pub fn limit(&self) -> Option<&Limit> {
        self.next_limit.as_ref()
    }

    /// Warnings for the user.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Sources of the methods in use.
    pub fn references(&self) -> &[String] {
        &self.references
    }

    /// Why the run stops before its end time, if a system has asked for that.
    pub fn stop_reason(&self) -> Option<&str> {
        self.stop.as_deref()
    }

    /// Whether the end is reached or a system has asked to stop.
    pub fn is_finished(&self) -> bool {
        self.stop.is_some() || self.clock.time >= self.end
    }

    /// Evaluates the right-hand side at the start and records the initial state. [`Simulation::step`] does
    /// this by itself; call it to know the first limit before any step is done. An error if a system fails.
    pub fn start(&mut self) -> Result<(), RunError> {
        if self.started {
            return Ok(());
        }
        self.started = true;
        self.pace.begin(self.clock.step);
        // With dt = 0 the last kick only sets prescribed velocities and takes the energies.
        self.start_short_steps()?;
        self.run_stages(|stage| stage.is_right_hand_side() || stage == Stage::FinalIntegrate)?;
        let drift = self.uniform_motion.at_start(&self.world, &self.resources, &self.ledger);
        self.ledger.open(drift.map_err(StepError::from)?);
        self.take_limit();
        self.watch_fixed_step();
        self.run_stages(|stage| stage == Stage::Record)?;
        Ok(())
    }

    /// Does one step. If it fails, the recorded output is readable, and the last checkpoint stays valid.
    pub fn step(&mut self) -> Result<(), RunError> {
        let result = self.try_step().map_err(|error| self.with_long_steps(error));
        if let Err(error) = &result {
            self.fail(error);
        }
        result
    }

    fn try_step(&mut self) -> Result<(), RunError> {
        self.start()?;
        self.balance_ranks();
        self.clock.dt = self.choose_step()?;
        self.run_stages(|stage| stage <= Stage::InitialIntegrate)?;
        self.run_short_steps()?;
        self.run_stages(|stage| stage > Stage::InitialIntegrate && stage != Stage::Record)?;
        self.clock.time = if self.ends_here() { self.end } else { self.clock.end() };
        self.clock.step += 1;
        let motion = &self.uniform_motion;
        let follows = motion.follow(self.clock.dt, &self.world, &self.resources, &mut self.ledger);
        follows.map_err(StepError::from)?;
        self.ledger.close_step();
        self.require_equal_ledgers()?;
        self.take_limit();
        self.watch_fixed_step();
        self.run_stages(|stage| stage == Stage::Record)?;
        self.checkpoint_if_due()
    }

    /// Does steps until the end, or until `go_on`, called before every step, returns false. Ends with the
    /// error of the first step that fails.
    pub fn run(&mut self, mut go_on: impl FnMut(&Self) -> bool) -> Result<(), RunError> {
        self.start()?;
        while !self.is_finished() && go_on(self) {
            self.step()?;
        }
        Ok(())
    }

    /// Divides loops among ranks anew ([`ranks`]), with the same cut on all of them. Results do not depend on
    /// it.
    pub fn set_cut(&mut self, cut: Cut) {
        self.world.phases().for_each(|phase| self.world.phase(phase).complete_all());
        ranks::set_cut(cut);
    }

    /// Hash of all columns and of the clock: equal hashes, equal states, bit for bit.
    pub fn state_hash(&self) -> StateHash {
        checkpoint::state_hash(self)
    }

    fn run_stages(&mut self, wanted: impl Fn(Stage) -> bool) -> Result<(), StepError> {
        let mut step = Step {
            world: &self.world,
            resources: &self.resources,
            clock: self.clock,
            ledger: &mut self.ledger,
            limits: &mut self.limits,
            warnings: &mut self.warnings,
            part: StepPart::long(&self.sub_steps.phases, self.sub_steps.long.is_some(), self.clock.step),
            stop: &mut self.stop,
        };
        self.schedule.run(&mut step, wanted)
    }

    fn run_short_stages(&mut self, last: bool, wanted: impl Fn(Stage) -> bool) -> Result<(), StepError> {
        let SubSteps { phases, state, long, .. } = &mut self.sub_steps;
        let mut step = Step {
            world: &self.world,
            resources: &self.resources,
            clock: self.clock,
            ledger: &mut self.ledger,
            limits: &mut state.limits,
            warnings: &mut self.warnings,
            part: StepPart::short(phases, *long, last, state.total),
            stop: &mut self.stop,
        };
        self.schedule.run(&mut step, wanted)
    }

    /// Divides loops anew where some ranks are ready long before others.
    fn balance_ranks(&mut self) {
        if ranks::has_several()
            && self.clock.step.is_multiple_of(STEPS_BETWEEN_CUTS)
            && let Some(cut) = ranks::balanced_cut()
        {
            self.set_cut(cut);
        }
    }

    /// That all ranks have the same energies.
    fn require_equal_ledgers(&self) -> Result<(), RunError> {
        let step = self.clock.step;
        let is_due = ranks::has_several() && step.is_multiple_of(STEPS_BETWEEN_LOOKS);
        match !is_due || ranks::agree(self.ledger.balance_error().to_bits()) {
            true => Ok(()),
            false => Err(RunError::Diverged { step }),
        }
    }

    /// Takes the limit of the next step; in place, so that a step does not allocate.
    fn take_limit(&mut self) {
        if let Some((dt, limit)) = self.sub_steps.limit() {
            self.limits.propose(dt, &limit.by);
        }
        match (self.limits.take(), &mut self.next_limit) {
            (Some(limit), Some(next)) => next.clone_from(limit),
            (limit, next) => *next = limit.cloned(),
        }
        if self.first_dt == 0.0 {
            self.first_dt = self.next_limit.as_ref().map_or(0.0, |limit| limit.dt);
        }
    }

    fn ends_here(&self) -> bool {
        self.clock.end() >= self.end * (1.0 - 1e-12)
    }

    fn choose_step(&self) -> Result<f64, RunError> {
        let dt = match &self.step_rule {
            scene::StepRule::Fixed(dt) => *dt,
            scene::StepRule::Adaptive { factor } => {
                let limit = self.next_limit.as_ref().ok_or(RunError::NoLimit)?;
                let (dt, by) = (limit.dt, || limit.by.clone());
                let fell = dt <= MIN_STEP * self.end && dt < SHRUNK * self.first_dt;
                if dt.is_nan() || fell {
                    return Err(RunError::StepTooSmall { dt, by: by() });
                }
                if dt * MAX_STEPS <= self.end {
                    return Err(RunError::TooManySteps { dt, by: by(), end: self.end });
                }
                factor * dt
            }
        };
        let rest = self.end - self.clock.time;
        // A rest of a little more than one step is one step: no sliver remains at the end.
        Ok(if dt >= rest * (1.0 - 1e-9) { rest } else { dt })
    }
}
