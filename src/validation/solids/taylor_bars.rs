//! S13, S14, S15: impact of cylinders of copper, steel and aluminium on a wall.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use super::taylor::{BarShape, impact, largest_radius, sides};
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::Kind;
use crate::template::Template;

pub(crate) const COPPER: Case = Case {
    id: "S13",
    title: "Taylor bar of copper",
    resolutions: &[8, 12, 16],
    ci_resolution: 8,
    run: copper,
};

pub(crate) const STEEL: Case = Case {
    id: "S14",
    title: "Taylor bar of 42CrMo4 steel",
    resolutions: &[8, 12, 16],
    ci_resolution: 8,
    run: steel,
};

pub(crate) const ALUMINIUM: Case = Case {
    id: "S15",
    title: "Taylor bar of aluminium 6061-T6",
    resolutions: &[8, 12, 16],
    ci_resolution: 8,
    run: aluminium,
};

fn shape(registry: &Registry, path: &str, text: &str, diameter: f64, across: usize) -> Result<BarShape> {
    let spacing = diameter / across as f64;
    let template = Template::new(path, text).set("bodies.bar.spacing", spacing)?;
    impact(&mut template.build(registry)?, DVec3::Z)
}

fn copper(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let text = include_str!("../../../tests/validation/taylor_copper/scene.ron");
    let shape = shape(registry, "tests/validation/taylor_copper/scene.ron", text, 6.4e-3, across)?;
    let mut checks = checks(&shape, (0.021494, 0.02), (0.0073135, 0.05), 2.0);
    // The length crosses that of the finite elements within 0.3 %.
    checks[1] = checks[1].clone().converging();
    Ok(checks)
}

fn steel(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let text = include_str!("../../../tests/validation/taylor_steel/scene.ron");
    let shape = shape(registry, "tests/validation/taylor_steel/scene.ron", text, 6.4e-3, across)?;
    let mut checks = checks(&shape, (0.02647, 0.02), (0.005625, 0.04), 1.2);
    checks[0] = checks[0].clone().converging();
    Ok(checks)
}

fn aluminium(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let text = include_str!("../../../tests/validation/taylor_aluminium/scene.ron");
    let template = Template::new("tests/validation/taylor_aluminium/scene.ron", text)
        .set("bodies.bar.spacing", 7.595e-3 / across as f64)?;
    let mut simulation = template.build(registry)?;
    let shape = impact(&mut simulation, DVec3::Z)?;
    // Cells of particles extend beyond the surface at the sharp rim of the foot; the surface encloses the
    // volume of the body.
    let shape = BarShape { radius: largest_radius(&sides(&simulation)?), ..shape };
    let of_radius = if across < 16 { 0.1 } else { 0.06 };
    Ok(checks(&shape, (0.026304, 0.03), (0.00725, of_radius), 1.5))
}

const SOURCE: &str = "published spread and finite elements, reference.csv";

fn checks(
    shape: &BarShape,
    (length, of_length): (f64, f64),
    (radius, of_radius): (f64, f64),
    strain: f64,
) -> Vec<Check> {
    vec![
        Check::new("length", shape.length, length, Tolerance::Relative(of_length), "m", SOURCE),
        Check::new("largest radius", shape.radius, radius, Tolerance::Relative(of_radius), "m", SOURCE),
        Check::above("largest plastic strain", shape.plastic_strain, strain, "finite elements"),
        shape.balance.check(Kind::Inelastic),
    ]
}
