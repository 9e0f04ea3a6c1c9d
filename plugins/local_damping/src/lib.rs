//! Damping of the absolute velocity of each particle, independent of its neighbours.
//!
//! With a constant rate, or as dynamic relaxation: the rate follows the slowest oscillation that is left,
//! until the bodies are at rest.

mod decay;
mod relaxation;
mod stiffness;
#[cfg(test)]
mod tests;

use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::rigid::RIGID_BODIES;
use meshless_engine::schedule::{Mode, Stage, System};
use meshless_engine::world::{Mass, Mobility, Velocity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use decay::{Decay, Window};
use relaxation::Relaxing;
use stiffness::PreviousForce;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<LocalDamping>();
}

/// Damps the motion of every particle that is free to move, but not that of rigid bodies.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LocalDamping {
    /// Rate \[1/s\] at which velocities decay, v' = -rate v; only in mode `Constant`, which needs it. An
    /// oscillation of period T is critically damped at 4 pi / T.
    pub rate: Option<f64>,
    /// Constant rate, or relaxation until rest.
    pub mode: DampingMode,
    /// Time \[s\] from which it acts. Default: the start.
    pub from: Option<f64>,
    /// Time \[s\] until which it acts, so that it is off before anything dynamic is recorded. Default: the
    /// end.
    pub until: Option<f64>,
}

/// Choice of the rate.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum DampingMode {
    /// The rate that is given.
    #[default]
    Constant,
    /// Dynamic relaxation to the static solution. The rate is twice the frequency of the motion that is left,
    /// so that the slowest oscillation is critically damped; the frequency is the Rayleigh quotient of the
    /// last step.
    Relaxation {
        /// The bodies are at rest when kinetic energy and the energy of the forces out of balance together
        /// are below tolerance^2 times the elastic energy: the displacement is then within about `tolerance`.
        #[serde(default = "default_tolerance")]
        tolerance: f64,
        /// Time \[s\] before which nothing counts as rest: the end of a ramp of the load.
        #[serde(default)]
        after: f64,
        /// Whether the run ends at rest.
        #[serde(default = "default_stop")]
        stop: bool,
    },
}

fn default_tolerance() -> f64 {
    1e-6
}

fn default_stop() -> bool {
    true
}

impl Plugin for LocalDamping {
    const NAME: &'static str = "local_damping";
    const REFERENCE: &'static str =
        "dynamic relaxation: P. Underwood, in: Computational Methods for Transient Analysis (1983) 245-265";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let window = self.window()?;
        let bodies = sim.scope().clone();
        match self.mode {
            DampingMode::Constant => {
                let rate = self.constant_rate()?;
                let decay = Decay { bodies: bodies.clone(), window, rate };
                let system =
                    System::new(Stage::PostStep, Self::NAME, decay).reads::<Mass>().reads::<Mobility>();
                let system = system.writes::<Velocity>().touches_packed(RIGID_BODIES, Mode::Reads);
                sim.add_system(system.on_bodies(bodies));
            }
            DampingMode::Relaxation { tolerance, after, stop } => {
                self.check_relaxation(tolerance, after)?;
                sim.add_column::<PreviousForce>();
                for system in relaxation::systems(&bodies, window, stop, sim.scene().time.end) {
                    sim.add_system(system);
                }
                sim.add_setup(move |setup| {
                    if setup.resources.try_get::<Relaxing>().is_none() {
                        setup.resources.insert(Relaxing::default());
                    }
                    setup.resources.get_mut::<Relaxing>().join(&bodies, tolerance, after);
                    Ok(())
                });
            }
        }
        Ok(())
    }
}

impl LocalDamping {
    fn window(&self) -> Result<Window, SetupError> {
        let window = Window { from: self.from.unwrap_or(0.0), until: self.until.unwrap_or(f64::INFINITY) };
        if window.from < window.until {
            return Ok(window);
        }
        Err(SetupError::parameter(
            if self.until.is_some() { "until" } else { "from" },
            format!("`until` must be later than `from`, found {} s and {} s", window.until, window.from),
            "give a later time, or leave `until` out",
        ))
    }

    fn constant_rate(&self) -> Result<f64, SetupError> {
        match self.rate {
            Some(rate) if rate >= 0.0 && rate.is_finite() => Ok(rate),
            Some(rate) => Err(SetupError::parameter(
                "rate",
                format!("`rate` must not be negative, found {rate} 1/s"),
                "damping takes energy out; 0 is none",
            )),
            None => Err(SetupError::parameter(
                "rate",
                "`rate` is missing",
                "give a rate in 1/s, such as `rate: 100.0`, or `mode: Relaxation()`",
            )),
        }
    }

    fn check_relaxation(&self, tolerance: f64, after: f64) -> Result<(), SetupError> {
        if self.rate.is_some() {
            let help = "leave `rate` out, or use `mode: Constant`";
            return Err(SetupError::parameter(
                "rate",
                "`Relaxation` has no `rate`: it finds its rate itself",
                help,
            ));
        }
        if !(1e-12..=0.1).contains(&tolerance) {
            let message = format!("`tolerance` must be from 1e-12 to 0.1, found {tolerance}");
            return Err(SetupError::parameter(
                "mode.tolerance",
                message,
                "the smaller it is, the longer the run takes",
            ));
        }
        if !(after >= 0.0 && after.is_finite()) {
            let message = format!("`after` must not be negative, found {after} s");
            return Err(SetupError::parameter("mode.after", message, "a run starts at 0 s"));
        }
        Ok(())
    }
}
