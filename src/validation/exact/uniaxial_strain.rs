//! M2: J2 plasticity in uniaxial strain.

use anyhow::Result;
use meshless_engine::glam::DMat3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::PlasticStrain;

use super::homogeneous::{Worst, cauchy, kirchhoff, value};
use crate::case::Case;
use crate::check::Check;
use crate::measure::{Record, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "M2",
    title: "J2 in uniaxial strain",
    resolutions: &[400, 800],
    ci_resolution: 400,
    run: uniaxial_strain,
};

const REFERENCE: &str = include_str!("../../../tests/validation/uniaxial_strain/reference.csv");
const SOURCE: &str = "closed form, reference.csv";

/// A metal of the reference.
struct Metal {
    name: &'static str,
    parameters: &'static str,
    /// Shear modulus, yield stress, hardening modulus, Pa.
    constants: (f64, f64, f64),
}

const METALS: [Metal; 3] = [
    Metal {
        name: "Al6061",
        parameters: "density: 2800.0, bulk: 69.0e9, shear: 26.5e9, hardening: Perfect(yield_stress: 164.0e6)",
        constants: (26.5e9, 164.0e6, 0.0),
    },
    Metal {
        name: "Ganzenmueller",
        parameters: "density: 2700.0, young: 78.2e9, poisson: 0.3, hardening: Perfect(yield_stress: 1.0e9)",
        constants: (78.2e9 / 2.6, 1.0e9, 0.0),
    },
    Metal {
        name: "Cu",
        parameters: "density: 8930.0, young: 117.0e9, poisson: 0.35, hardening: Linear(yield_stress: 400.0e6, modulus: 100.0e6)",
        constants: (117.0e9 / 2.7, 400.0e6, 100.0e6),
    },
];

/// The part of the reference that belongs to a metal, with the heads of its columns.
fn table(metal: &Metal) -> String {
    let plain = |line: &&str| line.starts_with("material") || line.replace('"', "").starts_with(metal.name);
    // The name of the metal may hold a comma of its own: the columns behind it count.
    let lines = REFERENCE.lines().filter(plain).map(|line| line.rsplitn(8, ',').collect::<Vec<_>>());
    let rows = lines.map(|mut row| {
        row.truncate(7);
        row.reverse();
        row.join(",")
    });
    rows.collect::<Vec<_>>().join("\n")
}

fn uniaxial_strain(registry: &Registry, steps: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for metal in &METALS {
        for (law, column) in [("J2", "axial_stress_comp_logEOS"), ("Hypoelastic", "axial_stress_comp_rhoEOS")]
        {
            let [stress, plastic, back] = errors(registry, steps, metal, law, column)?;
            let check = |what: &str, worst: Worst| {
                Check::below(format!("{} {law}: {what}", metal.name), worst.error(), 1e-6, SOURCE)
            };
            checks.push(check("error of the axial stress", stress));
            checks.push(check("error of the plastic strain", plastic));
            checks.push(check("error of q in unloading", back));
        }
    }
    Ok(checks)
}

fn errors(registry: &Registry, steps: usize, metal: &Metal, law: &str, column: &str) -> Result<[Worst; 3]> {
    let path = "tests/validation/uniaxial_strain/scene.ron";
    let mut simulation =
        Template::new(path, include_str!("../../../tests/validation/uniaxial_strain/scene.ron"))
            .set("materials.metal", format!("{law}({})", metal.parameters))?
            .set("time.step", format!("Fixed({})", 1.6 / steps as f64))?
            .build(registry)?;
    let table = table(metal);
    let stress = Record::read(&table, "log_strain_comp", column)?;
    let plastic = Record::read(&table, "log_strain_comp", "ep")?;
    let (shear, yield_stress, hardening) = metal.constants;
    let largest = stress.0.last().map_or(0.0, |row| row.1);
    let [mut of_stress, mut of_plastic, mut of_back] = [Worst::default(); 3];
    let mut turned = 0.0;
    run(&mut simulation, |simulation| {
        let tau = if law == "J2" { kirchhoff(simulation)? } else { cauchy(simulation)? };
        let q = tau.y_axis.y - tau.x_axis.x;
        let time = simulation.clock().time;
        if time <= 1.0 + 1e-9 {
            turned = q;
            let at =
                |record: &Record| record.0.iter().find(|row| (row.0 - 0.05 * time).abs() < 1e-9).copied();
            if let (Some((_, wanted)), Some((_, strain))) = (at(&stress), at(&plastic)) {
                of_stress.add(-tau.x_axis.x, wanted, largest);
                of_plastic.add(value::<PlasticStrain>(simulation)?, strain, 1.0);
            }
        } else {
            // Elastic until the stress is turned around; then plastic flow the other way.
            let drawn = 2.0 * shear * 0.05 * (time - 1.0);
            let beyond = drawn - 2.0 * turned;
            let flow = turned + hardening * beyond / (3.0 * shear + hardening);
            let wanted = if beyond < 0.0 { turned - drawn } else { -flow };
            of_back.add(q, wanted, yield_stress.max(tensor_size(&tau) * 1e-3));
        }
        Ok(())
    })?;
    Ok([of_stress, of_plastic, of_back])
}

fn tensor_size(tau: &DMat3) -> f64 {
    tau.x_axis.x.abs().max(tau.y_axis.y.abs())
}
