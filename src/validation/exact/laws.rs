//! M1 and M5: hyperelastic laws against closed forms, differences of their energy, and rotations.

use anyhow::{Context, Result, bail};
use meshless_engine::formulations::updated_lagrangian::UpdatedGradient;
use meshless_engine::glam::{DMat3, DQuat, DVec3};
use meshless_engine::invariants::Specimen;
use meshless_engine::materials::{
    DecoupledNeoHookean, Law, Material, MaterialModel, NeoHookean, StVenantKirchhoff, StateRows, StressRows,
};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, PiolaStress};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::template::Template;

pub(crate) const STRETCH: Case = Case {
    id: "M1",
    title: "homogeneous stretch 0.5 to 6",
    resolutions: &[7],
    ci_resolution: 7,
    run: stretch,
};
pub(crate) const CONSISTENCY: Case = Case {
    id: "M5",
    title: "stress is the slope of the energy, and turns with the body",
    resolutions: &[5],
    ci_resolution: 5,
    run: consistency,
};

pub(crate) const OF_BODIES: Case = Case {
    id: "M5U",
    title: "stress after updates is that of the law, and turns with the body, updated-Lagrangian",
    resolutions: &[5],
    ci_resolution: 5,
    run: of_bodies,
};

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;

fn laws() -> Result<[(&'static str, Material); 3]> {
    let (density, young, poisson, bulk, shear) = (1.0, Some(YOUNG), Some(POISSON), None, None);
    Ok([
        ("NeoHookean", NeoHookean { density, young, poisson, bulk, shear }.build()?),
        ("StVenantKirchhoff", StVenantKirchhoff { density, young, poisson, bulk, shear }.build()?),
        ("DecoupledNeoHookean", DecoupledNeoHookean { density, young, poisson, bulk, shear }.build()?),
    ])
}

fn stress_and_energy(material: &Material, deformation: DMat3) -> Result<(DMat3, f64)> {
    let (mut stress, mut energy) = ([DMat3::ZERO], [0.0]);
    let Law::Solid(law) = &material.law else { bail!("not a solid") };
    law.stress(&mut StressRows {
        dt: 0.0,
        deformation: &[deformation],
        share: &[1.0],
        stress_before: &[DMat3::ZERO],
        stress: &mut stress,
        energy: &mut energy,
        modulus: &mut [0.0],
        strength: &mut [f64::INFINITY],
        plastic_work: &mut [0.0],
        state: StateRows::default(),
    });
    Ok((stress[0], energy[0]))
}

/// Maximum error over the stress: uniaxial tension of the reference, uniaxial strain of every law.
fn stretch(_: &Registry, count: usize) -> Result<Vec<Check>> {
    let mut worst = 0.0f64;
    let reference = include_str!("../../../assets/reference/neo_hookean_uniaxial.csv");
    for line in reference.lines().filter(|line| !line.starts_with(['#', 'E'])) {
        let row = line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let &[young, poisson, stretch, _, _, _, _, lateral, wanted, ..] = &row[..] else { bail!("{line}") };
        if !(0.5..=6.0).contains(&stretch) {
            continue;
        }
        let model =
            NeoHookean { density: 1.0, young: Some(young), poisson: Some(poisson), bulk: None, shear: None };
        let deformation = DMat3::from_diagonal(DVec3::new(lateral, stretch, lateral));
        let (stress, _) = stress_and_energy(&model.build()?, deformation)?;
        worst = worst.max((stress.y_axis.y - wanted).abs() / wanted.abs().max(young));
    }
    let mut checks = vec![Check::below("NeoHookean, uniaxial tension", worst, 1e-6, "assets/reference")];
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let bulk = YOUNG / (3.0 * (1.0 - 2.0 * POISSON));
    let lambda = bulk - 2.0 / 3.0 * shear;
    let wanted: [fn(f64, f64, f64, f64) -> f64; 3] = [
        |s, lambda, shear, _| shear * (s - 1.0 / s) + lambda * s.ln() / s,
        |s, lambda, shear, _| 0.5 * (lambda + 2.0 * shear) * s * (s * s - 1.0),
        |s, _, shear, bulk| 2.0 / 3.0 * shear * s.powf(-5.0 / 3.0) * (s * s - 1.0) + bulk * (s - 1.0),
    ];
    for ((name, material), wanted) in laws()?.iter().zip(wanted) {
        let mut worst = 0.0f64;
        for k in 0..count {
            let s = 0.5 + 5.5 * k as f64 / (count - 1).max(1) as f64;
            let (stress, _) = stress_and_energy(material, DMat3::from_diagonal(DVec3::new(1.0, s, 1.0)))?;
            let wanted = wanted(s, lambda, shear, bulk);
            worst = worst.max((stress.y_axis.y - wanted).abs() / wanted.abs().max(YOUNG));
        }
        checks.push(Check::below(format!("{name}, uniaxial strain"), worst, 1e-6, "closed form"));
    }
    Ok(checks)
}

fn consistency(_: &Registry, count: usize) -> Result<Vec<Check>> {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.3, 1.0, -0.4).normalize(), 2.1));
    let sheared =
        DMat3::from_cols(DVec3::new(1.4, 0.1, -0.2), DVec3::new(0.3, 0.7, 0.1), DVec3::new(-0.1, 0.2, 1.1));
    let mut checks = Vec::new();
    for (name, material) in &laws()? {
        let (mut slope, mut rotation) = (0.0f64, 0.0f64);
        for k in 0..count {
            let deformation = sheared * (0.6 + 0.4 * k as f64);
            let (stress, _) = stress_and_energy(material, deformation)?;
            let largest = stress.to_cols_array().into_iter().map(f64::abs).max_by(f64::total_cmp);
            let scale = largest.context("a stress has components")?.max(YOUNG);
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                let energy = |by: f64| {
                    let mut moved = deformation;
                    moved.col_mut(column)[row] += by;
                    stress_and_energy(material, moved).map(|(_, energy)| energy)
                };
                let h = 1e-5;
                let near = 8.0 * (energy(h)? - energy(-h)?);
                let difference = (near - (energy(2.0 * h)? - energy(-2.0 * h)?)) / (12.0 * h);
                slope = slope.max((stress.col(column)[row] - difference).abs() / scale);
            }
            let (turned, _) = stress_and_energy(material, turn * deformation)?;
            let off = (turned - turn * stress).to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
            rotation = rotation.max(off / scale);
        }
        checks.push(Check::below(format!("{name}, stress less slope of energy"), slope, 1e-6, "exact"));
        let text = format!("{name}, stress of the rotated body");
        checks.push(Check::new(text, rotation, 0.0, Tolerance::Absolute(1e-6), "1", "exact"));
    }
    Ok(checks)
}

/// Stress of bodies under a prescribed affine map whose reference is updated three times.
fn of_bodies(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let sheared = DMat3::from_cols(DVec3::new(1.4, 0.1, 0.0), DVec3::new(0.3, 0.7, 0.0), DVec3::Z);
    let mut checks = Vec::new();
    for (name, material) in &laws()? {
        for (what, turn) in [
            ("stress of a body", DMat3::IDENTITY),
            ("stress of the turned body", DMat3::from_rotation_z(0.8)),
        ] {
            let (stress, _) = stress_and_energy(material, sheared)?;
            let (wanted, map) = (turn * stress, turn * sheared);
            let simulation = held(registry, across, name, map)?;
            let (view, rows) = simulation.world().body_view(BodyId(0));
            let (found, reference) = (view.read::<PiolaStress>()?, view.read::<UpdatedGradient>()?);
            let error = |row: usize| {
                (found[row].0 - wanted).to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max)
            };
            let worst = rows.clone().map(error).fold(0.0, f64::max) / YOUNG;
            checks.push(Check::below(format!("{name}, {what}"), worst, 1e-9, "the law"));
            let off = |row: usize| {
                (reference[row].0 - map).to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max)
            };
            let farthest = rows.map(off).fold(0.0, f64::max);
            checks.push(Check::below(
                format!("{name}, {what}: the reference follows it"),
                farthest,
                1e-9,
                "exact",
            ));
        }
    }
    Ok(checks)
}

/// A body under an affine map, after three very short steps with an update each.
fn held(registry: &Registry, across: usize, law: &str, map: DMat3) -> Result<Simulation> {
    let template = Template::new(
        "tests/validation/invariants/scene.ron",
        include_str!("../../../tests/validation/invariants/scene.ron"),
    );
    let template = template
        .set("bodies.block.spacing", 0.5 / across as f64)?
        .set("bodies.block.formulation", "UpdatedLagrangian(update: Every(1))")?
        .set("materials.soft", format!("{law}(density: 1.0, young: {YOUNG:?}, poisson: {POISSON:?})"))?
        .set("time", "(end: 1.0, step: Fixed(1e-12))")?;
    let make = || -> Result<Simulation> { Ok(template.clone().build(registry)?) };
    let mut simulation = Specimen::new(&make).moved(|_, x| map * x, |_| DVec3::ZERO)?;
    for _ in 0..3 {
        simulation.step()?;
    }
    Ok(simulation)
}
