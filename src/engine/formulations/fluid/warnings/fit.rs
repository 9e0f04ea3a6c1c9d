//! Whether the lattices of a fluid and of its boundaries fit at the start.
//!
//! Where particles of the two overlap or leave a gap, the densities of the fluid do not reflect it: the
//! effective position of a surface is wrong by up to half a spacing, and forces are those of uneven
//! particles. `sum_j V_j W_ij` of the particles beside the boundary shows it.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::filling::filling;
use crate::formulations::fluid::cloud::{FlowCloud, RowSums};
use crate::schedule::Step;

/// Distance of the particles beside a boundary from one of its particles, over their spacing.
const BESIDE: f64 = 1.5;
/// Root mean square difference of the filling beside a boundary from that in the fluid that is worth a
/// warning: a gap of a quarter of a spacing along a plane. Round bodies in square lattices have 0.03.
const MAX_DEVIATION: f64 = 0.04;
/// Minimum number of particles for a mean.
const MIN_COUNT: usize = 8;
/// Distances of particles that face a boundary across a gap from the nearest one of it, over the mean of both
/// spacings: half a spacing to two of empty space. Particles farther away are meant to fall.
const ACROSS: Range<f64> = 1.5..3.0;
/// Part of the particles that face a boundary that has to be across a gap: stairs of round bodies have a few.
const PART: f64 = 0.2;
/// Share of the distance from a boundary within which another particle of the flow is in between.
const BETWEEN: f64 = 0.9;

/// Warns of lattices that do not fit. `scratch` is overwritten.
pub fn look(cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
    for fluid in cloud.groups.iter().filter(|group| group.fluid().is_some()) {
        scratch.clear();
        scratch.resize(fluid.cloud.len(), None);
        cloud.for_each_row(fluid.cloud.start, scratch, &mut RowSums::default(), &filling(cloud));
        let rows = || fluid.cloud.clone().zip(&*scratch).filter_map(|(i, filling)| Some((i, (*filling)?)));
        let is_bounded = |i: usize| cloud.near_row(i).last().is_some_and(|&j| j as usize >= cloud.fluid);
        let inside: Vec<f64> = rows().filter(|(i, _)| !is_bounded(*i)).map(|(_, filling)| filling).collect();
        let even = if inside.len() < MIN_COUNT { 1.0 } else { mean(inside.iter().copied()) };
        let mut last = None;
        for boundary in cloud.groups.iter().filter(|group| group.fluid().is_none()) {
            // A thin body is there twice.
            if last.replace(boundary.body) == Some(boundary.body) {
                continue;
            }
            let names = || [fluid.body, boundary.body].map(|body| &step.world.body(body).name);
            let of_boundary = cloud.groups.iter().filter(|group| group.body == boundary.body);
            let of_boundary: Vec<Range<usize>> = of_boundary.map(|group| group.cloud.clone()).collect();
            let particles = fluid.cloud.clone().into_par_iter();
            let near: Vec<BesideBoundary> =
                particles.filter_map(|i| nearest(cloud, i, &of_boundary)).collect();
            let facing: Vec<f64> =
                near.par_iter().filter_map(|nearest| nearest.distance_across(cloud)).collect();
            let across = || facing.iter().filter(|distance| ACROSS.contains(distance));
            if across().count() >= MIN_COUNT && across().count() as f64 > PART * facing.len() as f64 {
                let gap = mean(across().copied()) - 1.0;
                let text = text_of_gap(names(), across().count(), gap);
                step.warnings.push(text);
                continue;
            }
            let is_beside = |nearest: &&BesideBoundary| nearest.distance < BESIDE * spacing(cloud, nearest.i);
            let filling = |nearest: &BesideBoundary| scratch[nearest.i - fluid.cloud.start];
            let beside: Vec<f64> =
                near.iter().filter(is_beside).filter_map(filling).map(|filling| filling / even).collect();
            let deviation = mean(beside.iter().map(|filling| (filling - 1.0).powi(2))).sqrt();
            if beside.len() >= MIN_COUNT && deviation > MAX_DEVIATION {
                let text = text(names(), mean(beside.iter().copied()), deviation);
                step.warnings.push(text);
            }
        }
    }
}

/// The particle of a boundary that is nearest to one of a fluid.
struct BesideBoundary {
    /// Particle of the fluid, and that of the boundary.
    i: usize,
    j: usize,
    /// Their distance, m.
    distance: f64,
}

/// The nearest of the particles of a boundary to particle `i`; none where none is near.
fn nearest(cloud: &FlowCloud, i: usize, of_boundary: &[Range<usize>]) -> Option<BesideBoundary> {
    let row = cloud.near_row(i);
    // Boundaries come last: inside of the fluid nothing is looked at.
    let bounds = row.iter().rev().map(|&j| j as usize).take_while(|&j| j >= cloud.fluid);
    let of_boundary = bounds.filter(|j| of_boundary.iter().any(|rows| rows.contains(j)));
    let squared = |j: usize| apart(cloud, i, j).length_squared();
    let (j, squared) = of_boundary.map(|j| (j, squared(j))).min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(BesideBoundary { i, j, distance: squared.sqrt() })
}

impl BesideBoundary {
    /// The distance over the mean of both spacings; none where another particle of the flow is in between.
    fn distance_across(&self, cloud: &FlowCloud) -> Option<f64> {
        let Self { i, j, distance } = *self;
        let fluid = cloud.near_row(i).iter().map(|&k| k as usize).take_while(|&k| k < cloud.fluid);
        let limit = (BETWEEN * distance).powi(2);
        let is_between = fluid.filter(|&k| k != i).any(|k| apart(cloud, k, j).length_squared() < limit);
        (!is_between).then(|| distance / (0.5 * (spacing(cloud, i) + spacing(cloud, j))))
    }
}

/// From particle `i` to particle `j`, m.
fn apart(cloud: &FlowCloud, i: usize, j: usize) -> DVec3 {
    cloud.offset(cloud.records[i].position(), cloud.records[j].position())
}

/// Spacing of a particle by its volume, m.
fn spacing(cloud: &FlowCloud, i: usize) -> f64 {
    cloud.records[i].volume().powf(if cloud.plane { 1.0 / 2.0 } else { 1.0 / 3.0 })
}

fn text_of_gap([fluid, boundary]: [&String; 2], count: usize, gap: f64) -> String {
    format!(
        "`{fluid}` starts apart from `{boundary}`: {count} of its particles face it across {gap:.2} spacings of empty space. The fluid falls through it, and its pressure there may stay wrong: let both shapes \
         meet, or leave more than two spacings between them"
    )
}

fn text([fluid, boundary]: [&String; 2], filling: f64, deviation: f64) -> String {
    format!(
        "the lattices of `{fluid}` and `{boundary}` do not fit at the start: beside `{boundary}` particles fill {:.1} % of space, with a deviation of {:.1} % (root mean square); the surface acts as if it were \
         up to half a spacing elsewhere. Put it on a multiple of the spacing from where the lattice of `{fluid}` begins, turn both shapes together (`Rotate(shape: Difference(...))`), or give both \
         `lattice: Relaxed(seed: 1, iterations: 30)`",
        100.0 * filling,
        100.0 * deviation
    )
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count().max(1) as f64;
    values.sum::<f64>() / count
}
