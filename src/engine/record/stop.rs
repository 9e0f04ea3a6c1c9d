//! Ends a run when a probe passes a value: `time: (stop_when: [(probe: "front", above: 0.5)])`.
//!
//! Values are compared at the samples of the probe. A condition is met at the first sample beyond the value
//! after one that is not: a run that is resumed there goes on to the next passage.

use std::sync::Arc;

use super::probe::{EnergyColumns, Gauge, ResolvedProbe};
use crate::fields::FieldTable;
use crate::notation::{quantity, quantity_to};
use crate::plugin::SimBuilder;
use crate::scene::{Problem, StopWhen};
use crate::schedule::Trigger;
use crate::schedule::{Mode, Run, Stage, Step, StepError, System};

/// Label of the system.
pub const STOP: &str = "stop_when";

/// A condition with its probe.
struct Condition {
    when: StopWhen,
    gauge: Arc<Gauge>,
    trigger: Trigger,
    /// Whether the last sample was beyond the value; none before the first one.
    beyond: Option<bool>,
}

impl Condition {
    fn resolve(
        k: usize,
        when: &StopWhen,
        sim: &SimBuilder<'_>,
        table: &Arc<FieldTable>,
    ) -> Result<Self, Vec<Problem>> {
        let probes = &sim.scene().probes;
        let Some((index, probe)) = probes.iter().enumerate().find(|(_, probe)| probe.name == when.probe)
        else {
            // Reported by the checks of the scene.
            return Err(Vec::new());
        };
        let ResolvedProbe { interval, gauge, .. } = ResolvedProbe::resolve(index, probe, sim, table)?;
        let names: Vec<String> = match &*gauge {
            Gauge::Energies(_) => Vec::new(),
            gauge => gauge.columns().into_iter().map(|(name, _)| name).collect(),
        };
        let at = |field: &str| format!("time.stop_when[{k}].{field}");
        match &when.column {
            None if names.len() != 1 => {
                let message = format!("probe `{}` has several columns, `column` must name one", when.probe);
                let problem = Problem::at_path(at("probe"), message);
                return Err(vec![if names.is_empty() { problem } else { problem.help(known(&names)) }]);
            }
            Some(column) if !names.is_empty() && !names.contains(column) => {
                let message = format!("probe `{}` has no column `{column}`", when.probe);
                return Err(vec![Problem::at_path(at("column"), message).help(known(&names))]);
            }
            _ => {}
        }
        Ok(Self { when: when.clone(), gauge, trigger: Trigger::new(interval), beyond: None })
    }

    /// Value and unit of the column; none for an energy account that is not open yet.
    fn read(&self, step: &Step<'_>) -> Result<Option<(f64, &'static str)>, StepError> {
        let wanted = |name: &str| self.when.column.as_deref().is_none_or(|column| column == name);
        let (columns, values) = match &*self.gauge {
            Gauge::Energies(energies) => {
                let accounts = EnergyColumns::accounts(step.ledger);
                (energies.names(&accounts), energies.values(&accounts, step.ledger))
            }
            gauge => (gauge.columns(), gauge.read(step.world, step.resources)?),
        };
        let mut found = columns.iter().zip(values).filter(|((name, _), _)| wanted(name));
        Ok(found.next().map(|((_, unit), value)| (value, *unit)))
    }

    /// Why the run stops now, if it does.
    fn look(&mut self, step: &Step<'_>) -> Result<Option<String>, StepError> {
        if !self.trigger.is_due(step.clock.time) {
            return Ok(None);
        }
        let Some((value, unit)) = self.read(step)? else { return Ok(None) };
        let above = self.when.above.filter(|limit| value > *limit).map(|limit| ("above", limit));
        let below = self.when.below.filter(|limit| value < *limit).map(|limit| ("below", limit));
        let passed = above.or(below);
        let before = self.beyond.replace(passed.is_some());
        Ok(passed.filter(|_| before == Some(false)).map(|(side, limit)| {
            let column = self.when.column.as_ref().map(|column| format!(".{column}")).unwrap_or_default();
            let name = &self.when.probe;
            let (limit, value) = (quantity(limit, unit), quantity_to(value, unit, 6));
            format!("probe `{name}{column}` is {side} {limit}: {value}")
        }))
    }
}

fn known(names: &[String]) -> String {
    let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    format!("known here: {}", names.join(", "))
}

struct Stop(Vec<Condition>);

impl Run for Stop {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for condition in &mut self.0 {
            if let Some(why) = condition.look(step)? {
                step.stop.get_or_insert(why);
            }
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let state: Vec<_> = self.0.iter().map(|condition| (condition.trigger, condition.beyond)).collect();
        postcard::to_stdvec(&state).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok(state) = postcard::from_bytes::<Vec<(Trigger, Option<bool>)>>(state) else { return false };
        for (condition, (trigger, beyond)) in self.0.iter_mut().zip(state) {
            condition.trigger.resume(trigger);
            condition.beyond = beyond;
        }
        true
    }
}

/// Adds the system where the scene has conditions; before the one that writes, so that a run ends with a
/// frame and a sample.
///
/// # Errors
/// A condition names no column of its probe.
pub(super) fn add_system(sim: &mut SimBuilder<'_>, table: &Arc<FieldTable>) -> Result<(), Vec<Problem>> {
    let mut problems = Vec::new();
    let mut conditions = Vec::new();
    for (k, when) in sim.scene().time.stop_when.iter().enumerate() {
        match Condition::resolve(k, when, sim, table) {
            Ok(condition) => conditions.push(condition),
            Err(found) => problems.extend(found),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    if !conditions.is_empty() {
        let mut columns: Vec<_> = conditions.iter().flat_map(|condition| condition.gauge.needs()).collect();
        columns.sort_unstable();
        columns.dedup();
        let system = System::new(Stage::Record, STOP, Stop(conditions)).reads_all();
        let system = columns.iter().fold(system, |system, column| system.touches(column, Mode::Reads));
        sim.add_system(system);
    }
    Ok(())
}
