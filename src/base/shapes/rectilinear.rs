//! Whether the faces of a shape are parallel to those of its lattice.

use super::shape::Shape;
use crate::space::Vec3;

/// Components of directions below this share of the largest are round-off.
const SAME: f64 = 1e-9;

impl Shape {
    /// Whether all faces are perpendicular to an axis of the lattice, which turns with the shape if that is
    /// turned as a whole. Faces of meshes are taken to be oblique. A particle file has no lattice.
    pub fn is_rectilinear(&self) -> bool {
        match self {
            Self::Translate { shape, .. } | Self::Rotate { shape, .. } => shape.is_rectilinear(),
            Self::Scale { shape, by, .. } if by.0.x == by.0.y => shape.is_rectilinear(),
            Self::Points { .. } => true,
            _ => self.is_along_axes(),
        }
    }

    /// Whether all faces are perpendicular to one of the axes.
    fn is_along_axes(&self) -> bool {
        match self {
            Self::Box { .. } => true,
            Self::HalfSpace { normal, .. } => is_along_axis(*normal),
            Self::Polygon { points } | Self::Extrusion { polygon: points, .. } => {
                let next = points.iter().cycle().skip(1);
                let edge = |(a, b): (&(f64, f64), &(f64, f64))| Vec3::new(b.0 - a.0, b.1 - a.1, 0.0);
                points.iter().zip(next).map(edge).all(is_along_axis)
            }
            Self::Union(parts) | Self::Intersection(parts) => parts.iter().all(Self::is_along_axes),
            Self::Difference(whole, hole) => whole.is_along_axes() && hole.is_along_axes(),
            Self::Translate { shape, .. } | Self::Scale { shape, .. } => shape.is_along_axes(),
            _ => false,
        }
    }
}

fn is_along_axis(direction: Vec3) -> bool {
    let along = direction.0.abs();
    along.element_sum() - along.max_element() <= SAME * along.max_element()
}

#[cfg(test)]
mod tests {
    use crate::shapes::tests::shape;

    #[test]
    fn faces_along_the_axes_of_the_lattice_are_known() {
        let step = "Polygon(points: [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])";
        let turned = |shape: &str| format!("Rotate(shape: {shape}, angle_degrees: 20)");
        let boxes = "Difference(Box(min: (0, 0), max: (4, 4)), Translate(shape: Box(min: (1, 1), max: (3, 3)), by: (0, 0.5)))";
        let ball = "Sphere(center: (0, 0), radius: 1)";
        for (text, expected) in [
            (step.to_owned(), true),
            (boxes.to_owned(), true),
            (turned(boxes), true),
            (format!("Intersection([{boxes}, HalfSpace(point: (0, 1), normal: (0, -2))])"), true),
            ("Points(file: \"a.csv\")".to_owned(), true),
            (format!("Scale(shape: {}, by: (2, 1))", turned(step)), false),
            (format!("Union([{boxes}, {}])", turned(step)), false),
            ("Polygon(points: [(0, 0), (2, 0), (0, 1)])".to_owned(), false),
            (format!("Difference({boxes}, {ball})"), false),
            (format!("Intersection([{boxes}, HalfSpace(point: (0, 1), normal: (1, -2))])"), false),
            (ball.to_owned(), false),
        ] {
            assert_eq!(shape(&text).is_rectilinear(), expected, "{text}");
        }
    }
}
