//! Bodies that are stretched spheres: ellipsoids, in two dimensions ellipses.

use glam::{DQuat, DVec3};

/// An ellipsoid about a place; in two dimensions an ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidEllipsoid {
    /// Rotation from the axes of space to its own.
    turn: DQuat,
    /// Half the lengths along its own axes, zero along the third one in two dimensions, m.
    semi_axes: DVec3,
}

impl RigidEllipsoid {
    /// One along the axes of space.
    pub(super) fn new(semi_axes: DVec3) -> Self {
        Self { turn: DQuat::IDENTITY, semi_axes }
    }

    /// The same, turned.
    pub fn turned(self, turn: DQuat) -> Self {
        Self { turn: turn * self.turn, ..self }
    }

    /// The same, `factor` times as large.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { semi_axes: factor * self.semi_axes, ..self }
    }

    /// Whether it is an ellipse.
    pub fn is_flat(&self) -> bool {
        self.semi_axes.z == 0.0
    }

    /// From the centre to a point of the surface: its direction on the sphere that was stretched.
    pub fn arm(&self, direction: DVec3) -> DVec3 {
        self.turn * (self.semi_axes * direction)
    }

    /// Direction on the sphere to the point that is deepest behind a plane of that outward normal.
    pub fn lowest(&self, normal: DVec3) -> DVec3 {
        -(self.semi_axes * (self.turn.inverse() * normal)).normalize_or_zero()
    }

    /// Whether a way from its centre ends on its surface, within a share of its lengths.
    pub(super) fn holds(&self, arm: DVec3, share: f64) -> bool {
        let own = self.turn.inverse() * arm;
        let lengths = self.semi_axes.to_array().into_iter().zip(own.to_array());
        let square: f64 = lengths.filter(|(a, _)| *a > 0.0).map(|(a, x)| (x / a).powi(2)).sum();
        (square - 1.0).abs() < 2.0 * share
    }

    /// Half of its smallest and of its largest length, m.
    pub fn extremes(&self) -> [f64; 2] {
        let lengths = || self.semi_axes.to_array().into_iter().filter(|a| *a > 0.0);
        [lengths().fold(f64::INFINITY, f64::min), lengths().fold(0.0, f64::max)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The support function of an ellipsoid is sqrt(sum (a_k n_k)^2).
    #[test]
    fn the_lowest_point_is_as_deep_as_the_support_function_says() {
        let a = DVec3::new(0.3, 0.2, 0.15);
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 0.7);
        let ellipsoid = RigidEllipsoid::new(a).turned(turn);
        for normal in [DVec3::Z, DVec3::new(1.0, 2.0, -3.0).normalize(), DVec3::X] {
            let arm = ellipsoid.arm(ellipsoid.lowest(normal));
            let support = (a * (turn.inverse() * normal)).length();
            assert!((arm.dot(normal) + support).abs() < 1e-14, "{normal}");
            assert!(ellipsoid.holds(arm, 1e-12) && !ellipsoid.holds(0.999 * arm, 1e-6));
        }
        assert_eq!(ellipsoid.extremes(), [0.15, 0.3]);
    }
}
