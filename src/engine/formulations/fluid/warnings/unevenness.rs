//! Rows and lattices that have broken up, and lattices that do not: friction between uneven particles is too
//! large, and particles in order yield like a solid.
//!
//! `m_i = sum_j V_j w_ij x_ij` over all neighbours is zero where particles are evenly spread. The criteria
//! are two means of it. In flows in which friction has dissipated more than the kinetic energy, they are also
//! weighted with the power of friction, so that the surroundings of a small body in a large tank count:
//!
//! - The root mean square of h |m_i|. In channels, cavities and vortices at Reynolds numbers of 50 to 1000 it
//!   is 0.042 to 0.054 once their rows have broken up, and then a channel has lost a tenth of its flux; with
//!   `particle_shifting` it is 0.013 to 0.015, and in flows that stay in rows below 0.005.
//! - The mean of h |p_i m_i| over the stress of friction `sqrt(mu P_i)`, with P_i the power per volume.
//!   Particles in a lattice under pressure resist shear as a solid does: a particle that has left its lattice
//!   site is pushed back. A disc that sinks between walls, five particles in radius, is too slow by about a
//!   third of this mean.
//!
//! A liquid at rest hums and settles, and the friction of that exceeds its kinetic energy too. It is no flow:
//! without bodies in it, and where gravity alone does work, friction counts from a share of the work that
//! gravity could do along the height of the liquid.

use super::friction::{FrictionOf, FrictionOfParticle};
use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud, Group, RowSums};
use crate::formulations::fluid::density::SHIFTING_ENERGY;
use crate::notation::quantity;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::schedule::{Account, AccountKind, GRAVITY, Ledger, Step};

/// Share of the particles that have to be inside: a flow with a free surface is left alone.
const CONFINED: f64 = 0.95;
/// Root mean square of the first moment times h that is worth a warning.
const UNEVEN: f64 = 0.03;
/// Stress of order over that of friction that is worth a warning.
const STIFF: f64 = 0.5;

/// Energy that friction has dissipated over the work that gravity could do along the height of the liquid,
/// below which a liquid that nothing moves is at rest: of 0.4 m of oil 7e-5 in two seconds from irregular
/// places, 2e-5 from a lattice.
const SHARE_OF_WEIGHT: f64 = 0.005;

/// Watches the particles of viscous flows without a free surface.
#[derive(Debug, Default)]
pub struct Unevenness {
    /// Whether the user has been warned of the unevenness and of the order of each group.
    pub told: Vec<[bool; 2]>,
    /// Work that gravity could do along the heights of all bodies, J.
    weight: f64,
}

impl Unevenness {
    /// Over the work that gravity could do, J.
    pub fn new(weight: f64) -> Self {
        Self { told: Vec::new(), weight }
    }

    /// Checks all fluids with friction.
    pub fn look(
        &mut self,
        cloud: &FlowCloud,
        scratch: &mut Vec<Option<FrictionOfParticle>>,
        step: &mut Step<'_>,
    ) {
        self.told.resize(cloud.groups.len(), [false; 2]);
        if !cloud.viscosities.is_viscous {
            return;
        }
        let friction = step.ledger.total_named(ACCOUNTS[0]);
        let flows = friction > SHARE_OF_WEIGHT * self.weight || is_driven(cloud, step.ledger);
        let is_slow = flows && friction > step.ledger.motion();
        for (group, told) in cloud.groups.iter().zip(&mut self.told) {
            // What shifts evens out.
            told[0] |= step.ledger.accounts().iter().any(|account| account.name == SHIFTING_ENERGY);
            if group.fluid().is_none() || *told == [true; 2] {
                continue;
            }
            scratch.clear();
            scratch.resize(group.cloud.len(), None);
            cloud.for_each_row(
                group.cloud.start,
                scratch,
                &mut RowSums::default(),
                &FrictionOf::new(cloud, group),
            );
            let Some(Means { plain, weighted, order }) = means(scratch) else { continue };
            let uneven = if is_slow { plain.max(weighted) } else { plain };
            let name = &step.world.body(group.body).name;
            let time = step.clock.time;
            if uneven > UNEVEN && !told[0] {
                told[0] = true;
                step.warnings.push(uneven_text(name, time, uneven));
            }
            if order > STIFF && is_slow && !told[1] {
                told[1] = true;
                step.warnings.push(stiff_text(name, time, order));
            }
        }
    }
}

/// Whether there are bodies that a fluid moves, or anything but gravity does work.
fn is_driven(cloud: &FlowCloud, ledger: &Ledger) -> bool {
    let is_free = |group: &Group| group.fluid().is_none() && !group.is_wall();
    let works = |account: &Account| {
        account.kind == AccountKind::Supplied && account.name != GRAVITY && account.total() != 0.0
    };
    cloud.groups.iter().any(is_free) || ledger.accounts().iter().any(works)
}

fn uneven_text(name: &str, time: f64, mean: f64) -> String {
    format!(
        "the particles of `{name}` have become uneven by {} (first moment times h {mean:.3}): friction between them is too large, a channel loses a tenth of its \
         flux; give it `plugins: [density_diffusion(), particle_shifting()]`, or start it with a pressure of some rho v^2",
        quantity(time, "s")
    )
}

fn stiff_text(name: &str, time: f64, ratio: f64) -> String {
    format!(
        "the particles of `{name}` resist as a solid does by {}: where they are sheared, pressure times unevenness is {ratio:.2} of the stress of friction, and a body \
         that they flow around is too slow by a third of that; take a smaller constant in `pressure`, `plugins: [density_diffusion(), particle_shifting()]`, or a wider `support`",
        quantity(time, "s")
    )
}

/// Means over the particles inside of a fluid.
struct Means {
    /// Root mean square of h |m_i|.
    plain: f64,
    /// The same with the power of friction as weights.
    weighted: f64,
    /// Mean stress of order over that of friction, with the same weights.
    order: f64,
}

/// Sums of the means.
#[derive(Clone, Copy, Default)]
struct UnevennessSums {
    count: f64,
    /// Of h |m_i|, squared.
    squares: f64,
    /// Power of friction, W.
    power: f64,
    /// Of these squares times the power, W.
    squares_by_power: f64,
    /// Of the stress of order over that of friction, times the power, W.
    order: f64,
}

impl UnevennessSums {
    fn of(row: &FrictionOfParticle) -> Self {
        let square = row.moment.powi(2);
        Self {
            count: 1.0,
            squares: square,
            power: row.power,
            squares_by_power: row.power * square,
            order: row.power * row.order,
        }
    }
}

impl BlockSum for UnevennessSums {
    fn add(&mut self, next: &Self) {
        self.count += next.count;
        self.squares += next.squares;
        self.power += next.power;
        self.squares_by_power += next.squares_by_power;
        self.order += next.order;
    }
}

/// The means; none for a flow with a free surface.
fn means(rows: &[Option<FrictionOfParticle>]) -> Option<Means> {
    let sums = sum_over_blocks(rows, &|_, rows: &[Option<FrictionOfParticle>]| {
        let mut sums = UnevennessSums::default();
        rows.iter().flatten().for_each(|row| sums.add(&UnevennessSums::of(row)));
        sums
    });
    let UnevennessSums { count, squares, power, squares_by_power, order } = sums;
    if count <= CONFINED * rows.len() as f64 {
        return None;
    }
    let plain = (squares / count).sqrt();
    if power <= 0.0 {
        return Some(Means { plain, weighted: 0.0, order: 0.0 });
    }
    Some(Means { plain, weighted: (squares_by_power / power).sqrt(), order: order / power })
}
