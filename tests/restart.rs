//! A run that is taken up from a checkpoint equals one that was not interrupted, bit for bit.

mod common;

use common::coupled::coupled;
use common::eulerian::diffusing;
use common::thin::{thin, torn};
use common::touching::{tool_of_triangles, touching};
use common::wearing::wearing;
use common::{
    all_plugins, crash, double, eulerian, failing, failing_metals, flow, metals, removal, simulation,
};

#[test]
fn a_resumed_run_has_the_bits_of_one_that_was_not_interrupted() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("state.mlc");
    // The memory of the time step is longer than 500 steps: some restarts fall before, some after it turns
    // over.
    let scenes = [
        (all_plugins(2), 700u64, 11u64),
        (all_plugins(2), 700, 12),
        (all_plugins(3), 200, 13),
        (removal(), 300, 14),
        (flow(2), 500, 15),
        (coupled(), 400, 20),
        (coupled(), 700, 21),
        (thin(), 300, 22),
        (torn(), 300, 27),
        (flow(3), 200, 16),
        (double(&flow(3)), 200, 16),
        (double(&flow(3)), 200, 17),
        (metals(), 200, 17),
        (failing(), 300, 18),
        (failing(), 300, 19),
        (failing_metals(), 400, 20),
        (failing_metals(), 400, 21),
        (crash(), 200, 22),
        (touching(), 300, 23),
        (tool_of_triangles(), 150, 24),
        (wearing(), 300, 25),
        (wearing(), 300, 26),
        (eulerian(&all_plugins(2)), 150, 28),
        (eulerian(&failing_metals()), 150, 29),
        (diffusing(), 100, 30),
    ];
    for (scene, (source, steps, seed)) in scenes.into_iter().enumerate() {
        let break_at = 1 + seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) % (steps - 1);
        let mut whole = simulation(&source);
        whole.run(|sim| sim.clock().step < steps).expect("a run");
        let mut first = simulation(&source);
        first.run(|sim| sim.clock().step < break_at).expect("a run");
        first.save(&path, &source).expect("a checkpoint");
        drop(first);
        let checkpoint = meshless::simulation::Checkpoint::read(&path).expect("a checkpoint");
        let mut second = simulation(&checkpoint.source());
        second.restore(&checkpoint).expect("a restart");
        assert_eq!(second.clock().step, break_at);
        second.run(|sim| sim.clock().step < steps).expect("a run");
        assert_eq!(whole.state_hash(), second.state_hash(), "scene {scene}, break at step {break_at}");
        assert_eq!(whole.summary().removed_of, second.summary().removed_of);
        assert_eq!(whole.ledger(), second.ledger(), "scene {scene}, break at step {break_at}");
    }
}
