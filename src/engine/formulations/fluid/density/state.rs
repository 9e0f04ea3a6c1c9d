//! Pressure of fluids by their equation of state, and the energy of their compression.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::mach::{Mach, relative_speed, wall_frame};
use crate::formulations::fluid::cloud::{FlowCloud, FluidState, Group};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::formulations::fluid::lists::blocks::Packed;
use crate::parallel::{BlockSum, FourLanes, HotLoop, for_each_own_block, run_hot};
use crate::schedule::{AccountKind, Run, Step, StepError};
use crate::world::{Density, Mass, Pressure, Removed};

/// Stable step in units of h / (c_0 + v). A tank at rest is stable up to 1.6, and grows at once at 1.8; the
/// energy of impacts asks for less.
const COURANT: f64 = 0.4;
/// Stable step of a light fluid beside a stiff one in units of h / sqrt(K / rho), with the largest bulk
/// modulus K of all fluids: the pressure of the stiff one moves the mass of the light one. Water below air of
/// a thousandth of its density is stable at 3.5 and not at 11.
const INTERFACE: f64 = 1.7;
/// Stable step in units of rho h^2 / mu, over the factor of friction. Eigenvalues of friction are up to 3.3
/// (a lattice) and 4.4 (irregular particles) of that factor times nu / h^2; explicit steps of friction stand
/// two over the largest.
const VISCOUS: f64 = 0.32;

/// Sets pressure and volume from the density.
pub struct ApplyState {
    /// Acceleration of gravity along the axes that are not periodic, m/s2.
    pub gravity: DVec3,
    /// Largest Mach numbers of the bodies that the user has been warned of.
    pub mach: Vec<Mach>,
    pub sums: Vec<StateSum>,
}

/// Sums over a block.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct StateSum {
    /// Energy of compression, J.
    energy: f64,
    /// Largest squared speed against the frame of the walls, m2/s2.
    speed_squared: f64,
}

impl BlockSum for StateSum {
    fn add(&mut self, next: &Self) {
        self.energy += next.energy;
        self.speed_squared = self.speed_squared.max(next.speed_squared);
    }
}

type Rows<'a> = (&'a mut [Pressure], &'a mut [FlowParticle], &'a [Density], &'a [Mass], &'a [Removed]);
/// With what blocks know of the same particles, if there are any.
type RowsAndPacked<'a> = (Rows<'a>, Option<&'a mut [Packed]>);

impl Run for ApplyState {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let FlowCloud { groups, records, kernel, pressure_factor, viscosities, blocks, .. } = &mut *cloud;
        let h = kernel.smoothing_length();
        let viscous = VISCOUS / viscosities.factor() * h * h;
        let factor = *pressure_factor;
        let account = step.ledger.account("compression", AccountKind::Stored);
        self.mach.resize(groups.len(), Mach::default());
        let fluids = groups.iter().filter_map(Group::fluid);
        let stiffest = fluids.map(FluidState::bulk_modulus).fold(0.0, f64::max);
        let frame = wall_frame(groups, records);
        for (group, mach) in groups.iter().zip(&mut self.mach) {
            let Some(state) = group.fluid() else { break };
            let view = step.world.phase(group.phase);
            let (density, mass) = (view.read_own::<Density>()?, view.read_own::<Mass>()?);
            let removed = view.read_own::<Removed>()?;
            let mut pressure = view.write_own::<Pressure>()?;
            let rows = group.rows.clone();
            let slices: Rows<'_> = (
                &mut pressure[rows.clone()],
                &mut records[group.cloud.clone()],
                &density[rows.clone()],
                &mass[rows.clone()],
                &removed[rows],
            );
            let packed = blocks.as_mut().map(|blocks| &mut blocks.packed[group.cloud.clone()]);
            let sum = for_each_own_block((slices, packed), &mut self.sums, &|_, rows: RowsAndPacked<'_>| {
                run_hot(Apply { state, factor, frame, rows: rows.0, packed: rows.1 })
            });
            step.ledger.set(account, group.body, sum.energy);
            let speed =
                relative_speed(sum.speed_squared.sqrt(), [frame, self.gravity], group, groups, records);
            let sound = state.sound_speed;
            let name = &step.world.body(group.body).name;
            mach.look(speed, state, name, step)?;
            step.limits.propose(COURANT * h / (sound + speed), format_args!("sound speed of `{name}`"));
            let limit = INTERFACE * h / (stiffest / state.density).sqrt();
            step.limits.propose(limit, format_args!("stiffer fluids beside `{name}`"));
            if state.viscosity > 0.0 {
                let limit = viscous * state.density / state.viscosity;
                step.limits.propose(limit, format_args!("viscosity of `{name}`"));
            }
        }
        cloud.share_states();
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        self.mach.iter().flat_map(|mach| mach.told.to_le_bytes()).collect()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let (told, rest) = state.as_chunks::<8>();
        self.mach = told.iter().map(|bytes| Mach { told: f64::from_le_bytes(*bytes) }).collect();
        rest.is_empty()
    }
}

/// The states of a block.
struct Apply<'a> {
    state: &'a FluidState,
    /// What multiplies pressures in sums over pairs.
    factor: f64,
    /// Velocity that speeds are measured against, m/s.
    frame: DVec3,
    rows: Rows<'a>,
    packed: Option<&'a mut [Packed]>,
}

impl HotLoop for Apply<'_> {
    type Output = StateSum;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> StateSum {
        let FluidState { density: rho_0, sound_speed, eos, .. } = *self.state;
        let (pressure, records, density, mass, removed) = self.rows;
        let mut sum = StateSum::default();
        let count = records.len();
        let (pressure, density) = (&mut pressure[..count], &density[..count]);
        let (mass, removed) = (&mass[..count], &removed[..count]);
        for (k, record) in records.iter_mut().enumerate() {
            let rho = density[k].0;
            let p = eos.pressure(rho, rho_0, sound_speed);
            pressure[k] = Pressure(p);
            // A removed particle has no volume: no sum over neighbours sees it.
            let volume = mass[k].0 / rho;
            record.place.0[3] = if removed[k] == Removed::NO { volume } else { 0.0 };
            let [x, y, z, _] = record.motion.0;
            let (x, y, z) = (x - self.frame.x, y - self.frame.y, z - self.frame.z);
            record.motion.0[3] = self.factor * p;
            sum.energy = a.scalar_mul_add(mass[k].0, eos.energy(rho, rho_0, sound_speed), sum.energy);
            let square = a.scalar_mul_add(x, x, a.scalar_mul_add(y, y, z * z));
            sum.speed_squared = if square > sum.speed_squared { square } else { sum.speed_squared };
        }
        if let Some(packed) = self.packed {
            packed.iter_mut().zip(&*records).for_each(|(packed, record)| packed.take_state(record));
        }
        sum
    }
}
