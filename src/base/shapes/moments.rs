//! Volume, centre and second moments of shapes in closed form, for mass and inertia of rigid bodies.

use glam::{DQuat, DVec3};

use crate::linalg::Sym3;

/// Moments of a shape. In two dimensions the volume is an area \[m²\], and moments are per metre of
/// thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Volume \[m³\].
    pub volume: f64,
    /// Centre \[m\].
    pub center: DVec3,
    /// Integral of (x - c)(x - c)^T over the shape, with its centre c \[m⁵\].
    pub second: Sym3,
}

impl Moments {
    /// Moments from triangles or tetrahedra of the given signed volumes that share the corner `origin`;
    /// `corners` are relative to it. `axes` is 2 for triangles, 3 for tetrahedra.
    ///
    /// Over a simplex in d dimensions with a corner at the origin, x x^T integrates to V / ((d + 1)(d + 2))
    /// (sum v v^T + s s^T) with s = sum v.
    pub(super) fn of_simplices(
        origin: DVec3,
        axes: usize,
        simplices: impl Iterator<Item = (f64, [DVec3; 3])>,
    ) -> Self {
        let d = axes as f64;
        let (mut volume, mut first, mut second) = (0.0, DVec3::ZERO, Sym3::ZERO);
        for (part, corners) in simplices {
            let sum: DVec3 = corners.iter().sum();
            let mut squares = Sym3::dyad(sum);
            corners.iter().for_each(|corner| squares += Sym3::dyad(*corner));
            volume += part;
            first += sum * (part / (d + 1.0));
            second += squares * (part / ((d + 1.0) * (d + 2.0)));
        }
        let center = first / volume;
        second += Sym3::dyad(center) * -volume;
        if volume < 0.0 {
            (volume, second) = (-volume, second * -1.0);
        }
        Self { volume, center: origin + center, second }
    }

    /// Moments of the translated shape.
    pub(super) fn translated(self, by: DVec3) -> Self {
        Self { center: self.center + by, ..self }
    }

    /// Moments of the shape rotated about a point.
    pub(super) fn rotated(self, turn: DQuat, about: DVec3) -> Self {
        let rotation = glam::DMat3::from_quat(turn);
        let second = Sym3::symmetric_part(rotation * self.second.to_matrix() * rotation.transpose());
        Self { center: about + turn * (self.center - about), second, ..self }
    }

    /// Moments of the shape scaled uniformly along its `axes` from a point.
    pub(super) fn scaled(self, by: f64, axes: usize, about: DVec3) -> Self {
        let volume = by.powi(axes as i32);
        Self {
            volume: self.volume * volume,
            center: about + by * (self.center - about),
            second: self.second * (volume * by * by),
        }
    }

    /// Moments of two disjoint shapes; with `sign` -1, of the first without the second, which it contains.
    pub(super) fn joined(self, other: Self, sign: f64) -> Self {
        let volume = self.volume + sign * other.volume;
        let center = (self.volume * self.center + sign * other.volume * other.center) / volume;
        let about = |part: Self| part.second + Sym3::dyad(part.center - center) * part.volume;
        Self { volume, center, second: about(self) + about(other) * sign }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::shapes::{Shape, Surface};
    use crate::space::Dimension;

    fn surface(text: &str, dimension: Dimension) -> Box<dyn Surface> {
        let shape: Shape = ron::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        shape
            .surface(dimension, Path::new("tests/scenes/meshes"), "shape")
            .unwrap_or_else(|e| panic!("{e:?}"))
    }

    /// Moments by counting cells, for comparison.
    fn counted(surface: &dyn Surface, dimension: Dimension, cells: usize) -> Moments {
        let bounds = surface.bounds();
        let axes = dimension.count();
        let side = bounds.extent() / cells as f64;
        let depth = if axes == 3 { cells } else { 1 };
        let mut places = Vec::new();
        for n in 0..cells * cells * depth {
            let index =
                DVec3::new((n % cells) as f64, (n / cells % cells) as f64, (n / cells / cells) as f64);
            let x = bounds.min + (index + 0.5) * side;
            if surface.distance(x) < 0.0 {
                places.push(x);
            }
        }
        let cell: f64 = (0..axes).map(|k| side[k]).product();
        let center = places.iter().sum::<DVec3>() / places.len() as f64;
        let mut second = Sym3::ZERO;
        places.iter().for_each(|x| second += Sym3::dyad(*x - center) * cell);
        Moments { volume: cell * places.len() as f64, center, second }
    }

    #[test]
    fn moments_are_those_of_counted_cells() {
        let (two, three) = (Dimension::Two, Dimension::Three);
        for (text, dimension) in [
            ("Box(min: (1, 2, 3), max: (2, 4, 6))", three),
            ("Box(min: (1, 2), max: (2, 4))", two),
            ("Sphere(center: (1, -1, 2), radius: 0.7)", three),
            ("Sphere(center: (1, -1), radius: 0.7)", two),
            ("Ring(center: (1, -1), inner: 0.3, outer: 0.7)", two),
            ("Cylinder(from: (0, 0, 0), to: (1, 2, 1), radius: 0.8)", three),
            ("Tube(from: (1, 0, 0), to: (1, 0, 2), inner: 0.3, outer: 0.8)", three),
            ("Shell(center: (1, 0, 2), inner: 0.3, outer: 0.8)", three),
            ("Polygon(points: [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (0, 2)])", two),
            ("Extrusion(polygon: [(0, 0), (0, 2), (1, 2), (1, 1), (3, 1), (3, 0)], from: 1, to: 4)", three),
            (
                "Translate(shape: Rotate(shape: Scale(shape: Box(min: (0, 0, 0), max: (1, 2, 3)), by: (2, 2, 2), about: (1, 0, 0)), \
              axis: (1, 2, 3), angle_degrees: 40, about: (1, 1, 1)), by: (1, 2, 3))",
                three,
            ),
            ("Difference(Box(min: (0, 0), max: (2, 1)), Sphere(center: (0.5, 0.5), radius: 0.3))", two),
            ("Union([Box(min: (0, 0), max: (2, 1)), Sphere(center: (3, 3), radius: 0.5)])", two),
        ] {
            let surface = surface(text, dimension);
            let exact = surface.moments().unwrap_or_else(|| panic!("{text} has no moments"));
            let found = counted(&*surface, dimension, if dimension == two { 600 } else { 120 });
            let near = |a: f64, b: f64, scale: f64| (a - b).abs() < 1e-2 * scale;
            let size = exact.second.trace().abs();
            let moments = exact.second.to_matrix() - found.second.to_matrix();
            assert!(near(exact.volume, found.volume, exact.volume), "{text}: {exact:?} {found:?}");
            assert!(exact.center.distance(found.center) < 1e-2, "{text}: {exact:?} {found:?}");
            assert!(moments.abs_diff_eq(glam::DMat3::ZERO, 1e-2 * size), "{text}: {exact:?} {found:?}");
        }
    }
}
