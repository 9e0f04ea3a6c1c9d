//! Values that are allowed but most likely a slip of units.

use crate::materials::Law;
use crate::notation::{number, quantity, quantity_to};
use crate::plugin::{BodyPlan, SimBuilder};

/// Densities of condensed matter and gases, kg/m3.
const DENSITIES: std::ops::RangeInclusive<f64> = 1.0..=3.0e4;
/// Largest ratio of yield stress and Young's modulus of any metal or polymer, with room.
const LARGEST_YIELD: f64 = 0.1;
/// Speeds of sound in solids, from gels to diamond, m/s.
const SOUND: std::ops::RangeInclusive<f64> = 0.01..=2.0e4;
/// Largest initial speed, in speeds of sound.
const LARGEST_MACH: f64 = 10.0;
/// Distance from the origin in spacings beyond which a double no longer tells neighbours apart well.
const FARTHEST: f64 = 1.0e10;

/// Warns of what looks like a slip of units.
pub(super) fn warn(sim: &mut SimBuilder<'_>) {
    let warnings: Vec<String> = sim.bodies().iter().flat_map(of_body).collect();
    for warning in warnings {
        if !sim.warnings.contains(&warning) {
            sim.warn(warning);
        }
    }
}

fn of_body(body: &BodyPlan) -> Vec<String> {
    let (name, material, density) = (&body.name, &body.material_name, body.material.density);
    let mut found = Vec::new();
    if !matches!(body.material.law, Law::Nothing) && !DENSITIES.contains(&density) {
        found.push(format!(
            "material `{material}` has a density of {} kg/m3, outside 1 to 30000 kg/m3: check its unit",
            number(density)
        ));
    }
    if let Law::Solid(law) = &body.material.law {
        let elastic = law.elastic();
        if let Some(stress) =
            law.initial_yield_stress().filter(|stress| *stress > LARGEST_YIELD * elastic.young)
        {
            found.push(format!(
                "material `{material}` yields at {}, {} times its Young's modulus of {}: check their units",
                quantity(stress, "Pa"),
                quantity_to(stress / elastic.young, "1", 3),
                quantity(elastic.young, "Pa")
            ));
        }
        let sound = body.material.sound_speed().unwrap_or(f64::INFINITY);
        if !SOUND.contains(&sound) {
            found.push(format!(
                "the speed of sound in material `{material}` is {}, outside 0.01 m/s to 20 km/s: check the units of its stiffness and density",
                quantity(sound, "m/s")
            ));
        }
        let speed = body.velocity.map_or(0.0, |velocity| velocity.0.length());
        if speed > LARGEST_MACH * sound {
            found.push(format!(
                "body `{name}` starts at {}, {} times the speed of sound in it ({})",
                quantity(speed, "m/s"),
                quantity_to(speed / sound, "1", 3),
                quantity(sound, "m/s")
            ));
        }
    }
    let farthest = body.sites.iter().map(|site| site.position.abs().max_element()).fold(0.0, f64::max);
    if farthest > FARTHEST * body.spacing {
        found.push(format!(
            "body `{name}` is {} m from the origin, {} of its spacings: its geometry is rounded",
            number(farthest),
            number(farthest / body.spacing)
        ));
    }
    found
}
