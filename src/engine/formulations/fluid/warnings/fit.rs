//! Whether the lattices of a fluid and of its boundaries fit at the start.
//!
//! Where particles of the two overlap or leave a gap, the densities of the fluid do not reflect it: the
//! effective position of a surface is wrong by up to half a spacing, and forces are those of uneven
//! particles. `sum_j V_j W_ij` of the particles beside the boundary shows it.

use rayon::prelude::*;

use super::filling::filling;
use crate::formulations::fluid::cloud::{FlowCloud, RowSums};
use crate::schedule::Step;
use crate::world::BodyId;

/// Distance of the particles beside a boundary from one of its particles, over their spacing.
const BESIDE: f64 = 1.5;
/// Root mean square difference of the filling beside a boundary from that in the fluid that is worth a
/// warning: a gap of a quarter of a spacing along a plane. Round bodies in square lattices have 0.03.
const MAX_DEVIATION: f64 = 0.04;
/// Minimum number of particles for a mean.
const MIN_COUNT: usize = 8;
/// Distances of particles that face a boundary across a gap from the nearest one of it, over the mean of both
/// spacings: half a spacing to two of empty space. Particles farther away are meant to fall.
const ACROSS: std::ops::Range<f64> = 1.5..3.0;
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
            let particles = fluid.cloud.clone().into_par_iter();
            let facing: Vec<f64> =
                particles.filter_map(|i| distance_across(cloud, i, boundary.body)).collect();
            let across = || facing.iter().filter(|distance| ACROSS.contains(distance));
            if across().count() >= MIN_COUNT && across().count() as f64 > PART * facing.len() as f64 {
                let gap = mean(across().copied()) - 1.0;
                let text = text_of_gap(names(), across().count(), gap);
                step.warnings.push(text);
                continue;
            }
            let is_beside = |i: usize| {
                let own = &cloud.records[i];
                let reach = BESIDE * own.volume().powf(if cloud.plane { 1.0 / 2.0 } else { 1.0 / 3.0 });
                let of_boundary = |j: usize| {
                    cloud.groups.iter().any(|group| group.body == boundary.body && group.cloud.contains(&j))
                };
                let to = |j: usize| cloud.offset(own.position(), cloud.records[j].position()).length();
                cloud
                    .near_row(i)
                    .iter()
                    .map(|&j| j as usize)
                    .any(|j| j >= cloud.fluid && of_boundary(j) && to(j) < reach)
            };
            let beside: Vec<f64> =
                rows().filter(|(i, _)| is_beside(*i)).map(|(_, filling)| filling / even).collect();
            let deviation = mean(beside.iter().map(|filling| (filling - 1.0).powi(2))).sqrt();
            if beside.len() >= MIN_COUNT && deviation > MAX_DEVIATION {
                let text = text(names(), mean(beside.iter().copied()), deviation);
                step.warnings.push(text);
            }
        }
    }
}

/// Distance of a particle from the nearest one of a boundary over the mean of their spacings; none where
/// another particle of the flow is between them, or none of the boundary is near.
fn distance_across(cloud: &FlowCloud, i: usize, boundary: BodyId) -> Option<f64> {
    let row = cloud.near_row(i);
    let begin = row.partition_point(|&j| (j as usize) < cloud.fluid);
    let (flow, bounds) = row.split_at(begin);
    let at = |j: u32| cloud.records[j as usize].position();
    let of_boundary = |j: &&u32| {
        let j = **j as usize;
        cloud.groups.iter().any(|group| group.body == boundary && group.cloud.contains(&j))
    };
    let to = |j: u32| cloud.offset(cloud.records[i].position(), at(j)).length();
    let nearest = bounds.iter().filter(of_boundary).copied().min_by(|&j, &k| to(j).total_cmp(&to(k)))?;
    let is_between =
        |&k: &u32| k as usize != i && cloud.offset(at(k), at(nearest)).length() < BETWEEN * to(nearest);
    let spacing = |j: usize| cloud.records[j].volume().powf(if cloud.plane { 1.0 / 2.0 } else { 1.0 / 3.0 });
    let mean_spacing = 0.5 * (spacing(i) + spacing(nearest as usize));
    (!flow.iter().any(is_between)).then(|| to(nearest) / mean_spacing)
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
