//! X3: a rubber gate in front of water, and the gate alone under a constant load.

use anyhow::{Context, Result};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, relax, run};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "X3", title: "elastic gate", resolutions: &[8, 12, 16], ci_resolution: 12, run: elastic_gate };

/// Thickness of the gate and its free length, m.
const THICKNESS: f64 = 5.0e-3;
const LENGTH: f64 = 79.0e-3;
/// A gate in air.
#[derive(Clone, Copy)]
struct DryGate {
    /// Young's modulus, Pa.
    young: f64,
    poisson: f64,
    /// Displacement of its end at rest, m: sideways and up.
    end: [f64; 2],
}

const DRY: [DryGate; 2] = [
    DryGate { young: 12.0e6, poisson: 0.4, end: [32.64e-3, 8.22e-3] },
    DryGate { young: 7.8e6, poisson: 0.47, end: [41.45e-3, 13.82e-3] },
];
const SOURCE: &str = "elastica in plane strain, reference.csv";
/// The gate is also computed in water if the number of particles across is a multiple of this, and compared
/// with half as many: the lattices of the gate and of the tank then end at the same height.
const FINE: usize = 16;
/// Maximum energy of the hourglass control, over the strain energy.
const SHARE: f64 = 0.1;

/// `across` is the number of particles over the thickness of the gate.
fn elastic_gate(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    // The tests run only the material of the experiment.
    let count = if across == CASE.ci_resolution { 1 } else { DRY.len() };
    for material in &DRY[..count] {
        checks.extend(dry(registry, across, *material)?);
    }
    // The displacements of the material that every resolution runs.
    checks[..2].iter_mut().for_each(|check| check.converges = true);
    if across.is_multiple_of(FINE) {
        checks.extend(wet(registry, across)?);
    }
    Ok(checks)
}

fn dry(registry: &Registry, across: usize, gate: DryGate) -> Result<Vec<Check>> {
    let DryGate { young, poisson, end } = gate;
    let spacing = THICKNESS / across as f64;
    let path = "tests/validation/elastic_gate/dry.ron";
    let text = include_str!("../../../tests/validation/elastic_gate/dry.ron");
    let mut simulation = Template::new(path, text)
        .set("materials.rubber.young", young)?
        .set("materials.rubber.poisson", poisson)?
        .set("bodies.gate.spacing", spacing)?
        .set("bodies.gate.shape.max", format!("({THICKNESS}, {})", 3.0 * spacing))?
        .build(registry)?;
    let gate = body(&simulation, "gate")?;
    let middle = MaterialPoint::new(&simulation, gate, DVec3::new(0.5 * THICKNESS, -LENGTH, 0.0))?;
    relax(&mut simulation)?;
    let moved = middle.displacement(&simulation)?;
    let name = |what: &str| format!("dry gate, {} MPa: {what}", young / 1e6);
    let check = |what, measured, reference| {
        let tolerance = Tolerance::Relative(0.02);
        Check::new(name(what), measured, reference, tolerance, "m", SOURCE)
    };
    Ok(vec![
        check("its end, to the side", moved.x, end[0]),
        check("its end, up", moved.y, end[1]),
        Check::below(name("control over strain energy"), control_share(&simulation), SHARE, "resolved"),
    ])
}

/// Energy of the hourglass control over the strain energy.
fn control_share(simulation: &Simulation) -> f64 {
    let ledger = simulation.ledger();
    ledger.total_named("hourglass") / ledger.total_named("strain")
}

/// The gate in water: fine, coarse, and with a fifth of the coefficient of the hourglass control.
fn wet(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let fine = flood(registry, across, 5.0)?;
    let coarse = flood(registry, across / 2, 5.0)?;
    let soft = flood(registry, across, 1.0)?;
    let pair = |name: &str, measured, reference, tolerance, source| {
        Check::new(name, measured, reference, Tolerance::Relative(tolerance), "m", source)
    };
    let (half, control) = ("the finer run", "the default of the control");
    Ok(vec![
        pair("in water, half the fineness: to the side", coarse.moved[0], fine.moved[0], 0.03, half),
        pair("in water, half the fineness: up", coarse.moved[1], fine.moved[1], 0.06, half),
        pair("in water, a fifth of the control: to the side", soft.moved[0], fine.moved[0], 0.03, control),
        pair("in water, a fifth of the control: up", soft.moved[1], fine.moved[1], 0.03, control),
        Check::below("in water: control over strain energy", fine.share, SHARE, "resolved"),
        fine.balance,
    ])
}

/// Results for the gate in water.
struct Flood {
    /// Maximum displacement of its lower corner sideways and up, m.
    moved: [f64; 2],
    /// Energy of the hourglass control over the strain energy at the maximum displacement.
    share: f64,
    balance: Check,
}

fn flood(registry: &Registry, across: usize, alpha: f64) -> Result<Flood> {
    let wet = 4.0 * THICKNESS / across as f64;
    let side = 4.0 * wet;
    let path = "tests/validation/elastic_gate/scene.ron";
    let text = include_str!("../../../tests/validation/elastic_gate/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", wet)?
        .set("bodies.tank.spacing", wet)?
        .set("bodies.gate.spacing", THICKNESS / across as f64)?
        .set("bodies.gate.plugins", format!("[hourglass_control(alpha: {alpha:?})]"))?
        .set("bodies.tank.shape[0][0].min", format!("({}, 0.0)", -side))?
        .set("bodies.tank.shape[0][1].min", format!("({}, {})", -side, -side))?
        .build(registry)?;
    let gate = body(&simulation, "gate")?;
    let corner = MaterialPoint::new(&simulation, gate, DVec3::new(0.1 + THICKNESS, 0.0, 0.0))?;
    let (mut aside, mut up) = (Record::default(), Record::default());
    let (mut largest, mut share) = (0.0, 0.0);
    let balance = run(&mut simulation, |simulation| {
        let (time, moved) = (simulation.clock().time, corner.displacement(simulation)?);
        aside.push(time, moved.x);
        up.push(time, moved.y);
        if moved.x > largest {
            (largest, share) = (moved.x, control_share(simulation));
        }
        Ok(())
    })?;
    let peak = |record: &Record| record.maximum().context("the gate does not come back");
    Ok(Flood {
        moved: [peak(&aside)?.1, peak(&up)?.1],
        share,
        balance: balance.check_of("in water", Kind::Smooth),
    })
}
