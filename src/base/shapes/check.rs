//! Checks of one shape, and the geometry of primitive shapes.

use std::path::Path;

use glam::{DQuat, DVec3};

use super::block::BoxRegion;
use super::cylinder::Cylinder;
use super::error::{FillError, FillErrorKind};
use super::half_space::HalfSpace;
use super::mesh;
use super::polygon::{Extrusion, Polygon};
use super::region::Aabb;
use super::ring::Ring;
use super::shape::Shape;
use super::shell::Shell;
use super::sphere::BallRegion;
use super::surface::Surface;
use crate::space::{Dimension, Vec3};

pub(super) type Checked<T> = Result<T, FillError>;

/// The checks of one shape, with its path in the scene.
pub(super) struct ShapeCheck<'a> {
    pub dimension: Dimension,
    pub folder: &'a Path,
    pub path: &'a str,
}

impl ShapeCheck<'_> {
    /// The geometry of a primitive shape.
    pub fn single(&self, shape: &Shape) -> Checked<Box<dyn Surface>> {
        let axes = self.dimension.count();
        Ok(match shape {
            Shape::Box { min, max } => {
                let corners = Aabb { min: self.point("min", *min)?, max: self.point("max", *max)? };
                for k in 0..axes {
                    self.range("max", k, corners.min[k], corners.max[k])?;
                }
                Box::new(BoxRegion { corners, axes })
            }
            Shape::Sphere { center, radius } => {
                let center = self.point("center", *center)?;
                Box::new(BallRegion { center, radius: self.positive("radius", *radius)?, axes })
            }
            Shape::HalfSpace { point, normal } => {
                let point = self.point("point", *point)?;
                let Some(normal) = self.point("normal", *normal)?.try_normalize() else {
                    return self.error("normal", FillErrorKind::NoNormal);
                };
                Box::new(HalfSpace { point, normal, axes })
            }
            Shape::Ring { center, inner, outer } => {
                self.exists("Ring", Dimension::Two, "`Tube`")?;
                let center = self.point("center", *center)?;
                let (inner, outer) = self.radii(*inner, *outer)?;
                Box::new(Ring { center, inner, outer })
            }
            Shape::Polygon { points } => {
                self.exists("Polygon", Dimension::Two, "`Extrusion`")?;
                Box::new(self.polygon("points", points)?)
            }
            _ => self.in_space(shape)?,
        })
    }

    /// The geometry of a three-dimensional shape.
    fn in_space(&self, shape: &Shape) -> Checked<Box<dyn Surface>> {
        Ok(match shape {
            Shape::Cylinder { from, to, radius } => {
                self.exists("Cylinder", Dimension::Three, "`Sphere` (a disc) or `Box`")?;
                let (from, to) = self.axis(*from, *to)?;
                Box::new(Cylinder { from, to, inner: 0.0, outer: self.positive("radius", *radius)? })
            }
            Shape::Tube { from, to, inner, outer } => {
                self.exists("Tube", Dimension::Three, "`Ring`")?;
                let (from, to) = self.axis(*from, *to)?;
                let (inner, outer) = self.radii(*inner, *outer)?;
                Box::new(Cylinder { from, to, inner, outer })
            }
            Shape::Shell { center, inner, outer } => {
                self.exists("Shell", Dimension::Three, "`Ring`")?;
                let center = self.point("center", *center)?;
                let (inner, outer) = self.radii(*inner, *outer)?;
                Box::new(Shell { center, inner, outer })
            }
            Shape::Extrusion { polygon, from, to } => {
                self.exists("Extrusion", Dimension::Three, "`Polygon`")?;
                let polygon = self.polygon("polygon", polygon)?;
                let (from, to) = (self.finite("from", *from)?, self.finite("to", *to)?);
                self.range("to", 2, from, to)?;
                Box::new(Extrusion { polygon, from, to })
            }
            Shape::Mesh { file, scale } => {
                self.exists("Mesh", Dimension::Three, "`Polygon`")?;
                let scale = self.positive("scale", *scale)?;
                Box::new(mesh::load(self.folder, file, scale).or_else(|kind| self.error("file", kind))?)
            }
            _ => return Err(FillError::new(self.path, FillErrorKind::NoInside)),
        })
    }

    pub fn field(&self, name: &str) -> String {
        format!("{}.{name}", self.path)
    }

    /// The path of argument `n` of a shape without field names.
    pub fn entry(&self, n: usize) -> String {
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

    /// The parts of a combination, each constructed by `make`.
    pub fn parts<R: ?Sized>(
        &self,
        shapes: &[Shape],
        make: impl Fn(&Shape, Dimension, &Path, &str) -> Checked<Box<R>>,
    ) -> Checked<Vec<Box<R>>> {
        if shapes.is_empty() {
            return Err(FillError::new(self.path, FillErrorKind::NoShapes));
        }
        let part = |(n, shape): (usize, &Shape)| {
            make(shape, self.dimension, self.folder, &format!("{}[{n}]", self.entry(0)))
        };
        shapes.iter().enumerate().map(part).collect()
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
