//! The system of the watchdog.

use super::bodies_inside::BodiesInside;
use super::crossed_planes::CrossedPlanes;
use super::domain::DomainCheck;
use super::energy_growth::{EnergyGrowth, resolution};
use super::free_modes::FreeModes;
use super::hourglass::HourglassShare;
use super::passing::PassingBodies;
use super::remedies::Remedies;
use super::soft_under_pressure::SoftUnderPressure;
use super::wrong_sign::WrongSign;
use crate::plugin::SimBuilder;
use crate::schedule::Trigger;
use crate::schedule::{Run, Stage, Step, StepError, System};

/// Label of the system that checks for invalid states at the end of every step.
pub const WATCHDOG: &str = "watchdog";

/// Steps between two checks of the domain: a particle that has left it stays outside.
const DOMAIN_INTERVAL: u64 = 10;

/// Share of the run in which hourglass energy is not judged.
const START: f64 = 0.1;

struct Watchdog {
    energy: EnergyGrowth,
    resolution: f64,
    hourglass: HourglassShare,
    wrong_sign: WrongSign,
    passing: PassingBodies,
    inside: BodiesInside,
    crossed: CrossedPlanes,
    soft: SoftUnderPressure,
    free: FreeModes,
    remedies: Remedies,
    domain: Option<DomainCheck>,
    /// Checks that end in a warning are made with the frames, but not with the first one: a body at rest has
    /// no energies.
    frames: Trigger,
    end: f64,
}

/// Adds the watchdog.
pub fn add_system(sim: &mut SimBuilder<'_>) {
    let domain = DomainCheck::of_scene(sim);
    let watchdog = Watchdog {
        energy: EnergyGrowth::default(),
        resolution: sim.bodies().iter().map(resolution).sum(),
        hourglass: HourglassShare::new(sim),
        wrong_sign: WrongSign::new(sim),
        passing: PassingBodies::new(sim),
        inside: BodiesInside::new(sim),
        crossed: CrossedPlanes::new(sim),
        soft: SoftUnderPressure::new(sim),
        free: FreeModes::new(sim),
        remedies: Remedies::new(sim),
        domain,
        frames: Trigger::after_interval(sim.scene().record_interval()),
        end: sim.scene().time.end,
    };
    sim.add_system(System::new(Stage::Record, WATCHDOG, watchdog).reads_all());
}

impl Run for Watchdog {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let at_end = step.clock.time >= self.end || step.stop.is_some();
        if let Some(domain) = &mut self.domain
            && (at_end || step.clock.step.is_multiple_of(DOMAIN_INTERVAL))
        {
            domain.look(step)?;
        }
        step.ledger.set_resolution(self.resolution);
        self.energy.look(step, self.resolution, &self.remedies)?;
        self.hourglass.look(step.ledger, step.world.bodies().len());
        if self.frames.is_due(step.clock.time) || at_end {
            // Waves of the first load have the control carry a part of them that the result has not.
            if at_end || step.clock.time > START * self.end {
                self.hourglass.judge(step.ledger, step.clock.time);
            }
            if at_end {
                self.hourglass.warn(step);
            }
            self.passing.look(step)?;
            self.inside.look(step)?;
            self.crossed.look(step)?;
            self.soft.look(step)?;
            self.free.look(step)?;
            self.wrong_sign.warn(step, &self.remedies, at_end);
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&(
            self.energy,
            &self.hourglass,
            &self.wrong_sign,
            (&self.passing.told, &self.inside.told, &self.crossed.told),
            (&self.soft.told, &self.free.told),
            self.frames,
        ))
        .unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok((energy, hourglass, wrong_sign, (passing, inside, crossed), (soft, free), frames)) =
            postcard::from_bytes(state)
        else {
            return false;
        };
        (self.energy, self.hourglass, self.wrong_sign) = (energy, hourglass, wrong_sign);
        (self.passing.told, self.inside.told, self.crossed.told) = (passing, inside, crossed);
        (self.soft.told, self.free.told) = (soft, free);
        self.frames.resume(frames);
        true
    }
}
