//! Checks of fluids and walls before a run.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Group};
use crate::formulations::fluid::density::{relative_speed, wall_frame};
use crate::formulations::fluid::lists::{Thickness, Thin};
use crate::formulations::fluid::walls::WallBody;
use crate::neighbors::Periodic;
use crate::notation::{place, quantity};
use crate::plugin::{BodyPlan, SetupError, SimBuilder};
use crate::scene::Problem;

/// Depth of the edges of walls that fluids may see through, in supports: those of 20 degrees or more.
const EDGES: f64 = 2.0;
/// Largest relative change of the density at the start.
const MAX_CHANGE: f64 = 0.1;
/// Thickness of a body without a lasting disturbance of the fluid around it, over the spacing of the fluid.
const THINNEST: f64 = 1.75;

fn fault(body: &BodyPlan, field: &str, message: String, help: &str) -> SetupError {
    let path = format!("bodies[{}].{field}", body.id.0);
    SetupError::Problems(vec![Problem::at_path(path, message).help(help)])
}

/// An error where walls hold no fluid and no contact names them.
pub fn walls_have_fluid(walls: &[WallBody], sim: &SimBuilder<'_>) -> Result<(), SetupError> {
    for wall in walls {
        let body = sim.body(wall.id);
        if !sim.touching_pairs().names(wall.id) {
            let message =
                format!("body `{}` is a wall, and there is no fluid that it could bound", body.name);
            let help = "add a body with `formulation: Fluid`, or a contact of the wall with another body";
            return Err(fault(body, "formulation", message, help));
        }
    }
    Ok(())
}

/// An error where a period is so short that a particle would see two images of another.
pub fn periods_are_long(periodic: &Periodic, support: f64) -> Result<(), SetupError> {
    let least = 2.0 * support;
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let length = periodic.lengths()[axis];
        if periodic.axes()[axis] && length < least * (1.0 + 1e-6) {
            let message = format!(
                "the period along {name} must be longer than twice the support of the fluid, {}, found {}",
                quantity(least, "m"),
                quantity(length, "m")
            );
            let problem = Problem::at_path("domain.periodic", message);
            let help = format!(
                "make the domain longer, or the spacing smaller: the support of the fluid is {}",
                quantity(support, "m")
            );
            return Err(SetupError::Problems(vec![problem.help(help)]));
        }
    }
    Ok(())
}

/// An error where the pressure of the start changes the density so much that the fluid is no liquid.
pub fn sound_is_fast(group: &Group, at: DVec3, p: f64, rho: f64, name: &str) -> Result<(), SetupError> {
    let Some(state) = group.fluid() else { return Ok(()) };
    let change = rho / state.density - 1.0;
    if change.abs() <= MAX_CHANGE {
        return Ok(());
    }
    let message = format!(
        "the pressure of {} at {} changes the density of `{name}` by {:.0} %: its speed of sound of {} is too low",
        quantity(p, "Pa"),
        place(at),
        100.0 * change,
        quantity(state.sound_speed, "m/s")
    );
    let fast = 10.0 * (2.0 * p.abs() / state.density).sqrt();
    let problem = Problem::at_path(format!("bodies[{}].material", group.body.0), message);
    let help = format!("leave `sound_speed` of the material out, or give some {}", quantity(fast, "m/s"));
    Err(SetupError::Problems(vec![problem.help(help)]))
}

/// An error where a body is coarser than the fluid that it bounds.
pub fn is_fine(body: &BodyPlan, spacing: f64) -> Result<(), SetupError> {
    if body.spacing <= spacing * (1.0 + 1e-9) {
        return Ok(());
    }
    let message = format!(
        "the spacing of `{}` must not exceed that of the fluid, found {} m and {spacing} m",
        body.name, body.spacing
    );
    Err(fault(body, "spacing", message, "give the body the spacing of the fluid, or a smaller one"))
}

/// An error where a wall is so coarse or so thin that the fluid would see through it; a warning where it does
/// so at fins.
pub fn wall_is_thick(
    body: &BodyPlan,
    spacing: f64,
    support: f64,
    periodic: &Periodic,
) -> Result<Option<String>, SetupError> {
    is_fine(body, spacing)?;
    let Some(Thin { thickness, at, is_widespread }) = Thickness::of(body, support, periodic)?.thin(EDGES)
    else {
        return Ok(None);
    };
    let layers = (support / body.spacing - 1e-9).ceil();
    let message = format!(
        "`{}` is {:.0} layers of particles thick at {}, thinner than the kernel support of the fluid, {}",
        body.name,
        thickness / body.spacing,
        place(at),
        quantity(support, "m")
    );
    let help = format!("make it at least {layers} layers thick, {}", quantity(layers * body.spacing, "m"));
    if is_widespread {
        return Err(fault(body, "shape", message, &help));
    }
    Ok(Some(format!("{message}: fluid on one side acts on that on the other; {help}")))
}

/// A warning where a body whose two sides have separate pressures is so thin that it stirs fluid at rest:
/// what does not see the other side lacks the part of its kernel beyond the body. The kinetic energy of water
/// beside plates 1, 1.5, 2 and 3 spacings thick is 6.4, 0.75, 0.05 and 0.06 J after a second.
pub fn thin_part_stirs(body: &BodyPlan, thin: &Thin, spacing: f64) -> Option<String> {
    (thin.thickness < THINNEST * spacing).then(|| {
        format!(
            "`{}` is {:.1} spacings of the fluid thick at {}: where it is thinner than two, it stirs fluid at rest; make it thicker, cut off the tips of edges below 25 degrees, \
             take a smaller spacing for the fluid, or, if it does not move, make it a wall",
            body.name,
            thin.thickness / spacing,
            place(thin.at)
        )
    })
}

/// An error where a fluid starts faster than its sound, relative to its boundaries.
pub fn flow_is_slow(cloud: &mut FlowCloud, world: &crate::world::World) -> Result<(), SetupError> {
    cloud.pack_all(world).map_err(|error| SetupError::internal(&error))?;
    let frame = wall_frame(&cloud.groups, &cloud.records);
    for group in &cloud.groups {
        let Some(state) = group.fluid() else { break };
        let records = &cloud.records[group.cloud.clone()];
        let speeds = records.iter().map(|record| record.velocity().distance(frame));
        let fastest = speeds.fold(0.0, f64::max);
        let fastest = relative_speed(fastest, [frame, DVec3::ZERO], group, &cloud.groups, &cloud.records);
        if fastest >= state.sound_speed {
            let body = world.body(group.body);
            let message = format!(
                "the fluid `{}` must start slower than its speed of sound, found {fastest} m/s and {} m/s",
                body.name, state.sound_speed
            );
            let problem = Problem::at_path(format!("bodies[{}].material", group.body.0), message);
            return Err(SetupError::Problems(vec![
                problem.help("give ten times the largest speed of the flow as `sound_speed`"),
            ]));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::formulations::fluid::tests::simulation;

    /// Whether it is told that a body in water, whose spacing is 0.02 m, is so thin that it stirs it.
    fn told(shape: &str, spacing: f64, formulation: &str) -> bool {
        let text = format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000, sound_speed: 10), "wood": NeoHookean(density: 500, young: 1.0e6, poisson: 0.3)}},
                domain: (min: (-0.4, -0.4), max: (0.4, 0.4), periodic: [X, Y]),
                bodies: [
                    (name: "water", material: "water", shape: Difference(Box(min: (-0.4, -0.4), max: (0.4, 0.4)), {shape}), spacing: 0.02, formulation: Fluid),
                    (name: "body", material: "wood", shape: {shape}, spacing: {spacing}, formulation: {formulation}),
                ],
                time: (end: 1.0))"#
        );
        simulation(&text).warnings().iter().any(|text| text.contains("it stirs fluid at rest"))
    }

    #[test]
    fn sheets_below_two_spacings_are_told_and_edges_are_not() {
        let sheet = |height: f64| format!("Box(min: (-0.2, 0), max: (0.2, {height}))");
        let wedge = |degrees: f64| {
            let half = 0.3 * (0.5 * degrees).to_radians().tan();
            format!("Polygon(points: [(0, 0), (0.3, {:?}), (0.3, {half:?})])", -half)
        };
        assert!(told(&sheet(0.02), 0.01, "Rigid"));
        assert!(told(&sheet(0.02), 0.01, "TotalLagrangian"));
        assert!(!told(&sheet(0.04), 0.02, "Rigid"));
        assert!(!told(&sheet(0.04), 0.01, "TotalLagrangian"));
        assert!(!told(&wedge(30.0), 0.02, "Rigid"));
        assert!(!told(&wedge(60.0), 0.02, "Rigid"));
    }
}
