//! The part of a facet that is selected, where the selected part of a surface ends within the facet.

use glam::DVec3;

use crate::shapes::{Facets, Region};

/// Cells along a side of a facet; a border through a cell is a straight line between its crossings.
const CELLS: usize = 4;
/// Bisections of the crossing of a border.
const BISECTIONS: usize = 40;
/// Share of a facet below which none of it is selected.
const NOTHING: f64 = 1e-9;

/// A facet, or a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SelectedFacet {
    pub facet: u32,
    /// Share of its area that is selected \[1\].
    pub share: f64,
    /// Barycentric coordinates of the middle of this part: the shares of the corners in a load on it \[1\].
    pub weights: DVec3,
}

impl SelectedFacet {
    /// The part of a facet within a region, all of it without one; none if they have nothing in common.
    pub fn new(facet: u32, facets: &Facets, within: Option<&dyn Region>) -> Option<Self> {
        let corners = facets.corners[facet as usize].map(|k| facets.points[k as usize]);
        let (cells, middle) = match facets.axes {
            2 => (segments(), DVec3::new(0.5, 0.5, 0.0)),
            _ => (triangles(), DVec3::splat(1.0 / 3.0)),
        };
        let whole = Self { facet, share: 1.0, weights: middle };
        let Some(region) = within else { return Some(whole) };
        let place = |b: DVec3| b.x * corners[0] + b.y * corners[1] + b.z * corners[2];
        let is_inside = |b: DVec3| region.contains(place(b));
        if cells.iter().flatten().all(|b| is_inside(*b)) {
            return Some(whole);
        }
        let (mut share, mut moment) = (0.0, DVec3::ZERO);
        for cell in &cells {
            let (part, middle) = measure(&clip(cell, is_inside));
            share += part;
            moment += part * middle;
        }
        (share > NOTHING).then(|| Self { facet, share, weights: moment / share })
    }

    /// The middle of this part, m.
    pub fn middle(&self, facets: &Facets) -> DVec3 {
        let [a, b, c] = facets.corners[self.facet as usize].map(|k| facets.points[k as usize]);
        self.weights.x * a + self.weights.y * b + self.weights.z * c
    }
}

/// A segment in pieces, in barycentric coordinates.
fn segments() -> Vec<Vec<DVec3>> {
    let at = |k: usize| {
        let s = k as f64 / CELLS as f64;
        DVec3::new(1.0 - s, s, 0.0)
    };
    (0..CELLS).map(|k| vec![at(k), at(k + 1)]).collect()
}

/// A triangle in smaller ones, in barycentric coordinates.
fn triangles() -> Vec<Vec<DVec3>> {
    let at = |i: usize, j: usize| {
        let (s, t) = (i as f64 / CELLS as f64, j as f64 / CELLS as f64);
        DVec3::new(1.0 - s - t, s, t)
    };
    let mut cells = Vec::new();
    for i in 0..CELLS {
        for j in 0..CELLS - i {
            cells.push(vec![at(i, j), at(i + 1, j), at(i, j + 1)]);
            if i + j + 1 < CELLS {
                cells.push(vec![at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    cells
}

/// The corners of the part of a cell that is inside.
fn clip(cell: &[DVec3], is_inside: impl Fn(DVec3) -> bool) -> Vec<DVec3> {
    let sides = if cell.len() == 2 { 1 } else { cell.len() };
    let mut part = Vec::new();
    for k in 0..sides {
        let (from, to) = (cell[k], cell[(k + 1) % cell.len()]);
        let (starts, ends) = (is_inside(from), is_inside(to));
        if starts {
            part.push(from);
        }
        if starts != ends {
            part.push(crossing(if starts { [from, to] } else { [to, from] }, &is_inside));
        }
        if sides == 1 && ends {
            part.push(to);
        }
    }
    part
}

/// Where the border crosses the way from a point inside to one outside.
fn crossing([mut inside, mut outside]: [DVec3; 2], is_inside: impl Fn(DVec3) -> bool) -> DVec3 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (inside + outside);
        *(if is_inside(middle) { &mut inside } else { &mut outside }) = middle;
    }
    inside
}

/// Share of a part in the facet, and its middle.
fn measure(part: &[DVec3]) -> (f64, DVec3) {
    match part {
        [] | [_] => (0.0, DVec3::ZERO),
        [from, to] => ((to.y - from.y).abs(), 0.5 * (*from + *to)),
        [first, rest @ ..] => {
            let (mut share, mut moment) = (0.0, DVec3::ZERO);
            for pair in rest.windows(2) {
                let (u, v) = (pair[0] - *first, pair[1] - *first);
                let area = (u.y * v.z - u.z * v.y).abs();
                share += area;
                moment += area / 3.0 * (*first + pair[0] + pair[1]);
            }
            (share, if share > 0.0 { moment / share } else { *first })
        }
    }
}
