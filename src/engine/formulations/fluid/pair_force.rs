//! Second pass over pairs: the force of pressure and viscosity.
//!
//! `f_i = -V_i sum_j V_j (p_i + p_j) w_ij x_ij + V_i sum_j V_j 2 mu_ij w_ij v_ij`, with the harmonic mean mu_ij of the two
//! viscosities. Swapping i and j turns the sign of every product. The friction is that of Morris, Fox, Zhu 1997, eq. 22, without their
//! softening r^2 / (r^2 + 0.01 h^2): a finite w_ij needs none, and it takes some 2 % from the viscosity.
//!
//! The part of the pressure force that a boundary's own pressure makes is kept apart: the energy of a boundary is not
//! that of a compressed fluid, so its work is booked by itself.

use glam::DVec3;

use super::cloud::{FlowCloud, Group, Role};
use super::record::{Four, Record, dot, padded, sums};
use crate::parallel::{Arithmetic, Lanes4, PlaneOrSolid, Split, for_each_block, run_hot_in};
use crate::world::Force;

/// Forces that are kept apart: viscous, and of the pressure of boundaries.
pub(super) const PARTS: usize = 2;

/// The pass over the particles of one group.
pub(super) struct PairForce<'a> {
    pub cloud: &'a FlowCloud,
    pub group: &'a Group,
    /// Whether the force is added to what is there already.
    pub adds: bool,
}

/// What the pass writes: the force, and [`PARTS`] parts of it for every particle.
pub(super) struct ForceRows<'a> {
    pub total: &'a mut [Force],
    pub parts: &'a mut [DVec3],
}

impl Split for ForceRows<'_> {
    fn rows(&self) -> usize {
        self.total.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (total, total_rest) = self.total.split_at_mut(at);
        let (parts, parts_rest) = self.parts.split_at_mut(PARTS * at);
        (Self { total, parts }, Self { total: total_rest, parts: parts_rest })
    }
}

impl PairForce<'_> {
    /// Writes the forces on all particles of the group, N.
    pub fn run(&self, rows: ForceRows<'_>) {
        for_each_block(rows, &mut Vec::new(), &|first, rows| {
            run_hot_in(self.cloud.plane, Rows { pass: self, first, rows });
        });
    }
}

struct Rows<'a> {
    pass: &'a PairForce<'a>,
    first: usize,
    rows: ForceRows<'a>,
}

impl PlaneOrSolid for Rows<'_> {
    #[inline(always)]
    fn run<A: Arithmetic, const D: usize>(self, a: A) {
        if self.pass.cloud.periods.any() { self.rows::<A, D, true>(a) } else { self.rows::<A, D, false>(a) }
    }
}

/// Sums over the neighbours of one particle in one group.
struct Sums<const D: usize> {
    /// sum V_j w x_ij.
    gradient: [Lanes4; D],
    /// sum V_j p_j w x_ij.
    pressure: [Lanes4; D],
    /// sum V_j 2 mu w v_ij.
    viscous: [Lanes4; D],
}

/// Twice the viscosity between two groups, Pa s.
#[inline(always)]
fn pair_viscosity(a: &Role, b: &Role) -> f64 {
    match (a, b) {
        (Role::Fluid(a), Role::Fluid(b)) => 2.0 * a.viscosity_with(b),
        (Role::Fluid(fluid), Role::Boundary(surface)) | (Role::Boundary(surface), Role::Fluid(fluid)) => {
            if surface.no_slip {
                2.0 * fluid.viscosity
            } else {
                0.0
            }
        }
        (Role::Boundary(_), Role::Boundary(_)) => 0.0,
    }
}

impl Rows<'_> {
    #[inline(always)]
    fn rows<A: Arithmetic, const D: usize, const P: bool>(self, a: A) {
        let PairForce { cloud, group, adds } = *self.pass;
        let ForceRows { total, parts } = self.rows;
        let own_is_fluid = group.fluid().is_some();
        for (k, total) in total.iter_mut().enumerate() {
            let i = group.cloud.start + self.first + k;
            let own = &cloud.records[i];
            let mut rest = if own_is_fluid {
                cloud.pairs.fluid.row(i)
            } else {
                cloud.pairs.boundary.row(i - cloud.fluid)
            };
            let (mut pressure, mut viscous, mut wall) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
            for other in &cloud.groups {
                let Some(&last) = rest.last() else { break };
                let end = other.cloud.end as u32;
                let count = if last < end { rest.len() } else { rest.partition_point(|&j| j < end) };
                let (row, tail) = rest.split_at(count);
                rest = tail;
                if row.is_empty() {
                    continue;
                }
                let viscosity = pair_viscosity(&group.role, &other.role);
                let sum = if viscosity > 0.0 {
                    self.pass.sum::<A, D, P, true>(a, i, own, row, viscosity)
                } else {
                    self.pass.sum::<A, D, P, false>(a, i, own, row, 0.0)
                };
                let of_i = sums(&sum.gradient) * own.pressure();
                let of_j = sums(&sum.pressure);
                match (own_is_fluid, other.fluid().is_some()) {
                    (true, true) => pressure += of_i + of_j,
                    (true, false) => {
                        pressure += of_i;
                        wall += of_j;
                    }
                    _ => {
                        pressure += of_j;
                        wall += of_i;
                    }
                }
                viscous += sums(&sum.viscous);
            }
            let volume = own.volume();
            let force = (viscous - pressure - wall) * volume;
            total.0 = if adds { total.0 + force } else { force };
            parts[PARTS * k] = viscous * volume;
            parts[PARTS * k + 1] = wall * -volume;
        }
    }
}

impl PairForce<'_> {
    #[inline(always)]
    fn sum<A: Arithmetic, const D: usize, const P: bool, const VISCOUS: bool>(
        &self,
        a: A,
        i: usize,
        own: &Record,
        row: &[u32],
        viscosity: f64,
    ) -> Sums<D> {
        let FlowCloud { records, kernel, periods, .. } = self.cloud;
        let zero = [Lanes4::ZERO; D];
        let mut sum = Sums { gradient: zero, pressure: zero, viscous: zero };
        for chunk in row.chunks(4) {
            let four = Four::<D>::gather::<A, P>(a, records, own, padded(chunk, i), periods);
            let square = dot(a, &four.x, &four.x);
            let weight = a.times(kernel.weights(a, a.sqrt(square)), four.volume);
            let pressure = a.times(weight, four.pressure);
            for axis in 0..D {
                sum.gradient[axis] = a.times_add(weight, four.x[axis], sum.gradient[axis]);
                sum.pressure[axis] = a.times_add(pressure, four.x[axis], sum.pressure[axis]);
            }
            if VISCOUS {
                let friction = a.scale(viscosity, weight);
                for axis in 0..D {
                    sum.viscous[axis] = a.times_add(friction, four.v[axis], sum.viscous[axis]);
                }
            }
        }
        sum
    }
}
