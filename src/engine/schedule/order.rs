//! The order of the systems: stage by stage, sorted by `before` and `after`, checked for ambiguity. Systems
//! that write a column run before those that add to it, unless the opposite is stated.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use thiserror::Error;

use super::resources::Resources;
use super::stage::Stage;
use super::step::{Step, StepError};
use super::step_part::Cadence;
use super::system::System;
use crate::ranks;
use crate::world::{Access, Declared, Mode, PhaseId};

/// Why the systems cannot be put in order.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ScheduleError {
    /// Two systems touch one column and no order is stated.
    #[error(
        "systems `{first}` and `{second}` of stage {stage:?} both touch `{column}` and neither says which runs first; \
         add `.before(\"{second}\")` or `.after(\"{second}\")` to `{first}`"
    )]
    Ambiguous {
        /// Label of one system.
        first: String,
        /// Label of the other.
        second: String,
        /// Stage of both.
        stage: Stage,
        /// Column that both touch.
        column: &'static str,
    },
    /// The stated orders contradict each other.
    #[error("systems of stage {stage:?} wait for each other: {systems}")]
    Cycle {
        /// Stage.
        stage: Stage,
        /// Labels of the systems.
        systems: String,
    },
    /// A system names a system that its stage does not have.
    #[error("system `{system}` wants to run {side} `{label}`, which stage {stage:?} does not have")]
    UnknownLabel {
        /// Label of the system.
        system: String,
        /// `before` or `after`.
        side: &'static str,
        /// The label that nothing has.
        label: String,
        /// Stage.
        stage: Stage,
    },
}

/// The systems in the order in which they run, with the time each has taken.
#[derive(Default)]
pub struct Schedule {
    systems: Vec<System>,
    cadences: Vec<Cadence>,
    times: Vec<Duration>,
}

impl Schedule {
    /// Orders the systems; those without stated order keep the order in which they were added. Those of
    /// sub-cycled phases run in the sub-steps. An error if the order is ambiguous or circular, or names a
    /// system that its stage does not have.
    pub fn new(systems: Vec<System>, sub_cycled: &[PhaseId]) -> Result<Self, ScheduleError> {
        let mut slots: Vec<Option<System>> = systems.into_iter().map(Some).collect();
        let mut ordered = Vec::with_capacity(slots.len());
        for stage in Stage::ALL {
            let members: Vec<usize> = (0..slots.len())
                .filter(|&k| slots[k].as_ref().is_some_and(|system| system.stage == stage))
                .collect();
            let stage_systems: Vec<System> = members.iter().filter_map(|&k| slots[k].take()).collect();
            ordered.extend(order_stage(stage, stage_systems, sub_cycled)?);
        }
        let times = vec![Duration::ZERO; ordered.len()];
        let cadences = ordered.iter().map(|system: &System| system.cadence(sub_cycled)).collect();
        Ok(Self { systems: ordered, cadences, times })
    }

    /// Runs the systems of the stages that `wanted` accepts, as far as they run in this part of the step.
    pub fn run(&mut self, step: &mut Step<'_>, wanted: impl Fn(Stage) -> bool) -> Result<(), StepError> {
        for (k, (system, time)) in self.systems.iter_mut().zip(&mut self.times).enumerate() {
            if wanted(system.stage) && step.part.has(self.cadences[k]) {
                step.ledger.enter(k);
                let start = Instant::now();
                if system.needs_all_packed() && ranks::has_several() {
                    step.resources.complete_packed();
                }
                step.world.enter(Some(k));
                let done = system.work.run(step);
                step.world.enter(None);
                if let Some(undeclared) = step.world.undeclared() {
                    return Err(undeclared.clone().into());
                }
                done.map_err(|error| error.of(system.item.as_ref()))?;
                *time += start.elapsed();
            }
        }
        Ok(())
    }

    /// Declared access of every system to the columns, in their order.
    pub fn declared(&self) -> Vec<Declared> {
        self.systems.iter().map(System::declared).collect()
    }

    /// Label, stage and total time of every system.
    pub fn timers(&self) -> impl Iterator<Item = (&str, Stage, Duration)> {
        self.systems.iter().zip(&self.times).map(|(s, &time)| (s.label.as_str(), s.stage, time))
    }

    /// Key and state of every system that has state; the key is the label, with a number where several have
    /// it.
    pub fn save(&self, resources: &Resources) -> Vec<(String, Vec<u8>)> {
        let state = |k: usize| self.systems[k].work.save_with(resources);
        let states = (0..self.systems.len()).map(|k| (self.key(k), state(k)));
        states.filter(|(_, state)| !state.is_empty()).collect()
    }

    /// Gives a system the state it saved. Returns `false` if there is no such system or it refuses the state.
    pub fn restore(&mut self, key: &str, state: &[u8], resources: &Resources) -> bool {
        let found = (0..self.systems.len()).find(|&k| self.key(k) == key);
        found.is_some_and(|k| self.systems[k].work.restore_with(state, resources))
    }

    fn key(&self, k: usize) -> String {
        let label = &self.systems[k].label;
        match self.systems[..k].iter().filter(|system| system.label == *label).count() {
            0 => label.clone(),
            before => format!("{label} {}", before + 1),
        }
    }

    /// The order in words: a line per stage, a line per system with the columns it touches.
    pub fn describe(&self) -> String {
        let mut text = String::new();
        let exchanges = self.exchanges();
        for stage in Stage::ALL {
            let all = self.systems.iter().zip(&self.cadences).zip(&exchanges);
            let members: Vec<_> = all.filter(|((system, _), _)| system.stage == stage).collect();
            if members.is_empty() {
                continue;
            }
            let _ = writeln!(text, "{stage:?}");
            for ((system, cadence), exchanged) in members {
                let when = match cadence {
                    Cadence::Long => "",
                    Cadence::Short => " (sub-steps)",
                    Cadence::Both => " (long and sub-steps)",
                };
                let _ = write!(text, "  {}{when}", system.label);
                for (mode, verb) in Mode::VERBS {
                    let all = system.access.iter().chain(&system.packed);
                    let columns: Vec<_> = all.filter(|a| a.mode == mode).map(|a| a.column).collect();
                    if !columns.is_empty() {
                        let _ = write!(text, "; {verb} {}", columns.join(", "));
                    }
                }
                if !exchanged.is_empty() {
                    let _ = write!(
                        text,
                        "; rows of neighbours changed since they were last read: {}",
                        exchanged.join(", ")
                    );
                }
                text.push('\n');
            }
        }
        text
    }

    /// Of every system: the columns and packed rows that it reads near ([`Mode::ReadsNear`]) and that have
    /// been changed since they were last read so. Several machines would exchange them before the system.
    fn exchanges(&self) -> Vec<Vec<&'static str>> {
        let mut found = vec![Vec::new(); self.systems.len()];
        let near = |access: &&Access| access.mode == Mode::ReadsNear;
        let changes = |access: &&Access| matches!(access.mode, Mode::Writes | Mode::Adds);
        // Who has changed what since the last exchange, from one step to the next.
        let (mut changed, mut changed_packed) = (Vec::<(usize, &str)>::new(), Vec::<&str>::new());
        for _ in 0..2 {
            for (k, system) in self.systems.iter().enumerate() {
                found[k].clear();
                for near in system.access.iter().filter(near) {
                    let stale = |(by, column): &(usize, &str)| {
                        *column == near.column && self.systems[*by].shares_rows_with(system)
                    };
                    if changed.iter().any(stale) {
                        changed.retain(|change| !stale(change));
                        found[k].push(near.column);
                    }
                }
                for near in system.packed.iter().filter(near) {
                    if changed_packed.contains(&near.column) {
                        changed_packed.retain(|rows| *rows != near.column);
                        found[k].push(near.column);
                    }
                }
                changed.extend(system.access.iter().filter(changes).map(|access| (k, access.column)));
                changed_packed.extend(system.packed.iter().filter(changes).map(|access| access.column));
            }
        }
        found
    }
}

fn order_stage(
    stage: Stage,
    systems: Vec<System>,
    sub_cycled: &[PhaseId],
) -> Result<Vec<System>, ScheduleError> {
    let mut precedes = stated_order(stage, &systems)?;
    put_writers_before_adders(&systems, &mut precedes);
    let n = systems.len();
    let mut order = Vec::with_capacity(n);
    let mut placed = vec![false; n];
    while order.len() < n {
        let ready = (0..n).find(|&k| !placed[k] && (0..n).all(|p| placed[p] || !precedes[p][k]));
        let Some(k) = ready else {
            let waiting = (0..n).filter(|&k| !placed[k]).map(|k| systems[k].label.as_str());
            return Err(ScheduleError::Cycle { stage, systems: waiting.collect::<Vec<_>>().join(", ") });
        };
        placed[k] = true;
        order.push(k);
    }
    check_ambiguity(stage, &systems, &precedes, sub_cycled)?;
    let mut slots: Vec<Option<System>> = systems.into_iter().map(Some).collect();
    Ok(order.into_iter().filter_map(|k| slots[k].take()).collect())
}

/// `precedes[a][b]`: a runs before b, by a chain of stated orders.
fn stated_order(stage: Stage, systems: &[System]) -> Result<Vec<Vec<bool>>, ScheduleError> {
    let n = systems.len();
    let mut precedes = vec![vec![false; n]; n];
    for (k, system) in systems.iter().enumerate() {
        let stated = [(&system.before, "before"), (&system.after, "after"), (&system.after_any, "")];
        for (labels, side) in stated {
            for label in labels {
                let named: Vec<usize> = (0..n).filter(|&m| systems[m].label == *label).collect();
                if named.is_empty() && !side.is_empty() {
                    return Err(ScheduleError::UnknownLabel {
                        system: system.label.clone(),
                        side,
                        label: label.clone(),
                        stage,
                    });
                }
                for m in named {
                    let (first, second) = if side == "before" { (k, m) } else { (m, k) };
                    precedes[first][second] = true;
                }
            }
        }
    }
    close(&mut precedes);
    Ok(precedes)
}

/// Takes in the orders that follow from others by a chain.
fn close(precedes: &mut [Vec<bool>]) {
    let n = precedes.len();
    for via in 0..n {
        for a in 0..n {
            if precedes[a][via] {
                for b in 0..n {
                    precedes[a][b] |= precedes[via][b];
                }
            }
        }
    }
}

/// Of two systems without a stated order, that which writes a column runs before that which adds to it.
fn put_writers_before_adders(systems: &[System], precedes: &mut [Vec<bool>]) {
    let n = systems.len();
    for writer in 0..n {
        for adder in 0..n {
            let is_stated = precedes[writer][adder] || precedes[adder][writer];
            if !is_stated && systems[writer].writes_what_is_added_by(&systems[adder]) {
                precedes[writer][adder] = true;
            }
        }
    }
    close(precedes);
}

fn check_ambiguity(
    stage: Stage,
    systems: &[System],
    precedes: &[Vec<bool>],
    sub_cycled: &[PhaseId],
) -> Result<(), ScheduleError> {
    let cadences: Vec<Cadence> = systems.iter().map(|system| system.cadence(sub_cycled)).collect();
    for a in 0..systems.len() {
        for b in a + 1..systems.len() {
            // Systems of the long step and of the short ones run apart.
            let apart = matches!(
                (cadences[a], cadences[b]),
                (Cadence::Long, Cadence::Short) | (Cadence::Short, Cadence::Long)
            );
            if apart || precedes[a][b] || precedes[b][a] {
                continue;
            }
            if let Some(column) = systems[a].conflict_with(&systems[b]) {
                return Err(ScheduleError::Ambiguous {
                    first: systems[a].label.clone(),
                    second: systems[b].label.clone(),
                    stage,
                    column,
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Column, Force, Mass, Position, Velocity};

    fn idle(label: &str) -> System {
        System::new(Stage::Rates, label, |_: &mut Step<'_>| Ok(()))
    }

    fn labels(systems: Vec<System>) -> Result<Vec<String>, ScheduleError> {
        let schedule = Schedule::new(systems, &[])?;
        Ok(schedule.timers().map(|(label, ..)| label.to_owned()).collect())
    }

    #[test]
    fn what_writes_a_column_runs_before_what_adds_to_it_unless_the_opposite_is_stated() {
        let adder = || idle("adder").adds::<Force>();
        assert_eq!(labels(vec![adder(), idle("writer").writes::<Force>()]).unwrap(), ["writer", "adder"]);
        let before = adder().before("writer");
        let writer = || idle("writer").writes::<Force>();
        assert_eq!(labels(vec![writer(), before]).unwrap(), ["adder", "writer"]);
        let second = ScheduleError::Ambiguous {
            first: "writer".to_owned(),
            second: "second".to_owned(),
            stage: Stage::Rates,
            column: Force::NAME,
        };
        assert_eq!(labels(vec![writer(), idle("second").writes::<Force>(), adder()]), Err(second));
        // Each adds to what the other writes: neither is first by the rule.
        let crossed = |label, writes: fn(System) -> System| writes(idle(label));
        let one = crossed("one", |system| system.writes::<Force>().adds::<Velocity>());
        let other = crossed("other", |system| system.writes::<Velocity>().adds::<Force>());
        assert!(matches!(labels(vec![one, other]), Err(ScheduleError::Ambiguous { .. })));
    }

    #[test]
    fn near_reads_of_what_has_changed_since_the_last_one_are_told() {
        let mover = System::new(Stage::InitialIntegrate, "mover", |_: &mut Step<'_>| Ok(()));
        let near = |stage, label: &str| {
            System::new(stage, label, |_: &mut Step<'_>| Ok(())).reads_near::<Position>().reads_near::<Mass>()
        };
        let systems = vec![
            mover.writes::<Position>(),
            near(Stage::Gradients, "first"),
            near(Stage::Rates, "second"),
            idle("other phase").on_phases([PhaseId(7)]).reads::<Position>(),
        ];
        let text = Schedule::new(systems, &[]).expect("an order").describe();
        let line =
            |label: &str| text.lines().find(|line| line.trim_start().starts_with(label)).expect("a line");
        let told = "rows of neighbours changed since they were last read: ";
        assert!(line("first").ends_with(&format!("{told}{}", Position::NAME)), "{text}");
        // Positions are those of the first; masses never change.
        assert!(line("second").contains("reads near") && !line("second").contains(told), "{text}");
    }

    #[test]
    fn packed_rows_that_another_phase_has_changed_are_told() {
        let of = |stage, label: &str, phase, mode| {
            System::new(stage, label, |_: &mut Step<'_>| Ok(()))
                .on_phases([PhaseId(phase)])
                .touches_packed("records", mode)
        };
        let systems = vec![
            of(Stage::Boundary, "walls", 1, Mode::Writes),
            of(Stage::Rates, "force on fluids", 0, Mode::ReadsNear),
            of(Stage::External, "load", 0, Mode::ReadsNear),
        ];
        let text = Schedule::new(systems, &[]).expect("an order").describe();
        let told = "reads near records; rows of neighbours changed since they were last read: records";
        assert!(text.contains(&format!("force on fluids; {told}")), "{text}");
        assert!(text.ends_with("load; reads near records\n"), "{text}");
    }
}
