//! Friction around a particle, and how even its neighbours are.

use std::ops::Range;

use glam::DVec3;

use crate::correction::{add_moment, moment_of};
use crate::formulations::fluid::cloud::{FlowCloud, Group, NearPairs, RowPass, smallest_eigenvalue};
use crate::formulations::fluid::lanes::{Axial, pack_axial};
use crate::parallel::{Arithmetic, Vector};

/// Smallest eigenvalue of the moment matrix above which a particle is inside the fluid.
const INSIDE: f64 = 0.75;

/// Friction data of a particle inside of a fluid.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrictionOfParticle {
    /// Power of friction with its neighbours over twice its factor, W.
    pub power: f64,
    /// h |m_i|, of the first moment m_i of its neighbours.
    pub moment: f64,
    /// h |p_i m_i| over the stress of friction.
    pub order: f64,
}

/// [`FrictionOfParticle`] of the particles of a group; none near a surface.
pub struct FrictionOf<'a> {
    pub cloud: &'a FlowCloud,
    /// Viscosity of the group, Pa s, and those between it and all groups.
    pub viscosity: f64,
    pub viscosities: &'a [f64],
}

impl<'a> FrictionOf<'a> {
    pub fn new(cloud: &'a FlowCloud, group: &Group) -> Self {
        let viscosity = group.fluid().map_or(0.0, |state| state.viscosity);
        Self { cloud, viscosity, viscosities: cloud.viscosities.of(group) }
    }
}

impl RowPass<2, 5> for FrictionOf<'_> {
    type Output = Option<FrictionOfParticle>;

    fn among(&self) -> Range<usize> {
        self.cloud.everything()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 2] {
        let cloud = self.cloud;
        [cloud.records[row].velocity(), pack_axial(cloud.spins[row].xyz(), cloud.plane)]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own, spin]: &[Vector<A>; 2],
        [other, _]: &[Vector<A>; 2],
        [xx, yy, zz, first, power]: &mut [Vector<A>; 5],
    ) {
        let weight = near.volume * near.weight;
        add_moment([xx, yy, zz], weight, near.x_ij);
        *first = near.x_ij.mul_add(weight, *first);
        let sheared = *other - *own - Axial::of(*spin).turn(near.x_ij);
        let viscosity = self.viscosities[near.group];
        power.x = sheared.length_squared().mul_add(weight * viscosity, power.x);
    }

    fn output(&self, i: usize, &[xx, yy, zz, first, power]: &[DVec3; 5]) -> Option<FrictionOfParticle> {
        let cloud = self.cloud;
        let own = &cloud.records[i];
        let moment = moment_of([xx, yy, zz], cloud.plane);
        let is_inside = own.volume() > 0.0 && smallest_eigenvalue(moment.matrix(), cloud.plane) > INSIDE;
        let moment = cloud.kernel.smoothing_length() * first.length();
        let stress = (self.viscosity * power.x).sqrt();
        is_inside.then(|| FrictionOfParticle {
            power: own.volume() * power.x,
            moment,
            order: if stress > 0.0 { own.pressure().abs() * moment / stress } else { 0.0 },
        })
    }
}
