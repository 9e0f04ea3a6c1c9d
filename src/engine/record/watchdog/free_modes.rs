//! Hourglass modes of bodies that nothing controls: motions of particles that the mean gradients do not see,
//! and that no stress resists.
//!
//! The energy that the usual control would hold in them, `sum_i (alpha/12) E_i V_i sum_j V_j w_ij |F_i X_ij -
//! x_ij|^2` with alpha = 5, is compared with that of the deformation. The mean over the neighbours of the
//! squared error over `|X_ij|^2` is that of the field `hourglass_residual`, and `sum_j V_j w_ij |X_ij|^2` is
//! the dimension.

use crate::fields::FieldInput;
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::schedule::{Ledger, Step, StepError};
use crate::solids::hourglass_residual;
use crate::world::{BodyId, PlasticStrain, ReferenceVolume};

/// Energy of the free modes over strain energy plus plastic work that is worth a warning. Without control it
/// is 1.3 in Cook's membrane, which is 10 % too soft, 2.9 in a patch that should breathe, and 2 and more in
/// parts that tear or lose their particles; 0.4 in colliding rings, whose rebound is 5 % off, 0.7 at the
/// steps of a wave in a bar, and zero where the strain is uniform.
const SHARE: f64 = 1.0;
/// The same over the kinetic energy, below which its share says nothing: the body hardly deforms.
const OF_MOTION: f64 = 0.02;
/// Coefficient of the usual control.
const ALPHA: f64 = 5.0;
/// The plugins that resist.
const CONTROLS: [&str; 2] = ["hourglass_control", "hessian_stabilization"];

/// A body without control.
struct Uncontrolled {
    id: BodyId,
    young: f64,
    /// Yield stress at the start, Pa, with which particles resist that have yielded.
    yields: f64,
}

/// Watches the bodies without control.
pub(super) struct FreeModes {
    bodies: Vec<Uncontrolled>,
    dimension: f64,
    /// Largest strain energy plus plastic work of each body so far, J: a body that swings through its rest
    /// shape is no reason to warn.
    pub largest: Vec<f64>,
    /// Bodies that the user has been warned of.
    pub told: Vec<bool>,
}

impl FreeModes {
    /// The solids of a scene that have none of the plugins.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let bodies: Vec<Uncontrolled> =
            sim.bodies().iter().filter_map(|body| uncontrolled(body, sim)).collect();
        let (largest, told) = (vec![0.0; bodies.len()], vec![false; bodies.len()]);
        Self { bodies, dimension: sim.dimension().count() as f64, largest, told }
    }

    /// Checks all bodies.
    ///
    /// # Errors
    /// A column is missing.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let Self { bodies, dimension, largest, told } = self;
        let bodies = bodies.iter().zip(largest).zip(told);
        for ((body, largest), told) in bodies.filter(|(_, told)| !**told) {
            let of = |account: &str| energy(step.ledger, account, body.id);
            *largest = largest.max(of("strain") + of("plastic_work"));
            let free = body.energy(step, *dimension)?;
            if free <= SHARE * *largest || free <= OF_MOTION * of("kinetic") {
                continue;
            }
            *told = true;
            step.warnings.push(format!(
                "nothing resists the hourglass modes of body `{}`, and its particles move in them: they pair up, and it is too soft; give it \
                 `plugins: [hourglass_control()]`",
                step.world.body(body.id).name
            ));
        }
        Ok(())
    }
}

impl Uncontrolled {
    /// What the usual control would hold, J.
    fn energy(&self, step: &Step<'_>, dimension: f64) -> Result<f64, StepError> {
        let (view, rows) = step.world.body_view(self.id);
        let volume = view.read::<ReferenceVolume>()?;
        let plastic = view.read::<PlasticStrain>().ok();
        let input =
            FieldInput { world: step.world, resources: step.resources, body: self.id, rows: rows.clone() };
        let mut residuals = Vec::with_capacity(rows.len());
        hourglass_residual(&input, &mut residuals)?;
        let modulus = |row: usize| {
            let has_yielded = plastic.as_ref().is_some_and(|plastic| plastic[row].0 > 0.0);
            if has_yielded { self.yields.min(self.young) } else { self.young }
        };
        let of = |(row, residual): (usize, f64)| modulus(row) * volume[row].0 * residual * residual;
        Ok(ALPHA / 12.0 * dimension * rows.zip(residuals).map(of).sum::<f64>())
    }
}

fn uncontrolled(body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<Uncontrolled> {
    let has_control = CONTROLS.iter().any(|plugin| sim.scene().has_plugin(body.id.0, plugin));
    if body.kind != BodyKind::Solid || has_control {
        return None;
    }
    let law = body.solid_law().ok()?;
    let yields = law.initial_yield_stress().unwrap_or(f64::INFINITY);
    Some(Uncontrolled { id: body.id, young: law.elastic().young, yields })
}

fn energy(ledger: &Ledger, account: &str, body: BodyId) -> f64 {
    let found = ledger.accounts().iter().find(|known| known.name == account);
    found.map_or(0.0, |account| account.of(body))
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    /// Whether a block with this displacement at the start, m, and velocity, m/s, is warned of.
    fn told(displacement: &str, velocity: &str) -> bool {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1, 1)), spacing: 0.1,
                          formulation: TotalLagrangian)],
                conditions: [InitialDisplacement(on: Select(body: "b"), value: ("{displacement}", 0.0)),
                             InitialVelocity(on: Select(body: "b"), value: ("{velocity}", 0.0))],
                record: (every: 1e-3), time: (end: 1e-2))"#
        );
        let (scene, source) = parse(Source::new("modes.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("nothing resists the hourglass modes"))
    }

    #[test]
    fn particles_that_move_to_and_fro_by_turns_are_warned_of_and_a_stretched_block_is_not() {
        assert!(told("0", "sin(pi*x/0.1)*sin(pi*y/0.1)"));
        assert!(!told("0.02*x", "0"));
        assert!(!told("0", "3 - 2*y"));
    }
}
