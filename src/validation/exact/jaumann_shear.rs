//! M4: simple shear with the Jaumann rate.

use anyhow::Result;
use meshless_engine::plugin::Registry;

use super::homogeneous::{Worst, cauchy};
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Record, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "M4",
    title: "Jaumann rate in simple shear",
    resolutions: &[300, 600, 1200],
    ci_resolution: 600,
    run: jaumann_shear,
};

const REFERENCE: &str = include_str!("../../../tests/validation/jaumann_shear/reference.csv");
const SHEAR: f64 = 1.0e9;

fn jaumann_shear(registry: &Registry, steps: usize) -> Result<Vec<Check>> {
    let path = "tests/validation/jaumann_shear/scene.ron";
    let mut simulation =
        Template::new(path, include_str!("../../../tests/validation/jaumann_shear/scene.ron"))
            .set("time.step", format!("Fixed({:e})", 1.0 / steps as f64))?
            .build(registry)?;
    let across = Record::read(REFERENCE, "gamma", "sxy_over_G_jaumann")?;
    let along = Record::read(REFERENCE, "gamma", "sxx_over_G_jaumann")?;
    let [mut of_across, mut of_along] = [Worst::default(); 2];
    run(&mut simulation, |simulation| {
        let gamma = 6.0 * simulation.clock().time;
        let sigma = cauchy(simulation)? * (1.0 / SHEAR);
        for (&(at, sxy), &(_, sxx)) in across.0.iter().zip(&along.0) {
            if (at - gamma).abs() < 1e-9 {
                of_across.add(sigma.y_axis.x, sxy, 1.0);
                of_along.add(sigma.x_axis.x, sxx, 1.0);
            }
        }
        Ok(())
    })?;
    let check = |what: &str, worst: Worst| {
        let tolerance = Tolerance::Absolute(1e-3);
        Check::new(what, worst.measured, worst.reference, tolerance, "G", "Dienes 1979, reference.csv")
            .converging()
    };
    Ok(vec![
        check("shear stress where it is farthest off", of_across),
        check("normal stress where it is farthest off", of_along),
    ])
}
