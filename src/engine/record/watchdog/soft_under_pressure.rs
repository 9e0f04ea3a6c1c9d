//! Solids under a pressure far above what they resist with, on lattices that are not even.
//!
//! There a uniform pressure leaves a force of some hundredths of it on each particle, which shear modulus and
//! hourglass control have to hold: particles give way, and the pressure falls short. Stress behind shocks in
//! elastic bodies at 2.5, 50 and 170 times the modulus: -0.7, -27 and -24 % in relaxed, +0.4, -18 and -16 %
//! in hexagonal lattices. Failed particles resist with nothing: -3 to -6 % at a tenth of the modulus, -14 to
//! -38 % at 0.4. Particles that have yielded have a resistance that follows the pressure.

use crate::plugin::{BodyKind, BodyPlan, Offer, SimBuilder};
use crate::schedule::{Step, StepError};
use crate::shapes::Lattice;
use crate::world::{BodyId, Damage, DeformationGradient, PiolaStress, Removed};

/// Pressure over Young's modulus that is worth a warning in elastic particles, and in failed ones.
const RATIO: f64 = 4.0;
const RATIO_OF_FAILED: f64 = 0.05;
/// Share of the particles under that pressure.
const SHARE: f64 = 0.05;

/// A body that is checked.
struct Soft {
    id: BodyId,
    /// Young's modulus, Pa.
    young: f64,
    /// Whether only its failed particles count: others yield.
    flows: bool,
}

/// Checks the pressure of soft bodies.
pub(super) struct SoftUnderPressure {
    bodies: Vec<Soft>,
    /// Bodies that the user has been warned of.
    pub told: Vec<bool>,
}

impl SoftUnderPressure {
    /// The solids with a reference configuration and an uneven lattice that are elastic or can fail.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let bodies: Vec<Soft> = sim.bodies().iter().filter_map(|body| soft(body, sim)).collect();
        Self { told: vec![false; bodies.len()], bodies }
    }

    /// Checks all bodies.
    ///
    /// # Errors
    /// A column is missing.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for (body, told) in self.bodies.iter().zip(&mut self.told).filter(|(_, told)| !**told) {
            let (view, rows) = step.world.body_view(body.id);
            let (f, stress) = (view.read::<DeformationGradient>()?, view.read::<PiolaStress>()?);
            let removed = view.read::<Removed>()?;
            let damage = view.read::<Damage>().ok();
            let has_failed = |row: usize| damage.as_ref().is_some_and(|damage| damage[row].0 >= 1.0);
            let squeezed = |row: usize, limit: f64| {
                let (f, p) = (f[row].0, stress[row].0);
                let trace = p.x_axis.dot(f.x_axis) + p.y_axis.dot(f.y_axis) + p.z_axis.dot(f.z_axis);
                let pressure = -trace / (3.0 * f.determinant());
                removed[row] == Removed::NO && pressure > limit * body.young
            };
            let failed =
                rows.clone().filter(|&row| has_failed(row) && squeezed(row, RATIO_OF_FAILED)).count();
            let intact = rows.clone().filter(|&row| !has_failed(row) && squeezed(row, RATIO)).count();
            let elastic = if body.flows { 0 } else { intact };
            let present = rows.clone().filter(|&row| removed[row] == Removed::NO).count().max(1);
            let share = |count: usize| count as f64 / present as f64;
            let (count, what, ratio) = if share(elastic) > SHARE {
                (elastic, "", RATIO)
            } else if share(failed) > SHARE {
                (failed, " have failed and", RATIO_OF_FAILED)
            } else {
                continue;
            };
            *told = true;
            step.warnings.push(format!(
                "{:.0} % of the particles of body `{}`{what} are under a pressure of more than {ratio} times Young's modulus, and its \
                 lattice is not even: particles give way, and the pressure falls short; use `formulation: Eulerian()`, or `lattice: Regular`, with curved sides `BodyFitted()`",
                100.0 * share(count),
                step.world.body(body.id).name
            ));
        }
        Ok(())
    }
}

fn soft(body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<Soft> {
    // Inside, the others are even.
    let is_uneven =
        matches!(sim.scene().bodies[body.id.0].lattice, Lattice::Hexagonal | Lattice::Relaxed { .. });
    if body.kind != BodyKind::Solid || !body.offers(Offer::FoldedTerms) || !is_uneven {
        return None;
    }
    let law = body.solid_law().ok()?;
    let flows = law.initial_yield_stress().is_some_and(f64::is_finite);
    (!flows || body.can_fail()).then(|| Soft { id: body.id, young: law.elastic().young, flows })
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    /// Whether a block of rubber, K = 1667 E, that is compressed by a share of its volume is warned of.
    fn told(lattice: &str, compression: f64) -> bool {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: 0.4999)}},
                bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (2, 2)), spacing: 0.1,
                          lattice: {lattice}, formulation: TotalLagrangian)],
                conditions: [InitialDisplacement(on: Select(body: "b"), value: ("-{compression:?}*x", 0.0))],
                record: (every: 1e-5), time: (end: 1e-5))"#
        );
        let (scene, source) = parse(Source::new("rubber.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("times Young's modulus"))
    }

    #[test]
    fn rubber_under_many_times_its_modulus_on_an_uneven_lattice_is_warned_of() {
        // 8 and 2 times the modulus.
        for lattice in ["Relaxed()", "Hexagonal"] {
            assert!(told(lattice, 0.005), "{lattice}");
            assert!(!told(lattice, 0.001), "{lattice}");
        }
        assert!(!told("Regular", 0.005));
    }
}
