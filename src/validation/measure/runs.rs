//! Runs of a case: to the end, up to a time, until rest.

use anyhow::{Result, ensure};
use meshless_engine::simulation::Simulation;

use super::energy::Balance;

/// Runs until the bodies are at rest, which a relaxation must detect before the end.
pub fn relax(simulation: &mut Simulation) -> Result<()> {
    simulation.run(|_| true)?;
    let reason = simulation.stop_reason();
    ensure!(reason.is_some(), "not at rest after {} s", simulation.clock().time);
    Ok(())
}

/// Runs up to a time, s.
pub fn run_until(simulation: &mut Simulation, time: f64) -> Result<()> {
    simulation.run(|simulation| simulation.clock().time < time)?;
    Ok(())
}

/// Runs to the end, calls `see` after every step, and returns the energy balance.
pub fn run(simulation: &mut Simulation, mut see: impl FnMut(&Simulation) -> Result<()>) -> Result<Balance> {
    let mut balance = Balance::default();
    simulation.start()?;
    see(simulation)?;
    while !simulation.is_finished() {
        simulation.step()?;
        balance.see(simulation);
        see(simulation)?;
    }
    ensure!(simulation.clock().time >= simulation.end(), "the run stopped before its end");
    Ok(balance)
}
