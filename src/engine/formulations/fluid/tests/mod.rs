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

pub fn column<C: Column + Copy>(sim: &Simulation, body: usize) -> Vec<C> {
    let (view, rows) = sim.world().body_view(BodyId(body));
    view.read::<C>().expect("a column")[rows].to_vec()
}
