//! C5: orthogonal cutting of aluminium by a rigid tool.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{
    BodyId, Damage, PlasticStrain, Position, ReferencePosition, ReferenceVolume, Removed, Temperature,
};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, body, run, state};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "C5",
    title: "metal cutting",
    resolutions: &[5, 10, 20],
    ci_resolution: 10,
    run: metal_cutting,
};

/// Depth of cut, and positions of the cut and of the free surface in the workpiece, m.
const DEPTH: f64 = 2.0e-4;
const CUT: f64 = 2.0e-4;
const TOP: f64 = 4.0e-4;
/// Friction.
const FRICTION: f64 = 0.2;
/// Interval over which forces are averaged, s: the chip has formed, and no crack has run through it at any of
/// the resolutions.
const PRESSED: [f64; 2] = [6.0e-6, 1.8e-5];
/// Heights above the free surface between which the chip is measured, in depths of cut: clear of its root,
/// and reached before the first crack moves its parts away from each other.
const CHIP: [f64; 2] = [0.25, 0.75];
/// Time over which its thickness is averaged from when it has reached the upper height, s.
const MEASURED: f64 = 1.0e-6;
/// Duration at the resolution of the tests, and at others, s.
const ENDS: [f64; 2] = [3.0e-5, 5.0e-5];

/// `across` is the number of particles in the depth of cut.
fn metal_cutting(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = DEPTH / across as f64;
    let held = 3.0 * spacing;
    let mut simulation = Template::new(
        "tests/validation/metal_cutting/scene.ron",
        include_str!("../../../tests/validation/metal_cutting/scene.ron"),
    )
    .set("time.end", ENDS[usize::from(across != CASE.ci_resolution)])?
    .set("bodies.workpiece.spacing", spacing)?
    .set("bodies.workpiece.shape.min", format!("(0, {})", -held))?
    .set("bodies.workpiece.shape.max", format!("({}, 4.0e-4)", 1.0e-3 + held))?
    .build(registry)?;
    let workpiece = body(&simulation, "workpiece")?;
    let (mut cutting, mut thrust, mut thickness) =
        (MeanOverSteps::default(), MeanOverSteps::default(), MeanOverSteps::default());
    let (mut strength, mut risen) = (None, None);
    let balance = run(&mut simulation, |simulation| {
        let time = simulation.clock().time;
        if (PRESSED[0]..PRESSED[1]).contains(&time) {
            let force = state(simulation, "tool")?.force;
            cutting.add(-force.x);
            thrust.add(force.y);
        } else if time >= PRESSED[1] && strength.is_none() {
            strength = Some(shear_strength(simulation, workpiece)?);
        }
        if risen.is_none_or(|since| time < since + MEASURED)
            && let Some(of_chip) = chip_thickness(simulation, workpiece)?
        {
            risen.get_or_insert(time);
            thickness.add(of_chip);
        }
        Ok(())
    })?;
    let (cutting, thrust) = (cutting.value(), thrust.value());
    let expected = strength.context("the run is too short")? * force_over_strength();
    let shear_angle = (DEPTH / thickness.value()).atan().to_degrees();
    let off = failed_off_the_cut(&simulation, workpiece)? / DEPTH;
    let source = "shear plane between Lee-Shaffer and Merchant";
    Ok(vec![
        Check::new("cutting force", cutting, expected, Tolerance::Relative(0.25), "N/m", source),
        Check::new(
            "thrust over cutting force",
            thrust / cutting,
            FRICTION,
            Tolerance::Relative(0.25),
            "1",
            "friction",
        ),
        Check::new(
            "shear angle by the thickness of the chip",
            shear_angle,
            usual_shear_angle().to_degrees(),
            Tolerance::Relative(0.2),
            "deg",
            source,
        ),
        Check::below("failed particles from the cut, in depths", off, 0.4, "the chip parts along the cut"),
        balance.check(Kind::Smooth),
    ])
}

/// A mean over steps.
#[derive(Default)]
struct MeanOverSteps {
    sum: f64,
    count: f64,
}

impl MeanOverSteps {
    fn add(&mut self, value: f64) {
        (self.sum, self.count) = (self.sum + value, self.count + 1.0);
    }

    fn value(&self) -> f64 {
        self.sum / self.count
    }
}

/// The shear angle phi half-way between Lee and Shaffer's 45 deg - beta and Merchant's 45 deg - beta/2, with
/// rake 0 and the friction angle beta.
fn usual_shear_angle() -> f64 {
    std::f64::consts::FRAC_PI_4 - 0.75 * FRICTION.atan()
}

/// d cos(beta) / (sin(phi) cos(phi + beta)), m.
fn force_over_strength() -> f64 {
    let (beta, phi) = (FRICTION.atan(), usual_shear_angle());
    DEPTH * beta.cos() / (phi.sin() * (phi + beta).cos())
}

/// Shear flow stress, the flow stress over sqrt 3, at the mean strain and temperature of the sheared material
/// that has not failed and a strain rate of v / (d / 10), Pa.
fn shear_strength(simulation: &Simulation, workpiece: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(workpiece);
    let (strain, damage) = (view.read::<PlasticStrain>()?, view.read::<Damage>()?);
    let temperature = view.read::<Temperature>()?;
    let sheared: Vec<usize> = rows.filter(|&k| strain[k].0 > 0.3 && damage[k].0 < 1.0).collect();
    let mean = |of: &dyn Fn(usize) -> f64| sheared.iter().map(|&k| of(k)).sum::<f64>() / sheared.len() as f64;
    let (strain, temperature) = (mean(&|k| strain[k].0), mean(&|k| temperature[k].0));
    let hot = ((temperature - 292.0) / (925.0 - 292.0)).max(0.0);
    let rate: f64 = 10.0 / (DEPTH / 10.0);
    let flow = (164.0e6 + 211.0e6 * strain.powf(0.465)) * (1.0 + 0.002 * rate.ln()) * (1.0 - hot.powf(1.419));
    Ok(flow / 3f64.sqrt())
}

/// Thickness of a chip that has reached the upper height, m: area of the material that was above the cut and
/// is now between two heights beside the rake face, over their difference.
fn chip_thickness(simulation: &Simulation, workpiece: BodyId) -> Result<Option<f64>> {
    let (view, rows) = simulation.world().body_view(workpiece);
    let (reference, position) = (view.read::<ReferencePosition>()?, view.read::<Position>()?);
    let (volume, removed) = (view.read::<ReferenceVolume>()?, view.read::<Removed>()?);
    let [low, high] = CHIP.map(|height| TOP + height * DEPTH);
    let chip = || rows.clone().filter(|&k| removed[k] == Removed::NO && reference[k].0.y > CUT);
    let area =
        || chip().filter(|&k| (low..high).contains(&position[k].0.y)).map(|k| volume[k].0).sum::<f64>();
    Ok(chip().any(|k| position[k].0.y >= high).then(|| area() / (high - low)))
}

/// Mean distance of failed particles from the cut, in the reference configuration of the workpiece, m.
fn failed_off_the_cut(simulation: &Simulation, workpiece: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(workpiece);
    let (reference, damage) = (view.read::<ReferencePosition>()?, view.read::<Damage>()?);
    let failed: Vec<f64> =
        rows.filter(|&k| damage[k].0 >= 1.0).map(|k| (reference[k].0.y - CUT).abs()).collect();
    Ok(failed.iter().sum::<f64>() / failed.len() as f64)
}
