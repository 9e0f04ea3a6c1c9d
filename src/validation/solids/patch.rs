//! S1: an irregular patch that breathes.

use std::f64::consts::TAU;

use anyhow::{Result, ensure};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{DeformationGradient, ReferenceVolume};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Disorder, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S1",
    title: "breathing patch, 444 random particles",
    resolutions: &[21],
    ci_resolution: 21,
    run: patch,
};

pub(crate) const EULERIAN: Case =
    Case { id: "S1E", title: "breathing patch, Eulerian", run: eulerian_patch, ..CASE };

pub(crate) const UPDATED: Case =
    Case { id: "S1U", title: "breathing patch, updated-Lagrangian", run: updated_patch, ..CASE };

/// Period of the mode with the largest change of area, s.
const PERIOD: f64 = 1.5412716;
/// Maximum relative drift of the energy.
const ENERGY: f64 = 0.01;
/// Duration of the run in periods.
const PERIODS: f64 = 200.0;

/// Default coefficient of the hourglass control, which is best for bending.
const DEFAULT: f64 = 5.0;
/// Coefficient that keeps particles in order over hundreds of periods.
const STIFF: f64 = 25.0;

/// Histories of a run.
struct PatchHistory {
    /// Mean of det F over the volume.
    dilatation: Record,
    /// Maximum disorder.
    disorder: f64,
    /// Minimum distance of two neighbours over the distance that the deformation gradient implies.
    closest: f64,
    /// Maximum relative change of the energy.
    energy: f64,
    /// Whether the run has reached its end.
    end: Result<()>,
}

fn patch(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for alpha in [DEFAULT, STIFF] {
        let history = breathe(registry, across, PatchControl::Alpha(alpha), PERIODS)?;
        let name = |what: &str| format!("alpha {alpha}: {what}");
        let (disorder, closest) = (history.disorder, history.closest);
        checks.extend(history.period_and_energy(name)?);
        let order = name("hourglass residual over 200 periods");
        if alpha == STIFF {
            checks.push(Check::below(order, disorder, 0.05, "coherent"));
            let near = name("least of |x| / |F X| in 200 periods");
            checks.push(Check::above(near, closest, 0.5, "coherent"));
        } else {
            checks.push(Check::below(order, disorder, 0.3, "bounded"));
        }
    }
    let without = breathe(registry, across, PatchControl::Alpha(0.0), 8.0)?;
    checks.push(Check::above(
        "hourglass residual within 8 periods without control",
        without.disorder,
        0.3,
        "disordered",
    ));
    Ok(checks)
}

/// The patch as an Eulerian body. Over 200 periods F drifts away from the positions, so that its disorder is
/// not checked.
fn eulerian_patch(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let history = breathe(registry, across, PatchControl::Eulerian, PERIODS)?;
    let closest = history.closest;
    let mut checks = history.period_and_energy(str::to_owned)?;
    checks.push(Check::above("least of |x| / |F X| in 200 periods", closest, 0.5, "coherent"));
    Ok(checks)
}

/// The patch as an updated-Lagrangian body, whose energy may drift by six times as much.
fn updated_patch(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let history = breathe(registry, across, PatchControl::Updated, PERIODS)?;
    let (disorder, energy) = (history.disorder, 6.0 * ENERGY);
    let mut checks = history.period_and_energy_within(str::to_owned, energy)?;
    checks.push(Check::below("hourglass residual over 200 periods", disorder, 0.3, "bounded"));
    Ok(checks)
}

impl PatchHistory {
    fn period_and_energy(self, name: impl Fn(&str) -> String) -> Result<Vec<Check>> {
        self.period_and_energy_within(name, ENERGY)
    }

    fn period_and_energy_within(self, name: impl Fn(&str) -> String, energy: f64) -> Result<Vec<Check>> {
        self.end?;
        Ok(vec![
            Check::new(
                name("spectral peak of the mean dilatation"),
                spectral_peak(&self.dilatation, 0.7 * PERIOD, 1.4 * PERIOD),
                PERIOD,
                Tolerance::Between(-0.04, 0.02),
                "s",
                "finite elements, reference.csv",
            ),
            Check::below(name("energy drift over 200 periods"), self.energy, energy, "energy is conserved"),
        ])
    }
}

/// Hourglass control of the patch.
#[derive(Clone, Copy)]
enum PatchControl {
    /// With this coefficient, and the formulation of the registry.
    Alpha(f64),
    /// With the default of updated-Lagrangian bodies.
    Updated,
    /// With the default of Eulerian bodies.
    Eulerian,
}

fn breathe(registry: &Registry, across: usize, control: PatchControl, periods: f64) -> Result<PatchHistory> {
    // 444 particles at 21 across; the support is 12 neighbours at any number.
    let spacing = 21.0 / across as f64 / 444f64.sqrt();
    let scene = Template::new(
        "tests/validation/patch/scene.ron",
        include_str!("../../../tests/validation/patch/scene.ron"),
    )
    .set("bodies.patch.spacing", spacing)?
    .set("time.end", periods * PERIOD)?;
    let scene = match control {
        PatchControl::Alpha(alpha) => scene.set("bodies.patch.plugins.hourglass_control.alpha", alpha)?,
        PatchControl::Updated => {
            scene.set("bodies.patch.formulation", "UpdatedLagrangian(update: Adaptive(change: 1.0))")?
        }
        PatchControl::Eulerian => scene
            .set("bodies.patch.plugins", "[hourglass_control()]")?
            .set("bodies.patch.formulation", "Eulerian()")?,
    };
    let mut simulation = scene.build(registry)?;
    let patch = body(&simulation, "patch")?;
    let disorder = Disorder::new(&simulation, patch)?;
    if let PatchControl::Alpha(_) = control {
        let neighbors = disorder.mean_neighbors(&simulation);
        ensure!((11.0..13.0).contains(&neighbors), "the particles have {neighbors} neighbours");
    }
    let mut history =
        PatchHistory { dilatation: Record::default(), disorder: 0.0, closest: 1.0, energy: 0.0, end: Ok(()) };
    simulation.start()?;
    let start = simulation.ledger().stored();
    let end = run(&mut simulation, |simulation| {
        history.dilatation.push(simulation.clock().time, mean_dilatation(simulation)?);
        history.energy = history.energy.max((simulation.ledger().stored() / start - 1.0).abs());
        if simulation.clock().step % 20 == 0 {
            history.disorder = history.disorder.max(disorder.measure(simulation)?);
            history.closest = history.closest.min(disorder.closest(simulation)?);
        }
        Ok(())
    });
    history.end = end.map(|_| ());
    Ok(history)
}

/// Mean of det F - 1 over the volume.
fn mean_dilatation(simulation: &Simulation) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(body(simulation, "patch")?);
    let gradient = view.read::<DeformationGradient>()?;
    let volume = view.read::<ReferenceVolume>()?;
    let total: f64 = rows.clone().map(|k| volume[k].0).sum();
    Ok(rows.map(|k| volume[k].0 * (gradient[k].0.determinant() - 1.0)).sum::<f64>() / total)
}

/// Period between two bounds at which the Fourier transform of the record, under a Hann window, is largest,
/// s.
fn spectral_peak(record: &Record, shortest: f64, longest: f64) -> f64 {
    let (samples, end) = (&record.0, record.0.last().map_or(1.0, |last| last.0));
    let mean = samples.iter().map(|s| s.1).sum::<f64>() / samples.len() as f64;
    let power = |frequency: f64| {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for pair in samples.windows(2) {
            let (t, value) = pair[0];
            let weight = (pair[1].0 - t) * (1.0 - (TAU * t / end).cos()) * (value - mean);
            let (sin, cos) = (TAU * frequency * t).sin_cos();
            real += weight * cos;
            imaginary += weight * sin;
        }
        real * real + imaginary * imaginary
    };
    // A quarter of the width of a spectral line.
    let step = 0.25 / end;
    let count = ((1.0 / shortest - 1.0 / longest) / step) as usize;
    let frequencies = (0..=count).map(|k| 1.0 / longest + k as f64 * step);
    let largest = frequencies.map(|f| (f, power(f))).max_by(|a, b| a.1.total_cmp(&b.1));
    largest.map_or(f64::NAN, |(frequency, _)| 1.0 / frequency)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spectral_peak_is_the_stronger_of_two_oscillations() {
        let mut record = Record::default();
        for k in 0..4000 {
            let t = 0.05 * f64::from(k);
            record.push(t, 0.3 + (TAU * t / 1.54).cos() + 0.5 * (TAU * t / 1.15).sin());
        }
        let period = spectral_peak(&record, 1.0, 2.0);
        assert!((period / 1.54 - 1.0).abs() < 2e-3, "{period}");
    }
}
