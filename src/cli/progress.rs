//! Progress of a run: a bar on a terminal, plain lines elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use meshless_engine::notation::quantity;
use meshless_engine::simulation::Simulation;

use super::text::{complain, counted, duration, speaks};

/// Time between two updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(200);
/// Time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(10);
/// Ticks of the bar for the whole run.
const TICKS: u64 = 1000;

/// Shows the progress of a run.
pub struct ProgressLine {
    display: Display,
    interval: Duration,
    begun: Instant,
    shown: Instant,
    start: (f64, u64),
    warned: usize,
}

enum Display {
    Nothing,
    Bar(ProgressBar),
    Lines,
}

impl ProgressLine {
    /// Starts the display; earlier time and steps do not count for the rates.
    pub fn new(sim: &Simulation, quiet: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let display = match (quiet || !speaks(), terminal) {
            (true, _) => Display::Nothing,
            (false, true) => Display::Bar(bar()),
            (false, false) => Display::Lines,
        };
        let interval = if terminal { BAR_INTERVAL } else { LINE_INTERVAL };
        let now = Instant::now();
        Self {
            display,
            interval,
            begun: now,
            shown: now,
            start: (sim.clock().time, sim.clock().step),
            warned: 0,
        }
    }

    /// Wall time since the start, s.
    pub fn elapsed(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Steps done since the start.
    pub fn steps(&self, sim: &Simulation) -> u64 {
        sim.clock().step - self.start.1
    }

    /// Particles times steps over wall time, 1/s.
    pub fn rate(&self, sim: &Simulation) -> f64 {
        self.steps(sim) as f64 * sim.world().len() as f64 / self.elapsed().max(1e-9)
    }

    /// Called after every step: shows new warnings, and the progress if it is due.
    pub fn update(&mut self, sim: &Simulation) {
        self.warn(sim);
        if self.shown.elapsed() < self.interval {
            return;
        }
        self.shown = Instant::now();
        let share = sim.clock().time / sim.end();
        match &self.display {
            Display::Nothing => {}
            Display::Bar(bar) => {
                bar.set_position((share * TICKS as f64) as u64);
                bar.set_message(self.state(sim));
            }
            Display::Lines => complain(&format!("{:5.1} %  {}", 100.0 * share, self.state(sim))),
        }
    }

    /// Shows the last warnings and removes the bar.
    pub fn finish(&mut self, sim: &Simulation) {
        self.warn(sim);
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }

    /// Shows the warnings since the last ones.
    pub fn warn(&mut self, sim: &Simulation) {
        for warning in sim.warnings().iter().skip(self.warned) {
            match &self.display {
                Display::Bar(bar) => bar.suspend(|| complain(&format!("warning: {warning}"))),
                _ => complain(&format!("warning: {warning}")),
            }
        }
        self.warned = sim.warnings().len();
    }

    fn state(&self, sim: &Simulation) -> String {
        let clock = sim.clock();
        let limiter = sim.limit().map(|limit| format!(" ({})", limit.by)).unwrap_or_default();
        let short = match (sim.sub_steps(), sim.short_limit()) {
            (Some((count, _)), Some(limit)) if count > 1 => format!(" = {count} sub-steps ({})", limit.by),
            _ => String::new(),
        };
        let done = clock.time - self.start.0;
        let rest = self.elapsed() * (sim.end() - clock.time) / done;
        format!(
            "t = {}  step {}  dt = {}{limiter}{short}  {}  {} left",
            quantity(clock.time, "s"),
            clock.step,
            quantity(clock.dt, "s"),
            counted(self.rate(sim), "particle-steps/s"),
            duration(rest)
        )
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {elapsed}\n{wide_msg}");
    let bar = ProgressBar::new(TICKS);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
