//! A step allocates no memory once everything has its size.
#![expect(unsafe_code, reason = "an allocator that counts cannot be written without")]

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use common::touching::landing;
use common::{all_plugins, double, eulerian, flow, of_many_tasks, simulation, with_formulation};
use meshless::scene::Source;

/// The allocator of the system, with a count of what is asked of it.
struct Counting;

static COUNT: AtomicU64 = AtomicU64::new(0);

// SAFETY: every call goes to the allocator of the system as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller keeps the promises of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the memory comes from `alloc` above, with this layout.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as for `dealloc`; the caller promises the size.
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// One test counts at a time.
static TURN: Mutex<()> = Mutex::new(());

/// Allocations of each of `steps` steps after a warm-up, on a number of threads.
fn counts(source: &Source, threads: usize, steps: usize) -> Vec<u64> {
    counts_of(|| source.clone(), threads, steps)
}

/// The same of a source that takes memory to be made.
fn counts_of(source: impl FnOnce() -> Source, threads: usize, steps: usize) -> Vec<u64> {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let source = source();
    pool.install(|| {
        let mut sim = simulation(&source);
        // The first frame is among them, in which what looks at frames gets its memory.
        sim.run(|sim| sim.clock().step < 60).expect("a run");
        let mut counts = Vec::with_capacity(steps);
        for _ in 0..steps {
            let before = COUNT.load(Ordering::Relaxed);
            sim.step().expect("a step");
            counts.push(COUNT.load(Ordering::Relaxed) - before);
        }
        counts
    })
}

#[test]
fn a_step_of_solids_with_all_stabilizers_allocates_nothing() {
    for dimension in [2, 3] {
        let counts = counts(&all_plugins(dimension), 1, 100);
        // The grid of the search of a body that touches itself has more cells as the body grows, which some
        // of its searches see.
        let some = counts.iter().filter(|&&count| count > 0).count();
        assert!(some <= 2, "{dimension} dimensions: {counts:?}");
    }
    // The queues by which threads hand over work take a block of memory now and then, whatever the size of
    // the bodies.
    let counts = counts(&all_plugins(3), 2, 100);
    assert!(counts.iter().sum::<u64>() < 20, "two threads: {counts:?}");
}

#[test]
fn differences_of_second_derivatives_allocate_nothing() {
    for plugin in ["hessian_stabilization()", "hessian_stabilization(form: Vidal2007)"] {
        for formulation in ["TotalLagrangian", "UpdatedLagrangian(update: Never)"] {
            let text = format!(
                r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
                    bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.2, 0.5)), spacing: 0.02,
                              formulation: {formulation}, plugins: [{plugin}])],
                    conditions: [InitialVelocity(on: Select(body: "b"), value: ("0.1*sin(9*y)", "0.1*x"))],
                    time: (end: 100.0))"#
            );
            let counts = counts(&Source::new("differences.ron", text), 1, 50);
            // A step that warns takes memory for the text.
            let some = counts.iter().filter(|&&count| count > 0).count();
            assert!(some <= 1, "{plugin}, {formulation}: {counts:?}");
        }
    }
}

#[test]
fn a_step_of_eulerian_bodies_allocates_nothing_but_room_for_longer_lists() {
    for (dimension, max) in [("Two", "(1.2, 0.5)"), ("Three", "(1.2, 0.5, 0.3)")] {
        let low = max.replace(|c: char| c.is_ascii_digit(), "0").replace("0.0", "0");
        let text = format!(
            r#"(dimension: {dimension}, materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
                bodies: [(name: "b", material: "m", shape: Box(min: {low}, max: {max}), spacing: 0.05,
                          formulation: Eulerian(), plugins: [hourglass_control()])],
                conditions: [InitialVelocity(on: Select(body: "b"), value: ("0.1*sin(9*y)", "0.1*x"))],
                time: (end: 100.0))"#
        );
        let counts = counts(&Source::new("eulerian.ron", text), 1, 100);
        let some = counts.iter().filter(|&&count| count > 0).count();
        assert!(some <= 5, "{dimension}: {counts:?}");
    }
}

/// The queues by which threads hand over work take a block of memory now and then, whatever the size of the
/// bodies; a pass that allocates does so in every step.
#[test]
fn steps_of_bodies_of_many_tasks_on_two_threads_allocate_nothing_of_their_own() {
    let solids = all_plugins(2);
    let scenes = [
        solids.clone(),
        with_formulation("UpdatedLagrangian(update: Never)", &solids),
        eulerian(&solids),
        flow(2),
        landing(),
    ];
    for scene in scenes {
        let counts = counts_of(|| of_many_tasks(&scene), 2, 40);
        let none = counts.iter().filter(|&&count| count == 0).count();
        assert!(none >= 20, "{}: {counts:?}", scene.name);
    }
}

#[test]
fn a_contact_that_begins_and_spreads_allocates_nothing() {
    let counts = counts(&landing(), 1, 200);
    assert!(counts.iter().all(|&count| count == 0), "{counts:?}");
}

#[test]
fn a_step_of_flows_allocates_nothing_but_room_for_longer_lists() {
    for source in [flow(2), flow(3), double(&flow(3))] {
        let counts = counts(&source, 1, 100);
        // The largest number of neighbours grows as water is compressed, and with it the memory of a list and
        // its search; the number of blocks changes with the lists, and with it what each of some twenty
        // arrays holds for a block.
        let none = counts.iter().filter(|&&count| count == 0).count();
        assert!(none >= 95 && counts.iter().all(|&count| count < 20), "{}: {counts:?}", source.name);
    }
}
