//! Rotation without torque: a product of rotations about the principal axes.
//!
//! The kinetic energy `sum_a l_a^2 / (2 I_a)` is split by axes; each part rotates the body about one of its
//! axes by `dt l_a / I_a` and conserves the angular momentum in space (Dullweber, Leimkuhler and McLachlan,
//! J. Chem. Phys. 107 (1997) 5840-5851). The product is symmetric in time and symplectic, like the drift of
//! the leapfrog that it replaces.

use glam::{DMat3, DQuat, DVec3};

use crate::linalg::{Eigen, Sym3};

/// Principal moments of inertia and their axes.
#[derive(Clone, Copy, Debug)]
pub struct Inertia {
    /// Principal moments, kg m2.
    pub moments: DVec3,
    /// Turns the principal axes into the axes of the reference configuration.
    pub frame: DQuat,
}

impl Inertia {
    /// From the tensor in the reference configuration, kg m2.
    pub fn new(tensor: &Sym3) -> Self {
        let Eigen { values, vectors } = Eigen::new(tensor);
        // The axes must be right-handed.
        let first = vectors.x_axis * vectors.determinant().signum();
        let frame = DQuat::from_mat3(&DMat3::from_cols(first, vectors.y_axis, vectors.z_axis)).normalize();
        Self { moments: values, frame }
    }

    /// Angular velocity of a body that is turned by `rotation`, 1/s, from its angular momentum, kg m2/s.
    pub fn angular_velocity(&self, rotation: DQuat, momentum: DVec3) -> DVec3 {
        let axes = rotation * self.frame;
        axes * ((axes.inverse() * momentum) / self.moments)
    }

    /// Angular momentum, kg m2/s, from the angular velocity, 1/s.
    pub fn angular_momentum(&self, rotation: DQuat, velocity: DVec3) -> DVec3 {
        let axes = rotation * self.frame;
        axes * ((axes.inverse() * velocity) * self.moments)
    }

    /// Where the body has turned to after `dt`, s, with a constant angular momentum, kg m2/s.
    pub fn turn(&self, rotation: DQuat, momentum: DVec3, dt: f64) -> DQuat {
        let mut axes = rotation * self.frame;
        for (axis, share) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
            let own = axes.inverse() * momentum;
            let angle = share * dt * own[axis] / self.moments[axis];
            axes *= DQuat::from_axis_angle(DVec3::AXES[axis], angle);
        }
        (axes * self.frame.inverse()).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TENSOR: Sym3 = Sym3 { xx: 1.0, yy: 2.0, zz: 2.6, xy: 0.2, xz: -0.1, yz: 0.15 };

    #[test]
    fn the_energy_of_a_free_rotation_is_kept_over_many_turns() {
        let inertia = Inertia::new(&TENSOR);
        let momentum = DVec3::new(1.0, -2.0, 0.7);
        let energy = |q: DQuat| 0.5 * momentum.dot(inertia.angular_velocity(q, momentum));
        let start = energy(DQuat::IDENTITY);
        let mut q = DQuat::IDENTITY;
        let mut worst = 0.0f64;
        for _ in 0..50_000 {
            q = inertia.turn(q, momentum, 0.02);
            worst = worst.max((energy(q) / start - 1.0).abs());
        }
        assert!(worst < 2e-4 && (energy(q) / start - 1.0).abs() < 2e-4, "{worst}");
    }

    #[test]
    fn the_error_of_the_rotation_falls_with_the_square_of_the_step() {
        let inertia = Inertia::new(&TENSOR);
        let momentum = DVec3::new(1.0, -2.0, 0.7);
        let after = |steps: u32| {
            let turn = |q, _| inertia.turn(q, momentum, 2.0 / f64::from(steps));
            (0..steps).fold(DQuat::IDENTITY, turn)
        };
        let exact = after(4096);
        let error = |steps| after(steps).angle_between(exact);
        let ratio = error(32) / error(64);
        assert!((3.8..4.2).contains(&ratio), "{ratio}");
    }

    #[test]
    fn a_rotation_about_a_principal_axis_is_exact() {
        let inertia = Inertia::new(&Sym3::from_diagonal(DVec3::new(3.0, 1.0, 2.0)));
        let q = inertia.turn(DQuat::IDENTITY, DVec3::new(0.0, 0.0, 4.0), 0.3);
        assert!((q * DVec3::X).distance(DVec3::new(0.6f64.cos(), 0.6f64.sin(), 0.0)) < 1e-15);
        let back = inertia.angular_momentum(q, inertia.angular_velocity(q, DVec3::new(1.0, 2.0, 3.0)));
        assert!(back.distance(DVec3::new(1.0, 2.0, 3.0)) < 1e-14);
    }
}
