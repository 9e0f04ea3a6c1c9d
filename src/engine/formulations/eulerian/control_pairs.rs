//! The sums over the pairs of a particle for its hourglass control, four neighbours at once.

use glam::{DMat3, DVec3};

use super::control_rows::Carried;
use super::near::EulerianNeighbors;
use super::particle::EulerianParticle;
use crate::parallel::{FourLanes, Lanes4, Matrix, Number, Vector};

/// The pairs of a body.
pub(super) struct ControlPairs<'a> {
    /// Support radius, m.
    pub support: f64,
    pub offsets: &'a [usize],
    pub near: &'a EulerianNeighbors,
    pub points: &'a [EulerianParticle],
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
}

/// The kernel at four neighbours.
struct FourKernel {
    /// Pair weight `w = -W' / r`.
    weight: Lanes4,
    /// Second derivative `W''`.
    curvature: Lanes4,
}

/// The sums so far.
struct ControlSums<A: FourLanes> {
    force: Vector<A>,
    couple: [Vector<A>; 3],
    stiffness: Number<A>,
    energy: Number<A>,
    energy_before: Number<A>,
}

/// Four neighbours: x_ij, X_ij, F_j, Young's moduli now and before, and volume.
struct FourOthers<A: FourLanes> {
    arm: Vector<A>,
    original: Vector<A>,
    deformation: Matrix<A>,
    modulus: Number<A>,
    before: Number<A>,
    volume: Number<A>,
}

impl ControlPairs<'_> {
    /// The sums of row `i`.
    #[inline(always)]
    pub fn of_row<A: FourLanes>(&self, a: A, i: usize) -> ControlRowSums {
        let own = &self.carried[i];
        let [x, y, z] = own.columns;
        let column = |column: Lanes4| Vector::splat(a, column.xyz());
        let own = OwnControl {
            place: Vector::splat(a, self.points[i].place.xyz()),
            original: Vector::splat(a, own.original.xyz()),
            deformation: Matrix([column(x), column(y), column(z)]),
            modulus: x.0[3],
            modulus_before: y.0[3],
        };
        let zero = Vector::zero(a);
        let none = Number::zero(a);
        let mut sums = ControlSums {
            force: zero,
            couple: [zero; 3],
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
            let kernel =
                FourKernel { weight: Lanes4(weight_fours[n]), curvature: in_double(curvature_fours[n]) };
            self.add(a, &own, fours[n], kernel, &mut sums);
        }
        if !rest.is_empty() {
            // The particle itself fills the lanes that are left, without a weight.
            let mut four = [i as u32; 4];
            let mut kernel = FourKernel { weight: Lanes4::ZERO, curvature: Lanes4::ZERO };
            for lane in 0..rest.len() {
                four[lane] = rest[lane];
                (kernel.weight.0[lane], kernel.curvature.0[lane]) =
                    (weight_rest[lane], f64::from(curvature_rest[lane]));
            }
            self.add(a, &own, four, kernel, &mut sums);
        }
        let [x, y, z] = sums.couple;
        ControlRowSums {
            force: sums.force.sum(),
            couple: DMat3::from_cols(x.sum(), y.sum(), z.sum()),
            stiffness: sums.stiffness.sum(),
            energy: sums.energy.sum(),
            energy_before: sums.energy_before.sum(),
        }
    }

    /// Reads four neighbours.
    #[inline(always)]
    fn four<A: FourLanes>(&self, a: A, own: &OwnControl<A>, four: [u32; 4]) -> FourOthers<A> {
        let [j, k, l, m] = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
        let points = [&self.points[j], &self.points[k], &self.points[l], &self.points[m]];
        let of = [&self.carried[j], &self.carried[k], &self.carried[l], &self.carried[m]];
        let [x, y, z, _] = a.transpose([points[0].place, points[1].place, points[2].place, points[3].place]);
        let arm = Vector::new(a, [x, y, z]) - own.place;
        let [x, y, z, _] = a.transpose([of[0].original, of[1].original, of[2].original, of[3].original]);
        let original = Vector::new(a, [x, y, z]) - own.original;
        let columns =
            |n: usize| a.transpose([of[0].columns[n], of[1].columns[n], of[2].columns[n], of[3].columns[n]]);
        let [[ax, ay, az, modulus], [bx, by, bz, before], [cx, cy, cz, volume]] =
            [columns(0), columns(1), columns(2)];
        let deformation = Matrix([
            Vector::new(a, [ax, ay, az]),
            Vector::new(a, [bx, by, bz]),
            Vector::new(a, [cx, cy, cz]),
        ]);
        let number = |lanes| Number::new(a, lanes);
        let (modulus, before, volume) = (number(modulus), number(before), number(volume));
        FourOthers { arm, original, deformation, modulus, before, volume }
    }

    /// Adds four neighbours.
    #[inline(always)]
    fn add<A: FourLanes>(
        &self,
        a: A,
        own: &OwnControl<A>,
        four: [u32; 4],
        kernel: FourKernel,
        sums: &mut ControlSums<A>,
    ) {
        let FourOthers { arm, original, deformation, modulus, before, volume } = self.four(a, own, four);
        let (weight, curvature) = (Number::new(a, kernel.weight), Number::new(a, kernel.curvature));
        let (own_guess, other_guess) = (own.deformation * original, deformation * original);
        let square = arm.length_squared().max(f64::MIN_POSITIVE);
        // s over |x| of both.
        let over = 1.0 / square;
        let (own_share, other_share) = (own_guess.dot(arm) * over - 1.0, other_guess.dot(arm) * over - 1.0);
        // Pairs that have met on the way.
        let apart = original.length_squared().max(f64::MIN_POSITIVE);
        let known = (self.support * self.support / apart).min(1.0);
        let volume = volume * known.squared();
        // Nothing acts across cracks.
        let own_modulus = (-modulus).if_below(0.0, Number::splat(a, own.modulus));
        let other_modulus = if own.modulus > 0.0 { modulus } else { Number::zero(a) };
        let own_before = (-before).if_below(0.0, Number::splat(a, own.modulus_before));
        let (own_stiffness, other_stiffness) =
            (volume * own_modulus * own_share, volume * other_modulus * other_share);
        // The whole errors, of which a part is resisted, and the rest of the error along the pair.
        let (own_error, other_error) = (own_guess - arm, other_guess - arm);
        let (half, one) = (0.5 * weight, Number::splat(a, 1.0));
        // Neighbours slide past each other where either of them flows.
        let part = modulus.min(own.modulus) * self.across;
        let rest = one - part;
        let (own_square, other_square) =
            (own_error.length_squared() * over, other_error.length_squared() * over);
        let (own_whole, other_whole) = (volume * own_modulus * part, volume * other_modulus * part);
        let (own_along, other_along) = (rest * own_stiffness, rest * other_stiffness);
        let errors = own_along * own_share + other_along * other_share;
        let all_errors = errors + own_whole * own_square + other_whole * other_square;
        // From w = -W' / r the slope of the weight is -(W'' + w) / r.
        let slope =
            half * (2.0 * (own_along + other_along) + errors) + 0.25 * (curvature + weight) * all_errors;
        let own_force = half * own_along;
        let guess = own_guess.mul_add(own_force, other_guess * (half * other_along));
        let own_push = own_error * (half * own_whole);
        sums.force += guess - arm * slope - own_push - other_error * (half * other_whole);
        let couple = arm.mul_add(own_force, own_push);
        sums.couple[0] = couple.mul_add(original.x, sums.couple[0]);
        sums.couple[1] = couple.mul_add(original.y, sums.couple[1]);
        if A::AXES == 3 {
            sums.couple[2] = couple.mul_add(original.z, sums.couple[2]);
        }
        let along = own_share.squared();
        let before_part = before.min(own.modulus_before) * self.across;
        let error = weight * volume * square;
        sums.stiffness += half * volume * (own_modulus + other_modulus);
        sums.energy = (error * (rest * along + part * own_square)).mul_add(own_modulus, sums.energy);
        let with_before = error * ((one - before_part) * along + before_part * own_square);
        sums.energy_before = with_before.mul_add(own_before, sums.energy_before);
    }
}

/// Four numbers in double precision.
#[inline(always)]
fn in_double([a, b, c, d]: [f32; 4]) -> Lanes4 {
    Lanes4([f64::from(a), f64::from(b), f64::from(c), f64::from(d)])
}
