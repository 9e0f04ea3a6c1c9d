//! The fit of a gradient over the neighbours of a particle.

use crate::linalg::Sym3;
use crate::parallel::{FourLanes, Lanes4};

/// The columns of a weighted sum times the inverse moment matrix.
#[inline(always)]
pub(crate) fn fit<A: FourLanes, const D: usize>(a: A, spread: &[Lanes4; D], inverse: &Sym3) -> [Lanes4; 3] {
    let Sym3 { xx, yy, zz, xy, xz, yz } = *inverse;
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut f = [Lanes4::ZERO; 3];
    for c in 0..D {
        for axis in 0..D {
            f[c] = a.scale_add(rows[axis][c], spread[axis], f[c]);
        }
    }
    f
}
