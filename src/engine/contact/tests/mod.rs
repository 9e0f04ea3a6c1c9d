//! Contact in small scenes, against closed forms and invariants.

mod apart;
mod at_rest;
mod crossing_edges;
mod deformed;
mod ellipsoids;
mod heat;
mod images;
mod impacts;
mod laws;
mod loaded;
mod long;
mod moving_frame;
mod noticing;
mod particles;
mod rigid;
mod rolling;
mod skin_energy;
mod skins;
mod spinning;
mod thin_tools;
mod tumbling;
mod turning;
mod walls;

use glam::DVec3;

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, Mass, Position, Velocity};

/// The simulation of a scene.
fn simulation(text: &str) -> Simulation {
    let (scene, source) = parse(Source::new("contact.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"))
}

/// Momentum of all bodies, kg m/s.
fn momentum(sim: &Simulation) -> DVec3 {
    let mut total = DVec3::ZERO;
    for k in 0..sim.world().bodies().len() {
        let (view, rows) = sim.world().body_view(BodyId(k));
        let (m, v) = (view.read::<Mass>().unwrap(), view.read::<Velocity>().unwrap());
        total += rows.map(|row| m[row].0 * v[row].0).sum::<DVec3>();
    }
    total
}

/// Angular momentum of all bodies about the origin, kg m2/s.
fn angular_momentum(sim: &Simulation) -> DVec3 {
    let mut total = DVec3::ZERO;
    for k in 0..sim.world().bodies().len() {
        let (view, rows) = sim.world().body_view(BodyId(k));
        let (m, v) = (view.read::<Mass>().unwrap(), view.read::<Velocity>().unwrap());
        let x = view.read::<Position>().unwrap();
        total += rows.map(|row| m[row].0 * x[row].0.cross(v[row].0)).sum::<DVec3>();
    }
    total
}

/// Centre and mean velocity of a body.
fn centre(sim: &Simulation, body: usize) -> (DVec3, DVec3) {
    let (view, rows) = sim.world().body_view(BodyId(body));
    let (m, x, v) =
        (view.read::<Mass>().unwrap(), view.read::<Position>().unwrap(), view.read::<Velocity>().unwrap());
    let mass: f64 = rows.clone().map(|row| m[row].0).sum();
    let place = rows.clone().map(|row| m[row].0 * x[row].0).sum::<DVec3>() / mass;
    (place, rows.map(|row| m[row].0 * v[row].0).sum::<DVec3>() / mass)
}
