//! The nodes with which a rigid body touches others.

use std::collections::BTreeSet;

use glam::DVec3;

use super::faces::{NEAR, NearestFaces};
use super::inertia::sphere_of;
use super::outline::Outline;
use super::round::Round;
use crate::shapes::{Shape, Site, Surface};
use crate::space::Dimension;

/// Cosine of the angle between two normals above which two faces do not touch: some 96 degrees.
const ACROSS: f64 = -0.1;
/// Length of an edge that counts as a point, over the spacing.
const SHORT: f64 = 0.5;

/// The part of a surface that a node is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    /// A corner, or a round outline.
    Corner,
    /// An edge along that unit vector.
    Edge(DVec3),
    /// A face with that outward normal.
    Face(DVec3),
}

/// A place at which a rigid body touches others.
#[derive(Clone, Copy, Debug)]
pub struct RigidNode {
    /// The place in the reference configuration, m.
    pub point: DVec3,
    /// What it is of, in the reference configuration.
    pub feature: Feature,
    /// Shape of the node.
    pub round: Round,
    /// Length that it represents, m.
    pub size: f64,
    /// Outward normals of the flat faces that end at a point of an edge or a corner, or at a circle, zero
    /// where there are fewer.
    pub ending: [DVec3; 4],
}

impl RigidNode {
    /// Radius of a round node, the smallest one of an ellipsoid, else zero, m.
    pub fn radius(&self) -> f64 {
        match self.round {
            Round::Point | Round::Edge(_) => 0.0,
            Round::Ball(radius) => radius,
            Round::Rim(rim) => rim.radius,
            Round::Ellipsoid(ellipsoid) => ellipsoid.extremes()[0],
        }
    }

    /// How far from its place it may touch, m.
    pub fn reach(&self) -> f64 {
        match self.round {
            Round::Edge(half) => half.length(),
            Round::Ellipsoid(ellipsoid) => ellipsoid.extremes()[1],
            Round::Point | Round::Ball(_) | Round::Rim(_) => self.radius(),
        }
    }

    /// How far the body reaches from its place, m.
    pub fn extent(&self) -> f64 {
        match self.round {
            Round::Ellipsoid(_) => self.reach(),
            Round::Point | Round::Edge(_) | Round::Ball(_) | Round::Rim(_) => self.radius(),
        }
    }

    /// Whether the surface there may touch one of that outward normal, in the reference configuration: a face
    /// does not touch what stands across it. Where the corner of another body passes a point of a face, the
    /// nearest surface of that body is for a moment the side beside the corner.
    pub fn faces(&self, normal: DVec3) -> bool {
        match self.feature {
            Feature::Face(own) => own.dot(normal) < ACROSS,
            Feature::Corner | Feature::Edge(_) => true,
        }
    }

    /// Whether it is the circle at an end of a cylinder.
    pub fn is_end(&self) -> bool {
        matches!(self.round, Round::Rim(_)) && self.ending[0] != DVec3::ZERO
    }

    /// Whether it is a point of a face, neither of an edge nor of something round.
    pub fn is_of_face(&self) -> bool {
        matches!(self.feature, Feature::Face(_))
    }
}

/// The contact nodes of a rigid body on the surfaces of other rigid bodies; round ones come first.
#[derive(Clone, Debug)]
pub struct Nodes {
    list: Vec<RigidNode>,
    outline: Option<Outline>,
}

impl Nodes {
    /// The centre of a sphere or disc. Of other shapes circles where the outline is round, and elsewhere
    /// points on sharp edges and corners, the outermost particles, moved to the surface, beside corners to
    /// all their faces, and in three dimensions the edges themselves.
    pub(super) fn new(
        shape: &Shape,
        surface: &dyn Surface,
        sites: &[Site],
        spacing: f64,
        dimension: Dimension,
    ) -> Self {
        let outline = Outline::of(shape, dimension);
        if let Some((center, radius)) = sphere_of(shape) {
            let ball = node(center, Feature::Corner, Round::Ball(radius), 2.0 * radius);
            return Self { list: vec![ball], outline };
        }
        let mut list = outline.map_or_else(Vec::new, |outline| round_nodes(&outline, spacing));
        let is_round = |x: DVec3| outline.is_some_and(|outline| outline.holds(x));
        let edges = surface.edges(spacing);
        let on_edges = along(&edges, spacing).into_iter().filter(|&(x, _)| !is_round(x));
        let faces = NearestFaces::new(surface, spacing, dimension);
        list.extend(on_edges.map(|(x, feature)| {
            let ending = faces.ending_at(x);
            RigidNode { ending, ..node(x, feature, Round::Point, spacing) }
        }));
        for site in sites {
            let nearest = surface.closest(site.position);
            if nearest.signed_distance.abs() >= NEAR * spacing {
                continue;
            }
            let mut near = faces.of(site.position, nearest);
            near.extend(faces.across(site.position, nearest));
            for face in near.into_iter().filter(|face| !is_round(face.point)) {
                list.push(node(face.point, Feature::Face(face.normal), Round::Point, spacing));
            }
        }
        // Shorter ones have points at their ends that nothing passes between.
        let long = edges.iter().filter(|[a, b]| a.distance(*b) > SHORT * spacing);
        list.extend(long.map(|&[a, b]| {
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            node(middle, Feature::Edge(half.normalize()), Round::Edge(half), spacing)
        }));
        Self { list, outline }
    }

    /// The nodes.
    pub fn list(&self) -> &[RigidNode] {
        &self.list
    }

    /// Radius of the body if it is one sphere, m.
    pub fn sphere(&self) -> Option<f64> {
        match self.list[..] {
            [RigidNode { round: Round::Ball(radius), .. }] => Some(radius),
            _ => None,
        }
    }

    /// Whether a place on the surface, in the reference configuration, is on the round outline: there the
    /// body touches with its own circles.
    pub fn is_round(&self, x: DVec3) -> bool {
        self.outline.is_some_and(|outline| outline.holds(x))
    }

    /// Rank of the outline among round ones: where two of them meet, the higher one touches.
    pub fn roundness(&self) -> u8 {
        match self.outline {
            Some(Outline::Ball { .. }) => 3,
            Some(Outline::Ellipsoid { .. }) => 2,
            Some(Outline::Side { .. }) => 1,
            None => 0,
        }
    }

    /// Whether there is an axis about which the outline turns in itself.
    pub fn turns_in_itself(&self) -> bool {
        matches!(self.outline, Some(Outline::Ball { .. } | Outline::Side { .. }))
    }

    /// Whether the round outline has circles in every plane: nothing can be between them.
    pub fn is_ball(&self) -> bool {
        matches!(self.outline, Some(Outline::Ball { .. }))
    }
}

/// A node beside which no face ends.
fn node(point: DVec3, feature: Feature, round: Round, size: f64) -> RigidNode {
    RigidNode { point, feature, round, size, ending: [DVec3::ZERO; 4] }
}

/// The circles of a round outline, or its ellipsoid.
fn round_nodes(outline: &Outline, spacing: f64) -> Vec<RigidNode> {
    let (centers, round) = outline.rounds(spacing);
    let size = match round {
        Round::Rim(rim) if centers.len() == 1 => 2.0 * rim.radius,
        _ => spacing,
    };
    let last = centers.len() - 1;
    let of = |(k, &center): (usize, &DVec3)| {
        let mut round = node(center, Feature::Corner, round, size);
        // The ends of a cylinder are flat.
        round.ending[0] = match k {
            0 => (center - centers[last]).normalize_or_zero(),
            _ if k == last => (center - centers[0]).normalize(),
            _ => DVec3::ZERO,
        };
        round
    };
    centers.iter().enumerate().map(of).collect()
}

/// The ends of edges, which are corners, and points between them. Of points in one cell of half a spacing the
/// first is kept, so that the many short edges of a fine mesh make no more of them than a coarse one has;
/// ends come first.
fn along(edges: &[[DVec3; 2]], spacing: f64) -> Vec<(DVec3, Feature)> {
    let ends = edges.iter().flatten().map(|&end| (end, Feature::Corner));
    let between = edges.iter().flat_map(|&[a, b]| {
        let parts = (a.distance(b) / spacing).round().max(1.0) as usize;
        let feature = Feature::Edge((b - a).normalize_or_zero());
        (1..parts).map(move |part| (a + (b - a) * (part as f64 / parts as f64), feature))
    });
    let mut taken = BTreeSet::new();
    let cell = |x: DVec3| (x / (0.5 * spacing)).to_array().map(|c| c.floor() as i64);
    ends.chain(between).filter(|(x, _)| taken.insert(cell(*x))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_kept_and_fine_edges_are_thinned() {
        let (a, b, c) = (DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 0.33, 0.0));
        let points = along(&[[a, b], [b, c]], 0.1);
        assert!([a, b, c].iter().all(|&end| points.contains(&(end, Feature::Corner))));
        assert_eq!(points.len(), 11 + 3);
        let fine: Vec<[DVec3; 2]> =
            (0..1000).map(|k| [k, k + 1].map(|k| DVec3::X * (f64::from(k) / 1000.0))).collect();
        assert!((18..=21).contains(&along(&fine, 0.1).len()));
    }
}
