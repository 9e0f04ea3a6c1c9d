//! The pairs of bodies of a scene that have a contact.

use std::collections::BTreeMap;

/// The pairs of bodies that have a contact: by the name of each body those of its partners.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TouchingPairs(BTreeMap<String, Vec<String>>);

impl TouchingPairs {
    /// These pairs.
    pub fn new(pairs: Vec<(String, String)>) -> Self {
        let mut partners: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for (one, other) in pairs {
            if one != other {
                partners.entry(other.clone()).or_default().push(one.clone());
            }
            partners.entry(one).or_default().push(other);
        }
        Self(partners)
    }

    /// Whether there is a contact between two bodies, or of one with itself.
    pub fn has(&self, a: &str, b: &str) -> bool {
        self.partners(a).any(|partner| partner == b)
    }

    /// Whether a body has any contact.
    pub fn names(&self, body: &str) -> bool {
        self.0.contains_key(body)
    }

    /// The bodies with which a body has a contact; itself if it has contact with itself.
    pub fn partners(&self, body: &str) -> impl Iterator<Item = &str> {
        self.0.get(body).into_iter().flatten().map(String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_have_no_order() {
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        let touching =
            TouchingPairs::new(vec![pair("ball", "floor"), pair("ball", "ball"), pair("wall", "ball")]);
        assert!(
            touching.has("floor", "ball") && touching.has("ball", "wall") && touching.has("ball", "ball")
        );
        assert!(!touching.has("floor", "wall") && !touching.has("floor", "floor"));
        assert!(touching.names("wall") && !touching.names("roof"));
        assert_eq!(touching.partners("ball").collect::<Vec<_>>(), ["floor", "ball", "wall"]);
    }
}
