//! Fields that need the bonds: how far a neighbourhood is from deforming affinely, and how many neighbours there are.

use super::formulation::{PackedRows, TotalLagrangian};
use crate::plugin::{Formulation, SimBuilder};
use crate::record::{Field, FieldInput};
use crate::world::{Column, DeformationGradient, MissingColumn, Position, ReferencePosition};

/// Adds the fields.
pub(super) fn add(sim: &mut SimBuilder<'_>) {
    let needs = vec![DeformationGradient::NAME, Position::NAME, ReferencePosition::NAME];
    let error = Field::with_input("hourglass_error", "1", &[""], needs, hourglass_error);
    sim.add_field(error.only_for(TotalLagrangian::NAME));
    let neighbors = Field::with_input("neighbors", "1", &[""], Vec::new(), neighbors);
    sim.add_field(neighbors.only_for(TotalLagrangian::NAME));
}

/// Root mean square of |F_i X_ij - x_ij| / |X_ij| over the neighbours; zero for a particle without neighbours.
fn hourglass_error(input: &FieldInput<'_>, out: &mut Vec<f64>) -> Result<(), MissingColumn> {
    let (view, _) = input.world.body_view(input.body);
    let packed = input.resources.get::<PackedRows>();
    let gradient = view.read::<DeformationGradient>()?;
    let position = view.read::<Position>()?;
    let reference = view.read::<ReferencePosition>()?;
    let (position, reference) = (bytemuck::cast_slice(&position), bytemuck::cast_slice(&reference));
    out.extend(input.rows.clone().map(|i| {
        let (mut sum, mut count) = (0.0, 0_u32);
        for (j, _) in packed.bonds.row(i).filter(|(j, _)| packed.sites[*j].is_present()) {
            let bond = packed.images.pair(reference, i, j);
            let misfit = gradient[i].0 * bond - packed.images.pair(position, i, j);
            sum += misfit.length_squared() / bond.length_squared();
            count += 1;
        }
        (sum / f64::from(count.max(1))).sqrt()
    }));
    Ok(())
}

/// Number of neighbours in the reference configuration that have not been removed.
fn neighbors(input: &FieldInput<'_>, out: &mut Vec<f64>) -> Result<(), MissingColumn> {
    let packed = input.resources.get::<PackedRows>();
    let present = |(j, _): &(usize, f32)| packed.sites[*j].is_present();
    out.extend(input.rows.clone().map(|i| packed.bonds.row(i).filter(present).count() as f64));
    Ok(())
}
