//! A body: a contiguous range of rows of one phase, made of one material.

use std::ops::Range;

/// Index of a phase: the particles of one formulation, which share their columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PhaseId(pub usize);

/// Index of a body in the order of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(pub usize);

/// A body of the scene.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name in the scene.
    pub name: String,
    /// The phase whose rows it occupies.
    pub phase: PhaseId,
    /// Its rows.
    pub rows: Range<usize>,
    /// Distance of neighbouring particles, m.
    pub spacing: f64,
    /// Name of its material in the scene.
    pub material: String,
}

/// The bodies that a system or a plugin acts on, in scene order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BodySet(Vec<BodyId>);

impl BodySet {
    /// The set of the given bodies.
    pub fn new(bodies: impl IntoIterator<Item = BodyId>) -> Self {
        let mut bodies: Vec<_> = bodies.into_iter().collect();
        bodies.sort_unstable();
        bodies.dedup();
        Self(bodies)
    }

    /// Whether the body is in the set.
    pub fn contains(&self, body: BodyId) -> bool {
        self.0.binary_search(&body).is_ok()
    }

    /// The bodies in scene order.
    pub fn iter(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.0.iter().copied()
    }

    /// Whether no body is in the set.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
