//! Data of every particle for the lists of a reference, packed for loops over pairs.

use glam::{DMat3, DVec3};

use crate::formulations::bonded::{Ellipsoid, FourSeen, OwnEllipsoid, SeenEllipsoid};
use crate::parallel::{FourLanes, Lanes4, Number, Vector, for_each_block};
use crate::symmetry::Ghosts;

/// All particles, and their ghosts. Loops over positions only read nothing else.
#[derive(Default)]
pub(super) struct SeenParticles {
    /// Place, m, and volume, m3. That of a ghost is without its shift, which is added to differences of
    /// places: seen from both ends of a bond, these are then the same to the last bit.
    pub places: Vec<Lanes4>,
    /// Shift of a ghost, m; empty where there is none.
    shifts: Vec<Lanes4>,
    ellipsoids: Vec<SeenEllipsoid>,
}

/// The columns of F_r.
pub(super) type Columns = [Lanes4; 3];

impl SeenParticles {
    /// Fills the rows of all particles at these places, m, with these volumes, m3, and support radii, m, and
    /// their ghosts.
    pub fn fill(
        &mut self,
        ghosts: &Ghosts,
        ellipsoids: &[Ellipsoid],
        support: &[f64],
        places: &[DVec3],
        volumes: &[f64],
    ) {
        let (count, all) = (places.len(), places.len() + ghosts.len());
        self.places.resize(all, Lanes4::ZERO);
        self.ellipsoids.resize(all, SeenEllipsoid::default());
        let seen = &mut self.ellipsoids[..count];
        for_each_block(seen, &mut Vec::new(), &|first, seen: &mut [SeenEllipsoid]| {
            for (own, row) in seen.iter_mut().zip(first..) {
                *own = SeenEllipsoid::of(&ellipsoids[row], support[row]);
            }
        });
        ghosts.fill(&mut self.ellipsoids, |ghost, own| own.image(ghost.map.signs));
        self.shifts.clear();
        if !ghosts.is_empty() {
            self.shifts.resize(all, Lanes4::ZERO);
            ghosts.fill(&mut self.shifts, |ghost, _| Lanes4::new(ghost.map.shift, 0.0));
        }
        self.place(ghosts, places, volumes);
    }

    /// Moves the particles to other places, m, and gives them other volumes, m3; their ellipsoids stay.
    pub fn place(&mut self, ghosts: &Ghosts, places: &[DVec3], volumes: &[f64]) {
        let seen = &mut self.places[..places.len()];
        for_each_block(seen, &mut Vec::new(), &|first, seen: &mut [Lanes4]| {
            for (own, row) in seen.iter_mut().zip(first..) {
                *own = Lanes4::new(places[row], volumes[row]);
            }
        });
        ghosts.fill(&mut self.places, |ghost, own| Lanes4::new(ghost.map.vector(own.xyz()), own.0[3]));
    }

    /// Whether there are ghosts.
    pub fn has_ghosts(&self) -> bool {
        !self.shifts.is_empty()
    }
}

/// Fills the columns of F_r of all particles, each times its `scale`, and of their ghosts.
pub(super) fn fill_columns(
    columns: &mut Vec<Columns>,
    ghosts: &Ghosts,
    gradient: &[DMat3],
    scale: impl Fn(usize) -> f64 + Sync,
) {
    let column = |column| Lanes4::new(column, 0.0);
    let of = |f: DMat3| [column(f.x_axis), column(f.y_axis), column(f.z_axis)];
    columns.resize(gradient.len() + ghosts.len(), [Lanes4::ZERO; 3]);
    for_each_block(&mut columns[..gradient.len()], &mut Vec::new(), &|first, columns: &mut [Columns]| {
        columns.iter_mut().zip(first..).for_each(|(own, row)| *own = of(gradient[row] * scale(row)));
    });
    ghosts.fill(columns, |ghost, _| of(ghost.map.tensor(gradient[ghost.source] * scale(ghost.source))));
}

/// A particle in every lane.
#[derive(Clone, Copy)]
pub(super) struct OwnParticle<A: FourLanes> {
    place: Vector<A>,
    ellipsoid: OwnEllipsoid<A>,
    columns: [Vector<A>; 3],
}

impl<A: FourLanes> OwnParticle<A> {
    /// That of a row.
    #[inline(always)]
    pub fn new(a: A, seen: &SeenParticles, row: usize) -> Self {
        Self {
            place: vector(a, seen.places[row]),
            ellipsoid: OwnEllipsoid::new(a, &seen.ellipsoids[row]),
            columns: [Vector::zero(a); 3],
        }
    }

    /// That of a row with its F_r.
    #[inline(always)]
    pub fn moving(a: A, seen: &SeenParticles, row: usize, [x, y, z]: &Columns) -> Self {
        Self { columns: [vector(a, *x), vector(a, *y), vector(a, *z)], ..Self::new(a, seen, row) }
    }

    /// Pair vectors to four others, m, with their volumes, m3; `GHOSTS` where there are ghosts among them.
    #[inline(always)]
    pub fn arms<const GHOSTS: bool>(
        &self,
        a: A,
        seen: &SeenParticles,
        [j, k, l, m]: [usize; 4],
    ) -> (Vector<A>, Number<A>) {
        let of = &seen.places[..];
        let [x, y, z, volume] = a.transpose([of[j], of[k], of[l], of[m]]);
        let arm = Vector::new(a, [x, y, z]) - self.place;
        if !GHOSTS {
            return (arm, Number::new(a, volume));
        }
        let of = &seen.shifts[..];
        let [x, y, z, _] = a.transpose([of[j], of[k], of[l], of[m]]);
        (arm + Vector::new(a, [x, y, z]), Number::new(a, volume))
    }

    /// Pair vectors as the mean of the F_r of both ends moves them, m.
    #[inline(always)]
    pub fn moved(&self, a: A, arm: Vector<A>, columns: &[Columns], [j, k, l, m]: [usize; 4]) -> Vector<A> {
        let of = [&columns[j], &columns[k], &columns[l], &columns[m]];
        let half = Number::splat(a, 0.5);
        let mut sum = Vector::zero(a);
        let along = [arm.x, arm.y, arm.z];
        for c in 0..A::AXES {
            let [x, y, z, _] = a.transpose([of[0][c], of[1][c], of[2][c], of[3][c]]);
            sum = (self.columns[c] + Vector::new(a, [x, y, z])).mul_add(along[c] * half, sum);
        }
        sum
    }

    /// Distances of pair vectors to four others by both metrics, m.
    #[inline(always)]
    pub fn measure(&self, a: A, r: Vector<A>, seen: &SeenParticles, [j, k, l, m]: [usize; 4]) -> FourSeen<A> {
        let of = &seen.ellipsoids[..];
        self.ellipsoid.measure(a, r, [&of[j], &of[k], &of[l], &of[m]])
    }
}

/// The first three lanes in all lanes of a vector.
#[inline(always)]
fn vector<A: FourLanes>(a: A, of: Lanes4) -> Vector<A> {
    Vector::splat(a, of.xyz())
}
