//! A body with given positions, and its forces.

use glam::{DMat3, DVec3};

use crate::simulation::{RunError, Simulation};
use crate::world::{BodyId, DeformationGradient, Force, MissingColumn, Position, Velocity};

/// A function that makes simulations whose first body is the specimen.
pub struct Specimen<'a, E> {
    make: &'a dyn Fn() -> Result<Simulation, E>,
}

/// Net force and net torque about the origin, over the sum of the sizes of the forces.
#[derive(Clone, Copy, Debug)]
pub struct NetForce {
    /// Net force over all forces.
    pub force: f64,
    /// Net torque over all forces, m.
    pub torque: f64,
    /// Sum of the sizes of the forces, N.
    pub size: f64,
}

/// Results for an affine map.
#[derive(Clone, Copy, Debug)]
pub struct Affine {
    /// Largest error of a component of the deformation gradient.
    pub gradient: f64,
    /// Forces.
    pub net: NetForce,
    /// Stored energy other than strain energy, over the strain energy: what stabilizers hold.
    pub held: f64,
}

/// Results for a rough displacement.
#[derive(Clone, Copy, Debug)]
pub struct ForceSlope {
    /// Largest difference of a force from the slope of the stored energy, over the largest force.
    pub error: f64,
    /// Forces.
    pub net: NetForce,
}

/// Step of the differences of the energy, m.
const STEP: f64 = 1e-4;

impl<'a, E: From<RunError> + From<MissingColumn>> Specimen<'a, E> {
    /// The specimen of the simulations that `make` makes.
    pub fn new(make: &'a dyn Fn() -> Result<Simulation, E>) -> Self {
        Self { make }
    }

    /// A simulation before its start, with places and velocities that are functions of the place; `place`
    /// also gets the number of the particle.
    ///
    /// # Errors
    /// The simulation cannot be built.
    pub fn moved(
        &self,
        place: impl Fn(usize, DVec3) -> DVec3,
        velocity: impl Fn(DVec3) -> DVec3,
    ) -> Result<Simulation, E> {
        let simulation = (self.make)()?;
        {
            let (view, rows) = simulation.world().body_view(BodyId(0));
            let (mut x, mut v) = (view.write::<Position>()?, view.write::<Velocity>()?);
            for (k, row) in rows.enumerate() {
                v[row].0 = velocity(x[row].0);
                x[row].0 = place(k, x[row].0);
            }
        }
        Ok(simulation)
    }

    /// Moves the specimen by an affine map `x -> map x + shift`.
    ///
    /// # Errors
    /// The simulation cannot be built or fails.
    pub fn affine(&self, map: DMat3, shift: DVec3) -> Result<Affine, E> {
        let mut simulation = self.moved(|_, x| map * x + shift, |_| DVec3::ZERO)?;
        simulation.start()?;
        let (view, rows) = simulation.world().body_view(BodyId(0));
        let off = |f: &DeformationGradient| (f.0 - map).to_cols_array().into_iter().map(f64::abs);
        let gradient = view.read::<DeformationGradient>()?[rows].iter().flat_map(off).fold(0.0, f64::max);
        let strain = simulation.ledger().total_named("strain");
        let held = (stored(&simulation) - strain).abs() / strain;
        Ok(Affine { gradient, net: NetForce::of(&simulation)?, held })
    }

    /// Forces after a rough displacement, for stabilizers without an energy.
    ///
    /// # Errors
    /// The simulation cannot be built or fails.
    pub fn rough(&self) -> Result<NetForce, E> {
        let axes = (self.make)()?.world().dimension().count();
        let mut simulation = self.moved(|_, x| x + rough(axes, x), |_| DVec3::ZERO)?;
        simulation.start()?;
        Ok(NetForce::of(&simulation)?)
    }

    /// Compares the forces after a rough displacement, of the size of 0.4 % of a body of 1 m, with
    /// differences of fourth order of the stored energy, at three particles.
    ///
    /// # Errors
    /// The simulation cannot be built or fails.
    pub fn slope(&self) -> Result<ForceSlope, E> {
        let moved = |moved: usize, axis: usize, by: f64| -> Result<Simulation, E> {
            let mut simulation = (self.make)()?;
            let axes = simulation.world().dimension().count();
            {
                let (view, rows) = simulation.world().body_view(BodyId(0));
                for (k, x) in view.write::<Position>()?[rows].iter_mut().enumerate() {
                    x.0 += rough(axes, x.0);
                    if k == moved {
                        x.0[axis] += by;
                    }
                }
            }
            simulation.start()?;
            Ok(simulation)
        };
        let simulation = moved(0, 0, 0.0)?;
        let (view, rows) = simulation.world().body_view(BodyId(0));
        let force: Vec<DVec3> = view.read::<Force>()?[rows].iter().map(|f| f.0).collect();
        let scale = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        let mut error = 0.0f64;
        for k in [0, force.len() / 2, force.len() - 1] {
            for axis in 0..simulation.world().dimension().count() {
                let energy = |by: f64| -> Result<f64, E> { Ok(stored(&moved(k, axis, by)?)) };
                let near = 8.0 * (energy(STEP)? - energy(-STEP)?);
                let slope = (near - (energy(2.0 * STEP)? - energy(-2.0 * STEP)?)) / (12.0 * STEP);
                error = error.max((force[k][axis] + slope).abs() / scale);
            }
        }
        Ok(ForceSlope { error, net: NetForce::of(&simulation)? })
    }
}

/// Stored energy without kinetic energy, J.
fn stored(simulation: &Simulation) -> f64 {
    simulation.ledger().stored() - simulation.ledger().total_named("kinetic")
}

/// A displacement that no neighbourhood sees as affine, in the plane or in space.
fn rough(axes: usize, x: DVec3) -> DVec3 {
    let phase = if axes == 2 { 31.0 * x.x + 17.0 * x.y } else { DVec3::new(31.0, 17.0, 23.0).dot(x) };
    let z = if axes == 2 { 0.0 } else { (2.3 * phase).sin() };
    0.004 * DVec3::new(phase.sin(), (1.7 * phase + 0.3).cos(), z)
}

impl NetForce {
    /// That of the forces on the first body.
    ///
    /// # Errors
    /// The particles have no force.
    pub fn of(simulation: &Simulation) -> Result<Self, MissingColumn> {
        let (view, rows) = simulation.world().body_view(BodyId(0));
        let (x, f) = (view.read::<Position>()?, view.read::<Force>()?);
        let size: f64 = rows.clone().map(|k| f[k].0.length()).sum();
        let force: DVec3 = rows.clone().map(|k| f[k].0).sum();
        let torque: DVec3 = rows.map(|k| x[k].0.cross(f[k].0)).sum();
        Ok(Self { force: force.length() / size, torque: torque.length() / size, size })
    }
}
