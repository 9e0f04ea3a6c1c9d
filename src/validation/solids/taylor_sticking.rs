//! S25: a Taylor bar on a wall to which it sticks, whose side rolls over onto the wall.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use super::taylor::{distance_from_axis, largest_radius, sides};
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S25",
    title: "Taylor bar on a sticking wall",
    resolutions: &[8, 12, 16],
    ci_resolution: 8,
    run: taylor_sticking,
};

const DIAMETER: f64 = 7.595e-3;
const LENGTH: f64 = 37.975e-3;
/// Length on the axis at the end and maximum radius, m: extrapolated in reference.csv.
const SHORTENED: f64 = 26.620e-3;
const RADIUS: f64 = 5.623e-3;
/// Radius at heights above the lowest point, as fractions of the initial length.
const PROFILE: [(&str, f64, f64); 3] = [
    ("radius 0.05 of the length above the foot", 0.05, 5.530e-3),
    ("radius 0.1 of the length above the foot", 0.1, 5.357e-3),
    ("radius 0.2 of the length above the foot", 0.2, 4.975e-3),
];
const SOURCE: &str = "finite elements, reference.csv";

/// `across` is the number of particles over the diameter.
fn taylor_sticking(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let text = include_str!("../../../tests/validation/taylor_sticking/scene.ron");
    let mut simulation = Template::new("tests/validation/taylor_sticking/scene.ron", text)
        .set("bodies.bar.spacing", DIAMETER / across as f64)?
        .build(registry)?;
    let bar = body(&simulation, "bar")?;
    let foot = MaterialPoint::new(&simulation, bar, DVec3::ZERO)?;
    let top = MaterialPoint::new(&simulation, bar, LENGTH * DVec3::Z)?;
    let balance = run(&mut simulation, |_| Ok(()))?;
    let length = top.position(&simulation)?.z - foot.position(&simulation)?.z;
    let sides = sides(&simulation)?;
    let lowest = sides.iter().flatten().map(|point| point.z).fold(f64::INFINITY, f64::min);
    let of_radius = Tolerance::Relative(if across < 16 { 0.1 } else { 0.06 });
    let radius = |at: &dyn Fn(&[DVec3]) -> f64| sides.iter().map(|side| at(side)).sum::<f64>() / 2.0;
    let largest = largest_radius(&sides);
    let mut checks = vec![
        Check::new("length", length, SHORTENED, Tolerance::Relative(0.03), "m", SOURCE).converging(),
        Check::new("largest radius", largest, RADIUS, of_radius, "m", SOURCE),
    ];
    for (name, share, reference) in PROFILE {
        let measured = radius(&|side| radius_at(side, lowest + share * LENGTH));
        let check = Check::new(name, measured, reference, of_radius, "m", SOURCE);
        checks.push(if share < 0.1 { check } else { check.converging() });
    }
    checks.push(balance.check(Kind::Inelastic));
    Ok(checks)
}

/// The largest radius at which a line of the surface passes a height, m.
fn radius_at(side: &[DVec3], height: f64) -> f64 {
    let passes = side.windows(2).filter(|pair| (pair[0].z - height) * (pair[1].z - height) <= 0.0);
    let crossing = |pair: &[DVec3]| {
        let share = (height - pair[0].z) / (pair[1].z - pair[0].z);
        distance_from_axis(&pair[0].lerp(pair[1], share))
    };
    passes.map(crossing).fold(0.0, f64::max)
}
