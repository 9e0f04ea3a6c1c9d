//! Temperatures at the start.

use meshless_engine::glam::DVec3;
use meshless_engine::notation::{place, quantity};
use meshless_engine::plugin::SimBuilder;
use meshless_engine::scene::Expression;
use meshless_engine::schedule::{Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodyId, BodySet, ReferencePosition, Temperature};

use crate::conduction::Conductor;
use crate::{ConductedTemperature, ROOM};

/// Difference of the mean temperatures of two bodies that is worth a warning, K.
const DIFFERENCE: f64 = 1.0;

/// Adds the system that fills the temperatures before the first step.
pub(crate) fn add_system(sim: &mut SimBuilder<'_>, conductors: &[Conductor], given: Option<&Expression>) {
    let bodies = conductors.iter().map(|of| (of.body, of.has_temperature)).collect();
    let set = BodySet::new(conductors.iter().map(|of| of.body));
    let phases = sim.phases_of(&set);
    let conduct =
        |[first, second]: &[BodyId; 2]| first != second && set.contains(*first) && set.contains(*second);
    let touching = sim.contact_pairs().map(|(_, pair)| pair).filter(conduct);
    let start = Start { bodies, touching: touching.collect(), given: given.cloned() };
    sim.add_system(
        System::new(Stage::Neighbors, "temperature_at_the_start", start)
            .on_phases(phases)
            .by_body()
            .reads::<ReferencePosition>()
            .adds::<Temperature>()
            .adds::<ConductedTemperature>(),
    );
}

struct Start {
    /// Bodies, and whether the material has set the temperature.
    bodies: Vec<(BodyId, bool)>,
    /// Pairs of them with a contact, through which no heat passes.
    touching: Vec<[BodyId; 2]>,
    given: Option<Expression>,
}

impl Run for Start {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        if step.clock.step > 0 || step.clock.dt > 0.0 {
            return Ok(());
        }
        for &(body, is_set) in &self.bodies {
            let (view, rows) = step.world.body_view(body);
            let reference = view.read::<ReferencePosition>()?;
            let (mut now, mut last) = (view.write::<Temperature>()?, view.write::<ConductedTemperature>()?);
            for row in rows {
                let at = |given: &Expression, x: DVec3| given.eval(x, 0.0);
                match &self.given {
                    Some(given) => now[row].0 = at(given, reference[row].0),
                    None if !is_set => now[row].0 = ROOM,
                    None => {}
                }
                if !now[row].0.is_finite() {
                    let message = format!(
                        "the temperature at {} is not finite: {}",
                        place(reference[row].0),
                        now[row].0
                    );
                    return Err(StepError::System { system: "heat_conduction".to_owned(), message });
                }
                last[row].0 = now[row].0;
            }
        }
        self.warn_of_differences(step)
    }
}

impl Start {
    /// Warns of bodies that touch and start at different temperatures.
    fn warn_of_differences(&self, step: &mut Step<'_>) -> Result<(), StepError> {
        for pair in &self.touching {
            let mut means = [0.0; 2];
            for (mean, body) in means.iter_mut().zip(pair) {
                let (view, rows) = step.world.body_view(*body);
                let (temperature, count) = (view.read::<Temperature>()?, rows.len() as f64);
                *mean = rows.map(|row| temperature[row].0).sum::<f64>() / count;
            }
            if (means[0] - means[1]).abs() > DIFFERENCE {
                let [first, second] = pair.map(|id| &step.world.body(id).name[..]);
                let [of_first, of_second] = means.map(|mean| quantity(mean, "K"));
                step.warnings.push(format!(
                    "no heat passes between `{first}` and `{second}`, which have a contact and start at {of_first} and {of_second}: \
                     `heat_conduction` conducts within bodies alone"
                ));
            }
        }
        Ok(())
    }
}
