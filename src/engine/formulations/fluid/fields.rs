//! Fields that show a flow: vorticity, and where its free surface is.

use std::ops::Range;

use glam::DVec3;

use crate::correction::{MomentMatrix, add_gradient, add_moment, moment_of};
use crate::fields::Field;
use crate::formulations::fluid::cloud::{
    ArrangementPass, FlowCloud, Near, NearPairs, RowPass, RowSums, smallest_eigenvalue,
};
use crate::parallel::{Arithmetic, Vector};
use crate::plugin::BodyKind;
use crate::world::{Column, Value, Velocity};

/// Smallest eigenvalue of the moment matrix above which a particle is inside the fluid.
const INSIDE: f64 = 0.75;
/// Smallest eigenvalue below which a particle is part of a surface, a thread or a drop, whatever is around
/// it.
const ALONE: f64 = 0.2;

/// Vorticity and free surface of fluids.
pub(crate) fn fields() -> [Field; 2] {
    let needs = || vec![Velocity::NAME];
    let vorticity = Field::with_input("vorticity", "1/s", DVec3::COMPONENTS, needs(), |input, out| {
        let (view, _) = input.world.body_view(input.body);
        let velocity = view.read::<Velocity>()?;
        let Some(cloud) = FlowCloud::whole(input.resources) else { return Ok(()) };
        let mut rows = vec![DVec3::ZERO; input.rows.len()];
        let pass = Vorticity { cloud: &cloud, velocity: &velocity };
        cloud.for_each_row(input.rows.start, &mut rows, &mut RowSums::default(), &pass);
        out.extend(rows.iter().flat_map(DVec3::to_array));
        Ok(())
    });
    let surface = Field::with_input("free_surface", "1", f64::COMPONENTS, needs(), |input, out| {
        let Some(cloud) = FlowCloud::whole(input.resources) else { return Ok(()) };
        let cloud: &FlowCloud = &cloud;
        let mut rows = vec![0.0; input.rows.len()];
        let output = |i: usize, moment: &MomentMatrix, first: DVec3| free_surface(cloud, i, moment, first);
        let pass = ArrangementPass { cloud, output };
        cloud.for_each_row(input.rows.start, &mut rows, &mut RowSums::default(), &pass);
        out.extend(rows);
        Ok(())
    });
    let vorticity = vorticity.about("Vorticity of the flow");
    let surface = surface.about("1 at the free surface, 0 inside of the fluid");
    [vorticity, surface].map(|field| field.only_for(BodyKind::Fluid))
}

/// `omega_i = sum_j V_j w_ij (M_i^-1 x_ij) x v_ij` over the fluids alone: exact where the velocity is linear,
/// at walls and surfaces as well.
struct Vorticity<'a> {
    cloud: &'a FlowCloud,
    velocity: &'a [Velocity],
}

impl RowPass<1, 6> for Vorticity<'_> {
    type Output = DVec3;

    fn among(&self) -> Range<usize> {
        0..self.cloud.fluid
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [self.velocity[row].0]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [xx, yy, zz, along_x, along_y, along_z]: &mut [Vector<A>; 6],
    ) {
        let weight = near.volume * near.weight;
        add_moment([xx, yy, zz], weight, near.x_ij);
        add_gradient([along_x, along_y, along_z], weight, near.x_ij, *other - *own);
    }

    #[inline(always)]
    fn output(&self, _: usize, [xx, yy, zz, u, v, w]: &[DVec3; 6]) -> DVec3 {
        let Some(inverse) = moment_of([*xx, *yy, *zz], self.cloud.plane).inverse() else {
            return DVec3::ZERO;
        };
        let [u, v, w] = [u, v, w].map(|sum| inverse * *sum);
        DVec3::new(w.y - v.z, u.z - w.x, v.x - u.y)
    }
}

/// One at a free surface, zero inside, from the moment matrix and the first moment of particle `i`: a
/// neighbour in the mouth of a cone, or of an umbrella at its end, along the outward normal covers the
/// particle (Marrone et al., J. Comput. Phys. 229 (2010) 3652-3663, section 3).
fn free_surface(cloud: &FlowCloud, i: usize, moment: &MomentMatrix, first_moment: DVec3) -> f64 {
    let least = smallest_eigenvalue(moment.matrix(), cloud.plane);
    if !(ALONE..=INSIDE).contains(&least) {
        return f64::from(u8::from(least < ALONE));
    }
    let inward = moment.inverse().map_or(first_moment, |inverse| inverse * first_moment);
    let outward = -inward.normalize_or_zero();
    let h = cloud.kernel.smoothing_length();
    let covers = |near: &Near| {
        let height = near.x_ij.dot(outward);
        let aside = (near.x_ij - outward * height).length();
        near.volume > 0.0
            && if near.distance >= std::f64::consts::SQRT_2 * h {
                (near.x_ij - outward * h).length() < h
            } else {
                (height - h).abs() + aside < h
            }
    };
    let mut covered = false;
    cloud.for_each_neighbor(i, |near| covered |= covers(near));
    f64::from(u8::from(!covered))
}
