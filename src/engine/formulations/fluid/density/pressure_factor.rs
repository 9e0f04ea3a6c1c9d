//! The factor of pressures in sums over pairs.
//!
//! The force of a pressure that rises evenly is its slope times `tau = tr(sum_j V_j w_ij x_ij (x) x_ij) / d`
//! in d dimensions: 1 for infinitely many neighbours, 0.997 in a square lattice, down to 0.97 among mixed
//! particles. So the mean s = 1 / tau over the particles inside of fluids multiplies all pressures in sums
//! over pairs, and the rates of compression, which are their adjoint. The pressure is right in the mean, and
//! as s is one number for all pairs, momentum, angular momentum and the balance of energy are as exact as
//! without it.

use glam::DVec3;

use crate::correction::MomentMatrix;
use crate::formulations::fluid::cloud::{ArrangementPass, FlowCloud, RowSums};
use crate::schedule::{Run, Step, StepError};

/// Number of steps from one mean to the next: particles mix much more slowly.
const INTERVAL: u64 = 32;
/// First moment `sum_j V_j w_ij x_ij` times the smoothing length from which on a particle does not count as
/// inside: at the surface it is some 0.5, two spacings below it 0.1, among mixed particles 0.02 to 0.05.
const OUTSIDE: f64 = 0.1;
/// Least tau of a particle inside: those of drops and threads, whose first moments may vanish too, have less.
const LEAST: f64 = 0.9;

/// Finds the factor.
pub struct PressureFactor {
    factor: f64,
    /// Weight of each particle, and with it tau.
    inside: Vec<[f64; 2]>,
    sums: RowSums,
}

impl Default for PressureFactor {
    fn default() -> Self {
        Self { factor: 1.0, inside: Vec::new(), sums: RowSums::default() }
    }
}

impl Run for PressureFactor {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        // A run that is resumed computes the last forces once more, with the factor that they had.
        let is_resumed = step.clock.dt == 0.0 && step.clock.step > 0;
        if step.clock.step.is_multiple_of(INTERVAL) && !is_resumed {
            self.factor = self.measure(&cloud);
        }
        cloud.pressure_factor = self.factor;
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        self.factor.to_le_bytes().to_vec()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok(bytes) = state.try_into() else { return false };
        self.factor = f64::from_le_bytes(bytes);
        true
    }
}

impl PressureFactor {
    fn measure(&mut self, cloud: &FlowCloud) -> f64 {
        let (h, axes) = (cloud.kernel.smoothing_length(), if cloud.plane { 2.0 } else { 3.0 });
        let output = |_, moment: &MomentMatrix, first: DVec3| {
            let moment = moment.matrix();
            let tau = (moment.xx + moment.yy + if cloud.plane { 0.0 } else { moment.zz }) / axes;
            let weight = 1.0 - (first.length() * h / OUTSIDE).powi(2);
            let weight = if tau > LEAST { weight.max(0.0) } else { 0.0 };
            [weight, weight * tau]
        };
        self.inside.resize(cloud.fluid, [0.0; 2]);
        cloud.for_each_row(0, &mut self.inside, &mut self.sums, &ArrangementPass { cloud, output });
        // Where no particle is inside it is one.
        let [weight, tau] = self.inside.iter().fold([1.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
        weight / tau
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::formulations::fluid::cloud::FlowCloud;
    use crate::formulations::fluid::tests::{column, double, simulation};
    use crate::simulation::Simulation;
    use crate::world::{Density, Force, Mass, Position, Velocity};

    #[test]
    fn mixed_particles_feel_the_slope_of_the_pressure_and_the_divergence_of_the_velocity() {
        for (precision, shape, dimension, middle) in [
            ("Double", "Box(min: (0, 0), max: (0.6, 0.6))", "Two", 0.3),
            ("Mixed", "Box(min: (0, 0), max: (0.6, 0.6))", "Two", 0.3),
            ("Mixed", "Box(min: (0, 0, 0), max: (0.4, 0.4, 0.4))", "Three", 0.2),
        ] {
            let mut sim = simulation(&format!(
                r#"(precision: {precision}, dimension: {dimension},
                    materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                    bodies: [(name: "water", material: "water", spacing: 0.02, shape: {shape},
                        lattice: Relaxed(seed: 3, iterations: 20), formulation: Fluid(pressure: "1000*(x - {middle})"))],
                    conditions: [InitialVelocity(on: Select(body: "water"), value: ("0.1*x", "0.2*y"))],
                    time: (end: 1.0))"#
            ));
            sim.start().expect("a start");
            let x = column::<Position>(&sim, 0);
            // A weight without an edge: forces across one would not cancel.
            let weight = |k: usize| {
                let of = |x: f64| (1.0 - ((x - middle) / (middle - 0.06)).powi(2)).max(0.0).powi(2);
                of(x[k].0.x) * of(x[k].0.y) * if dimension == "Two" { 1.0 } else { of(x[k].0.z) }
            };
            let all: f64 = (0..x.len()).map(weight).sum();
            let mean = |of: &dyn Fn(usize) -> f64| (0..x.len()).map(|k| weight(k) * of(k)).sum::<f64>() / all;
            let (force, mass) = (column::<Force>(&sim, 0), column::<Mass>(&sim, 0));
            let before = column::<Density>(&sim, 0);
            let slope = mean(&|k| force[k].0.x * before[k].0 / mass[k].0);
            assert!((slope / -1000.0 - 1.0).abs() < 4e-3, "{precision} {dimension}: {slope} Pa/m");
            sim.step().expect("a step");
            let after = column::<Density>(&sim, 0);
            let divergence = mean(&|k| (before[k].0 / after[k].0).ln()) / sim.clock().dt;
            assert!((divergence / 0.3 - 1.0).abs() < 4e-3, "{precision} {dimension}: {divergence} 1/s");
        }
    }

    /// A turning square under pressure expands, over three changes of the factor.
    #[test]
    fn momenta_and_energy_are_kept_while_the_factor_changes() {
        let mut sim = double(
            r#"(dimension: Two, materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0)},
                bodies: [(name: "water", material: "water", spacing: 0.02, shape: Box(min: (0, 0), max: (0.4, 0.4)),
                    lattice: Relaxed(seed: 3, iterations: 20), formulation: Fluid(pressure: "1000"))],
                conditions: [InitialVelocity(on: Select(body: "water"), value: ("0.2 - 2*y", "2*x"))],
                time: (end: 1.0))"#,
        );
        sim.start().expect("a start");
        let factor = |sim: &Simulation| sim.resources().get::<FlowCloud>().pressure_factor;
        let momenta = |sim: &Simulation| {
            let (m, v) = (column::<Mass>(sim, 0), column::<Velocity>(sim, 0));
            let x = column::<Position>(sim, 0);
            let of = |k: usize| (m[k].0 * v[k].0, m[k].0 * x[k].0.cross(v[k].0));
            (0..m.len()).map(of).fold((DVec3::ZERO, DVec3::ZERO), |a, b| (a.0 + b.0, a.1 + b.1))
        };
        let (first, (linear, angular)) = (factor(&sim), momenta(&sim));
        while sim.clock().step < 100 {
            sim.step().expect("a step");
        }
        let (last, (now, turned)) = (factor(&sim), momenta(&sim));
        assert!(first > 1.005 && last != first, "{first} {last}");
        assert!((now - linear).length() < 1e-12 * linear.length(), "{linear} {now}");
        assert!((turned - angular).length() < 1e-12 * angular.length(), "{angular} {turned}");
        assert!(sim.ledger().relative_error().abs() < 1e-3, "{}", sim.ledger().relative_error());
    }
}
