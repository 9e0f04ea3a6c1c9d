//! What slides of the contacts of two bodies, by the normal forces of their points.

use super::history::History;

/// Normal forces of the contacts of two bodies, N: all of them with friction, of those that slide, and of
/// those that have slid until this step and stick now.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::contact) struct Sliding {
    pub load: f64,
    pub slides: f64,
    pub caught: f64,
}

impl Sliding {
    /// Adds a contact, or a share of it.
    pub fn take_in(&mut self, share: f64, before: &History, now: &History) {
        let load = share * now.pressure;
        self.load += load;
        if now.slides {
            self.slides += load;
        } else if before.slides {
            self.caught += load;
        }
    }

    /// Adds those of others.
    pub fn add(&mut self, other: &Self) {
        self.load += other.load;
        self.slides += other.slides;
        self.caught += other.caught;
    }
}
