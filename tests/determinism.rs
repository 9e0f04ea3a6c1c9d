//! The same scene gives the same bits on any number of threads.

mod common;

use common::coupled::coupled;
use common::thin::thin;
use common::touching::{tool_of_triangles, touching};
use common::{all_plugins, crash, failing, failing_metals, flow, metals, removal, simulation};
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
        (3, metals()),
        (2, failing()),
        (2, failing_metals()),
        (2, crash()),
        (2, touching()),
        (3, tool_of_triangles()),
    ];
    for (dimension, source) in scenes {
        let one = hash_after(&source, 1, 150);
        assert_eq!(one, hash_after(&source, 2, 150), "{dimension} dimensions, two threads");
        assert_eq!(one, hash_after(&source, 7, 150), "{dimension} dimensions, seven threads");
        assert_ne!(one, hash_after(&source, 1, 149), "the hash tells states apart");
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
