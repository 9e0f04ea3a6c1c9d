//! Conversion of a shape of a scene to checked geometry.

use std::path::Path;

use glam::DVec3;

use super::boolean::{Intersection, Union};
use super::check::{Checked, ShapeCheck};
use super::difference::DifferenceRegion;
use super::error::{FillError, FillErrorKind};
use super::region::Region;
use super::shape::Shape;
use super::stretched_sphere::StretchedSphere;
use super::surface::Surface;
use super::transform::{Rotated, Scaled, Translated};
use crate::space::Dimension;

impl Shape {
    /// The set of points of this shape. Files are looked for in `folder`; `path` is the field that holds the
    /// shape, for error messages: `shape`, `within`.
    ///
    /// # Errors
    /// An invalid number, a shape that does not exist in this dimension, a polygon that crosses itself, a
    /// particle file.
    pub fn region(&self, dimension: Dimension, folder: &Path, path: &str) -> Checked<Box<dyn Region>> {
        let check = ShapeCheck { dimension, folder, path };
        let axes = dimension.count();
        Ok(match self {
            Self::Union(shapes) => Box::new(Union::new(check.parts(shapes, Self::region)?, axes)),
            Self::Intersection(shapes) => {
                Box::new(Intersection { parts: check.parts(shapes, Self::region)?, axes })
            }
            Self::Difference(whole, hole) => Box::new(DifferenceRegion::new(
                whole.region(dimension, folder, &check.entry(0))?,
                hole.region(dimension, folder, &check.entry(1))?,
                axes,
            )),
            Self::Translate { shape, by } => {
                let by = check.point("by", *by)?;
                Box::new(Translated { region: shape.region(dimension, folder, &check.field("shape"))?, by })
            }
            Self::Rotate { shape, axis, angle_degrees, about } => {
                let (turn, about) = check.turn(*axis, *angle_degrees, *about)?;
                let region = shape.region(dimension, folder, &check.field("shape"))?;
                Box::new(Rotated { region, turn, about })
            }
            Self::Scale { shape, by, about } => {
                let (by, about) = check.scale(*by, *about)?;
                let region = shape.region(dimension, folder, &check.field("shape"))?;
                // The distance from an ellipsoid is exact, that of another stretched shape a lower bound.
                match shape.stretched_sphere(by, about, axes) {
                    Some(ellipsoid) => Box::new(ellipsoid),
                    None => Box::new(Scaled { region, by, about, axes }),
                }
            }
            single => check.single(single)?,
        })
    }

    /// The surface of this shape, for tools. It exists for all single shapes, for translated, rotated and
    /// uniformly scaled ones, for stretched spheres, and for combinations of parts whose surfaces are
    /// disjoint. Files are looked for in `folder`; `path` is the field that holds the shape, for error
    /// messages.
    ///
    /// # Errors
    /// Those of [`region`](Self::region), and a combination or stretched shape whose nearest points have no
    /// closed form.
    pub fn surface(&self, dimension: Dimension, folder: &Path, path: &str) -> Checked<Box<dyn Surface>> {
        let check = ShapeCheck { dimension, folder, path };
        let axes = dimension.count();
        let none = |why| Err(FillError::new(path, FillErrorKind::NoSurface(why)));
        Ok(match self {
            Self::Union(shapes) => {
                let union = Union::new(check.parts(shapes, Self::surface)?, axes);
                if !union.is_apart(union.tolerance()) {
                    return none("the parts of the union touch each other, or nearly so");
                }
                Box::new(union)
            }
            Self::Difference(whole, hole) => {
                let whole = whole.surface(dimension, folder, &check.entry(0))?;
                let hole = hole.surface(dimension, folder, &check.entry(1))?;
                let difference = DifferenceRegion::new(whole, hole, axes);
                if !difference.is_hollow(difference.tolerance()) {
                    return none(
                        "the hole of the difference cuts the surface of the first shape, or nearly so",
                    );
                }
                Box::new(difference)
            }
            Self::Intersection(_) => return none("an intersection has edges between its parts"),
            Self::Translate { shape, by } => {
                let by = check.point("by", *by)?;
                Box::new(Translated { region: shape.surface(dimension, folder, &check.field("shape"))?, by })
            }
            Self::Rotate { shape, axis, angle_degrees, about } => {
                let (turn, about) = check.turn(*axis, *angle_degrees, *about)?;
                let region = shape.surface(dimension, folder, &check.field("shape"))?;
                Box::new(Rotated { region, turn, about })
            }
            Self::Scale { shape, by, about } => {
                let (by, about) = check.scale(*by, *about)?;
                let region = shape.surface(dimension, folder, &check.field("shape"))?;
                match shape.stretched_sphere(by, about, axes) {
                    Some(ellipsoid) => Box::new(ellipsoid),
                    None if is_stretched(by, axes) => {
                        return none("the factors of the scaling are not equal, and it scales no sphere");
                    }
                    None => Box::new(Scaled { region, by, about, axes }),
                }
            }
            single => check.single(single)?,
        })
    }
}

impl Shape {
    /// This sphere stretched along the axes; none for another shape or equal factors.
    fn stretched_sphere(&self, by: DVec3, about: DVec3, axes: usize) -> Option<StretchedSphere> {
        let Self::Sphere { center, radius } = self else { return None };
        let center = about + by * (center.0 - about);
        is_stretched(by, axes).then(|| StretchedSphere::new(center, by * *radius, axes))
    }
}

/// Whether scaling by these factors changes angles.
fn is_stretched(by: DVec3, axes: usize) -> bool {
    by.x != by.y || (axes == 3 && by.x != by.z)
}
