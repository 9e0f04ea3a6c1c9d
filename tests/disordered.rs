//! What holds exactly for particles in disorder: a lattice whose particles are moved at random by up to 30 %
//! of the spacing along every axis.

mod common;

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use common::simulation;
use meshless::formulations::updated_lagrangian::UpdatedReference;
use meshless::glam::{DMat3, DVec3};
use meshless::invariants::{NetForce, Specimen};
use meshless::scene::Source;
use meshless::simulation::{Checkpoint, Simulation};
use meshless::world::{BodyId, Force, Position, ReferencePosition};

const STABILIZERS: [&str; 3] = [
    "hourglass_control()",
    "hessian_stabilization(eta: 0.7)",
    "hessian_stabilization(form: Vidal2007, eta: 0.7)",
];
const FORMULATIONS: [&str; 2] = ["TotalLagrangian", "UpdatedLagrangian()"];
/// Of a body whose reference is updated.
const UPDATED: &str = "UpdatedLagrangian(update: Every(10))";
/// Particles along the axes.
const COUNTS: [(usize, [usize; 3]); 2] = [(2, [10, 5, 1]), (3, [6, 3, 3])];

/// Numbers from -1 to 1, by the generator of Lehmer.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0 * 48271 % 0x7fff_ffff;
        self.0 as f64 / f64::from(0x3fff_ffff) - 1.0
    }
}

/// Writes the particles, at a spacing of 0.1 m, and returns a scene of them.
fn scene(folder: &Path, dimension: usize, formulation: &str, plugin: &str, time: &str) -> Source {
    let counts = COUNTS[dimension - 2].1;
    let mut random = Random(20_071);
    let mut csv = String::from(if dimension == 2 { "x,y,volume\n" } else { "x,y,z,volume\n" });
    for cell in 0..counts[0] * counts[1] * counts[2] {
        let cell = [cell % counts[0], cell / counts[0] % counts[1], cell / counts[0] / counts[1]];
        for number in &cell[..dimension] {
            write!(csv, "{:?},", 0.1 * (*number as f64 + 0.5 + 0.3 * random.next())).expect("a text");
        }
        writeln!(csv, "{:?}", 0.1f64.powi(dimension as i32)).expect("a text");
    }
    std::fs::write(folder.join("points.csv"), csv).expect("a file");
    let name = if dimension == 2 { "Two" } else { "Three" };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Points(file: "points.csv"), spacing: 0.1,
                      formulation: {formulation}, plugins: [{plugin}])],
            time: ({time}))"#
    );
    Source::new(folder.join("scene.ron").to_string_lossy(), text)
}

/// Calls `check` for every dimension and stabilizer, with these formulations.
fn each(formulations: &[&str], mut check: impl FnMut(usize, &str, &str, &Path)) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (dimension, _) in COUNTS {
        for formulation in formulations {
            STABILIZERS.iter().for_each(|plugin| check(dimension, formulation, plugin, folder.path()));
        }
    }
}

#[test]
fn an_affine_map_is_exact_and_holds_nothing() {
    each(&FORMULATIONS, |dimension, formulation, plugin, folder| {
        let z = if dimension == 2 { DVec3::Z } else { DVec3::new(0.1, -0.1, 1.1) };
        let map = DMat3::from_cols(DVec3::new(1.2, 0.3, 0.0), DVec3::new(-0.2, 0.8, 0.0), z);
        let source = scene(folder, dimension, formulation, plugin, "end: 1.0");
        let make = || -> Result<Simulation, Box<dyn Error>> { Ok(simulation(&source)) };
        let found = Specimen::new(&make).affine(map, DVec3::new(0.7, -0.4, 0.0)).expect("a start");
        let name = format!("{dimension} dimensions, {formulation}, {plugin}: {found:?}");
        assert!(found.gradient < 1e-10 && found.held < 1e-12, "{name}");
        assert!(found.net.force < 1e-10 && found.net.torque < 1e-10, "{name}");
    });
}

#[test]
fn the_force_is_the_slope_of_the_energy() {
    each(&FORMULATIONS, |dimension, formulation, plugin, folder| {
        let source = scene(folder, dimension, formulation, plugin, "end: 1.0");
        let make = || -> Result<Simulation, Box<dyn Error>> { Ok(simulation(&source)) };
        let found = Specimen::new(&make).slope().expect("a start");
        let name = format!("{dimension} dimensions, {formulation}, {plugin}: {found:?}");
        assert!(found.error < 1e-6 && found.net.force < 1e-10 && found.net.torque < 1e-10, "{name}");
    });
}

/// Whether the present configuration has become the reference of the body.
fn is_updated(sim: &Simulation) -> bool {
    let (view, _) = sim.world().body_view(BodyId(0));
    let updated = view.read::<UpdatedReference>().expect("places of the last update");
    let start = view.read::<ReferencePosition>().expect("places of the start");
    updated.iter().zip(start.iter()).any(|(updated, start)| updated.0 != start.0)
}

#[test]
fn after_an_update_the_force_is_still_the_slope_of_the_energy() {
    each(&[UPDATED], |dimension, formulation, plugin, folder| {
        let source = scene(folder, dimension, formulation, plugin, "end: 100.0");
        let mut sim = Specimen::new(&|| -> Result<Simulation, Box<dyn Error>> { Ok(simulation(&source)) })
            .moved(|_, x| x, |x| DVec3::new(0.1 * (9.0 * x.y).sin(), 0.2 * x.x, 0.0))
            .expect("a simulation");
        sim.run(|sim| sim.clock().step < 14).expect("a run");
        assert!(is_updated(&sim), "{plugin}: no update");
        let path = folder.join("state.mlc");
        sim.save(&path, &source).expect("a checkpoint");
        let checkpoint = Checkpoint::read(&path).expect("a checkpoint");
        // The state with one particle off its place, after a step of nearly no length.
        let still = scene(folder, dimension, formulation, plugin, "end: 100.0, step: Fixed(1e-15)");
        let at = |row: usize, axis: usize, by: f64| {
            let mut sim = simulation(&still);
            sim.restore(&checkpoint).expect("a restart");
            let (view, _) = sim.world().body_view(BodyId(0));
            view.write::<Position>().expect("places")[row].0[axis] += by;
            sim.step().expect("a step");
            sim
        };
        let start = at(0, 0, 0.0);
        let net = NetForce::of(&start).expect("forces");
        assert!(net.force < 1e-10 && net.torque < 1e-10, "{dimension} dimensions, {plugin}: {net:?}");
        let (view, _) = start.world().body_view(BodyId(0));
        let force: Vec<DVec3> = view.read::<Force>().expect("forces").iter().map(|f| f.0).collect();
        let scale = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        let stored = |sim: &Simulation| sim.ledger().stored() - sim.ledger().total_named("kinetic");
        let row = force.len() / 2;
        for axis in 0..dimension {
            let energy = |by: f64| stored(&at(row, axis, by));
            let h = 1e-4;
            let slope = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
            let error = (force[row][axis] + slope).abs() / scale;
            assert!(error < 1e-6, "{dimension} dimensions, {plugin}: {error}");
        }
    });
}

#[test]
fn a_thrown_and_spinning_body_keeps_its_momenta_and_its_energy() {
    each(&["TotalLagrangian", UPDATED], |dimension, formulation, plugin, folder| {
        let source = scene(folder, dimension, formulation, plugin, "end: 5.0");
        let make = || -> Result<Simulation, Box<dyn Error>> { Ok(simulation(&source)) };
        let (center, spin) = (DVec3::new(0.5, 0.25, 0.0), DVec3::new(0.0, 0.0, 0.05));
        let found = Specimen::new(&make)
            .thrown(|x| DVec3::new(0.01 + 0.02 * (3.0 * x.x).cos(), 0.02, 0.0) + spin.cross(x - center))
            .expect("a run");
        let name = format!("{dimension} dimensions, {formulation}, {plugin}: {found:?}");
        assert!(found.momentum < 1e-12 && found.angular_momentum < 1e-10, "{name}");
        let most = if formulation == UPDATED { 0.03 } else { 0.005 };
        assert!(found.energy < most, "{name}");
    });
}
