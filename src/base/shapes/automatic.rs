//! The lattice of a body in a scene with a fluid, where the scene states none.
//!
//! What a fluid meets are the particles. Where a face does not lie between two layers of a lattice, the flow
//! sees it up to half a spacing elsewhere; oblique and curved faces are stairs, which brake it.

use super::cavity::MISFIT;
use super::fill::{Filling, is_uniform};
use super::lattice::Lattice;
use super::region::Region;
use super::rings::Rings;
use super::shape::Shape;
use crate::space::Vec3;

/// Components of directions below this share of the largest are round-off.
const SAME: f64 = 1e-9;

/// Coordinates of the faces that are perpendicular to each axis \[m\].
type Faces = [Vec<f64>; 3];

impl Filling<'_> {
    /// This filling with the lattice that `Automatic` stands for, for a body in a scene with a fluid.
    #[must_use]
    pub fn beside_fluid(self, shape: &Shape) -> Self {
        let lattice = if self.lattice == Lattice::Automatic { self.fitting(shape) } else { self.lattice };
        Self { lattice, ..self }
    }

    fn fitting(&self, shape: &Shape) -> Lattice {
        match shape {
            // The lattice moves with the shape.
            Shape::Translate { shape, .. } | Shape::Rotate { shape, .. } => return self.fitting(shape),
            Shape::Scale { shape, by, .. } if is_uniform(shape, by.0, self.dimension) && by.0.x > 0.0 => {
                return Filling { spacing: self.spacing / by.0.x, ..*self }.fitting(shape);
            }
            Shape::Points { .. } => return Lattice::Regular,
            // Its file need not be read for that.
            Shape::Mesh { .. } => return Lattice::body_fitted(),
            _ => {}
        }
        // What is wrong with the shape is found when it is filled.
        let Ok(region) = shape.region(self.dimension, self.folder, "shape") else { return Lattice::Regular };
        let mut faces = Faces::default();
        if shape.add_faces(&mut faces) {
            let is_regular = self.ends_at(&faces, region.as_ref());
            return if is_regular { Lattice::Regular } else { Lattice::body_fitted() };
        }
        // Shells about a centre are less even than what fits a ball of a few spacings: grains of that kind in
        // an abrasive flow made the shift of the fluid supply energy.
        match region.rings() {
            Some(Rings::Plane { .. } | Rings::Axial { .. }) => Lattice::Concentric,
            _ => Lattice::body_fitted(),
        }
    }

    /// Whether cells of the regular lattice end at all faces inside the bounds of the region.
    fn ends_at(&self, faces: &Faces, region: &dyn Region) -> bool {
        if self.is_wall && region.wall_frame(self.spacing).is_some() {
            return true;
        }
        let (frame, bounds) = (region.frame(), region.bounds());
        (0..self.dimension.count()).all(|k| {
            let side = frame.max[k] - frame.min[k];
            let cell = side / (side / self.spacing).round().max(1.0);
            let inside = |face: &&f64| **face > bounds.min[k] && **face < bounds.max[k];
            faces[k].iter().filter(inside).all(|face| {
                let cells = (face - frame.min[k]) / cell;
                (cells - cells.round()).abs() < MISFIT
            })
        })
    }
}

impl Shape {
    /// Appends the coordinates of all faces, and returns true if each is perpendicular to an axis.
    fn add_faces(&self, faces: &mut Faces) -> bool {
        match self {
            Self::Box { min, max } => {
                (0..3).for_each(|k| faces[k].extend([min.0[k], max.0[k]]));
                true
            }
            Self::HalfSpace { point, normal } => {
                let Some(k) = axis_of(*normal) else { return false };
                faces[k].push(point.0[k]);
                true
            }
            Self::Polygon { points } => add_edges(points, faces),
            Self::Extrusion { polygon, from, to } => {
                faces[2].extend([from, to]);
                add_edges(polygon, faces)
            }
            Self::Union(parts) | Self::Intersection(parts) => parts.iter().all(|part| part.add_faces(faces)),
            Self::Difference(whole, hole) => whole.add_faces(faces) && hole.add_faces(faces),
            Self::Translate { shape, by } => add_mapped(shape, faces, |k, face| face + by.0[k]),
            Self::Scale { shape, by, about } => {
                add_mapped(shape, faces, |k, face| about.0[k] + by.0[k] * (face - about.0[k]))
            }
            _ => false,
        }
    }
}

fn add_mapped(shape: &Shape, faces: &mut Faces, to: impl Fn(usize, f64) -> f64) -> bool {
    let mut own = Faces::default();
    let all = shape.add_faces(&mut own);
    (0..3).for_each(|k| faces[k].extend(own[k].iter().map(|&face| to(k, face))));
    all
}

fn add_edges(points: &[(f64, f64)], faces: &mut Faces) -> bool {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).all(|(a, b)| {
        let Some(along) = axis_of(Vec3::new(b.0 - a.0, b.1 - a.1, 0.0)) else { return false };
        let (across, place) = if along == 0 { (1, a.1) } else { (0, a.0) };
        faces[across].push(place);
        true
    })
}

/// The axis along which a direction is.
fn axis_of(direction: Vec3) -> Option<usize> {
    let along = direction.0.abs();
    let (k, largest) = (0..3).map(|k| (k, along[k])).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (along.element_sum() - largest <= SAME * largest).then_some(k)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::shapes::tests::shape;
    use crate::space::Dimension;

    fn chosen(text: &str, is_wall: bool) -> Lattice {
        let folder = Path::new(".");
        let (lattice, dimension, spacing) = (Lattice::Automatic, Dimension::Two, 0.1);
        Filling { lattice, spacing, dimension, folder, limit: 1000, is_wall }
            .beside_fluid(&shape(text))
            .lattice
    }

    const TANK: &str = "Difference(Box(min: (-0.43, -0.43), max: (4.3, 2)), Box(min: (0, 0), max: (4, 3)))";
    const BALL: &str = "Sphere(center: (0, 0), radius: 1)";

    #[test]
    fn boxes_whose_faces_lie_between_two_layers_are_regular() {
        let step = "Polygon(points: [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])";
        let hole = |x: f64| {
            format!(
                "Difference(Box(min: (0, 0), max: (4, 4)), Translate(shape: Box(min: (1, 1), max: (3, 3)), by: ({x}, 0.6)))"
            )
        };
        let turned = |shape: &str| format!("Rotate(shape: {shape}, angle_degrees: 20)");
        for text in [
            step,
            "Box(min: (0, 0), max: (1.234, 0.777))",
            &hole(0.3),
            &turned(&hole(0.3)),
            &format!("Scale(shape: {}, by: (0.5, 0.5))", hole(0.4)),
            &format!("Intersection([{}, HalfSpace(point: (0, 1.2), normal: (0, -2))])", hole(0.3)),
        ] {
            assert_eq!(chosen(text, false), Lattice::Regular, "{text}");
        }
        for text in [
            &hole(0.33),
            &turned(&hole(0.35)),
            &format!("Scale(shape: {}, by: (0.5, 0.5))", hole(0.3)),
            &format!("Scale(shape: {}, by: (2, 1))", turned(step)),
            &format!("Union([{step}, {}])", turned(step)),
            "Polygon(points: [(0, 0), (2, 0), (0, 1)])",
            &format!("Difference({step}, {BALL})"),
            &format!("Intersection([{step}, HalfSpace(point: (0, 1), normal: (1, -2))])"),
        ] {
            assert_eq!(chosen(text, false), Lattice::body_fitted(), "{text}");
        }
    }

    #[test]
    fn discs_have_rings_and_walls_cells_that_end_at_their_cavities() {
        assert_eq!(chosen(BALL, false), Lattice::Concentric);
        assert_eq!(
            chosen("Difference(Sphere(center: (0, 0), radius: 2), Sphere(center: (0, 0), radius: 1))", true),
            Lattice::Concentric
        );
        let column = "Cylinder(from: (0, 0, 0), to: (0, 0, 1), radius: 1)";
        let folder = Path::new(".");
        let filling = Filling {
            lattice: Lattice::Automatic,
            spacing: 0.1,
            dimension: Dimension::Three,
            folder,
            limit: 1_000_000,
            is_wall: false,
        };
        let of =
            |by: &str| filling.beside_fluid(&shape(&format!("Scale(shape: {column}, by: {by})"))).lattice;
        assert_eq!([of("(2, 2, 2)"), of("(1, 1, 2)")], [Lattice::Concentric, Lattice::body_fitted()]);
        assert_eq!(chosen(TANK, true), Lattice::Regular);
        assert_eq!(chosen(TANK, false), Lattice::body_fitted());
    }
}
