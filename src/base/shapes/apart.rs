//! Whether two sets of points have none in common, by their signed distances alone.

use glam::DVec3;

use super::region::Aabb;

/// Halvings of a box along each axis. What is nearer to each other than the smallest boxes is undecided.
const HALVINGS: usize = 8;

/// Two sets of points, by signed distances \[m\] whose magnitudes never exceed the true ones.
pub(super) struct TwoSets<A, B> {
    pub first: A,
    pub second: B,
    /// Distance up to which they count as touching \[m\].
    pub margin: f64,
    pub axes: usize,
}

impl<A: Fn(DVec3) -> f64, B: Fn(DVec3) -> f64> TwoSets<A, B> {
    /// Whether they certainly have no point of this box in common.
    pub fn are_apart(&self, within: &Aabb) -> bool {
        within.is_bounded() && self.are_apart_in(within, HALVINGS * self.axes)
    }

    fn are_apart_in(&self, within: &Aabb, halvings: usize) -> bool {
        let (center, reach) = (within.center(), 0.5 * within.extent().length() + self.margin);
        let first = (self.first)(center);
        if first > reach {
            return true;
        }
        let second = (self.second)(center);
        if second > reach {
            return true;
        }
        if halvings == 0 || first.max(second) <= 0.0 {
            return false;
        }
        let axis = longest(within.extent());
        let (mut low, mut high) = (*within, *within);
        low.max[axis] = center[axis];
        high.min[axis] = center[axis];
        [low, high].iter().all(|half| self.are_apart_in(half, halvings - 1))
    }
}

/// The axis of the largest extent.
fn longest(extent: DVec3) -> usize {
    let larger = |a: usize, b: usize| if extent[b] > extent[a] { b } else { a };
    larger(larger(0, 1), 2)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::shape::Shape;
    use crate::space::Dimension::{self, Three, Two};

    /// Whether it has a surface with known nearest points.
    fn has_surface(text: &str, dimension: Dimension) -> bool {
        let shape: Shape = ron::from_str(text).expect("a shape");
        shape.surface(dimension, Path::new(""), "shape").is_ok()
    }

    /// A ball of radius 1 with a cavity 0.52 from its centre, so that the box around the cavity comes out.
    fn bored(radius: f64) -> String {
        format!(
            "Difference(Sphere(center: (1, 0, 0), radius: 1), Sphere(center: (1.3, 0.3, 0.3), radius: {radius}))"
        )
    }

    #[test]
    fn a_cavity_is_inside_though_the_box_around_it_is_not() {
        let reach = 0.27_f64.sqrt();
        assert!(has_surface(&bored(0.98 - reach), Three));
        assert!(!has_surface(&bored(1.02 - reach), Three));
        assert!(has_surface(
            "Difference(Sphere(center: (0, 0, 0), radius: 1), Sphere(center: (0, 0, 0), radius: 0.97))",
            Three
        ));
        assert!(has_surface(
            "Difference(Sphere(center: (0, 0), radius: 1), Sphere(center: (0.4, 0), radius: 0.55))",
            Two
        ));
        assert!(!has_surface(
            "Difference(Sphere(center: (0, 0), radius: 1), Sphere(center: (0.5, 0), radius: 0.55))",
            Two
        ));
        let turned = "Rotate(shape: Box(min: (-0.5, -0.5), max: (0.5, 0.5)), angle_degrees: 45)";
        assert!(has_surface(&format!("Difference(Sphere(center: (0, 0), radius: 0.75), {turned})"), Two));
        assert!(!has_surface(&format!("Difference(Sphere(center: (0, 0), radius: 0.7), {turned})"), Two));
    }

    #[test]
    fn parts_are_apart_though_the_boxes_around_them_are_not() {
        let pair = |x: f64| {
            format!("Union([Sphere(center: (0, 0), radius: 1), Sphere(center: ({x}, {x}), radius: 1)])")
        };
        assert!(has_surface(&pair(1.44), Two) && !has_surface(&pair(1.41), Two));
        let cup = |y: f64| {
            format!(
                "Union([Ring(center: (0, 0), inner: 1, outer: 2), Sphere(center: (0, {y}), radius: 0.5)])"
            )
        };
        assert!(has_surface(&cup(0.45), Two) && !has_surface(&cup(0.55), Two));
    }
}
