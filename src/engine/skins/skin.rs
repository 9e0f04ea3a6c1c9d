//! The skin of a body in the reference configuration.

use std::path::Path;

use glam::DVec3;

use super::carriers::{Carrier, CarrierCells, REACH, carriers};
use super::scale::CANDIDATES;
use crate::plugin::{BodyPlan, Distances};
use crate::scene::Dimension;
use crate::shapes::{Facets, Shape};
use crate::symmetry::{Map, Repeat, maps_of};
use crate::world::BodyId;

/// Length of facets over the spacing.
const LENGTH: [f64; 2] = [0.5, 1.0];
/// Cosine of the turn of the normal above which a vertex is a corner.
const CORNER: f64 = 0.82;
/// Distance from a symmetry plane, or the end of a period, over the spacing up to which a vertex lies in it.
const ON_PLANE: f64 = 1e-3;

/// The surface of a body, and what carries it.
#[derive(Debug)]
pub(crate) struct Skin {
    /// Its body.
    pub body: BodyId,
    /// Distance of particles of the body, m.
    pub spacing: f64,
    /// The surface in the reference configuration.
    pub facets: Facets,
    /// Length (area) of every facet there, m (m2).
    pub measure: Vec<f64>,
    /// Of every vertex, how much of it is at a corner: 1 at corners and the ends of facets beside them,
    /// else 0.
    pub corner: Vec<f64>,
    /// The facets at every vertex, and where those of each begin.
    pub(super) facet_starts: Vec<u32>,
    pub(super) facets_at: Vec<u32>,
    pub(super) starts: Vec<u32>,
    pub(super) carriers: Vec<Carrier>,
    /// Maps of the images of carriers; the first map is the identity.
    pub(super) maps: Vec<Map>,
    /// Largest of the particles' lengths (areas) in a layer over their masses, m2/kg (m/kg in two
    /// dimensions).
    pub lightness: f64,
    /// Of every particle the length (area) for which it stands in a layer, m (m2).
    pub(super) layer: Vec<f64>,
    /// Of every particle how far it stands from the middle of its cell in the reference configuration, m;
    /// empty if all stand there, or if shares are those of the start.
    pub(super) moved: Vec<DVec3>,
    /// Reach of a vertex, m, if the shares of its carriers follow the deformation; none if they are those of
    /// the start.
    pub(super) reach: Option<f64>,
    /// The distances from which these shares follow.
    pub(super) distances: Distances,
}

impl Skin {
    /// The skin of a body, which ends where the body repeats itself, at symmetry planes that cut it and at
    /// the ends of a period that it fills; none where its surface is not known, or where it is too thin to
    /// carry one.
    pub fn of(
        body: &BodyPlan,
        shape: &Shape,
        repeats: &[Repeat],
        dimension: Dimension,
        folder: &Path,
    ) -> Option<Self> {
        let axes = dimension.count();
        let mut facets = shape.facets(dimension, folder, LENGTH[axes - 2] * body.spacing)?;
        repeats.iter().for_each(|repeat| leave_out(&mut facets, repeat, ON_PLANE * body.spacing));
        let maps = maps_of(repeats);
        let places: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
        let mut middles = places.clone();
        body.sides.iter().flat_map(|side| &side.moved).for_each(|(k, way)| {
            // Two conditions may hold one side.
            let (k, axis) = (*k as usize, way.abs().max_position());
            middles[k][axis] = places[k][axis] - way[axis];
        });
        let cells = CarrierCells { places: &places, middles: &middles };
        // Kernels of the present configuration.
        let follows = body.distances != Distances::Reference;
        let reach = follows.then_some(REACH * body.spacing);
        let farther = if reach.is_some() { CANDIDATES } else { 1.0 };
        let is_moved = reach.is_some() && !body.sides.is_empty();
        let moved = places.iter().zip(&middles).filter(|_| is_moved).map(|(now, middle)| now - middle);
        let moved = moved.collect();
        let (starts, carriers) = carriers(&facets.points, &cells, &maps, body.spacing, farther).ok()??;
        let normals: Vec<(DVec3, f64)> =
            (0..facets.corners.len()).map(|facet| facets.normal_and_measure(facet)).collect();
        let (facet_starts, facets_at) = facets_at_vertices(&facets);
        let measure = normals.iter().map(|normal| normal.1).collect();
        let power = (axes as f64 - 1.0) / axes as f64;
        let layer: Vec<f64> = body.sites.iter().map(|site| site.volume.powf(power)).collect();
        let mass = body.sites.iter().map(|site| body.material.density * site.volume);
        let lightness = layer.iter().zip(mass).map(|(layer, mass)| layer / mass).fold(0.0, f64::max);
        let mut skin = Self {
            body: body.id,
            spacing: body.spacing,
            corner: Vec::new(),
            facets,
            measure,
            facet_starts,
            facets_at,
            starts,
            carriers,
            maps,
            lightness,
            layer,
            moved,
            reach,
            distances: body.distances,
        };
        skin.corner = skin.corners(&normals);
        Some(skin)
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.facets.points.len()
    }

    /// The facets that meet at a vertex.
    #[inline]
    pub fn facets_at(&self, vertex: u32) -> &[u32] {
        let k = vertex as usize;
        &self.facets_at[self.facet_starts[k] as usize..self.facet_starts[k + 1] as usize]
    }

    #[inline]
    pub(super) fn carriers(&self, vertex: u32) -> &[Carrier] {
        let k = vertex as usize;
        &self.carriers[self.starts[k] as usize..self.starts[k + 1] as usize]
    }

    /// From the middle of the cell of a particle to a vertex that is at `arm` from the particle, in the
    /// reference configuration, m.
    #[inline]
    pub(super) fn arm_from_middle(&self, particle: u32, arm: DVec3) -> DVec3 {
        self.moved.get(particle as usize).map_or(arm, |moved| arm + *moved)
    }

    /// Map of the image of a carrier.
    #[inline]
    pub(super) fn map(&self, carrier: &Carrier) -> &Map {
        &self.maps[carrier.map as usize]
    }

    /// The particles that carry it at the start, ascending.
    pub fn particles(&self) -> Vec<u32> {
        let carriers = self.carriers.iter().filter(|carrier| carrier.weight > 0.0);
        let mut particles: Vec<u32> = carriers.map(|carrier| carrier.particle).collect();
        particles.sort_unstable();
        particles.dedup();
        particles
    }

    /// The parts of facets that each of `count` particles carries at the start, outwards, m2 (m in two
    /// dimensions): a uniform traction on them puts their sum times the traction on the particle.
    pub fn surfaces_of_particles(&self, count: usize) -> Vec<Vec<DVec3>> {
        let mut surfaces = vec![Vec::new(); count];
        for facet in 0..self.facets.corners.len() as u32 {
            let (normal, measure) = self.facets.normal_and_measure(facet as usize);
            let part = normal * (measure / self.facets.axes as f64);
            for carrier in self.corners_of(facet).iter().flat_map(|&vertex| self.carriers(vertex)) {
                surfaces[carrier.particle as usize].push(carrier.weight * self.map(carrier).vector(part));
            }
        }
        surfaces
    }

    /// The particles that carry a facet; some may come more than once.
    pub fn particles_of(&self, facet: u32) -> impl Iterator<Item = u32> {
        let carriers = self.corners_of(facet).iter().flat_map(|&vertex| self.carriers(vertex));
        carriers.map(|carrier| carrier.particle)
    }

    /// Number of all carriers of all vertices.
    pub(super) fn carrier_count(&self) -> usize {
        self.carriers.len()
    }

    /// The vertices of a facet: two or three.
    #[inline]
    pub fn corners_of(&self, facet: u32) -> &[u32] {
        &self.facets.corners[facet as usize][..self.facets.axes]
    }

    /// The facets at a corner and their other vertices.
    fn corners(&self, normals: &[(DVec3, f64)]) -> Vec<f64> {
        let normal = |facet: &u32| normals[*facet as usize].0;
        let turns = |vertex: u32| {
            let facets = self.facets_at(vertex);
            facets.iter().any(|a| facets.iter().any(|b| normal(a).dot(normal(b)) < CORNER))
        };
        let is_corner: Vec<bool> = (0..self.vertices() as u32).map(turns).collect();
        let mut corner = vec![0.0; self.vertices()];
        for facet in 0..self.facets.corners.len() as u32 {
            let vertices = self.corners_of(facet);
            if vertices.iter().any(|&vertex| is_corner[vertex as usize]) {
                vertices.iter().for_each(|&vertex| corner[vertex as usize] = 1.0);
            }
        }
        corner
    }
}

/// Leaves out the facets inside the body where it continues.
fn leave_out(facets: &mut Facets, repeat: &Repeat, tolerance: f64) {
    let Facets { axes, points, corners } = facets;
    let is_in = |vertex: &u32, at: f64| (points[*vertex as usize][repeat.axis()] - at).abs() < tolerance;
    corners.retain(|corners| !repeat.sides().iter().any(|at| corners[..*axes].iter().all(|k| is_in(k, *at))));
}

fn facets_at_vertices(facets: &Facets) -> (Vec<u32>, Vec<u32>) {
    let mut of_vertex: Vec<Vec<u32>> = vec![Vec::new(); facets.points.len()];
    for (facet, corners) in (0..).zip(&facets.corners) {
        corners[..facets.axes].iter().for_each(|&vertex| of_vertex[vertex as usize].push(facet));
    }
    let (mut starts, mut all) = (vec![0], Vec::new());
    for facets in of_vertex {
        all.extend(facets);
        starts.push(all.len() as u32);
    }
    (starts, all)
}
