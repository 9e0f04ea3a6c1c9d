//! Distance of fluid particles from the shape of a body that has moved and deformed.
//!
//! The position of a particle is mapped back to the reference configuration of the body, and compared with
//! the shape there: by the motion of the whole body, where that is one affine map, else by the affine map
//! that fits the particles of the body around it.
//!
//! A body that has lost particles has another shape, one of which particles have failed may have come apart,
//! and that of a particle file is not known. Their particles are spheres, and the distance is that from the
//! nearest. They overlap, so that nothing passes between two of them in the plane or four in space, and end
//! before a fluid at rest begins.

use glam::{DMat3, DVec3};

use super::body_motion::BodyMotion;
use crate::formulations::fluid::cloud::{FlowCloud, Group, LoadCarrier, Shares, part};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::linalg::dyad;
use crate::parallel::{sum_over_blocks, sum_over_own_blocks};
use crate::plugin::{BodyKind, SimBuilder};
use crate::schedule::{Step, StepError};
use crate::shapes::{Aabb, Region, images_near};
use crate::world::{Damage, ReferencePosition};

/// Square of the distance of a point from the centre of the particles near it, in standard deviations of
/// these, up to which a map is fitted to them: before a flat face it is some 2, before the corner of a
/// square 9. Farther outside, as before an acute edge or beside the few particles at the end of a fin that
/// are on one side of it, shares and map would be extrapolations by many times their size: a rigid body
/// carries forces there as a whole, and a deformable one has the distance and the force of its nearest
/// particle.
const OUTSIDE: f64 = 16.0;

/// Radii of the spheres of a body without a known shape in the plane and in space, over its spacing.
const SPHERES: [f64; 2] = [0.65, 0.75];

/// Distance from a face up to which a fluid particle is before it, over the spacing of the wall: those of the
/// first row are at half of it.
const BEFORE: f64 = 0.85;

/// The shape of a boundary.
pub struct BoundaryShape {
    pub group: Group,
    /// None of a body from a particle file.
    region: Option<Box<dyn Region>>,
    /// A box around it.
    bounds: Option<Aabb>,
    /// Stiffness of its repulsion of each fluid, N/m.
    pub stiffness: Vec<f64>,
    /// Spacing of its particles, m.
    pub spacing: f64,
    /// Kind of the body.
    kind: BodyKind,
    /// Whether its particles are spheres: it has lost some, some have failed, or it is from a particle file.
    pub is_made_of_spheres: bool,
    can_fail: bool,
    /// The last motion, of a body that has one; none where it has not been looked for.
    kept: Option<Option<BodyMotion>>,
    /// Distance of the nearest of its particles beyond which a particle is not beside it, m.
    pub reach: f64,
}

/// A fluid particle in the body as the scene has it.
pub struct PlaceInBody {
    /// Where it is there, m; beside one particle alone, the direction away from that.
    at: DVec3,
    /// Distance from the shape, negative inside of it, or from the sphere of one particle, m.
    pub distance: f64,
    /// The other one of these two distances, infinite where the shape is not known, m.
    pub other_distance: f64,
    /// Gradient of the place in the body with respect to that in space.
    map: DMat3,
    /// Shares of the particles around it in what acts on it.
    pub shares: Shares,
}

impl PlaceInBody {
    /// Whether the distance is that from one particle.
    pub fn is_beside_particle(&self) -> bool {
        matches!(self.shares.carrier, LoadCarrier::Particle(_))
    }
}

/// A boundary where it is now.
pub struct BoundaryView<'a> {
    pub shape: &'a BoundaryShape,
    /// Places of its particles in the scene.
    reference: &'a [ReferencePosition],
    /// The motion of the body, if it has one.
    motion: Option<BodyMotion>,
}

/// The face of a boundary before a fluid particle.
pub struct FaceBefore {
    pub place: PlaceInBody,
    /// Weight: one on the face, zero at [`BoundaryShape::before`].
    pub nearness: f64,
    /// From the face to the particle.
    pub normal: DVec3,
}

impl BoundaryView<'_> {
    /// Whether particle `i` is known to be farther than `range`, m.
    pub fn is_beyond(&self, range: f64, cloud: &FlowCloud, i: usize) -> bool {
        self.motion.is_some_and(|motion| self.shape.is_beyond(range, cloud, i, &motion))
    }

    /// Where particle `i` is; none if it is beside no particle of the body.
    pub fn place(&self, cloud: &FlowCloud, i: usize) -> Option<PlaceInBody> {
        self.shape.place(cloud, i, self.reference, self.motion.as_ref())
    }

    /// The face before particle `i`.
    pub fn face(&self, cloud: &FlowCloud, i: usize) -> Option<FaceBefore> {
        let place = self.place(cloud, i)?;
        let nearness = self.shape.nearness(&place)?;
        let normal = self.shape.direction(cloud, &place).normalize_or_zero();
        Some(FaceBefore { place, nearness, normal })
    }
}

impl BoundaryShape {
    /// That of a body whose shape is known; its nearest particle is within `reach`, m, of any particle beside
    /// it. None of a body from a particle file.
    pub fn of(group: &Group, reach: f64, sim: &SimBuilder<'_>) -> Option<Self> {
        let shape = Self::of_any(group, Vec::new(), reach, sim);
        shape.region.is_some().then_some(shape)
    }

    /// That of any body, with a stiffness of the repulsion of each fluid, N/m.
    pub fn of_any(group: &Group, stiffness: Vec<f64>, reach: f64, sim: &SimBuilder<'_>) -> Self {
        let body = sim.body(group.body);
        let shape = sim.scene().bodies[body.id.0].shape.cut_part_by_part();
        let region = shape.region(sim.dimension(), sim.folder(), "shape").ok();
        Self {
            group: group.clone(),
            stiffness,
            spacing: body.spacing,
            kind: body.kind,
            is_made_of_spheres: region.is_none(),
            bounds: region.as_ref().map(|region| region.bounds()),
            can_fail: body.can_fail(),
            region,
            kept: None,
            reach,
        }
    }

    /// Looks at the boundary where it is now.
    pub fn look<T>(
        &mut self,
        cloud: &FlowCloud,
        step: &Step<'_>,
        see: impl FnOnce(&BoundaryView<'_>) -> T,
    ) -> Result<T, StepError> {
        let view = step.world.phase(self.group.phase);
        let reference = &view.read_near::<ReferencePosition>()?[self.group.rows.clone()];
        let motion = self.motion(cloud, reference);
        Ok(see(&BoundaryView { shape: self, reference, motion }))
    }

    /// The motion of the body, if it is one map, and whether it has lost particles; both are known already of
    /// a body that has not moved since the last step, in which it was looked at. `reference` are the places
    /// of its particles in the scene.
    fn motion(&mut self, cloud: &FlowCloud, reference: &[ReferencePosition]) -> Option<BodyMotion> {
        let is_own = |group: &Group| group.cloud.start == self.group.cloud.start;
        let is_still = cloud.groups.iter().zip(&cloud.is_still).any(|(group, still)| *still && is_own(group));
        if let Some(motion) = self.kept.filter(|_| is_still) {
            return motion;
        }
        let records = &cloud.records[self.group.cloud.clone()];
        self.is_made_of_spheres = self.is_made_of_spheres || has_gone(records);
        let motion = BodyMotion::new(records, reference, self.spacing, cloud.plane);
        self.kept = Some(motion);
        motion
    }

    /// Makes spheres of the particles of a body of which some have failed.
    pub fn notice_failure(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        if !self.can_fail || self.is_made_of_spheres {
            return Ok(());
        }
        let view = step.world.phase(self.group.phase);
        let damage = view.read_own::<Damage>()?;
        let failed = sum_over_own_blocks(&damage[self.group.rows.clone()], &|_, damage: &[Damage]| {
            damage.iter().filter(|damage| damage.0 >= 1.0).count() as f64
        });
        self.is_made_of_spheres = failed > 0.0;
        Ok(())
    }

    /// In a step in which the body is not looked at.
    pub fn forget_motion(&mut self) {
        self.kept = None;
    }

    /// Whether particle `i` is farther than `range`, m, from a body with that motion.
    fn is_beyond(&self, range: f64, cloud: &FlowCloud, i: usize, motion: &BodyMotion) -> bool {
        let place = motion.home(cloud.records[i].position());
        self.region.is_some() && motion.keeps(cloud.pairs.periodic()) && self.distance(cloud, place) >= range
    }

    /// Where particle `i` is, none if it is beside no particle of the body; `reference` are the places of its
    /// particles in the scene, `motion` is that of the whole body, if it has one.
    fn place(
        &self,
        cloud: &FlowCloud,
        i: usize,
        reference: &[ReferencePosition],
        motion: Option<&BodyMotion>,
    ) -> Option<PlaceInBody> {
        let row = part(cloud.near_row(i), &self.group.cloud);
        let from = cloud.records[i].position();
        let offset = |j: u32| cloud.offset(from, cloud.records[j as usize].position());
        let weight = |j: u32| cloud.records[j as usize].volume() * cloud.kernel.value(offset(j).length());
        let weighing = row.iter().copied().filter(|&j| weight(j) > 0.0);
        let (nearest, away) = self.nearest(weighing.map(|j| (j, offset(j))))?;
        if self.is_made_of_spheres {
            return Some(self.beside(cloud, nearest, away, f64::INFINITY));
        }
        let origin = reference[nearest as usize - self.group.cloud.start].0;
        let home = |j: u32| apart(cloud, &self.group, reference, from, [nearest, j])[1];
        let (mut total, mut mean, mut mean_home) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for &j in row {
            let weight = weight(j);
            total += weight;
            mean += weight * offset(j);
            mean_home += weight * home(j);
        }
        (mean, mean_home) = (mean / total, mean_home / total);
        let (mut moment, mut moved) = (DMat3::ZERO, DMat3::ZERO);
        for &j in row {
            let (weight, x) = (weight(j) / total, offset(j) - mean);
            moment += weight * dyad(x, x);
            moved += weight * dyad(home(j) - mean_home, x);
        }
        if cloud.plane {
            moment.z_axis.z = 1.0;
            moved.z_axis.z = 1.0;
        }
        let powers = if cloud.plane { 4 } else { 6 };
        let is_regular = moment.determinant() > 1e-6 * self.spacing.powi(powers);
        let any_fit = is_regular.then(|| moment.inverse());
        let fit = any_fit.filter(|inverse| mean.dot(*inverse * mean) < OUTSIDE);
        let fitted = |inverse: DMat3| {
            let map = moved * inverse;
            (map, origin + mean_home - map * mean)
        };
        let (map, at) = match (motion, fit) {
            (Some(motion), _) => (motion.map, origin - motion.map * away),
            (None, Some(inverse)) => fitted(inverse),
            (None, None) => {
                let extrapolated = any_fit.map_or(f64::INFINITY, |any| self.distance(cloud, fitted(any).1));
                return Some(self.beside(cloud, nearest, away, extrapolated));
            }
        };
        let other_distance = self.distance_from_sphere(cloud, away);
        let slope = -(fit.unwrap_or(DMat3::ZERO) * mean);
        let shares = Shares { total, mean, slope, carrier: self.carrier(fit.is_some(), nearest) };
        Some(PlaceInBody { at, distance: self.distance(cloud, at), other_distance, map, shares })
    }

    /// The nearest of these particles, if it is within reach, and the vector to it, m.
    fn nearest(&self, particles: impl Iterator<Item = (u32, DVec3)>) -> Option<(u32, DVec3)> {
        particles
            .min_by(|(_, a), (_, b)| a.length_squared().total_cmp(&b.length_squared()))
            .filter(|(_, away)| away.length() <= self.reach)
    }

    /// What carries a force beside the body, where shares of the particles around fit it or not.
    fn carrier(&self, fits: bool, nearest: u32) -> LoadCarrier {
        match fits || self.kind != BodyKind::Rigid {
            true => LoadCarrier::Near,
            false => LoadCarrier::Body(nearest),
        }
    }

    /// Distance up to which a fluid particle is before a face, m.
    pub fn before(&self) -> f64 {
        BEFORE * self.spacing
    }

    /// Weight of a face for a particle at that place: one on it, zero at [`Self::before`] and beyond, where
    /// it is none.
    pub fn nearness(&self, place: &PlaceInBody) -> Option<f64> {
        let limit = self.before();
        (place.distance < limit).then(|| 1.0 - (place.distance.max(0.0) / limit).powi(2))
    }

    /// Distance from the sphere of a particle that is at `offset` from here, m.
    fn distance_from_sphere(&self, cloud: &FlowCloud, offset: DVec3) -> f64 {
        offset.length() - SPHERES[usize::from(!cloud.plane)] * self.spacing
    }

    /// Beside the sphere of one particle, which is at `offset` from here.
    fn beside(&self, cloud: &FlowCloud, particle: u32, offset: DVec3, from_shape: f64) -> PlaceInBody {
        let distance = self.distance_from_sphere(cloud, offset);
        let shares = Shares { carrier: LoadCarrier::Particle(particle), ..Shares::default() };
        let at = -offset.normalize_or_zero();
        PlaceInBody { at, distance, other_distance: from_shape, map: DMat3::IDENTITY, shares }
    }

    /// Distance from the shape or from its nearest periodic image, m, exact up to the reach; infinite without
    /// a known shape.
    pub fn distance(&self, cloud: &FlowCloud, at: DVec3) -> f64 {
        let Some(region) = &self.region else { return f64::INFINITY };
        self.least_of_images(cloud, at, |x| region.clearance(x))
    }

    /// A bound of that distance, m, which takes less time: its sign is exact, and it is no larger.
    pub fn distance_bound(&self, cloud: &FlowCloud, at: DVec3) -> f64 {
        let Some(region) = &self.region else { return f64::INFINITY };
        self.least_of_images(cloud, at, |x| region.distance(x))
    }

    /// The least distance of a place and of its periodic images that the body may be near, whose shape may
    /// go on beyond the sides of the domain.
    fn least_of_images(&self, cloud: &FlowCloud, at: DVec3, distance_of: impl Fn(DVec3) -> f64) -> f64 {
        let Some(bounds) = self.bounds.filter(|_| cloud.periods.any()) else { return distance_of(at) };
        let lengths = cloud.pairs.periodic().lengths();
        images_near(&bounds, at, lengths, self.reach).map(distance_of).fold(f64::INFINITY, f64::min)
    }

    /// Distance of another place from the shape, by the motion at a place, m.
    pub fn distance_from(&self, cloud: &FlowCloud, place: &PlaceInBody, way: DVec3) -> f64 {
        if place.is_beside_particle() {
            return f64::INFINITY;
        }
        self.distance(cloud, place.at + place.map * way)
    }

    /// Whether the foot of a particle is on a face of the shape: one there, zero on an edge, less than one
    /// near an edge.
    pub fn on_face(&self, cloud: &FlowCloud, place: &PlaceInBody) -> f64 {
        if place.is_beside_particle() {
            return 1.0;
        }
        let depth = 0.5 * self.spacing;
        let out = self.gradient(cloud, place.at).normalize_or_zero();
        let below = place.at - (place.distance + depth) * out;
        // As far below a face as it is from any other one.
        (5.0 * (-self.distance(cloud, below) / depth - 0.8)).clamp(0.0, 1.0)
    }

    /// Gradient of the distance in the scene, by central differences.
    pub fn gradient(&self, cloud: &FlowCloud, place: DVec3) -> DVec3 {
        let step = 1e-4 * self.spacing;
        let axes = if cloud.plane { 2 } else { 3 };
        let mut gradient = DVec3::ZERO;
        for (axis, unit) in DVec3::AXES.into_iter().enumerate().take(axes) {
            let at = |side: f64| self.distance(cloud, place + side * step * unit);
            gradient[axis] = (at(1.0) - at(-1.0)) / (2.0 * step);
        }
        gradient
    }

    /// Gradient of the distance with respect to the place in space, by central differences.
    pub fn direction(&self, cloud: &FlowCloud, place: &PlaceInBody) -> DVec3 {
        if place.is_beside_particle() {
            return place.at;
        }
        place.map.transpose() * self.gradient(cloud, place.at)
    }
}

/// Whether a particle is gone.
fn has_gone(records: &[FlowParticle]) -> bool {
    let gone = sum_over_blocks(records, &|_, records: &[FlowParticle]| {
        records.iter().filter(|record| record.volume() <= 0.0).count() as f64
    });
    gone > 0.0
}

/// The vector between two particles of a body, now and in the body as the scene has it, m: of the images that
/// are nearest to `from`, which need not be those that are nearest to each other.
pub fn apart(
    cloud: &FlowCloud,
    group: &Group,
    reference: &[ReferencePosition],
    from: DVec3,
    [first, second]: [u32; 2],
) -> [DVec3; 2] {
    let position = |j: u32| cloud.records[j as usize].position();
    let origin = |j: u32| reference[j as usize - group.cloud.start].0;
    let now = cloud.offset(from, position(second)) - cloud.offset(from, position(first));
    let periods = now - (position(second) - position(first));
    let home = origin(second) - origin(first);
    [now, if cloud.periods.any() { home + periods } else { home }]
}
