//! The arrangement of the particles of a neighbourhood, and its shear rate.

use std::ops::Range;

use meshless_engine::correction::{add_gradient, add_moment, moment_of};
use meshless_engine::formulations::fluid::{FlowCloud, NearPairs, RowPass, smallest_eigenvalue};
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::parallel::{Arithmetic, Vector};

/// Strength of the part that keeps close particles apart, with the fourth power of their kernel.
const CLOSE: f64 = 0.2;
/// Least kernel over that at the spacing: one plus its fourth power is one. Smaller powers would be denormal
/// numbers, which take some processors a hundred cycles each.
const FAR: f64 = 1e-5;

/// The neighbourhood of a particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Local {
    /// Smallest eigenvalue lambda of the moment matrix `sum_j V_j w_ij x_ij (x) x_ij`: one inside, about a
    /// half at a free surface.
    pub lambda: f64,
    /// Volume of the particles in a neighbourhood over the space that they have, less one: `sum_j V_j W_ij -
    /// 1`, with the particle itself.
    pub excess: f64,
    /// First moment `S = sum_j V_j (1 + 0.2 (W_ij / W(dp))^4) w_ij x_ij`, 1/m: it points to where particles
    /// are crowded.
    pub first_moment: DVec3,
    /// The part of `sum_j V_j w_ij x_ij` that walls and bodies contribute, 1/m; zero in confined flows.
    pub toward_walls: DVec3,
    /// Strain rate sqrt(2 D : D), 1/s.
    pub strain_rate: f64,
}

/// The pass that computes them.
pub struct Locals<'a> {
    cloud: &'a FlowCloud,
    /// One over the kernel at the spacing.
    usual: f64,
    confined: bool,
}

impl<'a> Locals<'a> {
    /// The pass over particles of that spacing, m.
    pub fn new(cloud: &'a FlowCloud, spacing: f64) -> Self {
        Self { cloud, usual: 1.0 / cloud.kernel.value(spacing), confined: cloud.is_confined() }
    }
}

impl RowPass<1, 9> for Locals<'_> {
    type Output = Local;

    fn among(&self) -> Range<usize> {
        self.cloud.everything()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [self.cloud.records()[row].velocity()]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [xx, yy, zz, first_moment, toward_walls, along_x, along_y, along_z, filled]: &mut [Vector<A>; 9],
    ) {
        let weight = near.volume * near.weight;
        let close = (near.kernel * self.usual).max(FAR).squared().squared();
        add_moment([xx, yy, zz], weight, near.x_ij);
        *first_moment = near.x_ij.mul_add(weight * (1.0 + CLOSE * close), *first_moment);
        filled.x += near.volume * near.kernel;
        add_gradient([along_x, along_y, along_z], weight, near.x_ij, *other - *own);
        if !near.is_fluid {
            *toward_walls = near.x_ij.mul_add(weight, *toward_walls);
        }
    }

    #[inline(always)]
    fn output(
        &self,
        i: usize,
        &[xx, yy, zz, first_moment, toward_walls, along_x, along_y, along_z, filled]: &[DVec3; 9],
    ) -> Local {
        let (cloud, plane) = (self.cloud, self.cloud.plane());
        Local {
            lambda: smallest_eigenvalue(moment_of([xx, yy, zz], plane).matrix(), plane),
            excess: cloud.volume(i) * cloud.kernel.value(0.0) + filled.x - 1.0,
            first_moment,
            toward_walls: if self.confined { DVec3::ZERO } else { toward_walls },
            strain_rate: strain_rate([along_x, along_y, along_z]),
        }
    }
}

/// Strain rate sqrt(2 D : D) of a velocity gradient with these rows, 1/s.
#[inline(always)]
fn strain_rate([x, y, z]: [DVec3; 3]) -> f64 {
    let gradient = DMat3::from_cols(x, y, z);
    let twice = gradient + gradient.transpose();
    let square =
        twice.x_axis.length_squared() + twice.y_axis.length_squared() + twice.z_axis.length_squared();
    (0.5 * square).sqrt()
}
