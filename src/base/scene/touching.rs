//! The pairs of bodies of a scene that have a contact.

/// The pairs of bodies that have a contact, by their names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TouchingPairs(Vec<(String, String)>);

impl TouchingPairs {
    /// These pairs.
    pub const fn new(pairs: Vec<(String, String)>) -> Self {
        Self(pairs)
    }

    /// Whether there is a contact between two bodies, or of one with itself.
    pub fn has(&self, a: &str, b: &str) -> bool {
        self.partners(a).any(|partner| partner == b)
    }

    /// Whether a body has any contact.
    pub fn names(&self, body: &str) -> bool {
        self.partners(body).next().is_some()
    }

    /// The bodies with which a body has a contact; itself if it has contact with itself.
    pub fn partners<'a>(&'a self, body: &'a str) -> impl Iterator<Item = &'a str> {
        self.0.iter().filter_map(move |(one, other)| match () {
            () if one == body => Some(other.as_str()),
            () if other == body => Some(one.as_str()),
            () => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_have_no_order() {
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        let touching = TouchingPairs(vec![pair("ball", "floor"), pair("ball", "ball"), pair("wall", "ball")]);
        assert!(
            touching.has("floor", "ball") && touching.has("ball", "wall") && touching.has("ball", "ball")
        );
        assert!(!touching.has("floor", "wall") && !touching.has("floor", "floor"));
        assert!(touching.names("wall") && !touching.names("roof"));
        assert_eq!(touching.partners("ball").collect::<Vec<_>>(), ["floor", "ball", "wall"]);
    }
}
