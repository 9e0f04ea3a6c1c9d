//! Fields of the Cauchy stress of solids that carry the first Piola-Kirchhoff stress: sigma = P F^T / J.

use std::sync::Arc;

use super::field::Field;
use crate::linalg::{Eigen, Sym3};
use crate::world::{DeformationGradient, PiolaStress, Value};

/// Cauchy stress sigma, von Mises stress sqrt(3/2 s : s), pressure -tr(sigma) / 3, extreme principal
/// stresses.
pub(super) fn fields() -> Vec<Field> {
    vec![
        of_stress("stress", |sigma| sigma.to_matrix()).about("Cauchy stress, positive in tension"),
        of_stress("von_mises", |sigma| (1.5_f64).sqrt() * sigma.deviator().norm()).about("Von Mises stress"),
        of_stress("pressure", |sigma| -sigma.trace() / 3.0).about("Pressure, positive in compression"),
        of_stress("max_principal_stress", |sigma| Eigen::new(sigma).values.z)
            .about("Largest principal Cauchy stress"),
        of_stress("min_principal_stress", |sigma| Eigen::new(sigma).values.x)
            .about("Smallest principal Cauchy stress"),
    ]
}

/// Whether a field, or the one of which this is a component, is a function of the stress.
pub(crate) fn is_of_stress(name: &str) -> bool {
    let base = name.split('.').next().unwrap_or(name);
    fields().iter().any(|field| field.name() == base)
}

/// Cauchy stress of a deformation gradient and a first Piola-Kirchhoff stress, Pa.
pub(crate) fn cauchy((f, p): (&DeformationGradient, &PiolaStress)) -> Sym3 {
    Sym3::symmetric_part(p.0 * f.0.transpose()) * (1.0 / f.0.determinant())
}

fn of_stress<V: Value>(name: &str, f: impl Fn(&Sym3) -> V + Send + Sync + 'static) -> Field {
    let f = Arc::new(f);
    let of_row = Arc::clone(&f);
    Field::new::<(DeformationGradient, PiolaStress), V>(name, "Pa", move |row| of_row(&cauchy(row)))
        .with_stress(move |stress| f(stress))
}
