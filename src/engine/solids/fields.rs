//! Fields of solids that need the neighbours: the hourglass residual, and the number of neighbours.

use glam::{DMat3, DVec3};

use crate::correction::AffineFit;
use crate::fields::{Field, FieldInput};
use crate::plugin::BodyKind;
use crate::world::{
    Column, Damage, DeformationGradient, MissingColumn, Position, ReferencePosition, ReferenceVolume,
};

/// The fields.
pub(crate) fn fields() -> [Field; 2] {
    let needs = vec![DeformationGradient::NAME, Position::NAME, ReferencePosition::NAME];
    let error = Field::with_input("hourglass_residual", "1", &[""], needs, hourglass_residual);
    let error =
        error.about("Hourglass residual: root mean square deviation of the neighbours from an affine motion");
    let neighbors = Field::with_input("neighbors", "1", &[""], Vec::new(), neighbors);
    let neighbors = neighbors.about("Number of neighbours");
    [error, neighbors].map(|field| field.only_for(BodyKind::Solid))
}

/// Root mean square of |F_i X_ij - x_ij| / |X_ij| over the neighbours. At a crack it is that of the intact
/// neighbours, with the F fitted to these, as in the control; zero for a particle that has failed or has too
/// few neighbours.
pub(crate) fn hourglass_residual(input: &FieldInput<'_>, out: &mut Vec<f64>) -> Result<(), MissingColumn> {
    let (view, _) = input.world.body_view(input.body);
    let Some(solid) = input.resources.solid(input.world.body(input.body).phase) else { return Ok(()) };
    let gradient = view.read::<DeformationGradient>()?;
    let (position, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
    let volume = view.read::<ReferenceVolume>()?;
    let damage = view.read::<Damage>().ok();
    let (ghosts, dimension) = (solid.ghosts(), input.world.dimension().count());
    let holds = |row: usize| damage.as_ref().is_none_or(|damage| damage[ghosts.source(row)].0 < 1.0);
    let (position, reference) = (bytemuck::cast_slice(&position), bytemuck::cast_slice(&reference));
    let mut bonds = Vec::new();
    out.extend(input.rows.clone().map(|i| {
        if !holds(i) {
            return 0.0;
        }
        bonds.clear();
        let mut is_edge = false;
        solid.neighbors(i, &mut |j, weight| {
            if holds(j) {
                let weight = weight * volume[ghosts.source(j)].0;
                let (arm, change) = (ghosts.pair(reference, i, j), ghosts.pair(position, i, j));
                bonds.push(Bond { weight, arm, change });
            } else {
                is_edge = true;
            }
        });
        let fit = || {
            let mut fit = AffineFit::new(dimension);
            bonds.iter().for_each(|bond| fit.add(bond.weight, bond.arm, bond.change - bond.arm));
            Some(DMat3::IDENTITY + fit.gradient()?)
        };
        let f = if is_edge { fit() } else { Some(gradient[i].0) };
        let square =
            |f: DMat3, bond: &Bond| (f * bond.arm - bond.change).length_squared() / bond.arm.length_squared();
        let sum = f.map_or(0.0, |f| bonds.iter().map(|bond| square(f, bond)).sum::<f64>());
        (sum / bonds.len().max(1) as f64).sqrt()
    }));
    Ok(())
}

/// A bond of a particle: V_j w_ij, X_ij and x_ij, m.
struct Bond {
    weight: f64,
    arm: DVec3,
    change: DVec3,
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
