//! Interrupted, killed and resumed runs.

use super::*;
use crate::simulation::{Checkpoint, Outcome};

/// Every file that must not depend on interruptions, with its content.
fn results(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let timeless = |name: &String| name != "summary.json" && name != "checkpoint.mlc";
    let names = names_in(folder).into_iter().filter(timeless);
    names.map(|name| (name.clone(), fs::read(folder.join(&name)).unwrap())).collect()
}

/// Goes on from the checkpoint in the folder.
fn resumed(folder: &Path) -> Simulation {
    let checkpoint = Checkpoint::read(&folder.join("checkpoint.mlc")).unwrap();
    let source = checkpoint.source();
    assert!(Path::new(&source.name).is_absolute() && source.name.ends_with("scenes/cantilever.ron"));
    let scene = parse(source).unwrap();
    let mut sim = try_build(&scene, &options(folder, Existing::Refuse, true)).unwrap();
    sim.restore(&checkpoint).unwrap();
    sim
}

#[test]
fn a_resumed_run_writes_the_files_of_one_that_was_not_interrupted() {
    let whole_folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| t.replace("Fixed(1.0e-4)", "Adaptive()"));
    let whole = run(built(&scene, whole_folder.path()));
    let steps = whole.clock().step;
    assert!(steps > 20, "{steps}");
    for at in [1, 2, 7, steps / 2, steps - 1] {
        let folder = tempfile::tempdir().unwrap();
        let mut first = built(&scene, folder.path());
        first.run(|sim| sim.clock().step < at).unwrap();
        assert_eq!(first.finish().unwrap().outcome, Outcome::Interrupted);
        let hash = first.state_hash();

        let second = resumed(folder.path());
        assert_eq!(second.state_hash(), hash);
        let second = run(second);
        assert_eq!(second.state_hash(), whole.state_hash(), "interrupted at step {at}");
        assert_eq!(second.ledger(), whole.ledger());
        let (found, expected) = (results(folder.path()), results(whole_folder.path()));
        for ((name, found), (_, expected)) in found.iter().zip(&expected) {
            assert!(found == expected, "{name} differs, interrupted at step {at}");
        }
        assert_eq!(found.len(), expected.len());
        let extremes = |sim: &Simulation| format!("{:?}", sim.summary().probes);
        assert_eq!(extremes(&second), extremes(&whole));
    }
}

#[test]
fn a_killed_run_goes_on_from_its_last_checkpoint() {
    let whole_folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| t);
    let whole = run(built(&scene, whole_folder.path()));

    let folder = tempfile::tempdir().unwrap();
    let mut killed = built(&scene, folder.path());
    killed.run(|sim| sim.clock().step < 137).unwrap();
    // A kill takes what was not flushed, and leaves half a row of what was.
    std::mem::forget(killed);
    let tip = folder.path().join("tip.csv");
    let text = fs::read_to_string(&tip).unwrap();
    fs::write(&tip, format!("{text}0.0137,-0.00")).unwrap();
    fs::write(folder.path().join(".checkpoint.mlc.x.tmp"), "half").unwrap();

    let second = resumed(folder.path());
    assert_eq!(second.clock().step, 100);
    assert!(!folder.path().join(".checkpoint.mlc.x.tmp").exists());
    let second = run(second);
    assert_eq!(second.state_hash(), whole.state_hash());
    assert!(results(folder.path()) == results(whole_folder.path()));
}

#[test]
fn a_run_can_be_interrupted_more_than_once() {
    let whole_folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| t);
    let whole = run(built(&scene, whole_folder.path()));
    let folder = tempfile::tempdir().unwrap();
    let mut sim = built(&scene, folder.path());
    for until in [0, 33, 34, 150, 200] {
        sim.run(|sim| sim.clock().step < until).unwrap();
        sim.finish().unwrap();
        if until < 200 {
            sim = resumed(folder.path());
        }
    }
    assert_eq!(sim.state_hash(), whole.state_hash());
    assert!(results(folder.path()) == results(whole_folder.path()));
}

#[test]
fn files_that_are_not_those_of_the_checkpoint_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut sim = built(&cantilever(|t| t), folder.path());
    sim.run(|sim| sim.clock().step < 50).unwrap();
    sim.finish().unwrap();
    fs::write(folder.path().join("tip.csv"), "t[s],x[m],y[m]\n").unwrap();
    let checkpoint = Checkpoint::read(&folder.path().join("checkpoint.mlc")).unwrap();
    let scene = parse(checkpoint.source()).unwrap();
    let mut sim = try_build(&scene, &options(folder.path(), Existing::Refuse, true)).unwrap();
    let error = sim.restore(&checkpoint).unwrap_err().to_string();
    assert!(error.contains("tip.csv") && error.contains("at the checkpoint"), "{error}");
}

#[test]
fn checkpoints_come_when_they_are_due() {
    let folder = tempfile::tempdir().unwrap();
    let mut sim = built(&cantilever(|t| t), folder.path());
    let file = folder.path().join("checkpoint.mlc");
    let mut seen = Vec::new();
    while !sim.is_finished() {
        sim.step().unwrap();
        if file.exists() {
            let clock = Checkpoint::read(&file).unwrap().clock();
            if seen.last() != Some(&clock.step) {
                assert_eq!(clock.step, sim.clock().step);
                seen.push(clock.step);
            }
        }
    }
    assert_eq!(seen, [50, 100, 150, 200]);
}

#[test]
fn a_complete_run_leaves_a_checkpoint_of_its_end_unless_the_scene_wants_none() {
    for (setting, there) in
        [("", true), ("checkpoint_at_end: true, ", true), ("checkpoint_at_end: false, ", false)]
    {
        let folder = tempfile::tempdir().unwrap();
        run(built(&cantilever(|t| t.replace("checkpoint_every: 0.005, ", setting)), folder.path()));
        let file = folder.path().join("checkpoint.mlc");
        assert_eq!(file.exists(), there, "{setting}");
        if there {
            assert_eq!(Checkpoint::read(&file).unwrap().clock().time, 0.02);
        }
    }
}

#[test]
fn a_checkpoint_of_a_run_that_writes_serves_one_that_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| t);
    let mut sim = built(&scene, folder.path());
    sim.run(|sim| sim.clock().step < 20).unwrap();
    sim.finish().unwrap();
    let checkpoint = Checkpoint::read(&folder.path().join("checkpoint.mlc")).unwrap();
    let mut silent = try_build(&scene, &BuildOptions::default()).unwrap();
    silent.restore(&checkpoint).unwrap();
    assert_eq!(silent.state_hash(), sim.state_hash());
}

/// A block whose particles are those of a file beside the scene.
fn block_of_points(folder: &Path) -> (Scene, Source) {
    let text = r#"Scene(
    dimension: Two,
    gravity: (0.0, -9.81),
    materials: {"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)},
    bodies: [
        Body(name: "block", material: "rubber", shape: Points(file: "block.csv"), spacing: 0.01,
             formulation: TotalLagrangian),
    ],
    time: (end: 0.02, step: Fixed(1.0e-4)),
)
"#;
    fs::write(folder.join("scene.ron"), text).unwrap();
    crate::scene::load(&folder.join("scene.ron"), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn write_points(folder: &Path, stretch: f64) {
    let mut text = "x,y,volume\n".to_owned();
    for k in 0..25 {
        text += &format!("{},{},1e-4\n", stretch * 0.01 * f64::from(k % 5), 0.01 * f64::from(k / 5));
    }
    fs::write(folder.join("block.csv"), text).unwrap();
}

#[test]
fn a_file_that_has_changed_is_refused_and_a_project_can_be_moved() {
    let place = tempfile::tempdir().unwrap();
    let project = place.path().join("project");
    fs::create_dir(&project).unwrap();
    write_points(&project, 1.0);
    let mut sim = built(&block_of_points(&project), &project.join("out"));
    sim.run(|sim| sim.clock().step < 20).unwrap();
    sim.finish().unwrap();
    drop(sim);
    let moved = place.path().join("renamed");
    fs::rename(&project, &moved).unwrap();
    let go_on = || {
        let checkpoint = Checkpoint::read(&moved.join("out/checkpoint.mlc")).unwrap();
        let scene = parse(checkpoint.source()).unwrap();
        let mut sim = try_build(&scene, &options(&moved.join("out"), Existing::Refuse, true)).unwrap();
        sim.restore(&checkpoint).map(|()| sim.clock().step).map_err(|error| error.to_string())
    };
    assert_eq!(go_on(), Ok(20));
    write_points(&moved, 0.99);
    let error = go_on().unwrap_err();
    assert!(error.contains("`block.csv` has changed since the run began"), "{error}");
}
