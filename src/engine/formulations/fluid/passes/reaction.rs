//! The force of the fluids on a body or on a part of it, apart from all other forces.
//!
//! The force of a pair across a surface acts at the midpoint of the pair, which on average lies on the
//! surface, though the sum over pairs is taken for a particle up to a support below it. Particles just below
//! the surface have 1.4 of the force on it, the rows behind them a part of it with the opposite sign, and in
//! a thin body a row also has forces of the fluid on the other side. On a part of a body counts what acts
//! there: a pair with the share of its midpoint, between the particles nearest to it, that is in this part.
//! Where the part ends, pairs to both sides of the same midpoint count with the same share, so that their
//! forces along the surface cancel.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Group, Neighborhood, PARTS};
use crate::formulations::fluid::moments::SurfaceMoments;
use crate::parallel::{BlockSum, for_each_own_block, share_wide_rows};
use crate::world::{BodyId, Force, Position};

/// What fluids do to a body or a part of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reaction {
    /// Force, N.
    pub force: DVec3,
    /// Its viscous part, N.
    pub viscous: DVec3,
    /// Torque, N m.
    pub torque: DVec3,
}

impl BlockSum for Reaction {
    fn add(&mut self, next: &Self) {
        self.force += next.force;
        self.viscous += next.viscous;
        self.torque += next.torque;
    }
}

/// Vectors of the reaction of one particle, as ranks exchange them.
const VECTORS: usize = 3;

type Rows<'a> = &'a mut [[DVec3; VECTORS]];

impl FlowCloud {
    /// Force of the fluids on every particle of a body, and the viscous part of it, N; none for a body
    /// without fluid beside it. It is computed from the particles of the last right-hand side.
    pub fn forces_on(&self, body: BodyId) -> Option<Vec<(DVec3, DVec3)>> {
        let mut sum: Option<Vec<(DVec3, DVec3)>> = None;
        // A thin body has a group for each of its sides.
        for group in self.groups.iter().filter(|group| group.body == body) {
            let mut total = vec![Force(DVec3::ZERO); group.rows.len()];
            let mut parts = vec![DVec3::ZERO; PARTS * group.rows.len()];
            self.force(group, &mut total, &mut parts);
            SurfaceMoments::default().add(self, group, &mut total, &mut parts);
            self.add_surface_forces(group, &mut total, &mut parts);
            let sum = sum.get_or_insert_with(|| vec![Default::default(); total.len()]);
            for (k, (all, viscous)) in sum.iter_mut().enumerate() {
                *all += total[k].0;
                *viscous += parts[PARTS * k];
            }
        }
        sum
    }

    /// Adds the forces at surfaces that are no sums over pairs.
    fn add_surface_forces(&self, group: &Group, total: &mut [Force], parts: &mut [DVec3]) {
        self.repel(group, total, parts);
        self.press_gaps(group, total, parts);
        self.add_edge_forces(group, total, parts);
        self.let_go(group, total);
    }

    /// Force and torque about a point of the fluids on that part of a body; none if the body has no fluid
    /// beside it, or if the neighbours of its particles are not known because no probe measures a part of it.
    /// `places` are those of all of its particles.
    pub fn reaction_on_part(
        &self,
        body: BodyId,
        is_part: &[bool],
        places: &[Position],
        about: DVec3,
    ) -> Option<Reaction> {
        let mut sum = None;
        for group in self.groups.iter().filter(|group| group.body == body) {
            let near = self.any_neighborhood(group)?;
            let part = MeasuredPart { cloud: self, group, near, is_part, places, about };
            sum.get_or_insert(Reaction::default()).add(&part.reaction());
        }
        sum
    }
}

/// A part of the particles of a boundary.
struct MeasuredPart<'a> {
    cloud: &'a FlowCloud,
    group: &'a Group,
    near: &'a Neighborhood,
    /// Of every particle, whether it is in the part.
    is_part: &'a [bool],
    places: &'a [Position],
    about: DVec3,
}

impl MeasuredPart<'_> {
    fn reaction(&self) -> Reaction {
        let Self { cloud, group, is_part, places, about, .. } = *self;
        let count = group.rows.len();
        let mut of_pairs = vec![[DVec3::ZERO; VECTORS]; count];
        for_each_own_block(&mut of_pairs[..], &mut Vec::new(), &|first, rows: Rows<'_>| {
            for (k, row) in (first..).zip(rows) {
                let Reaction { force, viscous, torque } = self.of_pairs(k);
                *row = [force, viscous, torque];
            }
        });
        share_wide_rows(of_pairs.as_flattened_mut(), VECTORS);
        let mut total = vec![Force(DVec3::ZERO); count];
        let mut parts = vec![DVec3::ZERO; PARTS * count];
        cloud.add_surface_forces(group, &mut total, &mut parts);
        let mut sum = Reaction::default();
        for (k, [force, viscous, torque]) in of_pairs.into_iter().enumerate() {
            sum.add(&Reaction { force, viscous, torque });
            if is_part[k] {
                let force = total[k].0;
                let arm = places[k].0 - about;
                sum.add(&Reaction { force, viscous: parts[PARTS * k], torque: arm.cross(force) });
            }
        }
        sum
    }

    /// Of the pairs of particle `k` with fluids that act on the part, in the order of its neighbours.
    fn of_pairs(&self, k: usize) -> Reaction {
        let Self { cloud, group, near, is_part, places, about } = *self;
        let mut sum = Reaction::default();
        let i = group.cloud.start + k;
        let count = near.list.row(k).iter().filter(|&&j| is_part[j as usize]).count();
        let is_apart = !is_part[k] && count == 0;
        if is_apart || cloud.records()[i].volume() == 0.0 {
            return sum;
        }
        let is_inside = is_part[k] && count == near.list.row(k).len();
        let (own, kernel) = (&cloud.records()[i], &cloud.kernel);
        let (viscosities, factor) = (cloud.viscosities.of(group), cloud.viscosities.factor());
        for &j in cloud.near_row(i) {
            let j = j as usize;
            let other = &cloud.records()[j];
            let x = cloud.offset(own.position(), other.position());
            let r = x.length();
            if j >= cloud.fluid || r >= kernel.support {
                continue;
            }
            let weight = own.volume() * other.volume() * kernel.weight(r);
            let spin = cloud.spins.get(j).map_or(DVec3::ZERO, |spin| spin.xyz());
            let viscosity = factor * viscosities[cloud.group_at(j)];
            let viscous = weight * viscosity * (other.velocity() - own.velocity() - spin.cross(x));
            let force = viscous - weight * (own.pressure() + other.pressure()) * x;
            let arm = places[k].0 + 0.5 * x - about;
            let share = if is_inside { 1.0 } else { self.share_of(k, 0.5 * x) };
            let [force, viscous] = [share * force, share * viscous];
            sum.add(&Reaction { force, viscous, torque: arm.cross(force) });
        }
        sum
    }

    /// The share of a place, from particle `k`, that belongs to the part. It goes from one particle to the
    /// next with the difference of the squares of their distances, as far as the spacing.
    fn share_of(&self, k: usize, place: DVec3) -> f64 {
        let Self { cloud, group, near, is_part, .. } = *self;
        let records = &cloud.records()[group.cloud.clone()];
        let square_to =
            |j: usize| (cloud.offset(records[k].position(), records[j].position()) - place).length_squared();
        let others = || near.list.row(k).iter().map(|&j| j as usize);
        let here = || others().filter(|&j| records[j].volume() > 0.0).chain([k]);
        let least = here().map(square_to).fold(f64::INFINITY, f64::min);
        let spacing = records[k].volume().powf(if cloud.plane { 1.0 / 2.0 } else { 1.0 / 3.0 });
        let (mut all, mut of_part) = (0.0, 0.0);
        for j in here() {
            let weight = (1.0 - (square_to(j) - least) / (spacing * spacing)).max(0.0);
            all += weight;
            of_part += if is_part[j] { weight } else { 0.0 };
        }
        of_part / all
    }
}
