//! The uniform motion of a scene: its velocity at the start, and what it adds to the energies in every step.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::parallel::{BlockSum, sum_over_own_blocks};
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{CommonMotion, Ledger, Resources};
use crate::world::{Body, BodyId, Mass, MissingColumn, Mobility, Removed, Velocity, World};

/// Energy of the uniform motion over all kinetic energy below which the scene is at rest.
const AT_REST: f64 = 1e-6;

/// What the uniform motion of a scene depends on.
pub(super) struct UniformMotion {
    /// Acceleration of gravity, m/s2.
    gravity: DVec3,
    /// Axes along which symmetry planes hold the frame.
    mirrored: [bool; 3],
}

/// Mass, kg, and momentum, kg m/s.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
struct Momentum {
    mass: f64,
    momentum: DVec3,
}

impl BlockSum for Momentum {
    fn add(&mut self, next: &Self) {
        self.mass += next.mass;
        self.momentum += next.momentum;
    }
}

/// What free and held particles have along each axis.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
struct MotionAlongAxes {
    /// Mass, kg, and momentum, kg m/s, of what is free.
    mass: DVec3,
    momentum: DVec3,
    /// Number of what is held, and the sum of its velocities, m/s.
    count: DVec3,
    velocity: DVec3,
}

impl MotionAlongAxes {
    fn of(mass: f64, velocity: DVec3, mobility: DVec3) -> Self {
        let held = DVec3::select(mobility.cmpeq(DVec3::ZERO), DVec3::ONE, DVec3::ZERO);
        let mass = mass * (DVec3::ONE - held);
        Self { mass, momentum: mass * velocity, count: held, velocity: held * velocity }
    }

    /// Velocity of the frame along an axis, m/s, for all bodies: where particles are held, rest or the mean
    /// velocity of those of one body, against which the rest has the least energy.
    fn frame(&self, axis: usize, bodies: &[Self]) -> f64 {
        let (mass, momentum) = (self.mass[axis], self.momentum[axis]);
        if self.count[axis] == 0.0 {
            return if mass > 0.0 { momentum / mass } else { 0.0 };
        }
        let energy = |u: f64| 0.5 * mass * u * u - momentum * u;
        let held = bodies.iter().filter(|body| body.count[axis] > 0.0);
        let velocities = held.map(|body| body.velocity[axis] / body.count[axis]);
        velocities.fold(0.0, |least, u| if energy(u) < energy(least) { u } else { least })
    }
}

impl BlockSum for MotionAlongAxes {
    fn add(&mut self, next: &Self) {
        self.mass += next.mass;
        self.momentum += next.momentum;
        self.count += next.count;
        self.velocity += next.velocity;
    }
}

type Rows<'a> = (&'a [Mass], &'a [Velocity], &'a [Removed]);

impl UniformMotion {
    /// That of a scene with symmetry planes along these axes, under this gravity, m/s2.
    pub fn new(gravity: DVec3, mirrored: [bool; 3]) -> Self {
        Self { gravity, mirrored }
    }

    /// The uniform motion at the start: along each axis that of held particles, or else that of the centre of
    /// mass of all bodies. None if it is at rest.
    pub fn at_start(
        &self,
        world: &World,
        resources: &Resources,
        ledger: &Ledger,
    ) -> Result<Option<CommonMotion>, MissingColumn> {
        let bodies = world.bodies().iter().enumerate();
        let of: Result<Vec<_>, _> =
            bodies.map(|(k, body)| motion(world, resources, BodyId(k), body)).collect();
        let of = of?;
        let mut all = MotionAlongAxes::default();
        of.iter().for_each(|motion| all.add(motion));
        let velocity = DVec3::from_array(
            [0, 1, 2].map(|axis| if self.mirrored[axis] { 0.0 } else { all.frame(axis, &of) }),
        );
        let own = 0.5 * all.mass.max_element() * velocity.length_squared();
        let moves = own > AT_REST * (ledger.total_named("kinetic") + own);
        moves.then(|| Ok(CommonMotion::new(velocity, added(velocity, world, resources)?))).transpose()
    }

    /// States the energies of the uniform motion after a step of length `dt`, s.
    pub fn follow(
        &self,
        dt: f64,
        world: &World,
        resources: &Resources,
        ledger: &mut Ledger,
    ) -> Result<(), MissingColumn> {
        let Some(drift) = ledger.drift_mut() else { return Ok(()) };
        let power = self.gravity.dot(drift.velocity);
        let mut mass = 0.0;
        for (k, body) in world.bodies().iter().enumerate() {
            let of = momentum(world, resources, BodyId(k), body)?;
            drift.kinetic[k] = energy(drift.velocity, of);
            mass += of.mass;
        }
        drift.gravity += dt * mass * power;
        Ok(())
    }
}

/// What a uniform motion adds to the kinetic energy of that mass and momentum, J.
fn energy(velocity: DVec3, of: Momentum) -> f64 {
    velocity.dot(of.momentum) - 0.5 * of.mass * velocity.length_squared()
}

fn added(velocity: DVec3, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
    let bodies = world.bodies().iter().enumerate();
    bodies.map(|(k, body)| Ok(energy(velocity, momentum(world, resources, BodyId(k), body)?))).collect()
}

/// The rigid body of that number, if it is one.
fn rigid<R>(resources: &Resources, id: BodyId, of: impl Fn(&RigidBody) -> R) -> Option<R> {
    let bodies = resources.try_get::<RigidBodies>()?;
    bodies.of(id).map(of)
}

/// Mass and momentum of a body.
fn momentum(
    world: &World,
    resources: &Resources,
    id: BodyId,
    body: &Body,
) -> Result<Momentum, MissingColumn> {
    let of_rigid = |body: &RigidBody| {
        let mass = if body.mass.is_finite() && !body.state.gone { body.mass } else { 0.0 };
        Momentum { mass, momentum: mass * body.state.velocity }
    };
    if let Some(momentum) = rigid(resources, id, of_rigid) {
        return Ok(momentum);
    }
    let (view, rows) = (world.phase(body.phase), body.rows.clone());
    let (mass, velocity) = (view.read_own::<Mass>()?, view.read_own::<Velocity>()?);
    let removed = view.read_own::<Removed>()?;
    let rows = (&mass[rows.clone()], &velocity[rows.clone()], &removed[rows]);
    Ok(sum_over_own_blocks(rows, &|_, (mass, velocity, removed): Rows<'_>| {
        let mut sum = Momentum::default();
        for ((mass, velocity), removed) in mass.iter().zip(velocity).zip(removed) {
            let mass = if *removed == Removed::NO { mass.0 } else { 0.0 };
            sum.add(&Momentum { mass, momentum: mass * velocity.0 });
        }
        sum
    }))
}

/// What a body has along each axis.
fn motion(
    world: &World,
    resources: &Resources,
    id: BodyId,
    body: &Body,
) -> Result<MotionAlongAxes, MissingColumn> {
    let count = body.rows.len() as f64;
    let of_rigid = |body: &RigidBody| {
        let free = |axis| if body.is_driven_along(axis) { 0.0 } else { 1.0 };
        let mass = if body.mass.is_finite() { body.mass } else { 0.0 };
        let of = MotionAlongAxes::of(mass, body.state.velocity, DVec3::new(free(0), free(1), free(2)));
        MotionAlongAxes { count: count * of.count, velocity: count * of.velocity, ..of }
    };
    if let Some(motion) = rigid(resources, id, of_rigid) {
        return Ok(motion);
    }
    let (view, rows) = (world.phase(body.phase), body.rows.clone());
    let (mass, velocity) = (view.read_own::<Mass>()?, view.read_own::<Velocity>()?);
    let mobility = view.read_own::<Mobility>()?;
    let rows = (&mass[rows.clone()], &velocity[rows.clone()], &mobility[rows]);
    Ok(sum_over_own_blocks(rows, &|_, rows: (&[Mass], &[Velocity], &[Mobility])| {
        let mut sum = MotionAlongAxes::default();
        for ((mass, velocity), mobility) in rows.0.iter().zip(rows.1).zip(rows.2) {
            sum.add(&MotionAlongAxes::of(mass.0, velocity.0, mobility.0));
        }
        sum
    }))
}
