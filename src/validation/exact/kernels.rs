//! K1: kernels and corrected gradients against closed forms.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use meshless_engine::correction::MomentMatrix;
use meshless_engine::glam::DVec3;
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::neighbors::{Cloud, NeighborList, Periodic};
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::Random;

pub(crate) const CASE: Case = Case {
    id: "K1",
    title: "kernels and corrected gradients",
    resolutions: &[8],
    ci_resolution: 8,
    run: kernels,
};

fn kernels(_: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for (name, dimension, value) in [
        (KernelName::CubicSpline, 2, 10.0 / (7.0 * PI)),
        (KernelName::CubicSpline, 3, 1.0 / PI),
        (KernelName::WendlandC2, 2, 7.0 / (4.0 * PI)),
        (KernelName::WendlandC2, 3, 21.0 / (16.0 * PI)),
    ] {
        let found = kernel(name, dimension)?.w(0.0, 1.0);
        let text = format!("W(0) of {} in {dimension} dimensions", name.as_str());
        checks.push(Check::new(text, found, value, Tolerance::Relative(1e-7), "1", "closed form"));
    }
    for dimension in [2, 3] {
        let (mut integral, mut slope, mut linear) = (0.0f64, 0.0f64, 0.0f64);
        for &name in KernelName::ALL {
            let kernel = kernel(name, dimension)?;
            integral = integral.max((mass(kernel) - 1.0).abs());
            slope = slope.max(slope_error(kernel));
            linear = linear.max(gradient_error(kernel, across)?);
        }
        let text = |what: &str| format!("{what}, all kernels, {dimension} dimensions");
        checks.push(Check::below(text("integral of W less one"), integral, 1e-7, "normalised"));
        checks.push(Check::below(text("W' against differences"), slope, 1e-7, "consistent"));
        checks.push(Check::below(text("gradient of a linear field"), linear, 1e-10, "exact"));
    }
    Ok(checks)
}

fn kernel(name: KernelName, dimension: usize) -> Result<Kernel> {
    Kernel::new(name, dimension).with_context(|| format!("no {} in {dimension} dimensions", name.as_str()))
}

/// Integral over space by Simpson's rule.
fn mass(kernel: Kernel) -> f64 {
    let count = 4000;
    let step = kernel.support_radius(1.0) / f64::from(count);
    let density = |k: i32| {
        let r = step * f64::from(k);
        let shell = if kernel.dimension() == 2 { 2.0 * PI * r } else { 4.0 * PI * r * r };
        shell * kernel.w(r, 1.0)
    };
    let weight = |k: i32| match k {
        0 => 1.0,
        k if k == count => 1.0,
        k if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=count).map(|k| weight(k) * density(k)).sum::<f64>() * step / 3.0
}

/// Maximum error of the slope, over W(0).
fn slope_error(kernel: Kernel) -> f64 {
    let (step, edge) = (1e-5, kernel.support_radius(1.0));
    let error = |k: i32| {
        let r = edge * (f64::from(k) + 0.37) / 200.0;
        let difference = (kernel.w(r + step, 1.0) - kernel.w(r - step, 1.0)) / (2.0 * step);
        (difference - kernel.dw_dr(r, 1.0)).abs() / kernel.w(0.0, 1.0)
    };
    (1..199).map(error).fold(0.0, f64::max)
}

/// Maximum relative error of the corrected gradient of a linear field on a disordered cloud.
fn gradient_error(kernel: Kernel, across: usize) -> Result<f64> {
    let mut random = Random::new(11);
    let dimension = kernel.dimension();
    let count = across.pow(dimension as u32);
    let place = |k: usize, random: &mut Random| {
        let mut x = DVec3::ZERO;
        for axis in 0..dimension {
            x[axis] = (k / across.pow(axis as u32) % across) as f64 + 0.8 * (random.next() - 0.5);
        }
        x
    };
    let places: Vec<DVec3> = (0..count).map(|k| place(k, &mut random)).collect();
    let volumes: Vec<f64> = (0..count).map(|_| 0.7 + 0.6 * random.next()).collect();
    let slope = DVec3::new(0.3, -1.2, if dimension == 3 { 0.7 } else { 0.0 });
    let support = 3.2;
    let h = kernel.smoothing_length(support);
    let list = NeighborList::reference(Cloud::uniform(&places, support), &Periodic::NONE)?;
    let mut worst = 0.0f64;
    for i in 0..count {
        let (mut moment, mut sum) = (MomentMatrix::new(dimension), DVec3::ZERO);
        for &j in list.row(i) {
            let x_ij = places[j as usize] - places[i];
            let weight = volumes[j as usize] * kernel.pair_weight(x_ij.length(), h);
            moment.add(weight, x_ij);
            sum += weight * slope.dot(x_ij) * x_ij;
        }
        let inverse = moment.inverse().context("a particle has too few neighbours")?;
        worst = worst.max((inverse * sum - slope).length() / slope.length());
    }
    Ok(worst)
}
