//! Fields of solids that need the neighbours: how far a neighbourhood is from deforming affinely, and how many neighbours there are.

use crate::fields::{Field, FieldInput};
use crate::plugin::{BodyKind, SimBuilder};
use crate::world::{Column, DeformationGradient, MissingColumn, Position, ReferencePosition};

/// Adds the fields.
pub(crate) fn add_fields(sim: &mut SimBuilder<'_>) {
    let needs = vec![DeformationGradient::NAME, Position::NAME, ReferencePosition::NAME];
    let error = Field::with_input("hourglass_error", "1", &[""], needs, hourglass_error);
    sim.add_field(error.only_for(BodyKind::Solid));
    let neighbors = Field::with_input("neighbors", "1", &[""], Vec::new(), neighbors);
    sim.add_field(neighbors.only_for(BodyKind::Solid));
}

/// Root mean square of |F_i X_ij - x_ij| / |X_ij| over the neighbours; zero for a particle without neighbours.
fn hourglass_error(input: &FieldInput<'_>, out: &mut Vec<f64>) -> Result<(), MissingColumn> {
    let (view, _) = input.world.body_view(input.body);
    let Some(solid) = input.resources.solid(input.world.body(input.body).phase) else { return Ok(()) };
    let gradient = view.read::<DeformationGradient>()?;
    let position = view.read::<Position>()?;
    let reference = view.read::<ReferencePosition>()?;
    let (position, reference) = (bytemuck::cast_slice(&position), bytemuck::cast_slice(&reference));
    out.extend(input.rows.clone().map(|i| {
        let (mut sum, mut count) = (0.0, 0_u32);
        solid.neighbors(i, &mut |j, _| {
            let bond = solid.ghosts().pair(reference, i, j);
            let misfit = gradient[i].0 * bond - solid.ghosts().pair(position, i, j);
            sum += misfit.length_squared() / bond.length_squared();
            count += 1;
        });
        (sum / f64::from(count.max(1))).sqrt()
    }));
    Ok(())
}

/// Number of neighbours that have not been removed.
fn neighbors(input: &FieldInput<'_>, out: &mut Vec<f64>) -> Result<(), MissingColumn> {
    let Some(solid) = input.resources.solid(input.world.body(input.body).phase) else { return Ok(()) };
    out.extend(input.rows.clone().map(|i| {
        let mut count = 0_u32;
        solid.neighbors(i, &mut |_, _| count += 1);
        f64::from(count)
    }));
    Ok(())
}
