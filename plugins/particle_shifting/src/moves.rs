//! The displacements.

use meshless_engine::formulations::fluid::{FlowCloud, RowPass};
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::parallel::{Arithmetic, Largest, Vector, sum_over_blocks};
use meshless_engine::schedule::{Step, StepError};
use meshless_engine::world::{BodyId, Velocity};

use crate::surface::{self, Place};

/// Largest displacement of a step over the spacing.
const LARGEST: f64 = 0.05;
/// Strength of the part that keeps close particles apart, with the fourth power of their kernel.
const CLOSE: f64 = 0.2;
/// Speed of the shift over smoothing length and shear rate.
const SHEAR: f64 = 2.0;

/// Makes the displacements of a body for a strength; `lambda` and `places` are those of all fluid particles, and so are the displacements.
pub fn make(
    step: &Step<'_>,
    cloud: &FlowCloud,
    id: BodyId,
    (strength, lambda, places): (f64, &[f64], &[Place]),
    moves: &mut [DVec3],
) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(id);
    let spacing = step.world.body(id).spacing;
    let velocity = view.read::<Velocity>()?;
    let squared = sum_over_blocks(&velocity[rows.clone()], &|_, v: &[Velocity]| {
        Largest::of(v.iter().map(|v| v.0.length_squared()))
    });
    let h = cloud.kernel.smoothing_length();
    let pass = Moves {
        cloud,
        lambda,
        places,
        factor: -2.0 * strength * h * step.clock.dt,
        shear: SHEAR * h,
        fastest: squared.0.sqrt(),
        usual: 1.0 / cloud.kernel.value(spacing),
        largest: LARGEST * spacing,
    };
    cloud.for_each_row(rows.start, &mut moves[rows], &pass);
    Ok(())
}

/// The displacements of the particles of one body.
struct Moves<'a> {
    cloud: &'a FlowCloud,
    lambda: &'a [f64],
    places: &'a [Place],
    /// -2 s h dt, m s.
    factor: f64,
    /// Speed over shear rate, m.
    shear: f64,
    /// Largest speed of the body, m/s.
    fastest: f64,
    /// One over the kernel at the spacing.
    usual: f64,
    /// Largest displacement, m.
    largest: f64,
}

impl RowPass for Moves<'_> {
    type Output = DVec3;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> DVec3 {
        if self.places[i] == Place::AtSurface {
            return DVec3::ZERO;
        }
        let records = self.cloud.records();
        let own = records[i].velocity();
        let mut sum = Vector::zero(a);
        let mut rate = [Vector::zero(a); 3];
        for near in self.cloud.fours(a, i, &self.cloud.everything()) {
            let close = (near.kernel * self.usual).squared().squared();
            let weight = near.volume * near.weight;
            sum = near.x_ij.mul_add(weight * (1.0 + CLOSE * close), sum);
            let v_ij = near.vector(|j| records[j].velocity() - own);
            rate[0] = near.x_ij.mul_add(weight * v_ij.x, rate[0]);
            rate[1] = near.x_ij.mul_add(weight * v_ij.y, rate[1]);
            if A::AXES == 3 {
                rate[2] = near.x_ij.mul_add(weight * v_ij.z, rate[2]);
            }
        }
        let speed = (self.shear * shear_rate(rate.map(Vector::sum))).min(self.fastest);
        let mut shift = sum.sum() * (self.factor * speed);
        if self.places[i] == Place::Near {
            let normal = surface::normal(a, self.cloud, self.lambda, i);
            shift -= normal * normal.dot(shift);
        }
        shift.clamp_length_max(self.largest)
    }
}

/// Shear rate sqrt(2 D : D) of a velocity gradient with these rows, 1/s.
#[inline(always)]
fn shear_rate([x, y, z]: [DVec3; 3]) -> f64 {
    let gradient = DMat3::from_cols(x, y, z);
    let twice = gradient + gradient.transpose();
    let square =
        twice.x_axis.length_squared() + twice.y_axis.length_squared() + twice.z_axis.length_squared();
    (0.5 * square).sqrt()
}
