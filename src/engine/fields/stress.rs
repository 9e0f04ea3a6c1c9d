//! Fields of the Cauchy stress of solids that carry the first Piola-Kirchhoff stress: sigma = P F^T / J.

use glam::DMat3;

use super::field::Field;
use crate::linalg::{Eigen, Sym3};
use crate::world::{DeformationGradient, PiolaStress};

/// Cauchy stress sigma, von Mises stress sqrt(3/2 s : s), pressure -tr(sigma) / 3, extreme principal
/// stresses.
pub(super) fn fields() -> Vec<Field> {
    vec![
        Field::new::<(DeformationGradient, PiolaStress), DMat3>("stress", "Pa", |row| {
            cauchy(row).to_matrix()
        })
        .about("Cauchy stress, positive in tension"),
        scalar("von_mises", |sigma| (1.5_f64).sqrt() * sigma.deviator().norm()).about("Von Mises stress"),
        scalar("pressure", |sigma| -sigma.trace() / 3.0).about("Pressure, positive in compression"),
        scalar("max_principal_stress", |sigma| Eigen::new(sigma).values.z)
            .about("Largest principal Cauchy stress"),
        scalar("min_principal_stress", |sigma| Eigen::new(sigma).values.x)
            .about("Smallest principal Cauchy stress"),
    ]
}

fn scalar(name: &str, f: impl Fn(&Sym3) -> f64 + Send + Sync + 'static) -> Field {
    Field::new::<(DeformationGradient, PiolaStress), f64>(name, "Pa", move |row| f(&cauchy(row)))
}

fn cauchy((f, p): (&DeformationGradient, &PiolaStress)) -> Sym3 {
    Sym3::symmetric_part(p.0 * f.0.transpose()) * (1.0 / f.0.determinant())
}
