//! Bodies that overlap: no two particles of different bodies may start closer than half their spacing.

use glam::DVec3;

use crate::neighbors::{Cloud, NeighborList, Periodic, Support};
use crate::notation::place;
use crate::plugin::{BodyKind, BodyPlan};
use crate::scene::{Problem, Scene};

/// One problem for every pair of bodies that overlap. Rigid bodies with a contact are left to that: it knows their surfaces.
pub(super) fn problems(bodies: &[BodyPlan], scene: &Scene) -> Vec<Problem> {
    let touching = scene.touching_pairs();
    let is_left = |first: &BodyPlan, second: &BodyPlan| {
        [first, second].iter().all(|body| body.kind == BodyKind::Rigid)
            && touching.has(&first.name, &second.name)
    };
    let owners: Vec<usize> = bodies.iter().flat_map(|body| vec![body.id.0; body.sites.len()]).collect();
    if bodies.len() < 2 {
        return Vec::new();
    }
    let positions: Vec<DVec3> =
        bodies.iter().flat_map(|body| body.sites.iter().map(|site| site.position)).collect();
    let reach = |body: &BodyPlan| vec![0.5 * body.spacing; body.sites.len()];
    let supports: Vec<f64> = bodies.iter().flat_map(reach).collect();
    let cloud = Cloud { positions: &positions, support: Support::PerParticle(&supports) };
    let Ok(list) = NeighborList::reference(cloud, &Periodic::NONE) else { return Vec::new() };
    let mut reported = Vec::new();
    let mut problems = Vec::new();
    for i in 0..positions.len() {
        for &j in list.row(i) {
            let pair = (owners[i], owners[j as usize]);
            if pair.0 < pair.1 && !reported.contains(&pair) {
                reported.push(pair);
                if is_left(&bodies[pair.0], &bodies[pair.1]) {
                    continue;
                }
                let (first, second) = (&bodies[pair.0].name, &bodies[pair.1].name);
                let message = format!("body `{second}` overlaps body `{first}` at {}", place(positions[i]));
                problems.push(
                    Problem::at_path(format!("bodies[{}].shape", pair.1), message)
                        .help("leave a gap of about the mean spacing between particles of different bodies"),
                );
            }
        }
    }
    problems
}
