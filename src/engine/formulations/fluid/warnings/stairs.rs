//! Fluids without friction that slide along the steps of a lattice.
//!
//! The particles of a regular lattice behind an oblique or curved face are stairs. As particles of a fluid
//! under the pressure p pass them at the speed v, they shake, and lose some `0.06 sqrt(rho p) v` per area:
//! measured on slopes of 3 to 30 degrees, 8 and 16 particles deep, with the speed of sound at 20, 40 and 80
//! times that of the flow, with and without diffusion of density, in square and hexagonal lattices. It does
//! not fall with the spacing. At 45 degrees rows of a square lattice are parallel to the face.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::intrusion::{IntrudedShape, Intrusion};
use crate::formulations::fluid::cloud::{BoundarySurface, FlowCloud, Group, Role, part};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::parallel::sum_over_own_blocks;
use crate::schedule::{Step, StepError};
use crate::world::ReferencePosition;

/// Stress over `sqrt(rho p) v`, with the pressure of the first row, of which some two thirds are found to be
/// beside stairs.
const DRAG: f64 = 0.1;
/// Energy over the largest that any account has held that is worth a warning.
const SHARE: f64 = 0.05;
/// Distance of the nearest particle of a boundary from those of a fluid in the first row, over the spacing.
const FIRST_ROW: f64 = 1.25;
/// Distance around them within which the particles of a boundary show its face, over the spacing.
const AROUND: f64 = 2.5;
/// Root mean square deviation of the depths of its outermost particles that makes stairs, over the spacing:
/// 0.29 where they are evenly spread from 0 to 1, less than 0.05 in lattices that follow the face.
const STEPS: f64 = 0.2;
/// Particles of a fluid that are looked at, at most.
const SAMPLE: usize = 20_000;

/// Energy that stairs have taken.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct StairsWatch {
    /// Of each group, J.
    taken: Vec<f64>,
    /// Time of the last look, s.
    since: f64,
    /// Whether the user has been told.
    told: bool,
}

impl StairsWatch {
    /// Looks at all boundaries, whose shapes are those of `known`; warns at the end of a run.
    pub fn look(
        &mut self,
        at_end: bool,
        cloud: &FlowCloud,
        known: &Intrusion,
        step: &mut Step<'_>,
    ) -> Result<(), StepError> {
        self.taken.resize(cloud.groups.len(), 0.0);
        let time = step.clock.time - std::mem::replace(&mut self.since, step.clock.time);
        for (other, taken) in cloud.groups.iter().zip(&mut self.taken) {
            let Role::Boundary(BoundarySurface { no_slip, .. }) = other.role else { continue };
            let Some(shape) = known.shape(other.body) else { continue };
            if no_slip && cloud.viscosities.is_viscous {
                continue;
            }
            let reference = step.world.phase(other.phase).read::<ReferencePosition>()?;
            let reference = &reference[other.rows.clone()];
            for fluid in cloud.groups.iter().filter(|group| group.fluid().is_some()) {
                let spacing = step.world.body(fluid.body).spacing;
                *taken +=
                    time * FaceInSteps { cloud, other, shape, reference, no_slip, fluid, spacing }.power();
            }
        }
        if at_end && !self.told {
            self.warn(cloud, step);
        }
        Ok(())
    }

    fn warn(&mut self, cloud: &FlowCloud, step: &mut Step<'_>) {
        let largest = step.ledger.largest();
        let boundaries = cloud.groups.iter().zip(&self.taken);
        let Some((worst, taken)) = boundaries.max_by(|a, b| a.1.total_cmp(b.1)) else { return };
        if *taken <= SHARE * largest {
            return;
        }
        // An estimate may exceed it where a body has been stopped.
        let taken = taken.min(largest);
        self.told = true;
        step.warnings.push(format!(
            "the fluid slides along faces of `{}` that are in the steps of its lattice, which have taken some {} of its motion by {}, {:.0} % of the largest energy of the run (by an estimate, to a factor of two): \
             they brake a liquid without friction, and finer ones do so as much; give it and the fluid `lattice: BodyFitted()`",
            step.world.body(worst.body).name,
            quantity(taken, "J"),
            quantity(step.clock.time, "s"),
            100.0 * taken / largest,
        ));
    }
}

/// A boundary, where its particles are in the scene, and a fluid before it.
struct FaceInSteps<'a> {
    cloud: &'a FlowCloud,
    other: &'a Group,
    shape: &'a IntrudedShape,
    reference: &'a [ReferencePosition],
    no_slip: bool,
    fluid: &'a Group,
    /// Of the fluid, m.
    spacing: f64,
}

impl FaceInSteps<'_> {
    /// Power that its stairs take from the fluid, W.
    fn power(&self) -> f64 {
        let Self { cloud, fluid, spacing, .. } = *self;
        let Some(state) = fluid.fluid() else { return 0.0 };
        let every = fluid.cloud.len().div_ceil(SAMPLE).max(1);
        let of_rows = |start: usize, rows: &[FlowParticle]| {
            let looked_at = (start..start + rows.len()).filter(|row| row.is_multiple_of(every));
            looked_at.map(|row| self.power_on(fluid.cloud.start + row)).sum::<f64>()
        };
        let power = sum_over_own_blocks(&cloud.records[fluid.cloud.clone()], &of_rows);
        let area = spacing.powi(if cloud.plane { 1 } else { 2 });
        DRAG * state.density.sqrt() * area * every as f64 * power
    }

    /// `sqrt(p) v^2` of particle `i` of the fluid, if it is beside stairs.
    fn power_on(&self, i: usize) -> f64 {
        let Self { cloud, other, spacing, .. } = *self;
        let (own, near) = (&cloud.records[i], part(cloud.near_row(i), &other.cloud));
        let offset = |j: u32| cloud.offset(own.position(), cloud.records[j as usize].position());
        let apart = |j: u32| offset(j).length() / spacing;
        let nearest = near.iter().copied().min_by(|&a, &b| apart(a).total_cmp(&apart(b)));
        let Some(nearest) = nearest.filter(|&j| apart(j) < FIRST_ROW && own.volume() > 0.0) else {
            return 0.0;
        };
        let (mut count, mut depths, mut squares, mut towards) = (0.0, 0.0, 0.0, DVec3::ZERO);
        for &j in near.iter().filter(|&&j| apart(j) < AROUND) {
            if let Some(depth) = self.depth(j) {
                (count, depths, squares) = (count + 1.0, depths + depth, squares + depth * depth);
                towards += offset(j);
            }
        }
        if count < 3.0 || squares / count - (depths / count).powi(2) < STEPS * STEPS {
            return 0.0;
        }
        // The particles of a surface to which fluids stick carry the velocity `2 v_w - v` for friction.
        let share = if self.no_slip { 0.5 } else { 1.0 };
        let past = share * (own.velocity() - cloud.records[nearest as usize].velocity());
        let along = past - past.project_onto_normalized(towards.normalize_or_zero());
        own.pressure().max(0.0).sqrt() * along.length_squared()
    }

    /// Depth of a particle of the boundary below its face, over its spacing, if it is one of the outermost.
    fn depth(&self, j: u32) -> Option<f64> {
        let place = self.reference[j as usize - self.other.cloud.start].0;
        let depth = -self.shape.region.distance(place) / self.shape.spacing;
        (depth < 1.0).then_some(depth)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::formulations::fluid::tests::simulation;
    use crate::simulation::Simulation;
    use crate::world::{BodyId, Mass, Velocity};

    const END: f64 = 0.4;

    /// A slab of water that slides down a smooth slope of 20 degrees, behind a wall in that lattice.
    fn slab(lattice: &str, wall: &str) -> Simulation {
        let (sin, cos) = 20.0_f64.to_radians().sin_cos();
        let corners = |[left, right]: [f64; 2], [low, high]: [f64; 2]| {
            let turned = |x: f64, y: f64| format!("({:?}, {:?})", x * cos + y * sin, y * cos - x * sin);
            [turned(left, low), turned(right, low), turned(right, high), turned(left, high)].join(", ")
        };
        let text = format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"water": Fluid(density: 1000, sound_speed: 30)}},
                bodies: [
                    (name: "water", material: "water", shape: Polygon(points: [{}]), spacing: 0.02, lattice: BodyFitted(), formulation: Fluid, plugins: []),
                    (name: "bed", material: "wall", shape: Polygon(points: [{}]), spacing: 0.02, lattice: {lattice}, formulation: {wall}),
                ],
                time: (end: {END}))"#,
            corners([0.0, 0.4], [0.0, 0.1]),
            corners([-0.3, 1.6], [-0.08, 0.0]),
        );
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("a run");
        sim
    }

    /// What the warning says that steps have taken, J.
    fn taken(sim: &Simulation) -> Option<f64> {
        let text = sim.warnings().iter().find(|text| text.contains("in the steps of its lattice"))?;
        let number = text.split("have taken some ").nth(1)?.split(' ').next()?;
        number.parse().ok()
    }

    /// Mean velocity along the slope over that without friction, which gravity alone determines.
    fn along(sim: &Simulation) -> f64 {
        let (view, rows) = sim.world().body_view(BodyId(0));
        let velocity = view.read::<Velocity>().expect("velocities");
        let mass = view.read::<Mass>().expect("masses");
        let down = DVec3::new(20.0_f64.to_radians().cos(), -20.0_f64.to_radians().sin(), 0.0);
        let momentum = rows.clone().map(|row| mass[row].0 * velocity[row].0.dot(down)).sum::<f64>();
        momentum / rows.map(|row| mass[row].0).sum::<f64>() / (9.81 * 20.0_f64.to_radians().sin() * END)
    }

    #[test]
    fn what_stairs_take_from_a_slab_that_slides_along_them_is_told() {
        // Of 40 kg without friction, J.
        let exact = 0.5 * 40.0 * (9.81 * 20.0_f64.to_radians().sin() * END).powi(2);
        for wall in ["Wall(slip: Free)", "Wall(slip: No)"] {
            let sim = slab("Regular", wall);
            let along = along(&sim);
            // A stress that grows with the velocity takes two thirds of what is missing; the rest is work of
            // gravity along the way that is missing.
            let lost = 2.0 / 3.0 * exact * (1.0 - along * along);
            let told = taken(&sim).expect("a warning");
            assert!(along < 0.97, "{wall}: {along}");
            assert!((0.5..=2.0).contains(&(told / lost)), "{wall}: {told} of {lost} J");
        }
    }

    #[test]
    fn a_lattice_that_follows_the_slope_takes_nothing_and_is_not_told() {
        let sim = slab("BodyFitted()", "Wall(slip: Free)");
        let along = along(&sim);
        assert!((along - 1.0).abs() < 0.01, "{along}");
        assert!(taken(&sim).is_none(), "{:?}", sim.warnings());
    }
}
