//! The energy that damage releases, in the energy balance.

use meshless_engine::parallel::{BlockSum, for_each_block};
use meshless_engine::plugin::SimBuilder;
use meshless_engine::schedule::{AccountKind, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodyId, ReferenceVolume};

use crate::FractureEnergy;

/// Adds the system that books the energy of the bodies.
pub(crate) fn add_system(sim: &mut SimBuilder<'_>, bodies: Vec<BodyId>) {
    let booking = Booking { bodies, sums: Vec::new() };
    sim.add_system(
        System::new(Stage::PostStep, "fracture_energy", booking)
            .reads::<FractureEnergy>()
            .reads::<ReferenceVolume>(),
    );
}

struct Booking {
    bodies: Vec<BodyId>,
    sums: Vec<Joule>,
}

#[derive(Clone, Copy, Default)]
struct Joule(f64);

impl BlockSum for Joule {
    fn add(&mut self, next: &Self) {
        self.0 += next.0;
    }
}

impl Run for Booking {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let account = step.ledger.account("fracture", AccountKind::Dissipated);
        for &id in &self.bodies {
            let (view, rows) = step.world.body_view(id);
            let density = view.read::<FractureEnergy>()?;
            let volume = view.read::<ReferenceVolume>()?;
            let both = (&density[rows.clone()], &volume[rows]);
            type Rows<'a> = (&'a [FractureEnergy], &'a [ReferenceVolume]);
            let sum = for_each_block(both, &mut self.sums, &|_, (density, volume): Rows<'_>| {
                Joule(density.iter().zip(volume).map(|(density, volume)| density.0 * volume.0).sum())
            });
            step.ledger.set(account, id, sum.0);
        }
        Ok(())
    }
}
