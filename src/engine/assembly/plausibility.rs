//! Values that are allowed but most likely wrong units.

use crate::boundaries::MAX_MACH;
use crate::materials::Law;
use crate::notation::{number, quantity, quantity_to};
use crate::plugin::{BodyPlan, SimBuilder};

/// Densities of condensed matter and gases, kg/m3.
const DENSITIES: std::ops::RangeInclusive<f64> = 1.0..=3.0e4;
/// Largest ratio of yield stress and Young's modulus of any metal or polymer, with a margin.
const MAX_YIELD: f64 = 0.1;
/// Speeds of sound in solids, from gels to diamond, m/s.
const SOUND: std::ops::RangeInclusive<f64> = 0.01..=2.0e4;
/// Solids from this density on are metals, rocks and ceramics, kg/m3.
const DENSE: f64 = 3.0e3;
/// Minimum speed of sound in dense solids: a hundredth of that in lead, m/s.
const DENSE_SOUND: f64 = 10.0;
/// Gravity of a centrifuge, m/s2: more is a slip of units.
const MAX_GRAVITY: f64 = 5.0e3;
/// Gravity of the Earth, with a margin, m/s2, under which a liquid lighter than any has a density in other
/// units.
const EARTH: std::ops::RangeInclusive<f64> = 9.5..=10.5;
/// Density of the lightest liquid, hydrogen, with a margin, kg/m3.
const LIGHTEST_LIQUID: f64 = 50.0;
/// Distance from the origin in spacings beyond which a double no longer tells neighbours apart well.
const FARTHEST: f64 = 1.0e10;

/// Warns of probably wrong units.
pub(super) fn warn(sim: &mut SimBuilder<'_>) {
    let gravity = sim.gravity().length();
    let of_gravity = (gravity > MAX_GRAVITY).then(|| {
        format!("gravity is {} m/s2: check its unit, that of the Earth is 9.81 m/s2", number(gravity))
    });
    let of_bodies =
        sim.bodies().iter().flat_map(|body| of_body(body).into_iter().chain(of_liquid(body, gravity)));
    let warnings: Vec<String> = of_gravity.into_iter().chain(of_bodies).collect();
    for warning in warnings {
        if !sim.warnings.get_mut().contains(&warning) {
            sim.warn(warning);
        }
    }
}

/// A liquid under gravity in SI whose density is not.
fn of_liquid(body: &BodyPlan, gravity: f64) -> Option<String> {
    let density = body.material.density;
    let is_light = DENSITIES.contains(&density) && density < LIGHTEST_LIQUID;
    (matches!(body.material.law, Law::Fluid(_)) && is_light && EARTH.contains(&gravity)).then(|| {
        format!(
            "material `{}` is a liquid with a density of {} kg/m3, under a gravity of {} m/s2: check its unit, water has 1000 kg/m3",
            body.material_name,
            number(density),
            number(gravity)
        )
    })
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
        if let Some(stress) = law.initial_yield_stress().filter(|stress| *stress > MAX_YIELD * elastic.young)
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
        } else if density >= DENSE && sound < DENSE_SOUND {
            found.push(format!(
                "the speed of sound in material `{material}`, of {} kg/m3, is {}, below 10 m/s: check the unit of its stiffness, which is in Pa",
                number(density),
                quantity(sound, "m/s")
            ));
        }
        let speed = body.velocity.map_or(0.0, |velocity| velocity.0.length());
        if speed > MAX_MACH * sound {
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

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    fn warnings(gravity: f64, material: &str, formulation: &str) -> Vec<String> {
        let text = format!(
            r#"(dimension: Two, gravity: (0.0, -{gravity:?}), materials: {{"m": {material}}},
                bodies: [(name: "a", material: "m", shape: Box(min: (0, 0), max: (0.1, 0.1)), spacing: 0.01, formulation: {formulation})],
                time: (end: 1.0))"#
        );
        let (scene, source) = parse(Source::new("units.ron", text)).expect("a scene");
        let sim = build(&scene, &source, &Registry::standard()).expect("a simulation");
        sim.warnings()
            .iter()
            .filter(|text| text.contains("check its unit") || text.contains("check the unit"))
            .cloned()
            .collect()
    }

    #[test]
    fn slips_of_units_are_warned_of() {
        let solid = |young: &str| format!("StVenantKirchhoff(density: 7850.0, young: {young}, poisson: 0.3)");
        // Steel in GPa and MPa.
        assert_eq!(warnings(9.81, &solid("210.0"), "TotalLagrangian").len(), 1);
        assert_eq!(warnings(9.81, &solid("210000.0"), "TotalLagrangian").len(), 1);
        assert!(warnings(9.81, &solid("210e9"), "TotalLagrangian").is_empty());
        let fluid = |density: f64| format!("Fluid(density: {density:?}, sound_speed: 600.0)");
        assert_eq!(warnings(9.81, &fluid(1.0), "Fluid").len(), 1);
        assert!(warnings(0.0, &fluid(1.0), "Fluid").is_empty());
        assert!(warnings(9.81, &fluid(1000.0), "Fluid").is_empty());
        assert_eq!(warnings(9810.0, &fluid(1000.0), "Fluid").len(), 1);
    }
}
