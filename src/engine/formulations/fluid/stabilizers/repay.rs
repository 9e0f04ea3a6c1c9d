//! Friction that compensates energy: the energy that a stabilizer without a potential has supplied to a flow,
//! neighbours lose.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, NearPairs, RowPass, RowSums};
use crate::parallel::{Arithmetic, Vector, sum_over_blocks};
use crate::schedule::{AccountKind, Step, StepError};
use crate::world::{BodyId, Mass, Removed, Velocity};

/// Largest share of their relative velocities that neighbours lose in a step.
const MAX_LOSS: f64 = 0.05;

/// Pays back what an account of dissipation has given to a body, where it is below zero: `dv_i = s
/// rho_0/rho_i sum_j V_j W_ij (v_ij . x_ij) x_ij / r_ij^2` over the body, with s such that the energy is
/// paid, at most 0.05 in a step. Forces of pairs are opposite: momentum and angular momentum stay, and rigid
/// rotation has no such friction. The account is that of the stabilizer, so that it is no source of energy.
#[derive(Debug, Default)]
pub struct Repayment {
    rubs: Vec<UnitFriction>,
    sums: RowSums,
}

/// Friction of strength one.
#[derive(Clone, Copy, Debug, Default)]
struct UnitFriction {
    /// Impulse, kg m/s.
    impulse: DVec3,
    /// Energy that it takes, J.
    taken: f64,
}

impl Repayment {
    /// Pays; velocities of that step must not be needed any more.
    ///
    /// # Errors
    /// A column is missing.
    pub fn pay(
        &mut self,
        step: &mut Step<'_>,
        cloud: &FlowCloud,
        id: BodyId,
        account: &str,
    ) -> Result<(), StepError> {
        let own = step.ledger.accounts().iter().find(|known| known.name == account);
        let owed = -own.map_or(0.0, |own| own.of(id));
        if owed <= 0.0 {
            return Ok(());
        }
        let (view, rows) = step.world.body_view(id);
        self.rubs.resize(rows.len(), UnitFriction::default());
        let rest_density = cloud.state(id).map_or(0.0, |state| state.density);
        let pass = FrictionPass { cloud, rows: rows.clone(), rest_density };
        cloud.for_each_row(rows.start, &mut self.rubs, &mut self.sums, &pass);
        let mut velocity = view.write::<Velocity>()?;
        let (mass, removed) = (view.read::<Mass>()?, view.read::<Removed>()?);
        let taken = sum_over_blocks(&self.rubs[..], &|_, rubs: &[UnitFriction]| {
            rubs.iter().map(|rub| rub.taken).sum::<f64>()
        });
        if taken <= 0.0 {
            return Ok(());
        }
        let strength = (owed / taken).min(MAX_LOSS);
        let slices = (&mut velocity[rows.clone()], &self.rubs[..], &mass[rows.clone()], &removed[rows]);
        type Rows<'a> = (&'a mut [Velocity], &'a [UnitFriction], &'a [Mass], &'a [Removed]);
        let lost = sum_over_blocks(slices, &|_, (velocity, rubs, mass, removed): Rows<'_>| {
            let mut lost = 0.0;
            for k in (0..velocity.len()).filter(|&k| removed[k] == Removed::NO) {
                let (v, change) = (velocity[k].0, strength * rubs[k].impulse / mass[k].0);
                lost -= mass[k].0 * change.dot(v + 0.5 * change);
                velocity[k].0 = v + change;
            }
            lost
        });
        let account = step.ledger.account(account, AccountKind::Dissipated);
        step.ledger.add(account, id, lost);
        Ok(())
    }
}

/// The pass over the particles of a body.
struct FrictionPass<'a> {
    cloud: &'a FlowCloud,
    rows: Range<usize>,
    /// Density at zero pressure rho_0, kg/m3: masses of particles would make forces of pairs unequal.
    rest_density: f64,
}

impl RowPass<1, 2> for FrictionPass<'_> {
    type Output = UnitFriction;

    fn among(&self) -> Range<usize> {
        self.rows.clone()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [self.cloud.records[row].velocity()]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [velocity, taken]: &mut [Vector<A>; 2],
    ) {
        let parting = (*other - *own).dot(near.x_ij) / near.distance;
        let share = near.volume * near.kernel * parting;
        *velocity = near.x_ij.mul_add(share / near.distance, *velocity);
        taken.x += 0.5 * share * parting;
    }

    #[inline(always)]
    fn output(&self, i: usize, &[velocity, taken]: &[DVec3; 2]) -> UnitFriction {
        let mass = self.rest_density * self.cloud.volume(i);
        UnitFriction { impulse: mass * velocity, taken: mass * taken.x }
    }
}
