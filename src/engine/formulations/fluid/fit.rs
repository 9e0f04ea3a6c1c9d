//! Whether the lattices of a fluid and of what bounds it fit at the start.
//!
//! Where particles of the two overlap or leave a gap, the densities of the fluid do not know it: a surface acts as if it stood elsewhere, by up to half a spacing, and forces are those of
//! uneven particles. `sum_j V_j W_ij` of the particles beside the boundary shows it.

use super::cloud::FlowCloud;
use super::filling::FillingPass;
use crate::schedule::Step;

/// Distance of the particles beside a boundary from one of its particles, over their spacing.
const BESIDE: f64 = 1.5;
/// Root mean square difference of the filling beside a boundary from that in the fluid that is worth a warning: a gap of a quarter of a spacing along a plane. Round bodies in square lattices have 0.03.
const MISFIT: f64 = 0.04;
/// Least number of particles for a mean.
const LEAST: usize = 8;

/// Warns of lattices that do not fit. `scratch` is overwritten.
pub(super) fn look(cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
    for fluid in cloud.groups.iter().filter(|group| group.fluid().is_some()) {
        scratch.clear();
        scratch.resize(fluid.cloud.len(), None);
        cloud.for_each_row(fluid.cloud.start, scratch, &FillingPass(cloud));
        let rows = || fluid.cloud.clone().zip(&*scratch).filter_map(|(i, filling)| Some((i, (*filling)?)));
        let is_bounded = |i: usize| cloud.near_row(i).last().is_some_and(|&j| j as usize >= cloud.fluid);
        let inside: Vec<f64> = rows().filter(|(i, _)| !is_bounded(*i)).map(|(_, filling)| filling).collect();
        let even = if inside.len() < LEAST { 1.0 } else { mean(inside.iter().copied()) };
        let mut last = None;
        for boundary in cloud.groups.iter().filter(|group| group.fluid().is_none()) {
            // A thin body is there twice.
            if last.replace(boundary.body) == Some(boundary.body) {
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
            let misfit = mean(beside.iter().map(|filling| (filling - 1.0).powi(2))).sqrt();
            if beside.len() >= LEAST && misfit > MISFIT {
                let names = [fluid.body, boundary.body].map(|body| &step.world.body(body).name);
                step.warnings.push(text(names, mean(beside.iter().copied()), misfit));
            }
        }
    }
}

fn text([fluid, boundary]: [&String; 2], filling: f64, misfit: f64) -> String {
    format!(
        "the lattices of `{fluid}` and `{boundary}` do not fit at the start: beside `{boundary}` particles fill {:.1} % of space, with a deviation of {:.1} % (root mean square); the surface acts as if it were \
         up to half a spacing elsewhere. Put it on a multiple of the spacing from where the lattice of `{fluid}` begins, turn both shapes together (`Rotate(shape: Difference(...))`), or give both \
         `lattice: Relaxed(seed: 1, iterations: 30)`",
        100.0 * filling,
        100.0 * misfit
    )
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count().max(1) as f64;
    values.sum::<f64>() / count
}
