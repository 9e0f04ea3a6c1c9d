//! The columns that a skin reads of its particles.

use glam::{DMat3, DVec3};
use hecs::ArchetypeColumn;

use super::carriers::Carrier;
use super::skin::Skin;
use crate::world::{DeformationGradient, MissingColumn, Mobility, Position, Removed, Velocity, World};

/// The columns of the particles of a body in this step.
pub(crate) struct SkinColumns<'a> {
    skin: &'a Skin,
    first_row: usize,
    position: ArchetypeColumn<'a, Position>,
    velocity: ArchetypeColumn<'a, Velocity>,
    mobility: ArchetypeColumn<'a, Mobility>,
    removed: ArchetypeColumn<'a, Removed>,
    gradient: ArchetypeColumn<'a, DeformationGradient>,
}

impl<'a> SkinColumns<'a> {
    /// Those of the body of a skin.
    pub fn new(skin: &'a Skin, world: &'a World) -> Result<Self, MissingColumn> {
        let (view, rows) = world.body_view(skin.body);
        Ok(Self {
            skin,
            first_row: rows.start,
            position: view.read()?,
            velocity: view.read()?,
            mobility: view.read()?,
            removed: view.read()?,
            gradient: view.read()?,
        })
    }

    /// The same, to be read by many.
    pub fn view(&self) -> SkinView<'_> {
        SkinView {
            skin: self.skin,
            first_row: self.first_row,
            position: &self.position,
            velocity: &self.velocity,
            mobility: &self.mobility,
            removed: &self.removed,
            gradient: &self.gradient,
        }
    }
}

/// The particles of a skin in this step.
#[derive(Clone, Copy)]
pub(crate) struct SkinView<'a> {
    skin: &'a Skin,
    first_row: usize,
    position: &'a [Position],
    velocity: &'a [Velocity],
    mobility: &'a [Mobility],
    removed: &'a [Removed],
    gradient: &'a [DeformationGradient],
}

impl SkinView<'_> {
    fn mean<T: std::ops::Add<Output = T>>(
        &self,
        vertex: u32,
        zero: T,
        of: impl Fn(&Carrier, usize) -> T,
    ) -> T {
        let carriers = self.skin.carriers(vertex).iter();
        carriers.fold(zero, |sum, carrier| sum + of(carrier, self.first_row + carrier.particle as usize))
    }

    /// Where a vertex is, m; how much a traction moves the layer of particles there along each axis, m2/kg (m/kg in two dimensions), if that is asked
    /// for; and whether none of its carriers has been removed.
    pub fn look(&self, vertex: u32, moving: bool) -> (DVec3, DVec3, bool) {
        let (mut place, mut mobility, mut is_there) = (DVec3::ZERO, DVec3::ZERO, true);
        for carrier in self.skin.carriers(vertex) {
            let row = self.first_row + carrier.particle as usize;
            place += carrier.weight * self.carried(carrier, row);
            is_there &= self.removed[row] == Removed::NO;
            if moving {
                mobility +=
                    self.mobility[row].0 * (carrier.weight * self.skin.layer[carrier.particle as usize]);
            }
        }
        (place, mobility, is_there)
    }

    /// Where the linear field of a carrier has a vertex, m.
    #[inline]
    fn carried(&self, carrier: &Carrier, row: usize) -> DVec3 {
        let place = self.position[row].0 + self.gradient[row].0 * carrier.arm;
        if carrier.map == 0 { place } else { self.skin.map(carrier).place(place) }
    }

    /// Where a vertex is, m.
    pub fn place(&self, vertex: u32) -> DVec3 {
        self.mean(vertex, DVec3::ZERO, |carrier, row| carrier.weight * self.carried(carrier, row))
    }

    /// Mean velocity of the particles that carry a vertex, m/s.
    pub fn velocity(&self, vertex: u32) -> DVec3 {
        self.mean(vertex, DVec3::ZERO, |carrier, row| {
            carrier.weight * self.skin.map(carrier).vector(self.velocity[row].0)
        })
    }

    /// Mean deformation gradient at a vertex.
    pub fn gradient(&self, vertex: u32) -> DMat3 {
        self.mean(vertex, DMat3::ZERO, |carrier, row| {
            let gradient = self.gradient[row].0;
            carrier.weight * if carrier.map == 0 { gradient } else { self.skin.map(carrier).tensor(gradient) }
        })
    }
}
