//! A bounding-volume hierarchy of triangles, for the nearest triangle and for those in a box.

use glam::DVec3;

use crate::shapes::region::Aabb;

/// Maximum number of triangles of a leaf.
const LEAF: usize = 4;

/// A node of the hierarchy: the bounding box of its two children, or of a few triangles.
struct BoxNode {
    bounds: Aabb,
    /// First triangle in `order` for a leaf, else the index of the second child; the first child is the next
    /// node.
    start: u32,
    /// Number of triangles of a leaf; 0 for an inner node.
    count: u32,
}

/// A hierarchy of bounding boxes, split at the median triangle along the longest side, so that its depth is
/// the logarithm of the number of triangles.
pub(super) struct Tree {
    nodes: Vec<BoxNode>,
    /// Indices of triangles, by leaf.
    order: Vec<u32>,
}

impl Tree {
    /// A tree over at least one box.
    pub fn new(boxes: &[Aabb]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect() };
        tree.split(boxes, 0, boxes.len());
        tree
    }

    fn split(&mut self, boxes: &[Aabb], start: usize, end: usize) {
        let of = |n: &u32| boxes[*n as usize];
        let first = of(&self.order[start]);
        let bounds = self.order[start..end].iter().fold(first, |all, n| all.union(&of(n)));
        let node = self.nodes.len();
        self.nodes.push(BoxNode { bounds, start: start as u32, count: (end - start) as u32 });
        if end - start <= LEAF {
            return;
        }
        let sides = bounds.extent();
        let axis = (0..3).fold(0, |longest, k| if sides[k] > sides[longest] { k } else { longest });
        let middle = (start + end) / 2;
        let key = |n: &u32| of(n).min[axis] + of(n).max[axis];
        self.order[start..end]
            .select_nth_unstable_by(middle - start, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        self.split(boxes, start, middle);
        self.nodes[node].start = self.nodes.len() as u32;
        self.nodes[node].count = 0;
        self.split(boxes, middle, end);
    }

    /// Calls `visit` for triangles that may be nearer to `point` than the squared distance returned by
    /// `visit`, near boxes first.
    pub fn nearest(&self, point: DVec3, mut visit: impl FnMut(u32) -> f64) {
        let square = |node: u32| {
            let bounds = &self.nodes[node as usize].bounds;
            point.distance_squared(point.clamp(bounds.min, bounds.max))
        };
        let mut least = f64::INFINITY;
        // The stack has two entries per level, of which there are at most 32.
        let mut stack = [(0u32, 0.0f64); 64];
        let mut len = 1;
        while len > 0 {
            len -= 1;
            let (number, distance) = stack[len];
            if distance > least {
                continue;
            }
            let node = &self.nodes[number as usize];
            let start = node.start as usize;
            for &triangle in &self.order[start..start + node.count as usize] {
                least = visit(triangle);
            }
            if node.count == 0 {
                let children = [number + 1, node.start];
                let [first, second] = children.map(square);
                let order = if first <= second { [1, 0] } else { [0, 1] };
                for k in order {
                    stack[len] = (children[k], [first, second][k]);
                    len += 1;
                }
            }
        }
    }

    /// Calls `visit` for the triangles of leaves that intersect `bounds`.
    pub fn touching(&self, bounds: &Aabb, mut visit: impl FnMut(u32)) {
        let mut stack = vec![0u32];
        while let Some(number) = stack.pop() {
            let node = &self.nodes[number as usize];
            if !node.bounds.touches(bounds) {
                continue;
            }
            let start = node.start as usize;
            self.order[start..start + node.count as usize].iter().for_each(|&triangle| visit(triangle));
            if node.count == 0 {
                stack.extend([node.start, number + 1]);
            }
        }
    }
}
