//! The same scene gives the same bits on any number of threads.

mod common;

use common::coupled::coupled;
use common::thin::thin;
use common::touching::{large_rigid_bodies, tool_of_triangles, touching};
use common::wearing::wearing;
use common::{
    all_plugins, crash, double, eulerian, failing, failing_metals, flow, metals, of_many_tasks, removal,
    simulation, with_formulation,
};
use meshless::record::StateHash;
use meshless::scene::Source;

fn hash_after(source: &Source, threads: usize, steps: u64) -> StateHash {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
    pool.install(|| {
        let mut sim = simulation(source);
        sim.run(|sim| sim.clock().step < steps).expect("a run");
        assert_eq!(sim.clock().step, steps);
        sim.state_hash()
    })
}

#[test]
fn one_two_and_seven_threads_give_the_same_bits() {
    let scenes = [
        (2, all_plugins(2)),
        (3, all_plugins(3)),
        (2, removal()),
        (2, flow(2)),
        (2, coupled()),
        (2, thin()),
        (3, flow(3)),
        (3, double(&flow(3))),
        (3, metals()),
        (2, failing()),
        (2, failing_metals()),
        (2, crash()),
        (2, touching()),
        (3, tool_of_triangles()),
        (2, wearing()),
    ];
    for (dimension, source) in scenes {
        let one = hash_after(&source, 1, 150);
        assert_eq!(one, hash_after(&source, 2, 150), "{dimension} dimensions, two threads");
        assert_eq!(one, hash_after(&source, 7, 150), "{dimension} dimensions, seven threads");
        assert_ne!(one, hash_after(&source, 1, 149), "the hash tells states apart");
    }
}

/// Loops over rows are handed out in tasks of 1 024: bodies of several tasks, of every formulation, so that
/// every pass is really divided.
#[test]
fn bodies_of_many_tasks_give_the_same_bits_on_one_two_and_seven_threads() {
    let differences = |form: &str| {
        let Source { name, text, .. } = all_plugins(2);
        Source::new(
            name,
            text.replace(
                "plugins: [hourglass_control()]",
                &format!("plugins: [hessian_stabilization({form})]"),
            ),
        )
    };
    let often = "UpdatedLagrangian(update: Every(3))";
    let scenes = [
        all_plugins(2),
        removal(),
        flow(2),
        flow(3),
        coupled(),
        thin(),
        metals(),
        failing(),
        crash(),
        wearing(),
        touching(),
        tool_of_triangles(),
        large_rigid_bodies(),
        differences(""),
        differences("form: Vidal2007"),
        with_formulation(often, &all_plugins(2)),
        with_formulation(often, &failing()),
        with_formulation(often, &touching()),
        eulerian(&all_plugins(3)),
        eulerian(&metals()),
        eulerian(&failing()),
    ];
    for (n, coarse) in scenes.iter().enumerate() {
        let source = of_many_tasks(coarse);
        let one = hash_after(&source, 1, 8);
        assert_eq!(one, hash_after(&source, 2, 8), "scene {n}, {}, two threads", coarse.name);
        assert_eq!(one, hash_after(&source, 7, 8), "scene {n}, {}, seven threads", coarse.name);
    }
}

#[test]
fn what_is_to_touch_and_to_flow_does() {
    for source in [touching(), tool_of_triangles()] {
        let mut sim = simulation(&source);
        sim.run(|sim| sim.clock().step < 150).expect("a run");
        for account in ["contact", "contact_damping", "friction", "plastic_work"] {
            assert!(sim.ledger().total_named(account) > 0.0, "{account}");
        }
    }
}
