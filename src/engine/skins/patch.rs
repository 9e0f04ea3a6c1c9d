//! The loaded part of a skin in a step: positions of its vertices, and the forces on them.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::columns::SkinView;
use super::following::{self, FollowingShare, follow};
use super::skin::Skin;
use super::vertex::{End, Vertex};
use crate::parallel::{FourLanes, HotLoop, Picked, for_each_block, run_hot, sum_over_blocks};
use crate::solids::SolidPhase;
use crate::world::{Force, sum_by_row};

/// In the place of a number for vertices that are not in the patch.
const NONE: u32 = u32::MAX;

/// Where a vertex was in the last step, m, and the deformation gradient there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Last {
    place: DVec3,
    gradient: DMat3,
}

impl Last {
    const UNKNOWN: Self = Self { place: DVec3::NAN, gradient: DMat3::NAN };
}

/// Quantities to be computed beside positions and velocities.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wanted {
    pub mobility: bool,
    /// Deformation gradients and their rates.
    pub gradients: bool,
}

/// Forces passed on to particles.
#[derive(Clone, Copy)]
struct CarrierForces<'a> {
    skin: &'a Skin,
    forces: &'a [DVec3],
    couples: Option<&'a [DMat3]>,
    starts: &'a [u32],
    ends: &'a [End],
    /// The shares at the ends, if they follow the deformation.
    following: &'a [FollowingShare],
}

/// The loop over particles, from the first of a block on.
struct OnParticles<'a> {
    all: CarrierForces<'a>,
    first: usize,
    on: (&'a mut [(DVec3, DMat3)], &'a mut [DMat3]),
}

impl HotLoop for OnParticles<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Self { all, first, on: (on, alone) } = self;
        let is_plane = all.skin.facets.axes == 2;
        for k in 0..on.len() {
            let ends = all.starts[first + k] as usize..all.starts[first + k + 1] as usize;
            let (force, couple) = if all.following.is_empty() {
                if is_plane {
                    all.on_particle_in_plane(a, &all.ends[ends])
                } else {
                    all.on_particle(a, &all.ends[ends])
                }
            } else {
                all.on_follower(&all.ends[ends.clone()], &all.following[ends])
            };
            on[k] = (force, couple);
            alone[k] = couple;
        }
    }
}

impl CarrierForces<'_> {
    /// The force, N, and the couple, N m, on a particle at these ends.
    #[inline(always)]
    fn on_particle<A: FourLanes>(&self, a: A, ends: &[End]) -> (DVec3, DMat3) {
        let (mut fx, mut fy, mut fz) = (0.0, 0.0, 0.0);
        let (mut xx, mut yx, mut zx) = (0.0, 0.0, 0.0);
        let (mut xy, mut yy, mut zy) = (0.0, 0.0, 0.0);
        let (mut xz, mut yz, mut zz) = (0.0, 0.0, 0.0);
        for end in ends {
            let mut f = self.forces[end.vertex as usize];
            if f.x == 0.0 && f.y == 0.0 && f.z == 0.0 {
                continue;
            }
            if end.map != 0 {
                f = self.skin.maps[end.map as usize].vector(f);
            }
            let (x, y, z) = (end.weight * f.x, end.weight * f.y, end.weight * f.z);
            (fx, fy, fz) = (fx + x, fy + y, fz + z);
            let arm = &end.arm;
            (xx, yx, zx) = (
                a.scalar_mul_add(x, arm.x, xx),
                a.scalar_mul_add(y, arm.x, yx),
                a.scalar_mul_add(z, arm.x, zx),
            );
            (xy, yy, zy) = (
                a.scalar_mul_add(x, arm.y, xy),
                a.scalar_mul_add(y, arm.y, yy),
                a.scalar_mul_add(z, arm.y, zy),
            );
            (xz, yz, zz) = (
                a.scalar_mul_add(x, arm.z, xz),
                a.scalar_mul_add(y, arm.z, yz),
                a.scalar_mul_add(z, arm.z, zz),
            );
        }
        let columns = [DVec3::new(xx, yx, zx), DVec3::new(xy, yy, zy), DVec3::new(xz, yz, zz)];
        let mut couple = DMat3 { x_axis: columns[0], y_axis: columns[1], z_axis: columns[2] };
        if self.couples.is_some() {
            couple += self.of_vertices(ends);
        }
        (DVec3::new(fx, fy, fz), couple)
    }

    /// The same in a plane, where all components along z are zero.
    #[inline(always)]
    fn on_particle_in_plane<A: FourLanes>(&self, a: A, ends: &[End]) -> (DVec3, DMat3) {
        let (mut fx, mut fy) = (0.0, 0.0);
        let (mut xx, mut yx, mut xy, mut yy) = (0.0, 0.0, 0.0, 0.0);
        for end in ends {
            let mut f = self.forces[end.vertex as usize];
            if f.x == 0.0 && f.y == 0.0 {
                continue;
            }
            if end.map != 0 {
                f = self.skin.maps[end.map as usize].vector(f);
            }
            let (x, y) = (end.weight * f.x, end.weight * f.y);
            (fx, fy) = (fx + x, fy + y);
            let arm = &end.arm;
            (xx, yx) = (a.scalar_mul_add(x, arm.x, xx), a.scalar_mul_add(y, arm.x, yx));
            (xy, yy) = (a.scalar_mul_add(x, arm.y, xy), a.scalar_mul_add(y, arm.y, yy));
        }
        let (x_axis, y_axis) = (DVec3::new(xx, yx, 0.0), DVec3::new(xy, yy, 0.0));
        let mut couple = DMat3 { x_axis, y_axis, z_axis: DVec3::ZERO };
        if self.couples.is_some() {
            couple += self.of_vertices(ends);
        }
        (DVec3::new(fx, fy, 0.0), couple)
    }

    /// The same where the shares follow the deformation.
    fn on_follower(&self, ends: &[End], shares: &[FollowingShare]) -> (DVec3, DMat3) {
        let force = |end: &End| self.skin.maps[end.map as usize].vector(self.forces[end.vertex as usize]);
        let (force, mut couple) = following::on_particle(ends, shares, force);
        if self.couples.is_some() {
            let shares = shares.iter().map(|of| of.share);
            couple += ends.iter().zip(shares).fold(DMat3::ZERO, |sum, (end, share)| {
                sum + self.of_vertices(&[End { weight: share, ..*end }])
            });
        }
        (force, couple)
    }

    /// Sum of the couples on vertices for a particle at these ends, N m.
    fn of_vertices(&self, ends: &[End]) -> DMat3 {
        let couples = self.couples.unwrap_or_default();
        let of = |end: &End| {
            let couple = couples[end.vertex as usize];
            end.weight * if end.map == 0 { couple } else { self.skin.maps[end.map as usize].tensor(couple) }
        };
        ends.iter().map(of).fold(DMat3::ZERO, |sum, couple| sum + couple)
    }
}

/// A part of a skin.
pub(crate) struct Patch {
    /// The skin.
    pub skin: Arc<Skin>,
    facets: Vec<u32>,
    vertices: Vec<u32>,
    /// Those of the selection before.
    old: Vec<u32>,
    /// Number in the patch of every vertex of the skin.
    numbers: Vec<u32>,
    /// Of every vertex of the skin.
    last: Vec<Last>,
    now: Vec<Vertex>,
    /// Whether all that carries them is there.
    is_whole: bool,
    forces: Vec<DVec3>,
    couples: Vec<DMat3>,
    /// Whether there are couples on vertices in this step.
    has_couples: bool,
    /// Heat on every vertex, J, and whether there is any in this step.
    pub(super) heats: Vec<f64>,
    pub(super) has_heat: bool,
    particles: Vec<u32>,
    pub(super) starts: Vec<u32>,
    pub(super) ends: Vec<End>,
    /// The shares at the ends, if they follow the deformation; else none.
    pub(super) following: Vec<FollowingShare>,
    on_particles: Vec<(DVec3, DMat3)>,
    /// The couples alone, as the pass of the internal force takes them.
    couples_on_particles: Vec<DMat3>,
}

impl Patch {
    /// An empty one, with capacity for all of the skin.
    pub fn new(skin: Arc<Skin>) -> Self {
        let (vertices, carriers) = (skin.vertices(), skin.carrier_count());
        let particles = carriers.min(skin.layer.len());
        Self {
            facets: Vec::with_capacity(skin.facets.corners.len()),
            vertices: Vec::with_capacity(vertices * skin.facets.axes * 3),
            old: Vec::with_capacity(vertices * skin.facets.axes * 3),
            numbers: vec![NONE; vertices],
            last: vec![Last::UNKNOWN; vertices],
            now: Vec::with_capacity(vertices),
            is_whole: false,
            forces: Vec::with_capacity(vertices),
            couples: Vec::with_capacity(vertices),
            has_couples: false,
            heats: Vec::with_capacity(vertices),
            has_heat: false,
            particles: Vec::with_capacity(particles),
            starts: Vec::with_capacity(particles + 1),
            ends: Vec::with_capacity(carriers),
            following: Vec::with_capacity(if skin.reach.is_some() { carriers } else { 0 }),
            on_particles: Vec::with_capacity(particles),
            couples_on_particles: Vec::with_capacity(particles),
            skin,
        }
    }

    /// Makes these facets, ascending, the patch.
    pub fn select(&mut self, facets: impl IntoIterator<Item = u32, IntoIter: Clone>) {
        let facets = facets.into_iter();
        if !self.facets.is_empty() && facets.clone().eq(self.facets.iter().copied()) {
            return;
        }
        let skin = Arc::clone(&self.skin);
        self.facets.clear();
        self.facets.extend(facets);
        std::mem::swap(&mut self.vertices, &mut self.old);
        self.old.iter().for_each(|&vertex| self.numbers[vertex as usize] = NONE);
        self.vertices.clear();
        self.vertices.extend(self.facets.iter().flat_map(|&facet| skin.corners_of(facet)));
        self.vertices.sort_unstable();
        self.vertices.dedup();
        for (number, &vertex) in (0..).zip(&self.vertices) {
            self.numbers[vertex as usize] = number;
        }
        for vertex in self.old.iter().map(|&vertex| vertex as usize) {
            if self.numbers[vertex] == NONE {
                self.last[vertex] = Last::UNKNOWN;
            }
        }
        let count = self.vertices.len();
        self.now.resize(count, Vertex::default());
        self.forces.resize(count, DVec3::ZERO);
        self.couples.resize(count, DMat3::ZERO);
        self.heats.resize(count, 0.0);
        self.find_particles(&skin);
    }

    /// The particles that carry the vertices, each with its vertices, both ascending.
    fn find_particles(&mut self, skin: &Skin) {
        let Self { vertices, particles, starts, ends, .. } = self;
        ends.clear();
        for (number, &vertex) in (0..).zip(&*vertices) {
            ends.extend(skin.carriers(vertex).iter().map(|carrier| End {
                arm: carrier.arm,
                weight: carrier.weight,
                particle: carrier.particle,
                vertex: number,
                map: carrier.map,
            }));
        }
        ends.sort_unstable_by_key(|end| (end.particle, end.vertex, end.map));
        particles.clear();
        starts.clear();
        for (number, end) in (0..).zip(&*ends) {
            if particles.last() != Some(&end.particle) {
                particles.push(end.particle);
                starts.push(number);
            }
        }
        starts.push(ends.len() as u32);
        let followed = if skin.reach.is_some() { self.ends.len() } else { 0 };
        self.following.resize(followed, FollowingShare::default());
        self.on_particles.resize(self.particles.len(), Default::default());
        self.couples_on_particles.resize(self.particles.len(), DMat3::ZERO);
    }

    /// Computes where the vertices are and how they move, and takes forces and heat off them. `dt` is the
    /// length of the step, s.
    pub fn update(&mut self, view: &SkinView<'_>, dt: f64, wanted: Wanted) {
        self.forces.fill(DVec3::ZERO);
        if std::mem::take(&mut self.has_couples) {
            self.couples.fill(DMat3::ZERO);
        }
        if std::mem::take(&mut self.has_heat) {
            self.heats.fill(0.0);
        }
        let Self { vertices, last, now, .. } = self;
        let rows = (Picked::new(vertices, last), &mut now[..]);
        type Rows<'a> = (Picked<'a, Last>, &'a mut [Vertex]);
        for_each_block(rows, &mut Vec::new(), &|_, (mut last, now): Rows<'_>| {
            view.places(last.numbers(), &mut |k, place, is_there| {
                let vertex = last.number(k) as u32;
                let last = last.row(k);
                let is_new = last.place.is_nan();
                let change = |new: DVec3| if dt > 0.0 { (new - last.place) / dt } else { DVec3::ZERO };
                let velocity = if is_new { view.velocity(vertex) } else { change(place) };
                let now = &mut now[k];
                (now.place, now.velocity, now.is_there) = (place, velocity, is_there);
                if wanted.mobility {
                    now.mobility = view.mobility(vertex);
                }
                if wanted.gradients {
                    let gradient = view.gradient(vertex);
                    let is_known = dt > 0.0 && !is_new;
                    let change = || (gradient - last.gradient) * (1.0 / dt);
                    now.rate = if is_known { change() } else { DMat3::ZERO };
                    now.gradient = gradient;
                    last.gradient = gradient;
                } else if is_new {
                    last.gradient = DMat3::IDENTITY;
                }
                last.place = place;
                if let Some(scale) = view.scale(vertex) {
                    now.scale = scale;
                }
            });
        });
        self.is_whole = self.now.iter().all(|vertex| vertex.is_there);
        follow(view, &self.ends[..self.following.len()], &self.now, &mut self.following);
    }

    /// The particles that carry the patch, by their numbers in the body, ascending.
    pub fn particles(&self) -> &[u32] {
        &self.particles
    }

    /// All vertices of the patch.
    pub fn vertices(&self) -> &[Vertex] {
        &self.now
    }

    /// The same by their numbers in the skin, ascending.
    pub fn vertex_numbers(&self) -> &[u32] {
        &self.vertices
    }

    /// Whether a vertex of the skin belongs to the patch.
    pub fn has(&self, vertex: u32) -> bool {
        self.numbers[vertex as usize] != NONE
    }

    /// The number in the patch of a vertex of the skin that belongs to it.
    #[inline]
    pub fn number(&self, vertex: u32) -> u32 {
        self.numbers[vertex as usize]
    }

    /// The numbers of the vertices of a facet among those of the patch; segments have two, and the last one
    /// twice.
    #[inline]
    pub fn numbers(&self, facet: u32) -> [usize; 3] {
        let [a, b, c] = self.skin.facets.corners[facet as usize];
        [self.number(a) as usize, self.number(b) as usize, self.number(c) as usize]
    }

    /// A vertex of the skin that belongs to the patch.
    #[inline]
    pub fn vertex(&self, vertex: u32) -> &Vertex {
        &self.now[self.numbers[vertex as usize] as usize]
    }

    /// The vertices of a facet of the patch; segments have two, and the last one twice.
    #[inline]
    pub fn corners(&self, facet: u32) -> [&Vertex; 3] {
        let [a, b, c] = self.skin.facets.corners[facet as usize];
        [self.vertex(a), self.vertex(b), self.vertex(c)]
    }

    /// Whether all that carries a facet is there.
    #[inline]
    pub fn is_there(&self, facet: u32) -> bool {
        self.is_whole || self.corners(facet).iter().all(|corner| corner.is_there)
    }

    /// Where the vertices of a facet are, m.
    #[inline]
    pub fn places(&self, facet: u32) -> [DVec3; 3] {
        // One by one: a mapped array would be called.
        let [a, b, c] = self.corners(facet);
        [a.place, b.place, c.place]
    }

    /// Pushes the point of a facet with these shares of its vertices by a force, N, and a couple, N m, f (x)
    /// A of the reference configuration.
    pub fn push(&mut self, facet: u32, shares: [f64; 3], force: DVec3, couple: Option<&DMat3>) {
        let corners = self.skin.facets.corners[facet as usize];
        for (&vertex, share) in corners[..self.skin.facets.axes].iter().zip(shares) {
            let number = self.numbers[vertex as usize] as usize;
            self.forces[number] += share * force;
            if let Some(couple) = couple {
                self.couples[number] += *couple * share;
                self.has_couples = true;
            }
        }
    }

    /// Pushes the vertex of that number in the patch by a force, N.
    pub fn push_vertex(&mut self, number: usize, force: DVec3) {
        self.forces[number] += force;
    }

    /// Pushes one vertex of a facet by a force, N.
    pub fn push_corner(&mut self, facet: u32, corner: usize, force: DVec3) {
        let vertex = self.skin.facets.corners[facet as usize][corner];
        self.forces[self.numbers[vertex as usize] as usize] += force;
    }

    /// The work of the mean of the forces on the vertices at the end of the last step, N, and of those at the
    /// end of this one, J; `last` becomes the latter.
    pub fn work(&self, last: &mut Vec<DVec3>, dt: f64) -> f64 {
        if last.len() != self.forces.len() {
            last.clone_from(&self.forces);
        }
        let (numbers, old) = (&self.vertices[..], &last[..]);
        let power = sum_by_row(self.skin.vertices(), numbers.len(), &|k| numbers[k] as usize, &|k| {
            0.5 * (old[k] + self.forces[k]).dot(self.now[k].velocity)
        });
        last.copy_from_slice(&self.forces);
        power * dt
    }

    /// Adds the forces on the vertices to the particles.
    pub fn transfer_forces(&mut self) {
        let Self { skin, forces, couples, has_couples, starts, ends, following, .. } = self;
        let couples = has_couples.then_some(&couples[..]);
        let all = CarrierForces { skin, forces, couples, starts, ends, following };
        let (on_particles, couples_on_particles) = (&mut self.on_particles, &mut self.couples_on_particles);
        let rows = (&mut on_particles[..], &mut couples_on_particles[..]);
        for_each_block(rows, &mut Vec::new(), &|first, on| run_hot(OnParticles { all, first, on }));
    }

    /// The particles of the patch, with the force, N, and the couple, N m, on each.
    pub fn on_particles(&self) -> impl Iterator<Item = (usize, DVec3, DMat3)> {
        let rows = self.particles.iter().zip(&self.on_particles);
        rows.map(|(particle, (force, couple))| (*particle as usize, *force, *couple))
    }

    /// Adds the couples to the stress of the particles; `first` is the first row of the body.
    pub fn add_couples(&self, solid: &mut dyn SolidPhase, first: usize) {
        solid.add_couples(first, &self.particles, &self.couples_on_particles);
    }

    /// Adds the forces on the particles of the body.
    pub fn add_forces(&self, force: &mut [Force]) {
        let rows = (Picked::new(&self.particles, force), &self.on_particles[..]);
        type Rows<'a> = (Picked<'a, Force>, &'a [(DVec3, DMat3)]);
        sum_over_blocks(rows, &|_, (mut rows, on): Rows<'_>| {
            for (k, (push, _)) in on.iter().enumerate().filter(|(_, on)| on.0 != DVec3::ZERO) {
                rows.row(k).0 += *push;
            }
        });
    }

    /// Where the vertices were in the last step.
    pub fn saved(&self) -> Vec<(u32, Last)> {
        self.vertices.iter().map(|&vertex| (vertex, self.last[vertex as usize])).collect()
    }

    /// Restores the saved state; the next selection keeps it.
    pub fn restore(&mut self, saved: &[(u32, Last)]) {
        if self.vertices.is_empty() {
            self.vertices.extend(saved.iter().map(|entry| entry.0));
        }
        for &(vertex, last) in saved {
            if let Some(own) = self.last.get_mut(vertex as usize) {
                *own = last;
            }
        }
    }
}
