//! The linear motion of a few points, by its first moment.

use glam::{DMat3, DVec3};

use super::spin::rotation;
use crate::linalg::Sym3;

/// Share of the trace of the moment matrix that is added to its diagonal: points that nearly lie in a plane
/// or on a line determine across it only their rotation. A second step corrects the error for other motions,
/// of which the square of this share remains.
const FLAT: f64 = 0.01;

/// The matrix B with `B M = T`, for the moment matrix `M = sum m x (x) x` of some points and `T = sum m v (x)
/// x`: the gradient of their motion. A motion that turns is found as it is, and what turns in T is in `B M`
/// to round-off, however the points lie.
#[inline(always)]
pub fn affine(moment: &Sym3, first: DMat3, plane: bool) -> DMat3 {
    let trace = moment.trace();
    if trace <= 0.0 {
        return DMat3::ZERO;
    }
    let mass = moment.to_matrix();
    let turn = turning(rotation(moment, axial(&first), plane));
    let rest = first - turn * mass;
    let inverse = (*moment + Sym3::from_diagonal(DVec3::splat(FLAT * trace))).inverse().to_matrix();
    let stretch = rest * inverse;
    let stretch = stretch + (rest - stretch * mass) * inverse;
    let lost = rotation(moment, axial(&(rest - stretch * mass)), plane);
    turn + stretch + turning(lost)
}

/// `sum x x v` of `sum v (x) x`.
pub fn axial(first: &DMat3) -> DVec3 {
    let [x, y, z] = [first.x_axis, first.y_axis, first.z_axis];
    DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x)
}

/// The matrix of the vector product with a vector.
fn turning(spin: DVec3) -> DMat3 {
    DMat3::from_cols(spin.cross(DVec3::X), spin.cross(DVec3::Y), spin.cross(DVec3::Z))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(points: &[DVec3], motion: DMat3) -> (Sym3, DMat3) {
        let dyad = |v: DVec3, x: DVec3| DMat3::from_cols(v * x.x, v * x.y, v * x.z);
        let moment = points.iter().fold(Sym3::ZERO, |sum, &x| sum + Sym3::dyad(x));
        (moment, points.iter().fold(DMat3::ZERO, |sum, &x| sum + dyad(motion * x, x)))
    }

    #[test]
    fn the_motion_of_points_is_theirs_and_what_turns_is_kept_however_they_lie() {
        let spin = turning(DVec3::new(0.3, -1.2, 0.7));
        let shear = DMat3::from_cols(DVec3::new(0.1, 0.0, 0.0), DVec3::new(2.0, -0.2, 0.0), DVec3::Z);
        let corners = [-1.0, 1.0].map(|x| [-1.0, 1.0].map(|y| [-1.0, 1.0].map(|z| DVec3::new(x, y, z))));
        let cube = corners.as_flattened().as_flattened();
        let flat: Vec<DVec3> = cube.iter().map(|x| x.with_z(0.0)).collect();
        for points in [cube, &flat] {
            let (moment, first) = moments(points, spin);
            assert!((affine(&moment, first, false) - spin).abs_diff_eq(DMat3::ZERO, 1e-13));
            // Any moment: its couple is that of the forces.
            let map = affine(&moment, shear, false);
            assert!(axial(&(map * moment.to_matrix() - shear)).length() < 1e-13);
        }
        let (moment, first) = moments(cube, shear);
        assert!(
            (affine(&moment, first, false) - shear)
                .abs_diff_eq(DMat3::ZERO, 2.0 * (3.0 * FLAT) * (3.0 * FLAT))
        );
    }
}
