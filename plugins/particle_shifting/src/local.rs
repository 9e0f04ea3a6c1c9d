//! How the particles of a neighbourhood lie, and how fast they are sheared.

use meshless_engine::correction::FourMoments;
use meshless_engine::formulations::fluid::{FlowCloud, FourNear, RowPass, smallest_eigenvalue};
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::parallel::{FourLanes, Number, Vector};

/// Strength of the part that keeps close particles apart, with the fourth power of their kernel.
const CLOSE: f64 = 0.2;

/// The neighbourhood of a particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Local {
    /// Smallest eigenvalue lambda of the moment matrix `sum_j V_j w_ij x_ij (x) x_ij`: one inside, about a half at a free surface.
    pub lambda: f64,
    /// Volume of the particles in a neighbourhood over the room that they have, less one: `sum_j V_j W_ij - 1`, with the particle itself.
    pub excess: f64,
    /// First moment `S = sum_j V_j (1 + 0.2 (W_ij / W(dp))^4) w_ij x_ij`, 1/m: it points to where particles are crowded.
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

impl RowPass for Locals<'_> {
    type Output = Local;

    #[inline(always)]
    fn row<A: FourLanes>(&self, a: A, i: usize) -> Local {
        let cloud = self.cloud;
        let mut sums = Sums::new(a);
        for near in cloud.fours(a, i, &(0..cloud.fluid)) {
            sums.add(self, i, &near);
        }
        let mut toward_walls = Vector::zero(a);
        for near in cloud.fours(a, i, &(cloud.fluid..cloud.everything().end)) {
            sums.add(self, i, &near);
            toward_walls = near.x_ij.mul_add(near.volume * near.weight, toward_walls);
        }
        let own = cloud.volume(i) * cloud.kernel.value(0.0);
        Local {
            lambda: smallest_eigenvalue(sums.moment.sum().matrix(), A::AXES == 2),
            excess: own + sums.filled.sum() - 1.0,
            first_moment: sums.first_moment.sum(),
            toward_walls: if self.confined { DVec3::ZERO } else { toward_walls.sum() },
            strain_rate: strain_rate(sums.gradient.map(Vector::sum)),
        }
    }
}

/// Sums over neighbours.
struct Sums<A: FourLanes> {
    moment: FourMoments<A>,
    first_moment: Vector<A>,
    filled: Number<A>,
    gradient: [Vector<A>; 3],
}

impl<A: FourLanes> Sums<A> {
    #[inline(always)]
    fn new(a: A) -> Self {
        Self {
            moment: FourMoments::new(a),
            first_moment: Vector::zero(a),
            filled: Number::zero(a),
            gradient: [Vector::zero(a); 3],
        }
    }

    #[inline(always)]
    fn add(&mut self, pass: &Locals<'_>, i: usize, near: &FourNear<A>) {
        let records = pass.cloud.records();
        let own = records[i].velocity();
        let weight = near.volume * near.weight;
        let close = (near.kernel * pass.usual).squared().squared();
        self.moment.add(weight, near.x_ij);
        self.first_moment = near.x_ij.mul_add(weight * (1.0 + CLOSE * close), self.first_moment);
        self.filled += near.volume * near.kernel;
        let v_ij = near.vector(|j| records[j].velocity() - own);
        self.gradient[0] = near.x_ij.mul_add(weight * v_ij.x, self.gradient[0]);
        self.gradient[1] = near.x_ij.mul_add(weight * v_ij.y, self.gradient[1]);
        if A::AXES == 3 {
            self.gradient[2] = near.x_ij.mul_add(weight * v_ij.z, self.gradient[2]);
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
