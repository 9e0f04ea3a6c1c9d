//! The files of a run and their content.

use super::*;
use crate::assembly::build;
use crate::record::read_series;
use crate::world::{BodyId, Force, Mass, Position, ReferencePosition};

#[test]
fn a_run_leaves_the_documented_files_with_their_headers() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out/run");
    run(built(&cantilever(|t| t), &out));
    let mut expected: Vec<String> = ["cantilever.pvd", "checkpoint.mlc", "energies.csv", "energy.csv"]
        .into_iter()
        .chain(["middle.csv", "summary.json", "support.csv", "tip.csv"])
        .map(str::to_owned)
        .collect();
    expected.extend((0..6).map(|k| format!("cantilever_beam_{k:06}.vtu")));
    expected.sort();
    assert_eq!(names_in(&out), expected);
    let header = |name: &str| {
        let text = fs::read_to_string(out.join(name)).unwrap();
        text.lines().next().unwrap().to_owned()
    };
    assert_eq!(header("tip.csv"), "t[s],x[m],y[m]");
    assert_eq!(header("support.csv"), "t[s],x[N],y[N]");
    assert_eq!(header("middle.csv"), "t[s],stress.xx[Pa]");
    let accounts = ["strain", "kinetic", "constraints", "gravity"];
    let total: Vec<String> = accounts.iter().map(|a| format!("{a}[J]")).collect();
    assert_eq!(header("energies.csv"), format!("t[s],{}", total.join(",")));
    let body: Vec<String> = accounts.iter().map(|a| format!("beam.{a}[J]")).collect();
    let balance = "balance_error[J],relative_error[1]";
    assert_eq!(header("energy.csv"), format!("t[s],{},{},{balance}", total.join(","), body.join(",")));
}

#[test]
fn samples_fall_on_the_first_step_end_at_or_after_each_due_time() {
    let folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| t.replace("1.0e-4", "3.0e-4").replace("end: 0.02", "end: 0.01"));
    run(built(&scene, folder.path()));
    let times = read_series(&folder.path().join("tip.csv")).unwrap().numbers("t").unwrap();
    let expected = [0.0, 0.0012, 0.0021, 0.003, 0.0042, 0.0051, 0.006, 0.0072, 0.0081, 0.009, 0.01];
    assert_eq!(times.len(), expected.len(), "{times:?}");
    for (time, expected) in times.iter().zip(expected) {
        assert!((time - expected).abs() < 1e-12, "{times:?}");
    }
    let energy = read_series(&folder.path().join("energy.csv")).unwrap();
    assert_eq!(energy.numbers("t").unwrap()[..2], [0.0, times[0] + 0.0006]);
    assert_eq!(energy.numbers("kinetic").unwrap()[0], 0.0);
}

#[test]
fn probes_are_means_and_sums_of_columns() {
    let folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| {
        let column = r#"probes: [
            Probe(name: "all", on: Select(body: "beam"), quantity: Position),
            Probe(name: "moved", on: Select(within: Box(min: (0.05, 0.0), max: (0.08, 0.01))), quantity: Displacement),"#;
        t.replace("probes: [", column)
    });
    let sim = run(built(&scene, folder.path()));
    let (view, rows) = sim.world().body_view(BodyId(0));
    let x = view.read::<Position>().unwrap();
    let reference = view.read::<ReferencePosition>().unwrap();
    let force = view.read::<Force>().unwrap();
    let last = |probe: &str, column: &str| {
        let series = read_series(&folder.path().join(format!("{probe}.csv"))).unwrap();
        *series.numbers(column).unwrap().last().unwrap()
    };
    let n = rows.len() as f64;
    let mean = rows.clone().map(|i| x[i].0.y).sum::<f64>() / n;
    assert!((last("all", "y") - mean).abs() < 1e-15);
    let right: Vec<usize> =
        rows.clone().filter(|&i| reference[i].0.x > 0.05 && reference[i].0.y < 0.01).collect();
    assert_eq!(right.len(), 3);
    let moved = right.iter().map(|&i| x[i].0.y - reference[i].0.y).sum::<f64>() / 3.0;
    assert!(moved < -1e-4 && (last("moved", "y") - moved).abs() < 1e-15);
    let held = rows.filter(|&i| reference[i].0.x < 0.01).map(|i| force[i].0.y).sum::<f64>();
    assert!((last("support", "y") - held).abs() < 1e-12 * held.abs());
}

#[test]
fn a_body_at_rest_pulls_its_support_down_by_its_weight() {
    // Newton's second law for the whole body: what the support takes is the weight less the inertia.
    let folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| t.replace("step: Fixed(1.0e-4)", "step: Fixed(1.0e-5)"));
    let mut sim = built(&scene, folder.path());
    let momentum = |sim: &Simulation| {
        let (view, rows) = sim.world().body_view(BodyId(0));
        let v = view.read::<crate::world::Velocity>().unwrap();
        let m = view.read::<Mass>().unwrap();
        rows.map(|i| m[i].0 * v[i].0.y).sum::<f64>()
    };
    let mut before = 0.0;
    sim.run(|sim| {
        if sim.clock().step == 999 {
            before = momentum(sim);
        }
        sim.clock().step < 1001
    })
    .unwrap();
    let weight = -9.81 * 1000.0 * 0.08 * 0.03;
    // The probe is sampled at t = 0.01, half way between the two momenta.
    let inertia = (momentum(&sim) - before) / 2e-5;
    sim.finish().unwrap();
    let series = read_series(&folder.path().join("support.csv")).unwrap();
    let at = series.numbers("t").unwrap().iter().position(|t| (t - 0.01).abs() < 1e-9).unwrap();
    let force = series.numbers("y").unwrap()[at];
    assert!((force - (weight - inertia)).abs() < 1e-4 * weight.abs(), "{force} {weight} {inertia}");
}

#[test]
fn the_point_probe_interpolates() {
    let folder = tempfile::tempdir().unwrap();
    let scene = cantilever(|t| {
        let points = r#"probes: [
            Probe(name: "inside", at: (0.043, 0.011), quantity: Position),
            Probe(name: "corner", at: (0.0, 0.0), quantity: Position),
            Probe(name: "far", at: (0.2, 0.2), may_be_empty: true, quantity: Velocity),"#;
        t.replace("probes: [", points)
    });
    run(built(&scene, folder.path()));
    let first = |probe: &str| {
        let series = read_series(&folder.path().join(format!("{probe}.csv"))).unwrap();
        [series.numbers("x").unwrap()[0], series.numbers("y").unwrap()[0]]
    };
    // A linear field, the position, comes out exactly, also outside the outermost particle centres.
    for (probe, at) in [("inside", [0.043, 0.011]), ("corner", [0.0, 0.0])] {
        let found = first(probe);
        assert!((found[0] - at[0]).abs() < 1e-15 && (found[1] - at[1]).abs() < 1e-15, "{found:?}");
    }
    assert!(first("far")[0].is_nan());
}

#[test]
fn a_probe_that_finds_nothing_in_any_sample_is_warned_of() {
    let warnings = |probe: &str| {
        let folder = tempfile::tempdir().unwrap();
        let text = format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [(name: "water", material: "water", shape: Box(min: (0, 0), max: (0.1, 0.1)), spacing: 0.02, formulation: Fluid)],
                probes: [Probe(name: "p", {probe})], time: (end: 0.001))"#
        );
        let warnings = run(built(&parse(Source::new("pond.ron", text)).unwrap(), folder.path()))
            .finish()
            .unwrap()
            .warnings;
        warnings.into_iter().filter(|text| text.contains("probe `p` has found nothing")).count()
    };
    let quantities = [
        r#"Field("pressure")"#,
        "WaterLevel(along: (0, 1))",
        "PressureSensor(normal: (0, 1))",
        "Flux(normal: (0, 1), within: Box(min: (0, 0), max: (0.1, 2)))",
    ];
    for quantity in quantities {
        assert_eq!(warnings(&format!("at: (0.05, 0.9), quantity: {quantity}")), 1, "{quantity}");
        assert_eq!(
            warnings(&format!("at: (0.05, 0.9), may_be_empty: true, quantity: {quantity}")),
            0,
            "{quantity}"
        );
    }
    for quantity in &quantities[..2] {
        assert_eq!(warnings(&format!("at: (0.05, 0.05), quantity: {quantity}")), 0, "{quantity}");
    }
}

#[test]
fn the_summary_tells_what_the_files_hold() {
    let folder = tempfile::tempdir().unwrap();
    let sim = run(built(&cantilever(|t| t), folder.path()));
    let text = fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["outcome"]["how"], "finished");
    assert_eq!(summary["steps"], 200);
    assert_eq!(summary["particles"], 24);
    assert_eq!(summary["particles_of"]["beam"], 24);
    assert_eq!(summary["energies"]["strain"], sim.ledger().total_named("strain"));
    let tip = read_series(&folder.path().join("tip.csv")).unwrap();
    let (times, y) = (tip.numbers("t").unwrap(), tip.numbers("y").unwrap());
    let least = y.iter().copied().fold(f64::INFINITY, f64::min);
    let column = &summary["probes"]["tip"][1];
    assert_eq!((&column["name"], &column["unit"]), (&"y".into(), &"m".into()));
    assert_eq!(column["min"], least);
    assert_eq!(column["min_time"], times[y.iter().position(|v| *v == least).unwrap()]);
    assert_eq!(column["last"], *y.last().unwrap());
    assert_eq!((column["max"].as_f64(), column["max_time"].as_f64()), (Some(0.0), Some(0.0)));
    let systems = summary["timings"].as_array().unwrap();
    assert!(systems.iter().any(|timing| timing["system"] == "output"));
    assert!(!summary["references"].as_array().unwrap().is_empty());
}

#[test]
fn without_output_nothing_is_written_and_the_state_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, source) = cantilever(|t| t);
    let before = std::env::current_dir().unwrap();
    let mut silent = build(&scene, &source, &Registry::standard()).unwrap();
    silent.run(|_| true).unwrap();
    let summary = silent.finish().unwrap();
    assert!(silent.checkpoint().unwrap().is_none() && summary.probes.is_empty());
    assert!(!before.join("energy.csv").exists() && !before.join("scenes").exists());
    let loud = run(built(&(scene, source), folder.path()));
    assert_eq!(silent.state_hash(), loud.state_hash());
}

#[test]
fn nothing_is_overwritten_unless_asked_for() {
    for file in ["energy.csv", "summary.json", "checkpoint.mlc", "tip.csv", "cantilever.pvd"]
        .into_iter()
        .chain(["cantilever_beam_000003.vtu"])
    {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(file);
        fs::write(&path, "mine").unwrap();
        let scene = cantilever(|t| t);
        let error = try_build(&scene, &BuildOptions::into_folder(folder.path())).map(|_| ()).unwrap_err();
        let text = error.to_string();
        assert!(text.contains(&format!("{file}` already exists")) && text.contains("--force"), "{text}");
        assert_eq!(names_in(folder.path()), [file]);
        assert_eq!(fs::read_to_string(&path).unwrap(), "mine");

        run(try_build(&scene, &options(folder.path(), Existing::Replace, false)).unwrap());
        let last = fs::read(&path);
        assert!(last.is_ok_and(|bytes| bytes != b"mine"), "{file}");
    }
}

#[test]
fn old_checkpoints_and_summaries_do_not_stay_beside_new_results() {
    let folder = tempfile::tempdir().unwrap();
    for file in ["summary.json", "checkpoint.mlc", "cantilever_beam_000099.vtu"] {
        fs::write(folder.path().join(file), "old").unwrap();
    }
    fs::write(folder.path().join("cantilever_notes.vtu"), "mine").unwrap();
    let scene = cantilever(|t| t);
    let mut sim = try_build(&scene, &options(folder.path(), Existing::Replace, false)).unwrap();
    assert!(folder.path().join("checkpoint.mlc").exists());
    sim.start().unwrap();
    for file in ["summary.json", "checkpoint.mlc", "cantilever_beam_000099.vtu"] {
        assert!(!folder.path().join(file).exists(), "{file}");
    }
    assert!(folder.path().join("cantilever_notes.vtu").exists());
}

#[test]
fn a_folder_that_cannot_be_made_is_told_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    let out = folder.path().join("file/out");
    let error =
        try_build(&cantilever(|t| t), &BuildOptions::into_folder(&out)).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("cannot make the output folder") && error.contains("file/out"), "{error}");
}
