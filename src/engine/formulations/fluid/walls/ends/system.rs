//! Removes the spurious expansion beside the ends of walls from the rates of compression.

use glam::{DMat3, DVec3};

use super::edges::{SpherePoints, add_edges};
use super::faces::FacesBefore;
use super::forces::WITHIN;
use crate::formulations::fluid::cloud::{FlowCloud, Group, WallEnd};
use crate::formulations::fluid::walls::surface_distance::{BoundaryShape, BoundaryView, FaceBefore};
use crate::linalg::dyad;
use crate::parallel::{for_each_block, own_rows};
use crate::plugin::SimBuilder;
use crate::schedule::{Run, Step, StepError};
use crate::world::ReferencePosition;

/// Number of places that are looked at on the way along a wall.
const WAY: usize = 6;
/// Distance from a wall at which such a place is clear of it, over the spacing: those of the first row are at
/// half of it.
const CLEAR: f64 = 0.15;

/// Finds the particles past the ends of walls.
pub struct WallEnds {
    shapes: Vec<BoundaryShape>,
    /// Rows of the particles of walls at convex edges; none before the first step.
    edges: Option<Vec<usize>>,
    /// Fluid particles within the support of one of these.
    beside: Vec<u32>,
    faces: FacesBefore,
    /// The projection onto walls for each of the particles beside edges, and the directions along walls.
    found: Vec<(WallEnd, DVec3)>,
}

impl WallEnds {
    /// That of the walls without suction of a flow; none without such walls.
    pub fn new(groups: &[Group], sim: &SimBuilder<'_>) -> Option<Self> {
        let walls = groups.iter().filter(|group| group.has_ends());
        let shape = |group| BoundaryShape::of(group, 0.0, sim);
        let shapes: Vec<BoundaryShape> = walls.filter_map(shape).collect();
        (!shapes.is_empty()).then_some(Self {
            shapes,
            edges: None,
            beside: Vec::new(),
            faces: FacesBefore::default(),
            found: Vec::new(),
        })
    }

    /// The rows at edges, which are found once; and memory for all particles.
    fn find_edges(&mut self, cloud: &FlowCloud, step: &Step<'_>) -> Result<(), StepError> {
        if self.edges.is_some() {
            return Ok(());
        }
        let (mut edges, points) = (Vec::new(), SpherePoints::new(cloud.plane));
        for shape in &mut self.shapes {
            shape.reach = cloud.kernel.support;
            let view = step.world.phase(shape.group.phase);
            let reference = &view.read_near::<ReferencePosition>()?[shape.group.rows.clone()];
            add_edges(shape, cloud, &points, reference, &mut edges);
        }
        if !edges.is_empty() {
            self.faces.reserve(cloud.fluid);
            self.beside.reserve(cloud.fluid);
            self.found.reserve(cloud.fluid);
        }
        self.edges = Some(edges);
        Ok(())
    }

    /// Finds the fluid particles of this rank beside edges, and takes them and those around them in. Whether
    /// there are any.
    fn find_beside(&mut self, cloud: &FlowCloud) -> bool {
        let Self { edges, beside, faces, .. } = self;
        faces.clear();
        beside.clear();
        let limit = (WITHIN * cloud.kernel.support).powi(2);
        let is_own = |i: u32| cloud.fluids().any(|fluid| own_rows(&fluid).contains(&(i as usize)));
        for &w in edges.iter().flatten() {
            let at = cloud.records[w].position();
            for &i in cloud.pairs.boundary.row(w - cloud.fluid) {
                let x = cloud.offset(at, cloud.records[i as usize].position());
                if x.length_squared() < limit && is_own(i) && faces.take_in(i) {
                    beside.push(i);
                }
            }
        }
        beside.sort_unstable();
        for &i in &*beside {
            let fluids = cloud.near_row(i as usize).iter().take_while(|&&j| (j as usize) < cloud.fluid);
            fluids.for_each(|&j| _ = faces.take_in(j));
        }
        !beside.is_empty()
    }

    /// Finds the faces before the particles that have been taken in.
    fn find_faces(&mut self, cloud: &FlowCloud, step: &Step<'_>) -> Result<(), StepError> {
        let Self { shapes, faces, .. } = self;
        for shape in shapes {
            shape.look(cloud, step, |seen| {
                faces.add(|i| {
                    let FaceBefore { place, nearness, normal } = seen.face(cloud, i)?;
                    Some(nearness * seen.shape.on_face(cloud, &place) * dyad(normal, normal))
                });
            })?;
        }
        Ok(())
    }

    /// Computes the projection onto walls for the particles beside edges.
    fn find_along(&mut self, cloud: &FlowCloud) {
        let Self { beside, faces, found, .. } = self;
        let nothing = |&i: &u32| (WallEnd { i: i as usize, along: DMat3::ZERO }, DVec3::ZERO);
        found.clear();
        found.extend(beside.iter().map(nothing));
        for_each_block(&mut found[..], &mut Vec::new(), &|_, found: &mut [(WallEnd, DVec3)]| {
            for (end, way) in found {
                if let Some(along_walls) = cloud.along_walls(end.i, faces) {
                    (end.along, *way) = along_walls;
                }
            }
        });
    }

    /// The open share of all ways along a wall, zero to one: whether there is no wall in the direction
    /// `along` it from particle `i`, within the support.
    fn find_open(&mut self, cloud: &FlowCloud, step: &Step<'_>) -> Result<(), StepError> {
        let Self { shapes, found, .. } = self;
        for shape in shapes {
            shape.look(cloud, step, |seen| {
                for_each_block(&mut found[..], &mut Vec::new(), &|_, found: &mut [(WallEnd, DVec3)]| {
                    for (end, along) in found.iter_mut().filter(|(end, _)| end.along != DMat3::ZERO) {
                        if let Some(open) = open_way(seen, cloud, end.i, *along) {
                            end.along *= open;
                        }
                    }
                });
            })?;
        }
        Ok(())
    }
}

/// Part of the way `along` a wall from particle `i` that is clear of it; none where the particle is not
/// beside it.
fn open_way(seen: &BoundaryView<'_>, cloud: &FlowCloud, i: usize, along: DVec3) -> Option<f64> {
    let place = seen.place(cloud, i)?;
    let nearest = (1..=WAY)
        .map(|k| k as f64 / WAY as f64 * cloud.kernel.support)
        .map(|way| seen.shape.distance_from(cloud, &place, way * along))
        .fold(f64::INFINITY, f64::min);
    Some((nearest / (CLEAR * seen.shape.spacing)).clamp(0.0, 1.0))
}

impl Run for WallEnds {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let half = 0.5 * step.clock.dt;
        let mut ends = std::mem::take(&mut cloud.ends);
        ends.clear();
        ends.reserve(cloud.fluid);
        self.find_edges(&cloud, step)?;
        if self.find_beside(&cloud) {
            self.find_faces(&cloud, step)?;
            self.find_along(&cloud);
            self.find_open(&cloud, step)?;
            ends.extend(self.found.iter().map(|(end, _)| *end).filter(|end| end.along != DMat3::ZERO));
        } else {
            self.shapes.iter_mut().for_each(BoundaryShape::forget_motion);
        }
        let mut rates = std::mem::take(&mut cloud.compression);
        ends.iter().for_each(|end| rates[end.i] -= cloud.rate_along(end, half));
        WallEnd::share(&mut ends);
        (cloud.compression, cloud.ends) = (rates, ends);
        Ok(())
    }
}
