//! Integration points of facets, with equal weights.

/// Points of a facet, by their shares of its vertices; each represents the same part of it.
#[derive(Clone, Debug)]
pub(crate) struct QuadratureRule {
    points: Vec<[f64; 3]>,
}

impl QuadratureRule {
    /// Points that are exact for squares of linear functions: two Gauss points of a segment, three points of
    /// a triangle.
    pub fn exact(axes: usize) -> Self {
        if axes == 2 {
            let low = 0.5 - 0.5 / 3f64.sqrt();
            return Self { points: vec![[1.0 - low, low, 0.0], [low, 1.0 - low, 0.0]] };
        }
        let (near, far) = (2.0 / 3.0, 1.0 / 6.0);
        Self { points: vec![[near, far, far], [far, near, far], [far, far, near]] }
    }

    /// The middles of `parts` equal parts of a segment, or of the triangles of `parts` rows into which a
    /// triangle is cut.
    pub fn fine(axes: usize, parts: usize) -> Self {
        let n = parts as f64;
        if axes == 2 {
            let at = |k: usize| (k as f64 + 0.5) / n;
            return Self { points: (0..parts).map(|k| [1.0 - at(k), at(k), 0.0]).collect() };
        }
        let mut points = Vec::new();
        for i in 0..parts {
            for j in 0..parts - i {
                let middle = |third: f64| {
                    let (u, v) = ((i as f64 + third) / n, (j as f64 + third) / n);
                    [1.0 - u - v, u, v]
                };
                points.push(middle(1.0 / 3.0));
                if i + j + 1 < parts {
                    points.push(middle(2.0 / 3.0));
                }
            }
        }
        Self { points }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The shares of the vertices at a point.
    pub fn shares(&self, point: usize) -> [f64; 3] {
        self.points[point]
    }
}
