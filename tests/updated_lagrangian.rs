//! Updated-Lagrangian solids beside total-Lagrangian ones in the same scenes.

mod common;

use common::touching::touching;
use common::{all_plugins, failing, failing_metals, removal, simulation};
use meshless::glam::DVec3;
use meshless::scene::Source;
use meshless::simulation::{Checkpoint, Simulation};
use meshless::world::{BodyId, Mass, Position, Velocity};

/// The scene with another formulation in the place of the total-Lagrangian one.
fn with(formulation: &str, source: &Source) -> Source {
    assert!(source.text.contains("formulation: TotalLagrangian"), "{}", source.name);
    let usual = source.text.replace("TotalLagrangian(support: 2.6)", "TotalLagrangian");
    let text = usual.replace("formulation: TotalLagrangian", &format!("formulation: {formulation}"));
    Source::new(source.name.clone(), text)
}

/// Updates often, so that short runs have many of them.
const OFTEN: &str = "UpdatedLagrangian(update: Adaptive(change: 0.01))";

fn after(source: &Source, steps: u64) -> Simulation {
    let mut sim = simulation(source);
    sim.run(|sim| sim.clock().step < steps).expect("a run");
    sim
}

fn positions(sim: &Simulation, body: usize) -> Vec<DVec3> {
    let body = sim.world().body(BodyId(body));
    let view = sim.world().phase(body.phase);
    view.read::<Position>().expect("positions")[body.rows.clone()].iter().map(|x| x.0).collect()
}

#[test]
fn without_updates_it_is_the_total_lagrangian_formulation() {
    for (dimension, steps) in [(2, 300), (3, 100)] {
        let scene = all_plugins(dimension);
        let total = after(&with("TotalLagrangian(kernel: cubic_spline, support: 2.4)", &scene), steps);
        let updated = after(&with("UpdatedLagrangian(update: Never)", &scene), steps);
        assert!((total.clock().time - updated.clock().time).abs() < 1e-12 * total.clock().time);
        for body in 0..2 {
            for (a, b) in positions(&total, body).iter().zip(positions(&updated, body)) {
                assert!((*a - b).length() < 1e-12, "body {body} in {dimension} dimensions: {a} and {b}");
            }
        }
    }
}

#[test]
fn bits_do_not_depend_on_threads_or_on_a_restart() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("state.mlc");
    let steps = 150;
    for source in [all_plugins(2), all_plugins(3), removal(), failing(), failing_metals(), touching()] {
        let source = with(OFTEN, &source);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
            pool.install(|| after(&source, steps).state_hash())
        };
        let one = on(1);
        assert_eq!(one, on(3), "{}: threads", source.name);
        after(&source, 71).save(&path, &source).expect("a checkpoint");
        let checkpoint = Checkpoint::read(&path).expect("a checkpoint");
        let mut second = simulation(&checkpoint.source());
        second.restore(&checkpoint).expect("a restart");
        second.run(|sim| sim.clock().step < steps).expect("a run");
        assert_eq!(one, second.state_hash(), "{}: restart", source.name);
    }
}

/// A beam that is thrown, spins and swings: 24 x 6 particles of rubber, irregular.
fn thrown(formulation: &str) -> Source {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"rubber": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "beam", material: "rubber", shape: Box(min: (0, 0), max: (1.2, 0.3)), spacing: 0.05,
                      lattice: Relaxed(seed: 5, iterations: 2), formulation: {formulation}, plugins: [hourglass_control()])],
            conditions: [InitialVelocity(on: Select(body: "beam"), value: ("0.3 - 0.4*(y - 0.15)", "0.4*(x - 0.6) + 0.2*cos(5.2*x)"))],
            time: (end: 100.0))"#
    );
    Source::new("thrown.ron", text)
}

/// Momentum, angular momentum about the origin, and the sums of their parts.
fn momenta(sim: &Simulation) -> (DVec3, DVec3) {
    let view = sim.world().phase(sim.world().body(BodyId(0)).phase);
    let (x, v) = (view.read::<Position>().expect("places"), view.read::<Velocity>().expect("velocities"));
    let m = view.read::<Mass>().expect("masses");
    let rows = 0..view.len();
    let linear = rows.clone().map(|k| v[k].0 * m[k].0).sum();
    (linear, rows.map(|k| x[k].0.cross(v[k].0) * m[k].0).sum())
}

#[test]
fn a_thrown_body_keeps_its_momenta_and_its_energy_through_updates() {
    let mut sim = simulation(&thrown("UpdatedLagrangian()"));
    sim.run(|sim| sim.clock().step < 1).expect("a step");
    let (linear, angular) = momenta(&sim);
    sim.run(|sim| sim.clock().time < 20.0).expect("a run");
    let (now, turned) = momenta(&sim);
    // Turned by more than two radians: the reference has been updated, and what it has changed is booked.
    assert!(sim.ledger().total_named("reference_update") != 0.0, "no update");
    assert!((now - linear).length() < 1e-12 * linear.length(), "momentum {linear} -> {now}");
    assert!((turned - angular).length() < 1e-10 * angular.length(), "angular momentum {angular} -> {turned}");
    let kinetic = sim.ledger().total_named("kinetic");
    let error = sim.ledger().balance_error();
    assert!(error.abs() < 0.03 * kinetic, "balance {error} J of {kinetic} J");
}
