//! Initial state of fluids: pressure, density, and mass of the particles.

use super::checks;
use crate::formulations::fluid::cloud::{FlowCloud, Group};
use crate::formulations::fluid::walls::PreviousVelocity;
use crate::plugin::{Setup, SetupError};
use crate::scene::Expression;
use crate::world::{
    Density, Mass, MissingColumn, Mobility, Position, Pressure, ReferenceVolume, Velocity, World,
};

/// Pressure of a fluid body at the start.
pub enum StartPressure {
    /// A function of place.
    Given(Expression),
    /// Of every particle at rest, in the order of rows, Pa.
    AtRest(Vec<f64>),
}

/// Fills the columns of all groups; `pressures` are those of the fluid groups.
pub fn start(cloud: &FlowCloud, pressures: &[StartPressure], setup: &Setup<'_>) -> Result<(), SetupError> {
    let missing = |error: MissingColumn| SetupError::internal(&error);
    for (k, group) in cloud.groups.iter().enumerate() {
        if let Some(pressure) = pressures.get(k) {
            start_fluid(group, pressure, setup.world)?;
        } else {
            start_wall(group, setup.world).map_err(missing)?;
        }
    }
    Ok(())
}

fn start_fluid(group: &Group, start: &StartPressure, world: &World) -> Result<(), SetupError> {
    let missing = |error: MissingColumn| SetupError::internal(&error);
    let Some(state) = group.fluid() else { return Ok(()) };
    let view = world.phase(group.phase);
    let position = view.read::<Position>().map_err(missing)?;
    let volume = view.read::<ReferenceVolume>().map_err(missing)?;
    let mut density = view.write::<Density>().map_err(missing)?;
    let mut pressure = view.write::<Pressure>().map_err(missing)?;
    let mut mass = view.write::<Mass>().map_err(missing)?;
    let mut mobility = view.write::<Mobility>().map_err(missing)?;
    for row in group.rows.clone() {
        let x = position[row].0;
        let p = match start {
            StartPressure::Given(expression) => expression.eval(x, 0.0),
            StartPressure::AtRest(pressures) => pressures[row - group.rows.start],
        };
        let rho = state.eos.density(p, state.density, state.sound_speed);
        if !(p.is_finite() && rho > 0.0) {
            let message = format!("the pressure at {x} is {p} Pa, and the density {rho} kg/m3");
            let field = format!("bodies[{}].formulation", group.body.0);
            return Err(SetupError::parameter(field, message, "give a pressure that the fluid can have"));
        }
        checks::sound_is_fast(group, x, p, rho, &world.body(group.body).name)?;
        density[row] = Density(rho);
        pressure[row] = Pressure(p);
        // The particles fill the shape as they are, compressed: so the sums over volumes are those of the
        // lattice.
        let m = rho * volume[row].0;
        mobility[row].0 *= mass[row].0 / m;
        mass[row] = Mass(m);
    }
    Ok(())
}

fn start_wall(group: &Group, world: &World) -> Result<(), MissingColumn> {
    let view = world.phase(group.phase);
    if !view.has::<PreviousVelocity>() {
        return Ok(());
    }
    let velocity = view.read::<Velocity>()?;
    let mut previous = view.write::<PreviousVelocity>()?;
    for row in group.rows.clone() {
        previous[row] = PreviousVelocity(velocity[row].0);
    }
    Ok(())
}
