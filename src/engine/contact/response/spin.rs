//! Sides that turn about the normal of their contact: a tangential spring turns with them.

use glam::{DMat3, DVec3};

/// Angular velocity of material with that velocity gradient, 1/s.
pub(in crate::contact) fn spin_of(gradient: DMat3) -> DVec3 {
    let [x, y, z] = [gradient.x_axis, gradient.y_axis, gradient.z_axis];
    0.5 * DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x)
}

/// The part of a vector across a normal, turned about it by an angle, rad.
pub(super) fn turned_about(normal: DVec3, angle: f64, vector: DVec3) -> DVec3 {
    let across = vector - vector.dot(normal) * normal;
    if angle == 0.0 {
        return across;
    }
    let (sine, cosine) = angle.sin_cos();
    cosine * across + sine * normal.cross(across)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spin_is_half_of_the_curl() {
        let spin = DVec3::new(0.3, -0.7, 1.1);
        let columns = DVec3::AXES.map(|axis| spin.cross(axis));
        let stretch = DMat3::from_diagonal(DVec3::new(0.2, -0.4, 0.5));
        let gradient = DMat3::from_cols(columns[0], columns[1], columns[2]) + stretch;
        assert!(spin_of(gradient).distance(spin) < 1e-15);
    }

    #[test]
    fn a_vector_turns_about_the_normal_and_keeps_its_length() {
        let (normal, vector) = (DVec3::Z, DVec3::new(2.0, 0.0, 5.0));
        let turned = turned_about(normal, std::f64::consts::FRAC_PI_2, vector);
        assert!(turned.distance(DVec3::new(0.0, 2.0, 0.0)) < 1e-15);
        assert_eq!(turned_about(normal, 0.0, vector), DVec3::new(2.0, 0.0, 0.0));
    }
}
