//! Prescribed displacements that jump: bodies then move by all of the jump within one step.

use glam::DVec3;

use super::field::VectorField;
use super::part::parts_of;
use super::pulses::some_of;
use crate::notation::quantity_to;
use crate::plugin::{Selection, SimBuilder};

/// A jump over the spacing that is told of: within a step, which sound takes for half a spacing, it is a
/// tenth of the speed of sound.
const TOLD: f64 = 0.05;
/// Parts of a run in which a jump is looked for.
const PARTS: u32 = 512;
/// Halvings of a part until what is left of its change is a jump.
const HALVINGS: u32 = 24;

/// Warns of a displacement that jumps; there is one warning for each body.
pub(super) fn warn(name: &str, field: &VectorField, selection: &Selection, sim: &mut SimBuilder<'_>) {
    let end = sim.scene().time.end;
    let mut warnings = Vec::new();
    for part in parts_of(selection, sim) {
        let body = sim.body(part.body);
        let told = TOLD * body.spacing;
        let found = some_of(&part.points).find_map(|place| jump(|t| field.at(place, t), end, told));
        if let Some((time, way)) = found {
            warnings.push(format!(
                "`{name}` moves `{}` by {} at once at {}: that is one step, with a speed that has no meaning; let the displacement grow, as `\"smoothstep((t - 0.1)/0.05)\"` does from 0.1 to 0.15 s",
                body.name,
                quantity_to(way, "m", 3),
                quantity_to(time, "s", 3)
            ));
        }
    }
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}

/// The first time at which a place jumps by more than `told`, and how far.
fn jump(at: impl Fn(f64) -> DVec3, end: f64, told: f64) -> Option<(f64, f64)> {
    let way = |from: f64, to: f64| (at(to) - at(from)).length();
    (0..PARTS).find_map(|part| {
        let time = |part: u32| end * f64::from(part) / f64::from(PARTS);
        let (mut from, mut to) = (time(part), time(part + 1));
        for _ in 0..HALVINGS {
            if way(from, to) <= told {
                return None;
            }
            let middle = 0.5 * (from + to);
            (from, to) = if way(from, middle) > way(middle, to) { (from, middle) } else { (middle, to) };
        }
        let left = way(from, to);
        (left > told && left.is_finite()).then_some((to, left))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundaries::tests::simulation;

    /// Jumps are found, and ramps and swings of a hundredth of a part of the run are none.
    #[test]
    fn jumps_are_told_from_what_is_steep() {
        let along_x = |value: f64| DVec3::new(value, 0.0, 0.0);
        let step = jump(|t| along_x(if t < 0.3 { 0.0 } else { 2.0 }), 1.0, 0.1);
        let (time, way) = step.expect("a jump");
        assert!((time - 0.3).abs() < 1e-6 && way == 2.0, "{time} {way}");
        assert!(jump(|t| along_x(if t < 0.3 { 0.0 } else { 0.05 }), 1.0, 0.1).is_none());
        let steep = 0.01 / f64::from(PARTS);
        assert!(jump(|t| along_x(((t - 0.3) / steep).clamp(0.0, 1.0)), 1.0, 0.1).is_none());
        assert!(jump(|t| along_x((t / steep).sin()), 1.0, 0.1).is_none());
    }

    /// A wall that jumps is told of, once; one that is pushed is not.
    #[test]
    fn a_displacement_that_jumps_is_noticed() {
        let count = |value: &str| {
            let text = format!(
                r#"(dimension: Two, materials: {{"rubber": Rubber()}},
                    bodies: [(name: "bar", material: "rubber", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.02, formulation: TotalLagrangian)],
                    conditions: [Displacement(on: Select(face: MaxX), value: ("{value}", 0))], time: (end: 0.5))"#
            );
            simulation(&text).warnings().iter().filter(|warning| warning.contains("at once")).count()
        };
        assert_eq!(count("0.01*step(t - 0.123)"), 1);
        assert_eq!(count("0.01*smoothstep((t - 0.1)/0.01)"), 0);
        assert_eq!(count("0.0005*step(t - 0.123)"), 0);
    }
}
