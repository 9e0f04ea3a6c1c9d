//! M3: flow stress of Johnson and Cook, isothermal and adiabatic.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;
use meshless_engine::world::{EquivalentStress, PlasticStrain, Temperature};

use super::homogeneous::{Worst, value};
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::run;
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "M3",
    title: "flow stress of Johnson and Cook",
    resolutions: &[500, 1000, 2000],
    ci_resolution: 500,
    run: johnson_cook,
};

const REFERENCE: &str = include_str!("../../../tests/validation/johnson_cook/reference.csv");
const SOURCE: &str = "ordinary differential equation, reference.csv";

/// Name in the reference, parameters, and thermal parameters.
const METALS: [(&str, &str, &str); 3] = [
    (
        "Al6061-T6 (Table1)",
        "density: 2800.0, a: 164.0e6, b: 211.0e6, n: 0.465, c: 0.002, m: 1.419, reference_temperature: 292.0, melt_temperature: 925.0",
        "specific_heat: 885.0",
    ),
    (
        "PMMA (Table1)",
        "density: 1186.0, a: 212.0e6, b: 580.0e6, n: 3.5, c: 0.081, m: 0.749, reference_rate: 0.001, reference_temperature: 213.0, \
         melt_temperature: 398.0, temperature: 292.0",
        "specific_heat: 1470.0",
    ),
    (
        "42CrMo4 (DynELA)",
        "density: 7830.0, a: 806.0e6, b: 614.0e6, n: 0.168, c: 0.0089, m: 1.1, reference_temperature: 293.15, melt_temperature: 1813.15",
        "specific_heat: 460.0",
    ),
];

fn johnson_cook(registry: &Registry, steps: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for (name, parameters, heat) in METALS {
        let [mut isothermal, mut adiabatic, mut temperature] = [Worst::default(); 3];
        for rate in ["0.001", "1", "1000", "100000"] {
            let rows = rows(name, rate)?;
            let cold = curve(registry, steps, parameters, rate)?;
            let hot = curve(registry, steps, &format!("{parameters}, {heat}"), rate)?;
            // The row without plastic strain lies before the first step.
            for [strain, slow, fast, heated] in rows.into_iter().filter(|row| row[0] > 0.0) {
                let (stress, _) = at(&cold, strain)?;
                isothermal.add(stress, slow * 1e6, slow * 1e6);
                let (stress, kelvin) = at(&hot, strain)?;
                adiabatic.add(stress, fast * 1e6, fast * 1e6);
                temperature.add(kelvin, heated, heated);
            }
        }
        let check = |what: &str, worst: Worst, unit| {
            let tolerance = Tolerance::Relative(0.005);
            Check::new(format!("{name}: {what}"), worst.measured, worst.reference, tolerance, unit, SOURCE)
        };
        checks.push(check("worst flow stress, isothermal", isothermal, "Pa"));
        checks.push(check("worst flow stress, adiabatic", adiabatic, "Pa"));
        checks.push(check("worst temperature", temperature, "K"));
    }
    Ok(checks)
}

/// Plastic strain, flow stress isothermal and adiabatic, MPa, and temperature, K, of a metal at a rate.
fn rows(name: &str, rate: &str) -> Result<Vec<[f64; 4]>> {
    let lines = REFERENCE.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let own = lines.filter(|row| row.len() == 6 && row[0] == name && row[1] == rate);
    // The reference has the temperature of the steel in degrees Celsius.
    let zero = if name.starts_with("42CrMo4") { 273.15 } else { 0.0 };
    let read = |row: Vec<&str>| {
        Ok([row[2].parse()?, row[3].parse()?, row[4].parse()?, row[5].parse::<f64>()? + zero])
    };
    own.map(read).collect()
}

/// Plastic strain, equivalent stress, Pa, and temperature, K, step by step.
fn curve(registry: &Registry, steps: usize, parameters: &str, rate: &str) -> Result<Vec<[f64; 3]>> {
    let duration = 1.05 / rate.parse::<f64>()?;
    let path = "tests/validation/johnson_cook/scene.ron";
    let mut simulation =
        Template::new(path, include_str!("../../../tests/validation/johnson_cook/scene.ron"))
            .set("materials.metal", format!("JohnsonCook(young: 7.0e12, poisson: 0.33, {parameters})"))?
            .set("conditions", format!(
                "[Displacement(on: Select(body: \"block\"), value: (\"x*(exp({rate}*t*sqrt(3)/2)-1)\", \"y*(exp(-{rate}*t*sqrt(3)/2)-1)\"))]"
            ))?
            .set("time", format!("(end: {duration:e}, step: Fixed({:e}))", duration / steps as f64))?
            .build(registry)?;
    let mut curve = Vec::with_capacity(steps);
    run(&mut simulation, |simulation| {
        curve.push([
            value::<PlasticStrain>(simulation)?,
            value::<EquivalentStress>(simulation)?,
            value::<Temperature>(simulation)?,
        ]);
        Ok(())
    })?;
    Ok(curve)
}

/// Stress and temperature at a plastic strain, between two steps.
fn at(curve: &[[f64; 3]], strain: f64) -> Result<(f64, f64)> {
    let pair = curve.windows(2).find(|pair| pair[0][0] < strain && pair[1][0] >= strain);
    let [before, after] =
        pair.and_then(|pair| <[_; 2]>::try_from(pair).ok()).context("strain not reached")?;
    let share = (strain - before[0]) / (after[0] - before[0]);
    let between = |k: usize| before[k] + share * (after[k] - before[k]);
    Ok((between(1), between(2)))
}
