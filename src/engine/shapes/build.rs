//! From a shape as written to checked geometry.

use glam::{DQuat, DVec3};

use super::block::Block;
use super::boolean::{Difference, Intersection, Union};
use super::cylinder::Cylinder;
use super::error::{FillError, FillErrorKind};
use super::polygon::{Extrusion, Polygon};
use super::region::{Aabb, Region};
use super::ring::Ring;
use super::shape::Shape;
use super::sphere::Sphere;
use super::transform::{Rotated, Scaled, Translated};
use crate::scene::{Dimension, Vec3};

type Checked<T> = Result<T, FillError>;

impl Shape {
    /// The set of points of this shape. `path` is the field that holds the shape, for error messages: `shape`, `within`.
    ///
    /// # Errors
    /// A number that cannot be, a shape that does not exist in this dimension, a polygon that crosses itself, a particle file.
    pub fn region(&self, dimension: Dimension, path: &str) -> Checked<Box<dyn Region>> {
        let check = Check { dimension, path };
        let axes = dimension.count();
        Ok(match self {
            Self::Box { min, max } => {
                let corners = Aabb { min: check.point("min", *min)?, max: check.point("max", *max)? };
                for k in 0..axes {
                    check.range("max", k, corners.min[k], corners.max[k])?;
                }
                Box::new(Block { corners, axes })
            }
            Self::Sphere { center, radius } => {
                let center = check.point("center", *center)?;
                Box::new(Sphere { center, radius: check.positive("radius", *radius)?, axes })
            }
            Self::Cylinder { from, to, radius } => {
                check.exists("Cylinder", Dimension::Three, "`Sphere` (a disc) or `Box`")?;
                let (from, to) = check.axis(*from, *to)?;
                Box::new(Cylinder { from, to, inner: 0.0, outer: check.positive("radius", *radius)? })
            }
            Self::Ring { center, inner, outer } => {
                check.exists("Ring", Dimension::Two, "`Tube`")?;
                let center = check.point("center", *center)?;
                let (inner, outer) = check.radii(*inner, *outer)?;
                Box::new(Ring { center, inner, outer })
            }
            Self::Tube { from, to, inner, outer } => {
                check.exists("Tube", Dimension::Three, "`Ring`")?;
                let (from, to) = check.axis(*from, *to)?;
                let (inner, outer) = check.radii(*inner, *outer)?;
                Box::new(Cylinder { from, to, inner, outer })
            }
            Self::Polygon { points } => {
                check.exists("Polygon", Dimension::Two, "`Extrusion`")?;
                Box::new(check.polygon("points", points)?)
            }
            Self::Extrusion { polygon, from, to } => {
                check.exists("Extrusion", Dimension::Three, "`Polygon`")?;
                let polygon = check.polygon("polygon", polygon)?;
                let (from, to) = (check.finite("from", *from)?, check.finite("to", *to)?);
                check.range("to", 2, from, to)?;
                Box::new(Extrusion { polygon, from, to })
            }
            Self::Union(shapes) => Box::new(Union { parts: check.parts(shapes)?, axes }),
            Self::Intersection(shapes) => Box::new(Intersection { parts: check.parts(shapes)?, axes }),
            Self::Difference(whole, hole) => Box::new(Difference {
                whole: whole.region(dimension, &check.entry(0))?,
                hole: hole.region(dimension, &check.entry(1))?,
                axes,
            }),
            Self::Translate { shape, by } => {
                let by = check.point("by", *by)?;
                Box::new(Translated { region: check.inner(shape)?, by })
            }
            Self::Rotate { shape, axis, angle_degrees, about } => {
                let (turn, about) = check.turn(*axis, *angle_degrees, *about)?;
                Box::new(Rotated { region: check.inner(shape)?, turn, about })
            }
            Self::Scale { shape, by, about } => {
                let (by, about) = check.scale(*by, *about)?;
                Box::new(Scaled { region: check.inner(shape)?, by, about, axes })
            }
            Self::Points { .. } => return Err(FillError::new(path, FillErrorKind::NoInside)),
        })
    }
}

/// The checks of one shape, which know where it stands.
pub(super) struct Check<'a> {
    pub dimension: Dimension,
    pub path: &'a str,
}

impl Check<'_> {
    pub fn field(&self, name: &str) -> String {
        format!("{}.{name}", self.path)
    }

    /// The path of argument `n` of a shape without field names.
    fn entry(&self, n: usize) -> String {
        format!("{}[{n}]", self.path)
    }

    fn error<T>(&self, field: &str, kind: FillErrorKind) -> Checked<T> {
        Err(FillError::new(self.field(field), kind))
    }

    fn exists(&self, shape: &'static str, dimension: Dimension, instead: &'static str) -> Checked<()> {
        let needs = if dimension == Dimension::Two { "two" } else { "three" };
        if dimension == self.dimension {
            return Ok(());
        }
        Err(FillError::new(self.path, FillErrorKind::WrongDimension { shape, needs, instead }))
    }

    fn finite(&self, field: &str, value: f64) -> Checked<f64> {
        if value.is_finite() { Ok(value) } else { self.error(field, FillErrorKind::NotFinite(value)) }
    }

    fn positive(&self, field: &str, value: f64) -> Checked<f64> {
        self.finite(field, value)?;
        if value > 0.0 { Ok(value) } else { self.error(field, FillErrorKind::NotPositive(value)) }
    }

    pub fn point(&self, field: &str, point: Vec3) -> Checked<DVec3> {
        for value in point.0.to_array() {
            self.finite(field, value)?;
        }
        if self.dimension == Dimension::Two && point.0.z != 0.0 {
            return self.error(field, FillErrorKind::NotFlat(point.0.z));
        }
        Ok(point.0)
    }

    fn range(&self, field: &str, axis: usize, min: f64, max: f64) -> Checked<()> {
        if min < max && (max - min).is_finite() {
            return Ok(());
        }
        self.error(field, FillErrorKind::EmptyRange { axis: ['x', 'y', 'z'][axis], min, max })
    }

    fn radii(&self, inner: f64, outer: f64) -> Checked<(f64, f64)> {
        self.positive("inner", inner)?;
        self.positive("outer", outer)?;
        if inner < outer {
            Ok((inner, outer))
        } else {
            self.error("inner", FillErrorKind::Radii { inner, outer })
        }
    }

    fn axis(&self, from: Vec3, to: Vec3) -> Checked<(DVec3, DVec3)> {
        let ends = (self.point("from", from)?, self.point("to", to)?);
        if ends.0 == ends.1 { self.error("to", FillErrorKind::NoLength) } else { Ok(ends) }
    }

    fn polygon(&self, field: &str, points: &[(f64, f64)]) -> Checked<Polygon> {
        for &(x, y) in points {
            self.finite(field, x)?;
            self.finite(field, y)?;
        }
        Polygon::new(points).or_else(|kind| self.error(field, kind))
    }

    fn parts(&self, shapes: &[Shape]) -> Checked<Vec<Box<dyn Region>>> {
        if shapes.is_empty() {
            return Err(FillError::new(self.path, FillErrorKind::NoShapes));
        }
        let part =
            |(n, shape): (usize, &Shape)| shape.region(self.dimension, &format!("{}[{n}]", self.entry(0)));
        shapes.iter().enumerate().map(part).collect()
    }

    fn inner(&self, shape: &Shape) -> Checked<Box<dyn Region>> {
        shape.region(self.dimension, &self.field("shape"))
    }

    /// The rotation and its fixed point.
    pub fn turn(&self, axis: Vec3, degrees: f64, about: Vec3) -> Checked<(DQuat, DVec3)> {
        for value in axis.0.to_array() {
            self.finite("axis", value)?;
        }
        let about = self.point("about", about)?;
        let angle = self.finite("angle_degrees", degrees)?.to_radians();
        let Some(direction) = axis.0.try_normalize() else {
            return self.error("axis", FillErrorKind::NoAxis);
        };
        if self.dimension == Dimension::Two && direction.truncate() != glam::DVec2::ZERO {
            return self.error("axis", FillErrorKind::AxisNotZ);
        }
        Ok((DQuat::from_axis_angle(direction, angle), about))
    }

    /// The factors (z: 1 in two dimensions) and the fixed point.
    pub fn scale(&self, by: Vec3, about: Vec3) -> Checked<(DVec3, DVec3)> {
        let mut factors = by.0;
        if self.dimension == Dimension::Two {
            factors.z = 1.0;
        }
        for factor in factors.to_array() {
            self.positive("by", factor)?;
        }
        Ok((factors, self.point("about", about)?))
    }
}
