//! The density of fluids at the end of the step, by continuity.

use bytemuck::{Pod, Zeroable};

use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud, FluidState};
use crate::parallel::{BlockSum, FourLanes, HotLoop, for_each_own_block, run_hot};
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{AccountKind, Run, Step, StepError};
use crate::world::{BodySet, Density, DensityRate, Mass, Removed};

crate::column! {
    /// Change of the density of a fluid that is still to follow from displacements beside the flow, in the
    /// next step. Plugins add to it.
    pub struct DensityShift(f64) = "density_shift", "rho_s", "kg/m^3";
}

/// Account of the energy that shifting takes out of fluids, by their weight and by the density that follows.
pub const SHIFTING_ENERGY: &str = "particle_shifting";

/// Note of a plugin that displaces particles: the account of the energy that the density takes out of these
/// fluids as it follows. Of several plugins of a fluid it is that of the first.
pub struct DisplacementAccount {
    /// Fluids.
    pub bodies: BodySet,
    /// Name of the account.
    pub name: &'static str,
}

/// Moves the density by the rate of compression, and by what pair terms found at the end of the step before.
pub struct Continuity {
    /// Account of the energy that pair terms take out by changing the density; none where no term does.
    pub account: Option<String>,
    /// Accounts of the energy that displacements take out by changing the density.
    pub displacements: Vec<DisplacementAccount>,
    pub sums: Vec<Change>,
}

/// Sums over a block.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Change {
    /// Energy of compression that pair terms take out, J.
    dissipated: f64,
    /// Energy of compression that displacements take out, J.
    shifted: f64,
    /// Energy of compression that the pressure of boundaries answers for, taken out of the fluid, J.
    by_boundaries: f64,
    /// Energy of compression that leaves with removed particles, J.
    removed: f64,
    /// First row, counted from one, whose density is not above zero.
    broken: usize,
}

impl BlockSum for Change {
    fn add(&mut self, next: &Self) {
        self.dissipated += next.dissipated;
        self.shifted += next.shifted;
        self.by_boundaries += next.by_boundaries;
        self.removed += next.removed;
        if self.broken == 0 {
            self.broken = next.broken;
        }
    }
}

impl Run for Continuity {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let dt = step.clock.dt;
        if dt == 0.0 {
            return Ok(());
        }
        let cloud = step.resources.get::<FlowCloud>();
        let flow = 0.5 * dt * cloud.pressure_factor;
        let terms = if self.account.is_some() { 0.5 * dt } else { 0.0 };
        for group in &cloud.groups {
            let Some(state) = group.fluid() else { break };
            let view = step.world.phase(group.phase);
            let mut density = view.write_own::<Density>()?;
            let (rate, mass) = (view.read_own::<DensityRate>()?, view.read_own::<Mass>()?);
            let removed = view.read_own::<Removed>()?;
            let rows = group.rows.clone();
            let mut shift =
                if view.has::<DensityShift>() { Some(view.write_own::<DensityShift>()?) } else { None };
            let due = shift.as_ref().map(|shift| &shift[rows.clone()]);
            let of_boundaries = cloud.boundary_compression.get(group.cloud.clone());
            let slices = (
                &mut density[rows.clone()],
                &cloud.compression[group.cloud.clone()],
                &rate[rows.clone()],
                &mass[rows.clone()],
                &removed[rows],
            );
            let change = for_each_own_block(slices, &mut self.sums, &|first, rows: Rows<'_>| {
                run_hot(AdvanceDensity { state, flow, terms, shift: due, of_boundaries, first, rows })
            });
            if change.broken > 0 {
                return Err(step.unstable("the density must be positive", group.body, change.broken - 1));
            }
            if change.removed != 0.0 {
                let account = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
                step.ledger.add(account, group.body, change.removed);
            }
            let displaced = self.displacements.iter().find(|by| by.bodies.contains(group.body));
            if let (Some(shift), Some(by)) = (&mut shift, displaced) {
                shift[group.rows.clone()].fill(DensityShift(0.0));
                let account = step.ledger.account(by.name, AccountKind::Dissipated);
                step.ledger.add(account, group.body, change.shifted);
            }
            if of_boundaries.is_some() {
                let account = step.ledger.account(ACCOUNTS[1], AccountKind::Dissipated);
                step.ledger.add(account, group.body, change.by_boundaries);
            }
            if let Some(name) = &self.account {
                let account = step.ledger.account(name, AccountKind::Dissipated);
                step.ledger.add(account, group.body, change.dissipated);
            }
        }
        Ok(())
    }
}

type Rows<'a> = (&'a mut [Density], &'a [f64], &'a [DensityRate], &'a [Mass], &'a [Removed]);

/// The densities of a block.
struct AdvanceDensity<'a> {
    state: &'a FluidState,
    /// Half of the step, s: for rates of compression, times the factor of pressures, and for those of pair
    /// terms, zero without any.
    flow: f64,
    terms: f64,
    shift: Option<&'a [DensityShift]>,
    /// The part of the rate of compression that the pressure of boundaries answers for.
    of_boundaries: Option<&'a [f64]>,
    first: usize,
    rows: Rows<'a>,
}

impl HotLoop for AdvanceDensity<'_> {
    type Output = Change;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> Change {
        let Self { state, flow, terms, shift, of_boundaries, first, rows } = self;
        let (density, compression, rate, mass, removed) = rows;
        let (mut change, mut least, mut sum) = (Change::default(), f64::INFINITY, 0.0);
        let count = density.len();
        // All columns have equally many rows: slicing once removes the checks of bounds.
        let (compression, rate) = (&compression[..count], &rate[..count]);
        let (mass, removed) = (&mass[..count], &removed[..count]);
        for (k, rho) in density.iter_mut().enumerate() {
            if removed[k] != Removed::NO {
                change.removed += mass[k].0 * state.eos.energy(rho.0, state.density, state.sound_speed);
                rho.0 = state.density;
                continue;
            }
            // Half of what pair terms and displacements do comes before the flow and half after it: the flow
            // then compresses at the mean of the pressures of the two kicks, and the energy balance closes to
            // second order in the step.
            let by_terms = terms * rate[k].0;
            let shift = shift.map_or(0.0, |shift| 0.5 * shift[first + k].0);
            let half = -flow * compression[k];
            let before = rho.0 + by_terms + shift;
            let after = a.scalar_mul_add(before, half, before) / (1.0 - half);
            if shift != 0.0 {
                change.shifted += mass[k].0
                    * (state.released(before - shift, before) + state.released(after, after + shift));
            }
            if by_terms != 0.0 {
                let middle = after + shift;
                change.dissipated += mass[k].0
                    * (state.released(rho.0, before - shift) + state.released(middle, middle + by_terms));
            }
            let end = after + shift + by_terms;
            let of_boundaries = of_boundaries.map_or(0.0, |rates| rates[first + k]);
            if of_boundaries != 0.0 {
                // The mean of the pressures of the two kicks, which do the work.
                let volume = mass[k].0 / (before * after).sqrt();
                change.by_boundaries += state.mean_pressure(rho.0, end) * volume * of_boundaries * 2.0 * flow;
            }
            rho.0 = end;
            least = if rho.0 < least { rho.0 } else { least };
            sum += rho.0;
        }
        // What is no number does not show in the minimum.
        if !(least > 0.0 && sum.is_finite()) {
            let is_good = |rho: &Density| rho.0 > 0.0 && rho.0.is_finite();
            change.broken = density.iter().position(|rho| !is_good(rho)).map_or(0, |k| first + k + 1);
        }
        change
    }
}

impl FluidState {
    /// Mean of the pressures at two densities, Pa.
    #[inline(always)]
    fn mean_pressure(&self, from: f64, to: f64) -> f64 {
        let pressure = |rho| self.eos.pressure(rho, self.density, self.sound_speed);
        0.5 * (pressure(from) + pressure(to))
    }

    /// Energy of compression that is released from one density to another, J/kg.
    #[inline(always)]
    fn released(&self, from: f64, to: f64) -> f64 {
        -self.eos.energy_change(from, to, self.density, self.sound_speed)
    }
}
