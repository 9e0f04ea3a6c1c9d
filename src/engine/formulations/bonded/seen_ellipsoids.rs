//! Ellipsoids packed for loops over pairs: distances to four neighbours as both ends measure them.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::ellipsoids::Ellipsoid;
use crate::parallel::{FourLanes, Lanes4, Number, Vector};

/// The ellipsoid of a particle as its neighbours read it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub(in crate::formulations) struct SeenEllipsoid {
    /// Gxx, Gyy, Gzz of the ellipsoid, and the factor of its kernel.
    stretch: Lanes4,
    /// Gxy, Gxz, Gyz, and the support radius, m.
    shear: Lanes4,
}

impl SeenEllipsoid {
    /// That of a support radius, m.
    pub fn of(ellipsoid: &Ellipsoid, support: f64) -> Self {
        let g = &ellipsoid.tensor;
        Self {
            stretch: Lanes4([g.xx, g.yy, g.zz, ellipsoid.density]),
            shear: Lanes4([g.xy, g.xz, g.yz, support]),
        }
    }

    /// That of an image, by the signs of its axes.
    pub fn image(&self, DVec3 { x, y, z }: DVec3) -> Self {
        let [xy, xz, yz, support] = self.shear.0;
        Self { stretch: self.stretch, shear: Lanes4([x * y * xy, x * z * xz, y * z * yz, support]) }
    }
}

/// The ellipsoid of the particle itself, in every lane.
#[derive(Clone, Copy)]
pub(in crate::formulations) struct OwnEllipsoid<A: FourLanes> {
    stretch: [Number<A>; 4],
    shear: [Number<A>; 4],
}

/// Four pairs.
#[derive(Clone, Copy)]
pub(in crate::formulations) struct FourSeen<A: FourLanes> {
    /// Square of the distance as both measure it, m2.
    pub square: Number<A>,
    /// Factor of the kernel.
    pub density: Number<A>,
    /// Mean support radius, m.
    pub support: Number<A>,
}

impl<A: FourLanes> OwnEllipsoid<A> {
    #[inline(always)]
    pub fn new(a: A, of: &SeenEllipsoid) -> Self {
        Self { stretch: numbers(a, of.stretch), shear: numbers(a, of.shear) }
    }

    /// Distances of pair vectors to four others by both metrics, m.
    #[inline(always)]
    pub fn measure(&self, a: A, r: Vector<A>, of: [&SeenEllipsoid; 4]) -> FourSeen<A> {
        let [xx, yy, zz, density] = a.transpose([of[0].stretch, of[1].stretch, of[2].stretch, of[3].stretch]);
        let [xy, xz, yz, support] = a.transpose([of[0].shear, of[1].shear, of[2].shear, of[3].shear]);
        let ([own_xx, own_yy, own_zz, own_density], [own_xy, own_xz, own_yz, own_support]) =
            (self.stretch, self.shear);
        let shear = sum(a, own_xy, xy);
        let mut twice =
            sum(a, own_xx, xx) * r.x * r.x + sum(a, own_yy, yy) * r.y * r.y + 2.0 * shear * r.x * r.y;
        if A::AXES == 3 {
            let shears = sum(a, own_xz, xz) * r.x + sum(a, own_yz, yz) * r.y;
            twice += (sum(a, own_zz, zz) * r.z + 2.0 * shears) * r.z;
        }
        FourSeen {
            square: twice * 0.5,
            density: sum(a, own_density, density) * 0.5,
            support: sum(a, own_support, support) * 0.5,
        }
    }

    /// G r of the particle itself, and of the mean of both ends.
    #[inline(always)]
    pub fn normals(&self, a: A, r: Vector<A>, of: [&SeenEllipsoid; 4]) -> (Vector<A>, Vector<A>) {
        let other = Self {
            stretch: lane_by_lane(a, [of[0].stretch, of[1].stretch, of[2].stretch, of[3].stretch]),
            shear: lane_by_lane(a, [of[0].shear, of[1].shear, of[2].shear, of[3].shear]),
        };
        let own = self.times(r);
        (own, (own + other.times(r)) * 0.5)
    }

    /// G r.
    #[inline(always)]
    fn times(&self, r: Vector<A>) -> Vector<A> {
        let ([xx, yy, zz, _], [xy, xz, yz, _]) = (self.stretch, self.shear);
        if A::AXES == 2 {
            return Vector { x: xx * r.x + xy * r.y, y: xy * r.x + yy * r.y, z: r.z };
        }
        Vector {
            x: xx * r.x + xy * r.y + xz * r.z,
            y: xy * r.x + yy * r.y + yz * r.z,
            z: xz * r.x + yz * r.y + zz * r.z,
        }
    }
}

/// Each lane in all lanes of a number.
#[inline(always)]
fn numbers<A: FourLanes>(a: A, Lanes4([x, y, z, w]): Lanes4) -> [Number<A>; 4] {
    [Number::splat(a, x), Number::splat(a, y), Number::splat(a, z), Number::splat(a, w)]
}

/// Each lane of four others.
#[inline(always)]
fn lane_by_lane<A: FourLanes>(a: A, others: [Lanes4; 4]) -> [Number<A>; 4] {
    let [x, y, z, w] = a.transpose(others);
    [Number::new(a, x), Number::new(a, y), Number::new(a, z), Number::new(a, w)]
}

#[inline(always)]
fn sum<A: FourLanes>(a: A, own: Number<A>, other: Lanes4) -> Number<A> {
    own + Number::new(a, other)
}
