//! The wall formulation: particles that bound a fluid, and move as prescribed.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::parallel::sum_over_own_blocks;
use crate::plugin::{BodyKind, Formulation, Offer, SetupError, SimBuilder};
use crate::scene::Vec3;
use crate::schedule::{Run, Stage, Step, StepError, System};
use crate::world::{BodyId, BodySet, ColumnSet, Force, Mobility, Pressure, World};

crate::column! {
    /// Velocity of a wall at the middle of the step before.
    pub struct PreviousVelocity(glam::DVec3) = "previous_velocity", "v_n-1/2", "m/s";
}

/// Label of the system with which the sums of forces on walls begin.
const NO_FORCE: &str = "no_force_on_walls";

/// Wall: boundary of fluids, moved only by conditions and the `velocity` of its body. It needs as many layers
/// of particles as the support of the fluid extends over, three in two dimensions and default settings.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Wall {
    /// Whether the fluid slides along the wall or sticks to it. Where nothing is stated it slides; a viscous
    /// fluid then causes a warning.
    pub slip: Option<Slip>,
    /// Whether the wall pressure may be negative: confined flows need it; at a free surface drops would stick
    /// to the wall.
    pub suction: bool,
    /// Velocity that the surface has beside that of its particles, such as that of a conveyor belt \[m/s\],
    /// for a fluid that sticks to it; it keeps its direction in space, also where the wall turns.
    pub surface_velocity: Vec3,
}

/// Condition on the motion of the fluid along a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Slip {
    /// The fluid slides along it.
    Free,
    /// The fluid sticks to it.
    No,
}

/// A wall with its parameters, until all bodies are known.
pub struct WallBody {
    pub id: BodyId,
    pub parameters: Wall,
}

/// Whether the flow has no free surface, so that bodies in it have suction: where a wall has it, or where the
/// domain has no end.
pub fn has_suction(sim: &SimBuilder<'_>) -> bool {
    let endless = sim.periodic().axes().iter().take(sim.dimension().count()).all(|&repeats| repeats);
    let walls = sim.scene().bodies.iter().filter(|body| body.formulation.name() == Wall::NAME);
    endless || walls.filter_map(|wall| wall.formulation.parse::<Wall>().ok()).any(|wall| wall.suction)
}

impl Formulation for Wall {
    const NAME: &'static str = "Wall";
    const REFERENCE: &'static str =
        "walls: S. Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 231 (2012) 7057-7075";
    const KIND: BodyKind = BodyKind::Boundary;
    const OFFERS: &'static [Offer] = &[Offer::Contact];

    fn columns(columns: &mut ColumnSet) {
        columns.add::<Pressure>().add::<PreviousVelocity>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let ids = BodySet::new(bodies.iter().map(|(id, _)| *id));
        let phases = sim.phases_of(&ids);
        sim.add_system(
            System::new(Stage::Rates, NO_FORCE, NoForce { walls: ids }).on_phases(phases).writes::<Force>(),
        );
        let walls: Vec<BodyId> = bodies.iter().map(|(id, _)| *id).collect();
        sim.add_setup(move |setup| walls.iter().try_for_each(|&id| hold(id, setup.world)));
        for (id, parameters) in bodies {
            sim.extend(WallBody { id, parameters });
        }
        Ok(())
    }
}

/// Walls have no mass, and with that no weight: the sum of forces on one begins with nothing, and becomes
/// that of flows and contacts.
struct NoForce {
    walls: BodySet,
}

impl Run for NoForce {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for id in step.part.due(step.world, &self.walls) {
            let (view, rows) = step.world.body_view(id);
            let mut force = view.write_own::<Force>()?;
            sum_over_own_blocks(&mut force[rows], &|_, force: &mut [Force]| force.fill(Force(DVec3::ZERO)));
        }
        Ok(())
    }
}

/// Takes the mobility of a wall, whether there is a fluid or not: no force moves it.
fn hold(id: BodyId, world: &World) -> Result<(), SetupError> {
    let (view, rows) = world.body_view(id);
    view.write::<Mobility>().map_err(|error| SetupError::internal(&error))?[rows].fill(Mobility(DVec3::ZERO));
    Ok(())
}
