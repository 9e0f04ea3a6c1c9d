//! How the springs of the vertices of a skin on a tool began.
//!
//! Points of the skin carry no history, so that a facet can change its rule. What a contact keeps from its
//! first step on belongs to the vertices, and points have the mean of those of their facet.

use super::points::ToolView;

/// In the place of an onset while a vertex does not touch.
const OUTSIDE: f64 = -1.0;

/// Depth over which the spring of every vertex of a skin begins, m: its way in the step in which it touched.
pub(in crate::contact) struct Onsets(Vec<f64>);

impl Onsets {
    /// Of that many vertices that do not touch yet.
    pub fn new(vertices: usize) -> Self {
        Self(vec![OUTSIDE; vertices])
    }

    /// Sets the onsets of vertices of these numbers, which so far are those of springs that begin in this
    /// step, to what they were when the contact began.
    pub(super) fn keep(&mut self, numbers: &[u32], seen: &mut [ToolView]) {
        for (&number, seen) in numbers.iter().zip(seen) {
            let kept = &mut self.0[number as usize];
            if seen.distance < 0.0 && *kept >= 0.0 {
                seen.onset = *kept;
            } else {
                *kept = if seen.distance < 0.0 { seen.onset } else { OUTSIDE };
            }
        }
    }

    /// State in a checkpoint: the vertices that touch.
    pub fn saved(&self) -> Vec<(u32, f64)> {
        (0..)
            .zip(&self.0)
            .filter(|(_, onset)| **onset >= 0.0)
            .map(|(vertex, onset)| (vertex, *onset))
            .collect()
    }

    /// Restores it; says whether it fits the skin.
    pub fn restore(&mut self, saved: &[(u32, f64)]) -> bool {
        self.0.fill(OUTSIDE);
        saved.iter().all(|&(vertex, onset)| {
            let own = self.0.get_mut(vertex as usize);
            own.map(|own| *own = onset).is_some()
        })
    }
}
