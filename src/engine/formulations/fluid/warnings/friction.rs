//! Friction around a particle, and how even its neighbours are.

use crate::correction::FourMoments;
use crate::formulations::fluid::cloud::{FlowCloud, Group, RowPass, smallest_eigenvalue};
use crate::formulations::fluid::lanes::Axial;
use crate::parallel::{FourLanes, Number, Vector};

/// Smallest eigenvalue of the moment matrix above which a particle is inside the fluid.
const INSIDE: f64 = 0.75;

/// What a particle inside of a fluid has to do with friction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Friction {
    /// Power of friction with its neighbours over twice its factor, W.
    pub power: f64,
    /// h |m_i|, of the first moment m_i of its neighbours.
    pub moment: f64,
    /// h |p_i m_i| over the stress of friction.
    pub order: f64,
}

/// [`Friction`] of a particle of a group; none near a surface.
pub struct FrictionOf<'a> {
    pub cloud: &'a FlowCloud,
    pub group: &'a Group,
}

impl RowPass for FrictionOf<'_> {
    type Output = Option<Friction>;

    #[inline(always)]
    fn row<A: FourLanes>(&self, a: A, i: usize) -> Option<Friction> {
        let Self { cloud, group } = *self;
        let own = &cloud.records[i];
        let (velocity, spin) = (Vector::splat(a, own.velocity()), Axial::splat(a, &cloud.spins[i]));
        let (mut moment, mut first) = (FourMoments::new(a), Vector::zero(a));
        let mut power = Number::zero(a);
        for (other, viscosity) in cloud.groups.iter().zip(cloud.viscosities.of(group)) {
            for near in cloud.fours(a, i, &other.cloud) {
                let weight = near.volume * near.weight;
                moment.add(weight, near.x_ij);
                first = near.x_ij.mul_add(weight, first);
                let v_ij = near.vector(|j| cloud.records[j].velocity()) - velocity;
                let sheared = v_ij - spin.turn(near.x_ij);
                power = sheared.length_squared().mul_add(weight * *viscosity, power);
            }
        }
        let is_inside =
            own.volume() > 0.0 && smallest_eigenvalue(moment.sum().matrix(), A::AXES == 2) > INSIDE;
        let viscosity = group.fluid().map_or(0.0, |state| state.viscosity);
        let moment = cloud.kernel.smoothing_length() * first.sum().length();
        let stress = (viscosity * power.sum()).sqrt();
        is_inside.then(|| Friction {
            power: own.volume() * power.sum(),
            moment,
            order: if stress > 0.0 { own.pressure().abs() * moment / stress } else { 0.0 },
        })
    }
}
