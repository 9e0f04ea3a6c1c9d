//! Lone particles above a floor with a pit of removed particles: they fall to its bottom, and bounce where
//! the floor is whole, on the cushion of pressure that their approach makes.

use glam::DVec3;

use super::column;
use super::repulsion::{SPACING, WALL, rain};
use crate::simulation::Simulation;
use crate::world::{BodyId, ParticleId, Position, Removed, Velocity};

/// Takes the particles of the floor out that `is_gone` names.
fn dig(sim: &Simulation, is_gone: impl Fn(DVec3) -> bool) {
    let (view, rows) = sim.world().body_view(BodyId(1));
    let (x, mut removed) =
        (view.read::<Position>().expect("places"), view.write::<Removed>().expect("a column"));
    let gone: Vec<usize> = rows.filter(|&row| is_gone(x[row].0)).collect();
    assert!(gone.len() > 10);
    gone.into_iter().for_each(|row| removed[row] = Removed::YES);
}

/// Depth of the pit, m: two layers.
const DEPTH: f64 = 2.0 * SPACING;

#[test]
fn fluid_fills_what_is_worn() {
    for dimension in [2, 3] {
        let mut sim = rain(dimension, 2.6, DVec3::new(0.0, -2.0, 0.0), 1.0, WALL);
        // Two of the four particles are above it.
        dig(&sim, |x| x.x > 0.06 && x.x < 0.22 && x.z.abs() < 0.1 && x.y > -DEPTH);
        let mut lowest = [f64::INFINITY; 4];
        sim.run(|sim| {
            let ids = column::<ParticleId>(sim, 0);
            let first = ids.iter().map(|id| id.0).min().unwrap_or_default();
            for (id, x) in ids.iter().zip(column::<Position>(sim, 0)) {
                if let Some(lowest) = lowest.get_mut((id.0 - first) as usize) {
                    *lowest = lowest.min(x.0.y);
                }
            }
            sim.clock().time < 0.08
        })
        .expect("a run");
        let surface = [0.0, -DEPTH, -DEPTH, 0.0];
        for (lowest, surface) in lowest.into_iter().zip(surface) {
            assert!(
                (surface - 0.5 * SPACING..surface + 1.2 * SPACING).contains(&lowest),
                "{dimension} {lowest}"
            );
        }
        assert!(column::<Velocity>(&sim, 0).iter().all(|v| v.0.y > 0.0), "{dimension}: all have bounced");
        assert!(sim.warnings().iter().all(|warning| !warning.contains("is inside")), "{:?}", sim.warnings());
    }
}
