//! The parts of a union in a tree of boxes, so that of many parts a query looks at those near a point alone.

use glam::DVec3;

use super::region::Aabb;

/// Parts of a leaf.
const LEAF: usize = 4;

/// A tree of the boxes around the parts of a union.
pub(super) struct UnionTree {
    /// Numbers of the parts, in the order of the leaves.
    parts: Vec<u32>,
    /// The first one is the root.
    nodes: Vec<PartsNode>,
}

struct PartsNode {
    bounds: Aabb,
    /// Where its parts are in the order of the leaves.
    first: u32,
    end: u32,
    /// The second of its two halves; the first one follows the node. Zero for a leaf.
    second: u32,
}

impl UnionTree {
    /// The tree of parts with these bounds.
    pub fn new(bounds: &[Aabb]) -> Self {
        let mut tree = Self { parts: (0..bounds.len() as u32).collect(), nodes: Vec::new() };
        tree.divide(bounds, 0, bounds.len());
        tree
    }

    /// The box around all parts.
    pub fn bounds(&self) -> Aabb {
        self.nodes[0].bounds
    }

    /// Adds the node of some parts, and those below it.
    fn divide(&mut self, bounds: &[Aabb], first: usize, end: usize) {
        let own = &self.parts[first..end];
        let around = own.iter().map(|&part| bounds[part as usize]);
        let around = around.reduce(|all, bounds| all.union(&bounds)).unwrap_or(Aabb::around([]));
        let number = self.nodes.len();
        self.nodes.push(PartsNode { bounds: around, first: first as u32, end: end as u32, second: 0 });
        if end - first <= LEAF {
            return;
        }
        let middle = |part: &u32| {
            let center = bounds[*part as usize].center();
            // Half-spaces have none.
            if center.is_finite() { center } else { DVec3::ZERO }
        };
        let middles = Aabb::around(own.iter().map(middle));
        let axis =
            (0..3).fold(
                0,
                |widest, axis| {
                    if middles.extent()[axis] > middles.extent()[widest] { axis } else { widest }
                },
            );
        let half = (end - first) / 2;
        let order = |a: &u32, b: &u32| middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(b));
        self.parts[first..end].select_nth_unstable_by(half, order);
        self.divide(bounds, first, first + half);
        self.nodes[number].second = self.nodes.len() as u32;
        self.divide(bounds, first + half, end);
    }

    /// The smallest of the distances of a point from the parts, m, which `distance` gives by their number: no
    /// part is nearer than its box.
    pub fn smallest(&self, point: DVec3, distance: impl Fn(usize) -> f64) -> f64 {
        let mut smallest = f64::INFINITY;
        self.look(0, point, &distance, &mut smallest);
        smallest
    }

    fn look(&self, number: usize, point: DVec3, distance: &impl Fn(usize) -> f64, smallest: &mut f64) {
        let node = &self.nodes[number];
        if node.second == 0 {
            for &part in &self.parts[node.first as usize..node.end as usize] {
                *smallest = smallest.min(distance(part as usize));
            }
            return;
        }
        let half = |number: usize| (self.nodes[number].bounds.gap(point), number);
        // By number: a mapped array would be called.
        let halves = [half(number + 1), half(node.second as usize)];
        let nearer = usize::from(halves[1].0 < halves[0].0);
        for (gap, half) in [halves[nearer], halves[1 - nearer]] {
            // Beyond a face of the box, a part is at least as far as that; inside all may be nearest.
            if gap <= 0.0 || gap < *smallest {
                self.look(half, point, distance, smallest);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::shapes::Shape;
    use crate::space::Dimension;
    use glam::DVec3;

    #[test]
    fn the_distance_from_many_parts_is_the_smallest_of_theirs() {
        let part = |k: usize| {
            let at = |step: usize| (k * step % 17) as f64;
            match k % 3 {
                0 => format!("Sphere(center: ({}, {}), radius: {})", at(5), at(11), 0.3 + 0.02 * k as f64),
                1 => format!("Box(min: ({0}, {1}), max: ({0}.7, {1}.4))", at(3), at(7)),
                _ => format!("Ring(center: ({}, {}), inner: 0.5, outer: 0.8)", at(13), at(2)),
            }
        };
        let region = |text: &str| {
            let shape: Shape = ron::from_str(text).expect("a shape");
            shape
                .region(Dimension::Two, std::path::Path::new(""), "shape")
                .unwrap_or_else(|_| panic!("{text}"))
        };
        let texts: Vec<String> = (0..50).map(part).collect();
        let whole = region(&format!("Union([{}])", texts.join(", ")));
        let parts: Vec<_> = texts.iter().map(|text| region(text)).collect();
        for k in 0..3000 {
            let point = DVec3::new((k * 37 % 211) as f64 * 0.1 - 2.0, (k * 59 % 197) as f64 * 0.1 - 1.5, 0.0);
            let smallest = |of: &dyn Fn(usize) -> f64| (0..50).map(of).fold(f64::INFINITY, f64::min);
            assert_eq!(whole.distance(point), smallest(&|k| parts[k].distance(point)), "{point}");
            assert_eq!(whole.clearance(point), smallest(&|k| parts[k].clearance(point)), "{point}");
        }
    }
}
