//! Shares of particles in the value of a field at a point.
//!
//! With weights w_k and distances d_k from the point, the value is that of the weighted least-squares plane
//! at the point, `f = mean(f) - g . mean(d)` with the slope `g = C^-1 cov(d, f)` (moving least squares of
//! first order, Lancaster & Salkauskas, Math. Comp. 37 (1981) 141), a sum of shares of the particles by which
//! linear fields are exact. Where the particles do not span the space, it is the plain weighted mean
//! (Shepard).

use glam::DVec3;

use crate::correction::MomentMatrix;

/// Largest sum of the sizes of what the slope adds to the shares. At a corner of a block in space it is 3.4;
/// particles that nearly lie on a line, and a point beside it, have any: their slope is not that of the
/// field.
const LARGEST: f64 = 6.0;

/// Shares of particles with these weights and offsets from the point, m.
pub(super) fn shares(near: &[(f64, DVec3)], axes: usize) -> Vec<f64> {
    let total: f64 = near.iter().map(|(weight, _)| weight).sum();
    let middle = near.iter().map(|(weight, offset)| weight * offset).sum::<DVec3>() / total;
    let mut moment = MomentMatrix::new(axes);
    near.iter().for_each(|(weight, offset)| moment.add(*weight, offset - middle));
    let slope = moment.inverse().map_or(DVec3::ZERO, |inverse| inverse * middle);
    let by_slope = |(weight, offset): &(f64, DVec3)| weight * slope.dot(offset - middle);
    let size: f64 = near.iter().map(|particle| by_slope(particle).abs()).sum();
    let factor = if size > LARGEST { LARGEST / size } else { 1.0 };
    near.iter().map(|particle| particle.0 / total - factor * by_slope(particle)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corner of a cubic lattice, half a spacing outside of its outermost particle.
    #[test]
    fn a_linear_field_is_exact_at_a_corner() {
        let of = |x: f64, y: f64, z: f64| {
            let offset = DVec3::new(x, y, z);
            ((1.0 - offset.length() / 2.0).powi(2), offset)
        };
        let near = [of(0.5, 0.5, 0.5), of(1.5, 0.5, 0.5), of(0.5, 1.5, 0.5), of(0.5, 0.5, 1.5)];
        let field = |d: DVec3| 7.0 + 3.0 * d.x - 5.0 * d.y + 2.0 * d.z;
        let value: f64 = shares(&near, 3).iter().zip(&near).map(|(share, (_, d))| share * field(*d)).sum();
        assert!((value - 7.0).abs() < 1e-12, "{value}");
    }

    /// Three particles nearly on a line, and a point beside it: the values say nothing of the slope there.
    #[test]
    fn particles_nearly_on_a_line_do_not_multiply_what_they_differ_by() {
        let near = [
            (0.1, DVec3::new(1.5, -0.6, 0.0)),
            (0.2, DVec3::new(1.51, 0.1, 0.0)),
            (0.1, DVec3::new(1.5, 0.8, 0.0)),
        ];
        let found = shares(&near, 2);
        assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        // Values from zero to one: what the slope adds is at most half of the sum of sizes.
        let value: f64 = found.iter().zip([0.0, 1.0, 0.0]).map(|(share, value)| share * value).sum();
        assert!((value - 0.5).abs() < 0.5 * LARGEST + 1e-12, "{value}");
    }
}
