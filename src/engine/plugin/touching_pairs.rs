//! The pairs of bodies of a scene that have a contact.

use crate::world::BodyId;

/// The pairs of bodies that have a contact: of each body its partners, ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TouchingPairs(Vec<Vec<BodyId>>);

impl TouchingPairs {
    /// These pairs of so many bodies.
    pub fn new(bodies: usize, pairs: impl Iterator<Item = [BodyId; 2]>) -> Self {
        let mut partners = vec![Vec::new(); bodies];
        for [one, other] in pairs {
            partners[one.0].push(other);
            partners[other.0].push(one);
        }
        for partners in &mut partners {
            partners.sort_unstable();
            partners.dedup();
        }
        Self(partners)
    }

    /// Whether there is a contact between two bodies, or of one with itself.
    pub fn has(&self, a: BodyId, b: BodyId) -> bool {
        self.0[a.0].binary_search(&b).is_ok()
    }

    /// Whether a body has any contact.
    pub fn names(&self, body: BodyId) -> bool {
        !self.0[body.0].is_empty()
    }

    /// The bodies with which a body has a contact; itself if it has contact with itself.
    pub fn partners(&self, body: BodyId) -> &[BodyId] {
        &self.0[body.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_have_no_order() {
        let [ball, floor, wall, roof] = [0, 1, 2, 3].map(BodyId);
        let touching = TouchingPairs::new(4, [[ball, floor], [ball, ball], [wall, ball]].into_iter());
        assert!(touching.has(floor, ball) && touching.has(ball, wall) && touching.has(ball, ball));
        assert!(!touching.has(floor, wall) && !touching.has(floor, floor));
        assert!(touching.names(wall) && !touching.names(roof));
        assert_eq!(touching.partners(ball), [ball, floor, wall]);
    }
}
