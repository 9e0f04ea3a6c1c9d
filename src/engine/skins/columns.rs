//! The columns that a skin reads of its particles.

use glam::{DMat3, DVec3};
use hecs::ArchetypeColumn;

use super::carriers::Carrier;
use super::scale::Scale;
use super::skin::Skin;
use crate::parallel::{FourLanes, HotLoop, run_hot};
use crate::plugin::Distances;
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
            position: view.read_near()?,
            velocity: view.read_near()?,
            mobility: view.read_near()?,
            removed: view.read_near()?,
            gradient: view.read_near()?,
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
        of: impl Fn(f64, &Carrier, usize) -> T,
    ) -> T {
        let scale = self.scale(vertex);
        let carriers = self.skin.carriers(vertex).iter();
        carriers.fold(zero, |sum, carrier| {
            let row = self.first_row + carrier.particle as usize;
            let share = scale.map_or(carrier.weight, |scale| scale.share(self.distance(carrier)));
            sum + of(share, carrier, row)
        })
    }

    /// Distance of a vertex from the middle of the cell of a carrier, as its kernel measures it, m.
    fn distance(&self, carrier: &Carrier) -> f64 {
        let arm = self.skin.arm_from_middle(carrier.particle, carrier.arm);
        let now = self.gradient[self.first_row + carrier.particle as usize].0 * arm;
        self.skin.distances.between(arm.length(), now.length())
    }

    /// Scale of the shares of a vertex, if they follow the deformation.
    pub(super) fn scale(&self, vertex: u32) -> Option<Scale> {
        let distances = self.skin.carriers(vertex).iter().map(|carrier| self.distance(carrier));
        self.skin.reach.map(|reach| Scale::of(distances, reach))
    }

    /// Where a particle or its image has a vertex that is at `arm` from it in the reference configuration, m;
    /// from the middle of its cell to the vertex, there and now, as the particle sees it, m.
    pub fn carried_by(&self, particle: u32, map: u32, arm: DVec3) -> (DVec3, [DVec3; 2]) {
        let row = self.first_row + particle as usize;
        let gradient = self.gradient[row].0;
        let middle = self.skin.arm_from_middle(particle, arm);
        let place = self.position[row].0 + gradient * arm;
        (self.skin.maps[map as usize].place(place), [middle, gradient * middle])
    }

    /// The distances from which shares follow.
    pub(super) fn distances(&self) -> Distances {
        self.skin.distances
    }

    /// A vector beside an image, as the particle sees it.
    pub fn back(&self, map: u32, vector: DVec3) -> DVec3 {
        self.skin.maps[map as usize].vector(vector)
    }

    /// Inverse mass of the layer of particles at a vertex under a traction along each axis, m2/kg (m/kg in
    /// two dimensions).
    pub fn mobility(&self, vertex: u32) -> DVec3 {
        self.mean(vertex, DVec3::ZERO, |share, carrier, row| {
            self.mobility[row].0 * (share * self.skin.layer[carrier.particle as usize])
        })
    }

    /// Where a vertex is, m, and whether none of its carriers has been removed.
    #[inline(always)]
    fn look<A: FourLanes>(&self, a: A, vertex: u32) -> (DVec3, bool) {
        if self.skin.reach.is_some() {
            return self.look_at_following(vertex);
        }
        // Two sums of each component: an addition waits for the one before it.
        let (mut x, mut y, mut z) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let mut is_there = true;
        for carrier in self.skin.carriers(vertex) {
            let row = self.first_row + carrier.particle as usize;
            is_there &= self.removed[row] == Removed::NO;
            let (weight, arm) = (carrier.weight, carrier.arm);
            if carrier.map != 0 {
                let place = self.carried(carrier, row);
                x[0] = a.scalar_mul_add(weight, place.x, x[0]);
                y[0] = a.scalar_mul_add(weight, place.y, y[0]);
                z[0] = a.scalar_mul_add(weight, place.z, z[0]);
                continue;
            }
            let (place, f) = (&self.position[row].0, &self.gradient[row].0);
            let (p, q, r) = (weight * arm.x, weight * arm.y, weight * arm.z);
            x[0] = a.scalar_mul_add(p, f.x_axis.x, a.scalar_mul_add(weight, place.x, x[0]));
            y[0] = a.scalar_mul_add(p, f.x_axis.y, a.scalar_mul_add(weight, place.y, y[0]));
            x[1] = a.scalar_mul_add(r, f.z_axis.x, a.scalar_mul_add(q, f.y_axis.x, x[1]));
            y[1] = a.scalar_mul_add(r, f.z_axis.y, a.scalar_mul_add(q, f.y_axis.y, y[1]));
            z[0] = a.scalar_mul_add(p, f.x_axis.z, a.scalar_mul_add(weight, place.z, z[0]));
            z[1] = a.scalar_mul_add(r, f.z_axis.z, a.scalar_mul_add(q, f.y_axis.z, z[1]));
        }
        (DVec3::new(x[0] + x[1], y[0] + y[1], z[0] + z[1]), is_there)
    }

    /// The same in a plane, where all components along z are zero.
    #[inline(always)]
    fn look_in_plane<A: FourLanes>(&self, a: A, vertex: u32) -> (DVec3, bool) {
        let (mut x, mut y) = ([0.0; 2], [0.0; 2]);
        let mut is_there = true;
        for carrier in self.skin.carriers(vertex) {
            let row = self.first_row + carrier.particle as usize;
            is_there &= self.removed[row] == Removed::NO;
            let (weight, arm) = (carrier.weight, carrier.arm);
            if carrier.map != 0 {
                let place = self.carried(carrier, row);
                x[0] = a.scalar_mul_add(weight, place.x, x[0]);
                y[0] = a.scalar_mul_add(weight, place.y, y[0]);
                continue;
            }
            let (place, f) = (&self.position[row].0, &self.gradient[row].0);
            let (p, q) = (weight * arm.x, weight * arm.y);
            x[0] = a.scalar_mul_add(p, f.x_axis.x, a.scalar_mul_add(weight, place.x, x[0]));
            y[0] = a.scalar_mul_add(p, f.x_axis.y, a.scalar_mul_add(weight, place.y, y[0]));
            x[1] = a.scalar_mul_add(q, f.y_axis.x, x[1]);
            y[1] = a.scalar_mul_add(q, f.y_axis.y, y[1]);
        }
        (DVec3::new(x[0] + x[1], y[0] + y[1], 0.0), is_there)
    }

    /// The same where the shares follow the deformation: those without a share need not be there.
    fn look_at_following(&self, vertex: u32) -> (DVec3, bool) {
        let VertexPosition(place, missing) =
            self.mean(vertex, VertexPosition::default(), |share, carrier, row| {
                let missing = share > 0.0 && self.removed[row] != Removed::NO;
                VertexPosition(share * self.carried(carrier, row), u32::from(missing))
            });
        (place, missing == 0)
    }

    /// Where the linear field of a carrier has a vertex, m.
    fn carried(&self, carrier: &Carrier, row: usize) -> DVec3 {
        self.skin.map(carrier).place(self.position[row].0 + self.gradient[row].0 * carrier.arm)
    }

    /// Calls `each` with the number of every vertex of a list, where it is, m, and whether none of its
    /// carriers has been removed.
    pub fn places(&self, vertices: &[u32], each: &mut impl FnMut(usize, DVec3, bool)) {
        run_hot(VertexPlaces { view: *self, vertices, each });
    }

    /// Mean velocity of the particles that carry a vertex, m/s.
    pub fn velocity(&self, vertex: u32) -> DVec3 {
        self.mean(vertex, DVec3::ZERO, |share, carrier, row| {
            share * self.skin.map(carrier).vector(self.velocity[row].0)
        })
    }

    /// Mean deformation gradient at a vertex.
    pub fn gradient(&self, vertex: u32) -> DMat3 {
        self.mean(vertex, DMat3::ZERO, |share, carrier, row| {
            let gradient = self.gradient[row].0;
            share * if carrier.map == 0 { gradient } else { self.skin.map(carrier).tensor(gradient) }
        })
    }
}

/// Where a vertex is, m, and how many of its carriers have been removed.
#[derive(Clone, Copy, Default)]
struct VertexPosition(DVec3, u32);

impl std::ops::Add for VertexPosition {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

/// The loop over the vertices of a list.
struct VertexPlaces<'a, E> {
    view: SkinView<'a>,
    vertices: &'a [u32],
    each: &'a mut E,
}

impl<E: FnMut(usize, DVec3, bool)> HotLoop for VertexPlaces<'_, E> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let skin = self.view.skin;
        let is_plane = skin.facets.axes == 2 && skin.reach.is_none();
        for (k, &vertex) in self.vertices.iter().enumerate() {
            let (place, is_there) =
                if is_plane { self.view.look_in_plane(a, vertex) } else { self.view.look(a, vertex) };
            (self.each)(k, place, is_there);
        }
    }
}
