//! The formulation of rigid bodies: parameters and initial state.

use glam::{DQuat, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::body::{RigidBodies, RigidBody, RigidParts, RigidState};
use super::constraint::{Constraint, DrivenBody, DrivenRotation, HalvedBody, RotationConstraint};
use super::followed::FollowedFunctions;
use super::inertia::{MassProperties, Tilt};
use super::nodes::{Nodes, RigidNode};
use super::rotation::Inertia;
use super::systems;
use crate::integrate::OwnMotion;
use crate::parallel::sum_over_blocks;
use crate::plugin::{BodyKind, BodyPlan, Formulation, Offer, Setup, SetupError, SimBuilder};
use crate::scene::{Dimension, Vec3};
use crate::shapes::{ByDistance, Shape, Surface};
use crate::world::{BodyId, BodySet, ColumnSet, Mass, Mobility, Position, Velocity};

/// Largest share of a spin across the axis of rotation that is taken for rounding.
const ROUNDING: f64 = 1e-6;

/// Rigid body: it moves as a whole, with mass and inertia of its shape, and touches others with the exact
/// surface of its shape. It moves freely, except along the axes that `Fix`, `Velocity` or `Displacement` hold
/// or drive; these conditions must select the whole body.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rigid {
    /// How it may turn. Default: freely, but not at all if a condition holds or drives its translation, along
    /// one axis or more: a body that is to roll then needs `Free`.
    pub rotation: Option<Rotation>,
    /// Angular velocity at the start, about its centre \[rad/s\].
    pub spin: Vec3,
    /// Mass \[kg; kg per metre of thickness in two dimensions\]. Default: density times volume.
    pub mass: Option<f64>,
}

/// How a rigid body may turn.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub enum Rotation {
    /// Freely about its centre.
    Free,
    /// Not at all.
    Held,
    /// About an axis through its centre with this direction.
    About(Vec3),
}

impl Formulation for Rigid {
    const NAME: &'static str = "Rigid";
    const REFERENCE: &'static str = "rigid rotation: A. Dullweber, B. Leimkuhler, R. McLachlan, J. Chem. Phys. 107 (1997) \
                                     5840-5851";
    const KIND: BodyKind = BodyKind::Rigid;
    const OFFERS: &'static [Offer] = &[Offer::Contact];

    fn columns(_: &mut ColumnSet) {}

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let mut drives: Vec<DrivenBody> = sim.take_extensions();
        let mut rotations: Vec<DrivenRotation> = sim.take_extensions();
        let halved: Vec<HalvedBody> = sim.take_extensions();
        let mut all = RigidBodies::default();
        let mut spins = Vec::new();
        for (id, parameters) in bodies {
            sim.extend(OwnMotion(id));
            let own = drives.extract_if(.., |drive| drive.body == id).collect();
            let turning = rotations.extract_if(.., |rotation| rotation.body == id).collect();
            let constraint = parameters.constraint(id, own, turning, sim)?;
            halved
                .iter()
                .filter(|halved| halved.body == id)
                .try_for_each(|halved| constraint.holds(halved, sim))?;
            if parameters.rotation.is_none() {
                warn_of_held_rotation(id, &constraint, sim);
            }
            spins.push(parameters.spin.0);
            all.0.push(parameters.body(id, constraint, sim)?);
        }
        let ids = BodySet::new(all.iter().map(|body| body.id));
        sim.add_setup(move |setup| {
            start(&mut all, &spins, setup)?;
            setup.resources.insert(all);
            Ok(())
        });
        let followed = FollowedFunctions::new(sim.take_extensions(), sim.scene().time.end);
        systems::add(sim, ids, followed);
        Ok(())
    }
}

/// Warns of a body that cannot roll because a condition holds or drives it along some of its axes, and
/// nothing is said of its rotation.
fn warn_of_held_rotation(id: BodyId, constraint: &Constraint, sim: &mut SimBuilder<'_>) {
    let moves = !constraint.moves_as_prescribed();
    let name = sim.body(id).name.clone();
    let rubs = |(number, pair): (usize, [BodyId; 2])| {
        sim.scene().contacts[number].friction > 0.0 && pair.contains(&id)
    };
    if constraint.is_held_from_turning() && moves && sim.contact_pairs().any(rubs) {
        sim.warn(format!(
            "rigid body `{name}` does not turn, so that friction cannot make it roll: a condition holds or drives it along some axes; \
             `formulation: Rigid(rotation: Free)` lets it turn, `Rigid(rotation: Held)` says that it shall not"
        ));
    }
}

impl Constraint {
    /// Checks that a prescribed motion keeps a body where a symmetry plane cuts it.
    fn holds(&self, halved: &HalvedBody, sim: &SimBuilder<'_>) -> Result<(), SetupError> {
        let HalvedBody { body, axis } = *halved;
        let is_held = self.drives.iter().any(|drive| drive.axes[axis])
            && !matches!(self.turning, RotationConstraint::Free);
        if is_held {
            return Ok(());
        }
        let (name, axis) = (&sim.body(body).name, ["X", "Y", "Z"][axis]);
        let message =
            format!("rigid body `{name}` is cut by a symmetry plane normal to {axis}, and may leave it");
        let help =
            format!("prescribe its motion, such as by `Fix(on: Select(body: \"{name}\"), axes: [{axis}])`");
        Err(SetupError::parameter(format!("bodies[{}].formulation", body.0), message, help))
    }
}

impl Rigid {
    fn constraint(
        &self,
        id: BodyId,
        drives: Vec<DrivenBody>,
        mut rotations: Vec<DrivenRotation>,
        sim: &SimBuilder<'_>,
    ) -> Result<Constraint, SetupError> {
        let at = |field: &str| format!("bodies[{}].formulation{field}", id.0);
        let (body, end) = (sim.body(id), sim.scene().time.end);
        let middle =
            if body.bounds.is_bounded() { 0.5 * (body.bounds.min + body.bounds.max) } else { DVec3::ZERO };
        for axis in 0..3 {
            let mut motions = drives.iter().filter(|drive| drive.axes[axis]).map(|drive| &drive.motion);
            let Some(first) = motions.next() else { continue };
            if let Some(other) = motions.find(|other| !first.agrees(other, axis, middle, end)) {
                let (name, one, other) = (["x", "y", "z"][axis], first.by(), other.by());
                let message = format!(
                    "`{one}` and `{other}` both prescribe the {name} motion of rigid body `{}`, and differ",
                    body.name
                );
                return Err(SetupError::parameter(at(""), message, "leave the axis to one of them"));
            }
        }
        if rotations.len() > 1 {
            let message = format!("rigid body `{}` is turned by two conditions", sim.body(id).name);
            return Err(SetupError::parameter(at(""), message, "leave its rotation to one of them"));
        }
        let turning = match (rotations.pop(), self.rotation) {
            (Some(_), Some(_)) => {
                let message = "the rotation of the body is prescribed by a condition, and stated here too";
                return Err(SetupError::parameter(at(""), message, "leave out `rotation`"));
            }
            (Some(driven), None) => RotationConstraint::Driven(driven),
            (None, Some(Rotation::Free)) => RotationConstraint::Free,
            (None, Some(Rotation::Held)) => RotationConstraint::Held,
            (None, Some(Rotation::About(axis))) => {
                RotationConstraint::About(checked_axis(axis.0, sim.dimension(), &at(".rotation"))?)
            }
            (None, None) if drives.is_empty() => RotationConstraint::Free,
            (None, None) => RotationConstraint::Held,
        };
        Ok(Constraint { drives, turning, dimension: sim.dimension() })
    }

    fn body(
        &self,
        id: BodyId,
        constraint: Constraint,
        sim: &SimBuilder<'_>,
    ) -> Result<RigidBody, SetupError> {
        let plan = sim.body(id);
        let shape = &sim.scene().bodies[id.0].shape;
        let surface = surface(plan, shape, sim)?;
        let of_shape = MassProperties::new(plan, &*surface, sim.dimension());
        let mass = self.mass.unwrap_or(of_shape.mass);
        self.check(plan, mass, &constraint, sim.dimension())?;
        let factor = mass / of_shape.mass;
        let nodes = Nodes::new(shape, &*surface, &plan.sites, plan.spacing, sim.dimension());
        let distance_of = |node: &RigidNode| node.point.distance(of_shape.center) + node.extent();
        let bounding_radius = nodes.list().iter().map(distance_of).fold(0.0, f64::max);
        let points = of_shape.points * factor;
        let parts = RigidParts {
            id,
            mass,
            inertia: Inertia::new(&(of_shape.tensor * factor)),
            points: (points.determinant() > 0.0).then(|| points.inverse()),
            bounding_radius,
            surface,
            nodes,
            constraint,
        };
        Ok(RigidBody::new(parts, RigidState::at(of_shape.center)))
    }
}

/// The surface of a body. Where no contact names it, any shape will do.
fn surface(plan: &BodyPlan, shape: &Shape, sim: &SimBuilder<'_>) -> Result<Box<dyn Surface>, SetupError> {
    let exact = sim.surface(shape, &format!("bodies[{}].shape", plan.id.0));
    if exact.is_ok() || sim.touching_pairs().names(plan.id) {
        return exact;
    }
    match shape.region(sim.dimension(), sim.folder(), "shape") {
        Ok(region) => Ok(Box::new(ByDistance(region))),
        Err(_) => exact,
    }
}

impl Rigid {
    /// Whether a body of this mass, kg, can move as its constraint lets it.
    fn check(
        &self,
        plan: &BodyPlan,
        mass: f64,
        constraint: &Constraint,
        dimension: Dimension,
    ) -> Result<(), SetupError> {
        let (id, name) = (plan.id, &plan.name);
        let place = format!("bodies[{}].formulation{}", id.0, if self.mass.is_some() { ".mass" } else { "" });
        if mass < 0.0 || mass.is_nan() {
            let message = format!("`mass` must be positive, found {mass} kg");
            let help = "leave it out: it follows from density and shape";
            return Err(SetupError::parameter(place, message, help));
        }
        let has_mass = mass > 0.0 && mass.is_finite();
        if !has_mass && !constraint.is_complete() {
            let message = format!(
                "a rigid body that moves freely must have a positive mass, found {mass} kg for `{name}`"
            );
            let help = "give it a positive `mass`, or leave it out: it follows from density and shape";
            return Err(SetupError::parameter(place, message, help));
        }
        if !has_mass {
            let message = format!("`mass` must be positive, found {mass} kg for `{name}`");
            let help =
                "leave it out: where the whole motion is prescribed, mass matters for the weight alone";
            return Err(SetupError::parameter(place, message, help));
        }
        let is_held = constraint.moves_as_prescribed() && constraint.is_held_from_turning();
        if !plan.bounds.is_bounded() && !is_held {
            let message = format!("rigid body `{name}` is unbounded, and its motion must be prescribed");
            let help =
                "prescribe its translation by `Fix`, `Velocity` or `Displacement`, and let it not turn";
            return Err(SetupError::parameter(format!("bodies[{}].shape", id.0), message, help));
        }
        if dimension == Dimension::Two && (self.spin.0.x != 0.0 || self.spin.0.y != 0.0) {
            let message = "a two-dimensional body turns about z alone";
            let help = "give `spin: (0.0, 0.0, rate)`";
            return Err(SetupError::parameter(format!("bodies[{}].formulation.spin", id.0), message, help));
        }
        self.check_spin(plan, constraint)
    }

    /// Whether the body can start with the stated spin: what its constraint does not let it have is gone
    /// before the first step.
    fn check_spin(&self, plan: &BodyPlan, constraint: &Constraint) -> Result<(), SetupError> {
        let (spin, name) = (self.spin.0, &plan.name);
        let refuse = |message: String, help: &str| {
            Err(SetupError::parameter(format!("bodies[{}].formulation.spin", plan.id.0), message, help))
        };
        if spin == DVec3::ZERO {
            return Ok(());
        }
        match &constraint.turning {
            RotationConstraint::Free => Ok(()),
            RotationConstraint::Held if self.rotation.is_none() => refuse(
                format!(
                    "rigid body `{name}` has a spin, and does not turn: a condition holds or drives it along some axes"
                ),
                "`Rigid(rotation: Free)` lets it turn; else leave out `spin`",
            ),
            RotationConstraint::Held => refuse(
                format!("rigid body `{name}` has a spin, and its rotation is held"),
                "leave out `spin`, or let it turn by `rotation: Free` or `rotation: About(axis)`",
            ),
            RotationConstraint::Driven(rotation) => refuse(
                format!(
                    "the rotation of rigid body `{name}` is prescribed by `{}`, and it has a spin",
                    rotation.by
                ),
                "leave out `spin`",
            ),
            RotationConstraint::About(axis) => {
                let along = *axis * axis.dot(spin);
                if spin.distance(along) <= ROUNDING * spin.length() {
                    return Ok(());
                }
                refuse(
                    format!(
                        "rigid body `{name}` turns about {axis} alone, and its spin {spin} 1/s has another axis"
                    ),
                    "give a spin along the axis of `rotation: About(axis)`",
                )
            }
        }
    }
}

/// The unit vector along an axis of rotation.
pub(crate) fn checked_axis(axis: DVec3, dimension: Dimension, field: &str) -> Result<DVec3, SetupError> {
    let length = axis.length();
    if !(length > 0.0 && length.is_finite()) {
        return Err(SetupError::parameter(
            field,
            format!("the axis must not be a zero vector, found {axis}"),
            "such as `(0, 0, 1)`",
        ));
    }
    if dimension == Dimension::Two && (axis.x != 0.0 || axis.y != 0.0) {
        return Err(SetupError::parameter(
            field,
            "a two-dimensional body turns about z alone",
            "give `(0, 0, 1)`",
        ));
    }
    Ok(axis / length)
}

/// The motion at the start from the velocities of the particles, which initial conditions have set.
fn start(bodies: &mut RigidBodies, spins: &[DVec3], setup: &mut Setup<'_>) -> Result<(), SetupError> {
    let missing = |error: crate::world::MissingColumn| SetupError::internal(&error);
    for (body, spin) in bodies.iter_mut().zip(spins) {
        let (view, rows) = setup.world.body_view(body.id);
        let (x, velocity) =
            (view.read::<Position>().map_err(missing)?, view.read::<Velocity>().map_err(missing)?);
        let mut mass = view.write::<Mass>().map_err(missing)?;
        let total: f64 = sum_over_blocks(&mass[rows.clone()], &|_, mass: &[Mass]| {
            mass.iter().map(|mass| mass.0).sum::<f64>()
        });
        let tilt = Tilt::new(rows.clone().map(|row| (mass[row].0, x[row].0)), body.state.center);
        let mut momentum = DVec3::ZERO;
        let mut turning = DVec3::ZERO;
        for row in rows.clone() {
            let own = &mut mass[row].0;
            *own *= body.mass / total * tilt.at(x[row].0);
            momentum += *own * velocity[row].0;
            turning += (x[row].0 - body.state.center).cross(*own * velocity[row].0);
        }
        let angular = body.points.map_or(DVec3::ZERO, |inverse| inverse * turning) + *spin;
        body.state.velocity = momentum / body.mass;
        body.state.angular_velocity = angular;
        body.state.angular_momentum = body.inertia.angular_momentum(DQuat::IDENTITY, angular);
        // The engine's own integrator and all plugins leave the particles alone.
        view.write::<Mobility>().map_err(missing)?[rows].fill(Mobility(DVec3::ZERO));
    }
    Ok(())
}
