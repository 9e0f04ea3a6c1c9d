//! Cases of solids with Eulerian bodies instead of total-Lagrangian ones, and elastic tension (S20).

use anyhow::Result;
use meshless_engine::glam::DMat3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::{DeformationGradient, PiolaStress, ReferencePosition};

use super::oscillating_plate::{PLATES, plate};
use super::{bending_column, taylor_bars, turek_hron, upsetting};
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::exact::{invariants, jaumann_shear};
use crate::measure::{Disorder, body};
use crate::template::Template;

pub(crate) const AFFINE: Case = Case {
    id: "K2E",
    run: |registry, n| (invariants::AFFINE.run)(&eulerian(registry), n),
    ..invariants::AFFINE
};
pub(crate) const PAIR_TERM: Case = Case {
    id: "K4E",
    run: |registry, n| (invariants::PAIR_TERM.run)(&eulerian(registry), n),
    ..invariants::PAIR_TERM
};
pub(crate) const THROWN: Case = Case {
    id: "K6E",
    title: "thrown, spinning and swinging Eulerian body, 100 periods",
    run: thrown,
    ..invariants::THROWN
};
pub(crate) const SHEAR: Case = Case {
    id: "M4E",
    run: |registry, n| (jaumann_shear::CASE.run)(&eulerian(registry), n),
    ..jaumann_shear::CASE
};
pub(crate) const PLATE: Case = Case {
    id: "S8E",
    title: "oscillating plate, Eulerian",
    resolutions: &[6, 10, 14, 20],
    ci_resolution: 6,
    run: oscillating_plate,
};
pub(crate) const ALUMINIUM: Case = Case {
    id: "S15E",
    title: "Taylor bar of aluminium 6061-T6, Eulerian",
    run: |registry, n| (taylor_bars::ALUMINIUM.run)(&eulerian(registry), n),
    ..taylor_bars::ALUMINIUM
};
pub(crate) const UPSETTING: Case = Case {
    id: "S21E",
    title: "upsetting of an aluminium cylinder, Eulerian",
    run: |registry, n| (upsetting::CASE.run)(&eulerian(registry), n),
    ..upsetting::CASE
};
pub(crate) const FLAG: Case = Case {
    id: "S9E",
    title: "Turek-Hron CSM1, CSM2, CSM3, Eulerian",
    run: |registry, n| (turek_hron::CASE.run)(&eulerian(registry), n),
    ..turek_hron::CASE
};
pub(crate) const COLUMN: Case = Case {
    id: "S11E",
    title: "bending column, Eulerian",
    resolutions: &[10, 12, 16],
    ci_resolution: 10,
    run: bent,
};
pub(crate) const TENSION: Case = Case {
    id: "S20",
    title: "elastic tension of an Eulerian body",
    resolutions: &[10, 14, 20],
    ci_resolution: 10,
    run: tension,
};

fn eulerian(registry: &Registry) -> Registry {
    registry.clone().with_stand_in("TotalLagrangian", "Eulerian")
}

/// Within twice the tolerances of total-Lagrangian bodies, as the oscillating plate.
fn bent(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let checks = (bending_column::CASE.run)(&eulerian(registry), across)?;
    Ok(checks.into_iter().map(|check| check.widened(2.0)).collect())
}

fn thrown(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    (invariants::THROWN.run)(&eulerian(registry), across)
}

/// The resolution at which the thick plate swings for 2.5 s, and the thin one, too, once, which costs nearly
/// twice as much.
const DECAY: usize = 10;

fn oscillating_plate(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let long = across == DECAY;
    let mut checks = Vec::new();
    for (k, of) in PLATES[..if long { 2 } else { 1 }].iter().enumerate() {
        checks.extend(plate(&eulerian(registry), across, *of, long && k == 0)?.into_iter().map(|check| {
            let is_period = check.name.ends_with("period");
            Check { tolerance: if is_period { Tolerance::Relative(0.04) } else { check.tolerance }, ..check }
        }));
    }
    Ok(checks)
}

/// Free length, m, and final nominal strain.
const LENGTH: f64 = 0.04;
const STRAIN: f64 = 0.45;
/// Strain at which a body without control has fractured.
const FRACTURED: f64 = 0.2;

/// `across` is the number of particles over the width of 20 mm.
fn tension(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (stress, disorder) = drawn(registry, across, "hourglass_control(), ", STRAIN)?;
    let (_, free) = drawn(registry, across, "", FRACTURED)?;
    Ok(vec![
        Check::new(
            "mean stress in the middle",
            stress,
            29.4e9,
            Tolerance::Relative(0.03),
            "Pa",
            "E' ln(1.45)",
        ),
        Check::below("hourglass residual at 0.45", disorder, 0.05, "smooth"),
        Check::above("hourglass residual without control at 0.2", free, 0.3, "numerical fracture"),
    ])
}

/// Stretches the plate to a strain; returns the axial Cauchy stress in its middle, and the disorder of the
/// free part.
fn drawn(registry: &Registry, across: usize, control: &str, strain: f64) -> Result<(f64, f64)> {
    let spacing = 0.02 / across as f64;
    let clamps = 3.0 * spacing;
    let mut simulation = Template::new(
        "tests/validation/eulerian_tension/scene.ron",
        include_str!("../../../tests/validation/eulerian_tension/scene.ron"),
    )
    .set("bodies.plate.spacing", spacing)?
    .set("bodies.plate.shape.min", format!("({}, -0.01)", -clamps))?
    .set("bodies.plate.shape.max", format!("({}, 0.01)", LENGTH + clamps))?
    .set("bodies.plate.plugins", format!("[{control}local_damping(rate: 1.95e5)]"))?
    .set("time.end", strain * LENGTH / (2.0 * 19.86))?
    .build(registry)?;
    let id = body(&simulation, "plate")?;
    let free = Disorder::within(&simulation, id, |x| x.x > 0.0 && x.x < LENGTH)?;
    simulation.run(|_| true)?;
    let (view, rows) = simulation.world().body_view(id);
    let reference = view.read::<ReferencePosition>()?;
    let (f, p) = (view.read::<DeformationGradient>()?, view.read::<PiolaStress>()?);
    let cauchy = |k: usize| {
        let sigma: DMat3 = p[k].0 * f[k].0.transpose() * (1.0 / f[k].0.determinant());
        sigma.x_axis.x
    };
    let middle = rows.filter(|&k| (reference[k].0.x - 0.5 * LENGTH).abs() < 1.01 * spacing);
    let stresses: Vec<f64> = middle.map(cauchy).collect();
    Ok((stresses.iter().sum::<f64>() / stresses.len() as f64, free.measure(&simulation)?))
}
