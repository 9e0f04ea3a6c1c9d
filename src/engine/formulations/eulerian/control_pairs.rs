//! The sums over the pairs of a particle for its hourglass control, four neighbours at once.

use glam::{DMat3, DVec3};

use super::control_rows::Carried;
use super::near::EulerianNeighbors;
use super::particle::EulerianParticle;
use super::within::{filled_up, records};
use crate::formulations::bonded::{OwnEllipsoid, SeenEllipsoid};
use crate::parallel::{FourLanes, Lanes4, Matrix, Number, Vector};

/// The pairs of a body.
pub(super) struct ControlPairs<'a> {
    /// Support radius, m.
    pub support: f64,
    pub offsets: &'a [usize],
    pub near: &'a EulerianNeighbors,
    pub points: &'a [EulerianParticle],
    /// Ellipsoids of all rows; empty where supports are spheres.
    pub ellipsoids: &'a [SeenEllipsoid],
    pub carried: &'a [Carried],
    /// Resistance to the error across a pair, over that to the error along it, for each Pa of the lesser
    /// modulus of the pair, 1/Pa.
    pub across: f64,
}

/// Sums over the pairs of a particle, without xi and its volume.
pub(super) struct ControlRowSums {
    /// dU/dx.
    pub force: DVec3,
    /// dU/dF.
    pub couple: DMat3,
    /// Half of the torque of the forces along normals of the ellipsoid, which come from the weights; a stress
    /// that turns with the ellipsoid balances it.
    pub turn: DVec3,
    pub stiffness: f64,
    /// Four times the energies, with the moduli of now and of the last step.
    pub energy: f64,
    pub energy_before: f64,
}

/// The particle itself, four times.
struct OwnControl<A: FourLanes> {
    place: Vector<A>,
    original: Vector<A>,
    deformation: Matrix<A>,
    modulus: f64,
    modulus_before: f64,
    ellipsoid: OwnEllipsoid<A>,
}

/// The sums so far.
struct ControlSums<A: FourLanes> {
    force: Vector<A>,
    couple: [Vector<A>; 3],
    /// Four times [`ControlRowSums::turn`].
    turn: [Number<A>; 3],
    stiffness: Number<A>,
    energy: Number<A>,
    energy_before: Number<A>,
}

/// Four neighbours.
struct FourOthers<A: FourLanes> {
    /// -x_ij.
    back: Vector<A>,
    /// X_ij.
    original: Vector<A>,
    /// F_i X_ij - x_ij.
    own_error: Vector<A>,
    /// F_j X_ij - x_ij.
    other_error: Vector<A>,
    /// Young's moduli now and before.
    modulus: Number<A>,
    before: Number<A>,
    volume: Number<A>,
}

/// The kernel at four neighbours.
struct FourKernel {
    /// Pair weight `w = -W' / r`.
    weight: Lanes4,
    /// Second derivative `W''`.
    curvature: [f32; 4],
}

impl ControlPairs<'_> {
    /// The sums of row `i`.
    #[inline(always)]
    pub fn of_row<A: FourLanes>(&self, a: A, i: usize) -> ControlRowSums {
        if self.ellipsoids.is_empty() { self.sums::<A, false>(a, i) } else { self.sums::<A, true>(a, i) }
    }

    #[inline(always)]
    fn sums<A: FourLanes, const STRETCHED: bool>(&self, a: A, i: usize) -> ControlRowSums {
        let own = self.own(a, i);
        let (zero, none) = (Vector::zero(a), Number::zero(a));
        let mut sums = ControlSums {
            force: zero,
            couple: [zero; 3],
            turn: [none; 3],
            stiffness: none,
            energy: none,
            energy_before: none,
        };
        let (neighbors, weights) = self.near.row(self.offsets[i], i);
        let curvatures = &self.near.curvatures[self.offsets[i]..self.offsets[i] + neighbors.len()];
        let (fours, rest) = neighbors.as_chunks::<4>();
        let (weight_fours, weight_rest) = weights.as_chunks::<4>();
        let (curvature_fours, curvature_rest) = curvatures.as_chunks::<4>();
        for n in 0..fours.len() {
            let kernel = FourKernel { weight: Lanes4(weight_fours[n]), curvature: curvature_fours[n] };
            self.add::<A, STRETCHED>(a, &own, &fours[n], kernel, &mut sums);
        }
        if !rest.is_empty() {
            // What fills the lanes that are left has no weight.
            let mut kernel = FourKernel { weight: Lanes4::ZERO, curvature: [0.0; 4] };
            for (lane, (weight, curvature)) in weight_rest.iter().zip(curvature_rest).enumerate() {
                kernel.weight.0[lane] = *weight;
                kernel.curvature[lane] = *curvature;
            }
            self.add::<A, STRETCHED>(a, &own, &filled_up(rest), kernel, &mut sums);
        }
        let force = total(a, sums.force, sums.stiffness);
        let [x, y, z] = sums.couple;
        let (x, y, z) = (total(a, x, sums.energy), total(a, y, sums.energy_before), total(a, z, none));
        let mut turn = DVec3::ZERO;
        if STRETCHED {
            let [along_x, along_y, along_z] = sums.turn;
            turn = total(a, Vector { x: along_x, y: along_y, z: along_z }, none).xyz() * 0.25;
        }
        ControlRowSums {
            force: force.xyz(),
            couple: DMat3::from_cols(x.xyz(), y.xyz(), z.xyz()),
            turn,
            stiffness: force.0[3],
            energy: x.0[3],
            energy_before: y.0[3],
        }
    }

    #[inline(always)]
    fn own<A: FourLanes>(&self, a: A, i: usize) -> OwnControl<A> {
        let Carried { columns: [x, y, z], original } = self.carried[i];
        let deformation = [Vector::splat(a, x.xyz()), Vector::splat(a, y.xyz()), Vector::splat(a, z.xyz())];
        OwnControl {
            place: Vector::splat(a, self.points[i].place.xyz()),
            original: Vector::splat(a, original.xyz()),
            deformation: Matrix(deformation),
            modulus: x.0[3],
            modulus_before: y.0[3],
            ellipsoid: OwnEllipsoid::new(a, &self.ellipsoids.get(i).copied().unwrap_or_default()),
        }
    }

    /// Reads four neighbours.
    #[inline(always)]
    fn four<A: FourLanes>(&self, a: A, own: &OwnControl<A>, four: &[u32; 4]) -> FourOthers<A> {
        let [j, k, l, m] = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
        let points = [&self.points[j], &self.points[k], &self.points[l], &self.points[m]];
        let of = [&self.carried[j], &self.carried[k], &self.carried[l], &self.carried[m]];
        let [x, y, z, _] = a.transpose([points[0].place, points[1].place, points[2].place, points[3].place]);
        let back = own.place - Vector::new(a, [x, y, z]);
        let [x, y, z, _] = a.transpose([of[0].original, of[1].original, of[2].original, of[3].original]);
        let original = Vector::new(a, [x, y, z]) - own.original;
        let [ax, ay, az, modulus] =
            a.transpose([of[0].columns[0], of[1].columns[0], of[2].columns[0], of[3].columns[0]]);
        let [bx, by, bz, before] =
            a.transpose([of[0].columns[1], of[1].columns[1], of[2].columns[1], of[3].columns[1]]);
        let [cx, cy, cz, volume] =
            a.transpose([of[0].columns[2], of[1].columns[2], of[2].columns[2], of[3].columns[2]]);
        let deformation = Matrix([
            Vector::new(a, [ax, ay, az]),
            Vector::new(a, [bx, by, bz]),
            Vector::new(a, [cx, cy, cz]),
        ]);
        FourOthers {
            back,
            original,
            own_error: own.deformation.mul_add(original, back),
            other_error: deformation.mul_add(original, back),
            modulus: Number::new(a, modulus),
            before: Number::new(a, before),
            volume: Number::new(a, volume),
        }
    }

    /// Adds four neighbours.
    #[inline(always)]
    fn add<A: FourLanes, const STRETCHED: bool>(
        &self,
        a: A,
        own: &OwnControl<A>,
        four: &[u32; 4],
        kernel: FourKernel,
        sums: &mut ControlSums<A>,
    ) {
        let FourOthers { back, original, own_error, other_error, modulus, before, volume } =
            self.four(a, own, four);
        let [p, q, r, s] = kernel.curvature;
        let curvature = Number::new(a, Lanes4([f64::from(p), f64::from(q), f64::from(r), f64::from(s)]));
        let weight = Number::new(a, kernel.weight);
        let square = back.length_squared().max(f64::MIN_POSITIVE);
        let over = 1.0 / square;
        // -s over |x|, and the squares of the whole errors over that of x.
        let (own_share, other_share) = (own_error.dot(back) * over, other_error.dot(back) * over);
        let (own_square, other_square) =
            (own_error.length_squared() * over, other_error.length_squared() * over);
        // Pairs that have met on the way.
        let apart = original.length_squared().max(f64::MIN_POSITIVE);
        let known = (self.support * self.support / apart).min(1.0);
        let volume = volume * known.squared();
        // Nothing acts across cracks.
        let own_modulus = volume * (-modulus).if_below(0.0, Number::splat(a, own.modulus));
        let other_modulus = if own.modulus > 0.0 { volume * modulus } else { Number::zero(a) };
        // Neighbours slide past each other where either of them flows: of the whole errors a part is
        // resisted, and the rest of the error along the pair.
        let part = modulus.min(own.modulus) * self.across;
        let rest = 1.0 - part;
        let (own_whole, other_whole) = (own_modulus * part, other_modulus * part);
        let (own_along, other_along) = (own_modulus * rest * own_share, other_modulus * rest * other_share);
        let along = own_along.mul_add(own_share, other_along * other_share);
        let own_energy = own_along.mul_add(own_share, own_whole * own_square);
        let energy = own_energy + other_along.mul_add(other_share, other_whole * other_square);
        let (half, back_half) = (0.5 * weight, -0.5 * weight);
        sums.stiffness = half.mul_add(own_modulus + other_modulus, sums.stiffness);
        let scale = weight * square;
        sums.energy = scale.mul_add(own_energy, sums.energy);
        let own_before = volume * (-before).if_below(0.0, Number::splat(a, own.modulus_before));
        let part = before.min(own.modulus_before) * self.across;
        let error = part.mul_add(own_square - own_share.squared(), own_share.squared());
        sums.energy_before = (scale * own_before).mul_add(error, sums.energy_before);
        // From w = -W' / r the slope of the weight is -(W'' + w) / r.
        let of_shape = half * (along - (own_along + other_along));
        let of_weight = 0.25 * (curvature + weight) * energy;
        if STRETCHED {
            self.add_along_normals(a, own, (four, back), of_weight * square, sums);
        }
        let slope = if STRETCHED { of_shape } else { of_shape + of_weight };
        sums.force = back.mul_add(slope, sums.force);
        sums.force = own_error.mul_add(back_half * (own_along + own_whole), sums.force);
        sums.force = other_error.mul_add(back_half * (other_along + other_whole), sums.force);
        let couple = back.mul_add(half * own_along, own_error * (half * own_whole));
        sums.couple[0] = couple.mul_add(original.x, sums.couple[0]);
        sums.couple[1] = couple.mul_add(original.y, sums.couple[1]);
        if A::AXES == 3 {
            sums.couple[2] = couple.mul_add(original.z, sums.couple[2]);
        }
    }

    /// Adds the force of four pairs as their weights change, which is along the normals of the ellipsoids,
    /// `G x` over the square of the distance, and what turns these.
    #[inline(always)]
    fn add_along_normals<A: FourLanes>(
        &self,
        a: A,
        own: &OwnControl<A>,
        (four, back): (&[u32; 4], Vector<A>),
        change: Number<A>,
        sums: &mut ControlSums<A>,
    ) {
        let of = records(four, self.ellipsoids);
        let (own_normal, normal) = own.ellipsoid.normals(a, back, of);
        let change = change / normal.dot(back).max(f64::MIN_POSITIVE);
        sums.force = normal.mul_add(change, sums.force);
        sums.add_turn(own_normal, back, change);
    }
}

impl<A: FourLanes> ControlSums<A> {
    /// Adds a multiple of the vector product of two vectors to what turns the ellipsoid. In a plane it has
    /// one component, across the plane.
    #[inline(always)]
    fn add_turn(&mut self, v: Vector<A>, w: Vector<A>, times: Number<A>) {
        if A::AXES == 3 {
            self.turn[0] += times * (v.y * w.z - v.z * w.y);
            self.turn[1] += times * (v.z * w.x - v.x * w.z);
        }
        self.turn[2] += times * (v.x * w.y - v.y * w.x);
    }
}

/// The sums over the lanes of a vector, and of a number in the last one.
#[inline(always)]
fn total<A: FourLanes>(a: A, Vector { x, y, z }: Vector<A>, last: Number<A>) -> Lanes4 {
    a.sums([x.lanes(), y.lanes(), z.lanes(), last.lanes()])
}
