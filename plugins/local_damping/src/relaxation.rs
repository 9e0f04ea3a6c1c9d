//! Dynamic relaxation: damping that follows the slowest oscillation that is left, until rest.
//!
//! The Rayleigh quotient of the last displacement, omega^2 = -dx.df / (m dx.dx), is a mean of the squared
//! frequencies in the motion, weighted by their share. Damping at 2 omega removes the fast modes first; the
//! remaining motion is slower, and the rate falls with it until the slowest mode is critically damped.
//! Compared with stopping the motion at each peak of kinetic energy, it needs no detection of peaks, which
//! fast oscillations trigger too early.
//!
//! The quotient is that of all bodies that relax, wherever the plugin is stated. For one of two bodies that
//! touch, dx.df contains the force by which the other one moves it, and is no stiffness.

use meshless_engine::notation::quantity;
use meshless_engine::parallel::BlockSum;
use meshless_engine::rigid::RIGID_BODIES;
use meshless_engine::schedule::{AccountKind, Mode, Run, Shareable, Stage, Step, StepError, System};
use meshless_engine::world::{BodyId, BodySet, Force, Mass, Mobility, Velocity};

use crate::decay::{Window, damp, name_undamped, open_account};
use crate::stiffness::{LastMotion, PreviousForce, look};

/// Name of the systems that look at the motion.
const LOOK: &str = "relaxing_motion";
/// Displacement off equilibrium, over the whole, from which on the user is told.
const OFF: f64 = 1e-3;

/// The relaxing bodies of a scene, and their motion.
pub struct Relaxing {
    bodies: Vec<BodyId>,
    /// Smallest tolerance of all.
    tolerance: f64,
    /// Time before which nothing counts as rest for one of them, s.
    after: f64,
    /// Motion of all of them in the last step.
    motion: LastMotion,
    /// Whether all of them have left the forces of the step before.
    is_known: bool,
    /// Step that `motion` belongs to.
    step: Option<u64>,
}

impl Shareable for Relaxing {
    const ROWS: &'static [&'static str] = &[LOOK];
}

impl Default for Relaxing {
    fn default() -> Self {
        let motion = LastMotion::default();
        Self { bodies: Vec::new(), tolerance: f64::INFINITY, after: 0.0, motion, is_known: true, step: None }
    }
}

impl Relaxing {
    /// Takes in the bodies of one plugin.
    pub fn join(&mut self, bodies: &BodySet, tolerance: f64, after: f64) {
        self.bodies.extend(bodies.iter());
        self.tolerance = self.tolerance.min(tolerance);
        self.after = self.after.max(after);
    }

    fn add(&mut self, motion: &LastMotion, is_known: bool, step: u64) {
        if self.step.replace(step) != Some(step) {
            (self.motion, self.is_known) = (LastMotion::default(), true);
        }
        self.motion.add(motion);
        self.is_known &= is_known;
    }

    /// Stored energy of the bodies beside that of their motion, J.
    fn elastic(&self, step: &Step<'_>) -> f64 {
        let stored =
            step.ledger.accounts().iter().filter(|a| a.kind == AccountKind::Stored && a.name != "kinetic");
        stored.map(|account| self.bodies.iter().map(|&id| account.of(id)).sum::<f64>()).sum()
    }
}

/// Adds the motion of some bodies in the last step to that of all relaxing ones.
struct Look {
    bodies: BodySet,
    /// Whether the last step has left its forces.
    looked: bool,
}

impl Run for Look {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut motion = LastMotion::default();
        for body in self.bodies.iter() {
            motion.add(&look(step, body)?);
        }
        let is_known = std::mem::replace(&mut self.looked, true);
        step.resources.get_mut::<Relaxing>().add(&motion, is_known, step.clock.step);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        vec![u8::from(self.looked)]
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let [looked] = state else { return false };
        self.looked = *looked == 1;
        true
    }
}

/// The relaxation of a set of bodies.
struct Relaxation {
    bodies: BodySet,
    window: Window,
    /// Whether the run ends at rest.
    stop: bool,
    /// Time at which the run ends without rest, s.
    end: f64,
    /// Squared frequency that the energy of unbalanced forces is measured with, 1/s2: the last low one.
    slow: f64,
}

/// The systems of a relaxation: the look at its bodies, and, after all looks, the damping.
pub fn systems(bodies: &BodySet, window: Window, stop: bool, end: f64) -> [System; 2] {
    let look = Look { bodies: bodies.clone(), looked: false };
    let relaxation = Relaxation { bodies: bodies.clone(), window, stop, end, slow: f64::INFINITY };
    let look = System::new(Stage::PostStep, LOOK, look)
        .reads::<Force>()
        .reads::<Velocity>()
        .writes::<PreviousForce>()
        .touches_packed(LOOK, Mode::Adds);
    let relax = System::new(Stage::PostStep, "local_damping", relaxation)
        .writes::<Velocity>()
        .touches_packed(LOOK, Mode::Reads)
        .touches_packed(RIGID_BODIES, Mode::Reads)
        .after_any(LOOK);
    [look, relax].map(|system| system.reads::<Mass>().reads::<Mobility>().on_bodies(bodies.clone()))
}

impl Relaxation {
    /// Squared frequency of the last step, 1/s2; zero where the motion meets no resistance.
    fn measure(&mut self, motion: &LastMotion, dt: f64) -> f64 {
        let squared = if motion.inertia > 0.0 { (motion.resistance / motion.inertia).max(0.0) } else { 0.0 };
        // It falls at once and rises slowly: at a turning point of the slow motion only fast ones are seen.
        if squared > 0.0 {
            let risen = self.slow * (1.0 + dt * self.slow.sqrt());
            self.slow = if self.slow.is_finite() { squared.min(risen) } else { squared };
        }
        squared
    }

    /// Energy of motion and of forces out of balance, J.
    fn moving(&self, motion: &LastMotion) -> f64 {
        let unbalanced = if motion.unbalance > 0.0 { 0.5 * motion.unbalance / self.slow } else { 0.0 };
        0.5 * motion.twice_kinetic + unbalanced
    }

    /// Ends the run at rest; says at its end that there is none.
    fn judge(&self, relaxing: &Relaxing, step: &mut Step<'_>) {
        let (moving, elastic) = (self.moving(&relaxing.motion), relaxing.elastic(step));
        let now = step.clock.end();
        if now >= relaxing.after && moving <= relaxing.tolerance * relaxing.tolerance * elastic {
            *step.stop = Some(format!("in static equilibrium to {:.0e}", relaxing.tolerance));
        } else if now >= self.end * (1.0 - 1e-9) && moving > OFF * OFF * elastic {
            // Energies are quadratic in what displacements are off by.
            let text = format!(
                "`local_damping` has not brought the bodies to rest by the end of the run: kinetic energy and that of the forces out of balance are {} beside an elastic energy of {}, so that displacements and stresses are some {:.1} % off equilibrium; a later `end` lets it go on",
                quantity(moving, "J"),
                quantity(elastic, "J"),
                100.0 * (moving / elastic).sqrt().min(1.0)
            );
            if !step.warnings.contains(&text) {
                step.warnings.push(text);
            }
        }
    }
}

impl Run for Relaxation {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        open_account(step);
        name_undamped(step, &self.bodies);
        let resources = step.resources;
        let relaxing = resources.get::<Relaxing>();
        let time = self.window.share(&step.clock);
        if !relaxing.is_known || time == 0.0 {
            return Ok(());
        }
        let omega = self.measure(&relaxing.motion, step.clock.dt).sqrt();
        let factor = (-2.0 * omega * time).exp();
        for body in self.bodies.iter() {
            damp(step, body, factor)?;
        }
        if self.stop {
            self.judge(&relaxing, step);
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        self.slow.to_le_bytes().to_vec()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok(slow) = <[u8; 8]>::try_from(state) else { return false };
        self.slow = f64::from_le_bytes(slow);
        true
    }
}
