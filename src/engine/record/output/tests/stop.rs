//! Runs that end when a probe passes a value.

use super::*;
use crate::simulation::{Checkpoint, Outcome};

fn stopping(condition: &str) -> (Scene, Source) {
    cantilever(|text| text.replace("Fixed(1.0e-4)", &format!("Fixed(1.0e-4), stop_when: [{condition}]")))
}

const SAG: &str = r#"(probe: "tip", column: "y", below: -1.0e-4)"#;

#[test]
fn a_run_ends_at_the_first_sample_beyond_the_value() {
    let folder = tempfile::tempdir().unwrap();
    let whole = run(built(&cantilever(|t| t), folder.path()));
    let series = crate::record::read_series(&folder.path().join("tip.csv")).unwrap();
    let (t, y) = (series.numbers("t").unwrap(), series.numbers("y").unwrap());
    let first = y.iter().position(|y| *y < -1.0e-4).expect("it sags that far");
    assert!(first > 1 && t[first] < whole.end(), "{y:?}");

    let folder = tempfile::tempdir().unwrap();
    let sim = run(built(&stopping(SAG), folder.path()));
    assert_eq!(sim.clock().time, t[first]);
    let Outcome::Stopped(why) = sim.summary().outcome else { panic!("{:?}", sim.summary().outcome) };
    assert!(why.starts_with("probe `tip.y` is below -100 µm: -"), "{why}");
    // The last state is recorded.
    let energy = crate::record::read_series(&folder.path().join("energy.csv")).unwrap();
    assert_eq!(energy.numbers("t").unwrap().last(), Some(&t[first]));
}

#[test]
fn interruptions_do_not_move_the_end() {
    let whole = run(built(&stopping(SAG), tempfile::tempdir().unwrap().path()));
    let steps = whole.clock().step;
    for at in [1, steps / 2, steps - 1] {
        let folder = tempfile::tempdir().unwrap();
        let mut first = built(&stopping(SAG), folder.path());
        first.run(|sim| sim.clock().step < at).unwrap();
        first.finish().unwrap();
        let second = run(resumed(folder.path()));
        assert_eq!(second.clock().step, steps, "interrupted at {at}");
        assert_eq!(second.state_hash(), whole.state_hash());
        assert!(matches!(second.summary().outcome, Outcome::Stopped(_)));
    }
}

#[test]
fn a_run_that_has_stopped_can_be_taken_further() {
    let folder = tempfile::tempdir().unwrap();
    let first = run(built(&stopping(SAG), folder.path()));
    let second = run(resumed(folder.path()));
    assert!(second.clock().step > first.clock().step);
    assert_eq!(second.clock().time, second.end());
}

fn resumed(folder: &Path) -> Simulation {
    let checkpoint = Checkpoint::read(&folder.join("checkpoint.mlc")).unwrap();
    let scene = parse(checkpoint.source()).unwrap();
    let mut sim = try_build(&scene, &options(folder, Existing::Refuse, true)).unwrap();
    sim.restore(&checkpoint).unwrap();
    sim
}

#[test]
fn energies_and_runs_that_write_nothing_stop_too() {
    let condition = r#"(probe: "energies", column: "kinetic", above: 1.0e-6)"#;
    let mut sim = try_build(&stopping(condition), &BuildOptions::default()).unwrap();
    sim.run(|_| true).unwrap();
    assert!(sim.stop_reason().is_some_and(|why| why.contains("`energies.kinetic` is above 1 µJ: ")));
}

#[test]
fn faults_of_conditions_point_at_them() {
    for (condition, message, at) in [
        (r#"(probe: "tipp", above: 1)"#, "unknown probe `tipp`", "\"tipp\""),
        (r#"(probe: "tip", column: "y")"#, "needs `above` or `below`", r#"(probe: "tip", column: "y")"#),
        (r#"(probe: "tip", above: 1)"#, "has several columns", "\"tip\""),
        (r#"(probe: "tip", column: "w", above: 1)"#, "has no column `w`", "\"w\""),
    ] {
        let text = cantilever(|t| t).1.text;
        let text = text.replace("Fixed(1.0e-4)", &format!("Fixed(1.0e-4), stop_when: [{condition}]"));
        let source = Source::new("x.ron", text);
        let error = match parse(source.clone()) {
            Ok(scene) => try_build(&scene, &BuildOptions::default()).err().expect("an error"),
            Err(error) => error,
        };
        assert!(error.problems[0].message.contains(message), "{error}");
        let span = error.problems[0].span(&source).unwrap();
        assert_eq!(&source.text[span], at, "{error}");
    }
}
