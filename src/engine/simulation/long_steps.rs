//! Steps longer than the stable ones: a fixed step, or a factor above one on the limit.

use super::{RunError, Simulation};
use crate::notation::{number, quantity};
use crate::scene::StepRule;

/// The begin of the warning of a fixed step; there is one of them in a run.
const FIXED: &str = "the fixed time step of ";

impl Simulation {
    /// Warns of a fixed step that is longer than the limit of the next step, the first time that it is.
    pub(super) fn watch_fixed_step(&mut self) {
        let (StepRule::Fixed(dt), Some(limit)) = (&self.step_rule, &self.next_limit) else { return };
        if *dt <= limit.dt || self.warnings.iter().any(|warning| warning.starts_with(FIXED)) {
            return;
        }
        let since = match self.clock.step {
            0 => String::new(),
            _ => format!(" from {} on", quantity(self.clock.time, "s")),
        };
        self.warnings.push(format!(
            "{FIXED}{} exceeds the stable one of {}{since}, limited by {}",
            quantity(*dt, "s"),
            quantity(limit.dt, "s"),
            limit.by
        ));
    }

    /// The error of a step with what is known of the length of steps: a particle that inverts in steps that
    /// are too long says nothing of its material.
    pub(super) fn with_long_steps(&self, error: RunError) -> RunError {
        let RunError::Step(error) = error else { return error };
        let why = match &self.step_rule {
            StepRule::Fixed(_) => self.warnings.iter().find(|warning| warning.starts_with(FIXED)).cloned(),
            StepRule::Adaptive { factor } if *factor > 1.0 => {
                Some(format!("the steps are {} times the stable ones", number(*factor)))
            }
            StepRule::Adaptive { .. } => None,
        };
        RunError::Step(match why {
            Some(why) => error.of_long_steps(&why),
            None => error,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};
    use crate::simulation::Simulation;

    /// A soft block that falls on a plate from 0.2 m above it, with this speed, m/s.
    fn falling(speed: f64, step: &str) -> (Simulation, Option<String>) {
        let text = format!(
            r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000.0, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "block", material: "soft", shape: Box(min: (-0.5, 0.2), max: (0.5, 0.7)), spacing: 0.05,
                     velocity: (0.5, {:?}), formulation: TotalLagrangian),
                    (name: "plate", material: "soft", shape: Box(min: (-1, -0.2), max: (1, 0)), spacing: 0.05, formulation: Rigid),
                ],
                conditions: [Fix(on: Select(body: "plate"))],
                contacts: [(between: ("block", "plate"))],
                time: (end: 0.1, step: {step}))"#,
            -speed
        );
        let (scene, source) =
            parse(Source::new("falling.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|error| panic!("{error}"));
        let error = sim.run(|_| true).err().map(|error| error.to_string());
        (sim, error)
    }

    fn warned(sim: &Simulation) -> Vec<&String> {
        sim.warnings().iter().filter(|warning| warning.starts_with(super::FIXED)).collect()
    }

    #[test]
    fn a_fixed_step_that_becomes_too_long_is_warned_of_once_and_named_by_the_error() {
        for (speed, unstable) in [(5.0, false), (15.0, true)] {
            let (sim, error) = falling(speed, "Fixed(3e-4)");
            let [warning] = *warned(&sim) else { panic!("{:?}", sim.warnings()) };
            assert!(warning.contains(" on, limited by stiffness of contact"), "{warning}");
            // Before, the error of the second one said that its material cannot bear what presses it.
            assert!(!unstable || error.is_some(), "no error");
            assert!(error.as_ref().is_none_or(|error| error.ends_with(warning)), "{error:?}");
        }
    }

    #[test]
    fn a_fixed_step_that_is_short_enough_is_not_warned_of() {
        let (sim, error) = falling(5.0, "Fixed(2e-5)");
        assert!(warned(&sim).is_empty() && error.is_none(), "{:?} {error:?}", sim.warnings());
    }
}
