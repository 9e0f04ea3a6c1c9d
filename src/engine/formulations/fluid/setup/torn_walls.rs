//! Walls of which a part moves against the rest.
//!
//! The faces at the edge of a piston, and what a particle of the adjacent wall does there, are found between
//! bodies (`walls::edges`): within one body there is no edge. A piston that is a part of its tank, between
//! two walls, has 0.89 and 0.94 of the pressure, 10 and 20 particles across, and 0.99 as a body of its own.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::formulations::fluid::walls::WallBody;
use crate::notation::{place, quantity};
use crate::plugin::{BodyPlan, MotionOfPlace, SimBuilder};

/// Distance of neighbours over the spacing: two rows that join, along the lattice and across it.
const NEIGHBOURS: f64 = 1.5;
/// Times of a run at which motions are compared.
const TIMES: u32 = 64;
/// Pairs of particles that are compared, of a wall.
const PAIRS: usize = 1000;
/// Motion against the rest that counts, in spacings: a liquid 10 deep is then compressed by half a percent.
const LEAST: f64 = 0.05;
/// It is a tear where it exceeds this many times the change from there to as far again within the part.
const SMOOTH: f64 = 2.0;

/// The conditions that prescribe the motion of a particle along each axis.
type HeldAxes = [Option<usize>; 3];

/// Warns of walls of which a part moves against the rest.
pub fn warn(walls: &[WallBody], sim: &mut SimBuilder<'_>) {
    let warnings: Vec<String> = walls.iter().filter_map(|wall| of_wall(sim.body(wall.id), sim)).collect();
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}

/// The warning of one wall.
fn of_wall(body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<String> {
    let pairs = borders(body, sim);
    let motions = PartMotions::of(body, sim);
    let compared = pairs.iter().step_by(pairs.len().div_ceil(PAIRS).max(1));
    let (slip, at) =
        compared.filter_map(|pair| motions.tear(*pair, body)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(format!(
        "a part of the wall `{}` moves by {} against the rest of it, at {}: the flow does not see the edge between the two, so that the pressure is too small there (a piston \
         has 11 and 6 % too little force, 10 and 20 particles across); make the part that moves a body of its own, at rest with a `surface_velocity` where it slides along itself",
        body.name,
        quantity(slip, "m"),
        place(at)
    ))
}

/// Neighbours of one wall whose motions are prescribed by different conditions.
fn borders(body: &BodyPlan, sim: &SimBuilder<'_>) -> Vec<[usize; 2]> {
    let held = |number: usize| held(body, number, sim);
    if (1..body.sites.len()).all(|number| held(number) == held(0)) {
        return Vec::new();
    }
    let reach = NEIGHBOURS * body.spacing;
    let cell = |x: DVec3| (x / reach).to_array().map(|along| along.floor() as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    let mut pairs = Vec::new();
    for (number, site) in body.sites.iter().enumerate() {
        let (own, [x, y, z]) = (held(number), cell(site.position));
        for near in (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]) {
            let others = cells.get(&near).into_iter().flatten();
            let is_near = |other: &&usize| body.sites[**other].position.distance(site.position) < reach;
            pairs.extend(
                others.filter(is_near).filter(|&&other| held(other) != own).map(|&other| [other, number]),
            );
        }
        cells.entry([x, y, z]).or_default().push(number);
    }
    pairs
}

/// The conditions that hold a particle of a body.
fn held(body: &BodyPlan, number: usize, sim: &SimBuilder<'_>) -> HeldAxes {
    let row = (body.rows.start + number) as u32;
    sim.prescribed.get(&(body.phase, row)).copied().unwrap_or_default()
}

/// The motions that conditions prescribe.
struct PartMotions {
    /// Of each condition; none where only the condition knows it.
    values: Vec<Option<MotionOfPlace>>,
    /// Of each particle.
    held: Vec<HeldAxes>,
    /// Velocity of the rest, m/s.
    rest: DVec3,
    /// Time between two looks, s.
    apart: f64,
}

impl PartMotions {
    fn of(body: &BodyPlan, sim: &SimBuilder<'_>) -> Self {
        let scene = sim.scene();
        let apart = scene.time.end / f64::from(TIMES);
        Self {
            values: sim.prescriptions.iter().map(|by| by.velocity_of_place(apart)).collect(),
            held: (0..body.sites.len()).map(|number| held(body, number, sim)).collect(),
            rest: scene.bodies[body.id.0].velocity.map_or(DVec3::ZERO, |velocity| velocity.0),
            apart,
        }
    }

    /// Velocity of a place that moves as a particle does, m/s.
    fn velocity(&self, number: usize, at: DVec3, t: f64) -> DVec3 {
        let along = |axis: usize| match self.held[number][axis] {
            Some(by) => self.values[by].as_ref().map_or(self.rest[axis], |value| value(at, t)[axis]),
            None => self.rest[axis],
        };
        DVec3::new(along(0), along(1), along(2))
    }

    /// The largest distance by which two neighbours come apart or slide, m, and their place, if they do not
    /// move as parts of one smooth motion.
    fn tear(&self, [one, other]: [usize; 2], body: &BodyPlan) -> Option<(f64, DVec3)> {
        let [x, y] = [one, other].map(|number| body.sites[number].position);
        let (mut apart, mut own) = (DVec3::ZERO, [DVec3::ZERO; 2]);
        let mut largest = 0.0_f64;
        for k in 0..TIMES {
            let t = self.apart * f64::from(k);
            let [v, w] = [self.velocity(one, x, t), self.velocity(other, y, t)];
            apart += self.apart * (v - w);
            own[0] += self.apart * (self.velocity(one, 2.0 * x - y, t) - v);
            own[1] += self.apart * (self.velocity(other, 2.0 * y - x, t) - w);
            let smooth = own[0].length().max(own[1].length());
            if apart.length() > SMOOTH * smooth {
                largest = largest.max(apart.length());
            }
        }
        (largest > LEAST * body.spacing).then_some((largest, x))
    }
}
