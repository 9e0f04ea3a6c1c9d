//! The fields that scenes may name.

use super::spawn::standard_columns;
use crate::fields::{Field, named};
use crate::plugin::Registry;
use crate::world::{
    ColumnSet, Damage, EquivalentStress, InternalEnergy, PlasticStrain, PlasticWork, Temperature,
    ViscousHeat, YieldStress,
};
use crate::{formulations, solids};

/// The fields that probes and recordings may ask for, as far as the bodies have them, by name; plugins may
/// add more.
pub fn fields(registry: &Registry) -> Vec<Field> {
    let mut columns = ColumnSet::default();
    standard_columns(&mut columns);
    registry.formulations().for_each(|entry| (entry.columns)(&mut columns));
    // Those of materials that flow, heat and fail.
    columns.add::<PlasticStrain>().add::<EquivalentStress>().add::<YieldStress>().add::<PlasticWork>();
    columns.add::<InternalEnergy>().add::<ViscousHeat>().add::<Temperature>().add::<Damage>();
    let mut fields = named(&columns);
    fields.extend(with_neighbours());
    fields.sort_by(|one, other| one.name().cmp(other.name()));
    fields.dedup_by(|one, other| one.name() == other.name());
    fields
}

/// Those that need neighbours. All scenes know them, so that the vorticity in a scene without fluid is a
/// field that its bodies lack, and not an unknown one.
pub(super) fn with_neighbours() -> impl Iterator<Item = Field> {
    solids::fields().into_iter().chain(formulations::fluid::fields())
}
