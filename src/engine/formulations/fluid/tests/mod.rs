//! Tests of flows, by what they test.

mod flows;

mod several;

mod spin;

mod soft_block;

mod soft_pressure;

mod channel;

mod vessels;

mod light;
mod loads;

mod rest;

mod repulsion;

mod worn;

mod ends;

mod driven;

mod sharp_edges;

mod thin;

mod sub_cycled;

mod slow;

mod noticing;

mod gaps;

mod moving;

mod falling;

mod torn_walls;

use glam::DVec3;

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, Column};

pub fn simulation(text: &str) -> Simulation {
    simulation_with(&Registry::standard(), text)
}

pub fn simulation_with(registry: &Registry, text: &str) -> Simulation {
    let built =
        parse(Source::new("test.ron", text)).and_then(|(scene, source)| build(&scene, &source, registry));
    match built {
        Ok(simulation) => simulation,
        Err(error) => panic!("{error}"),
    }
}

/// The simulation of a scene with its sums in double precision: for what holds to their round-off.
pub fn double(text: &str) -> Simulation {
    simulation(&text.replacen("(dimension", "(precision: Double, dimension", 1))
}

/// The factor of pressures by a second implementation, from the first moment of every particle of the fluid,
/// 1/m, and the trace of the second: the inverse of the mean of tau, that trace over the dimension, and of a
/// one, over particles with a tau above 0.9, weighed by 1 less the square of the first moment over 0.1 / h.
fn pressure_factor(moments: impl Iterator<Item = (DVec3, f64)>, h: f64, dimension: usize) -> f64 {
    let (mut total, mut sum) = (1.0, 1.0);
    for (first, trace) in moments {
        let (share, tau) = (1.0 - (10.0 * h * first.length()).powi(2), trace / dimension as f64);
        if tau > 0.9 && share > 0.0 {
            (total, sum) = (total + share, sum + share * tau);
        }
    }
    total / sum
}

pub fn column<C: Column + Copy>(sim: &Simulation, body: usize) -> Vec<C> {
    let (view, rows) = sim.world().body_view(BodyId(body));
    view.read::<C>().expect("a column")[rows].to_vec()
}
