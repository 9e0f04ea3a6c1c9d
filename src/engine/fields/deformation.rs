//! Fields of the deformation.

use super::field::Field;
use crate::linalg::{Eigen, Sym3};
use crate::world::DeformationGradient;

/// Volume ratio J = det F, and the extreme principal stretches: the square roots of the eigenvalues of F^T F.
pub(super) fn fields() -> Vec<Field> {
    vec![
        Field::new::<(DeformationGradient,), f64>("volume_ratio", "1", |(f,)| f.0.determinant())
            .about("Volume over that of the reference configuration, det F"),
        Field::new::<(DeformationGradient,), f64>("max_principal_stretch", "1", |(f,)| stretches(f).z)
            .about("Largest principal stretch"),
        Field::new::<(DeformationGradient,), f64>("min_principal_stretch", "1", |(f,)| stretches(f).x)
            .about("Smallest principal stretch"),
    ]
}

/// Principal stretches, ascending. Rounding can leave a square just below zero.
fn stretches(f: &DeformationGradient) -> glam::DVec3 {
    Eigen::new(&Sym3::gram(f.0)).values.max(glam::DVec3::ZERO).map(f64::sqrt)
}
