//! Processes started by `mpirun` write the files of one process, byte for byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// How long a run may take: what waits for ever is a fault.
const PATIENCE: Duration = Duration::from_secs(120);

fn scene(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes").join(name).display().to_string()
}

/// `meshless` with these arguments on that many ranks of one thread.
fn ranks(size: usize, arguments: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    // More ranks than cores, as root in a container, must do as well.
    let settings = [
        ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
        ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
        ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
        ("OMPI_MCA_mpi_yield_when_idle", "1"),
        ("OMPI_MCA_btl_vader_single_copy_mechanism", "none"),
        ("OMPI_MCA_hwloc_base_binding_policy", "none"),
    ];
    command.envs(settings).args(["-n", &size.to_string(), env!("CARGO_BIN_EXE_meshless")]).args(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Waits for its end, but not for ever.
fn ended(mut child: Child) -> Output {
    let begun = Instant::now();
    while child.try_wait().expect("a process").is_none() {
        if begun.elapsed() > PATIENCE {
            child.kill().expect("a process that can be ended");
            panic!("the ranks wait for each other");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().expect("the output of a process")
}

fn run(size: usize, arguments: &[&str]) -> Output {
    ended(ranks(size, arguments).spawn().expect("mpirun"))
}

fn assert_success(output: &Output) {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// What a run has written, but for the times of the summary.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let kept = entries
        .filter(|path| path.extension().is_some_and(|extension| extension != "json" && extension != "rrd"));
    kept.map(|path| (path.file_name().unwrap_or_default().into(), fs::read(&path).expect("a file"))).collect()
}

#[test]
fn ranks_write_the_files_of_one_process() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scenes = [
        ("twisting_column.ron", "40"),
        ("taylor_bar.ron", "40"),
        ("colliding_rings.ron", "60"),
        ("projectile.ron", "60"),
        ("metal_cutting.ron", "10"),
        ("dam_break.ron", "120"),
        ("taylor_green.ron", "60"),
        ("elastic_gate.ron", "20"),
        ("floating_box.ron", "60"),
    ];
    for (name, steps) in scenes {
        let write = |size: usize| {
            let out = folder.path().join(format!("{name}.{size}"));
            assert_success(&run(
                size,
                &[
                    "run",
                    &scene(name),
                    "--steps",
                    steps,
                    "--threads",
                    "1",
                    "--out",
                    &out.display().to_string(),
                ],
            ));
            files(&out)
        };
        let alone = write(1);
        assert!(
            alone.contains_key(Path::new("checkpoint.mlc")) && alone.len() > 1,
            "{name}: {:?}",
            alone.keys()
        );
        for size in [2, 3] {
            assert!(write(size) == alone, "{name} on {size} ranks");
        }
    }
}

/// The line of the summary that tells the state.
fn state_hash(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text.lines().find(|line| line.starts_with("state hash")).expect("the summary tells the state");
    line.to_owned()
}

#[test]
fn a_run_goes_on_with_another_number_of_ranks() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = scene("dam_break.ron");
    let write = |name: &str, first: usize, then: usize| {
        let out = folder.path().join(name);
        let text = out.display().to_string();
        assert_success(&run(first, &["run", &scene, "--steps", "50", "--threads", "1", "--out", &text]));
        let output = run(then, &["resume", &text, "--steps", "70", "--threads", "1"]);
        assert_success(&output);
        // The checkpoint names the folder that it lies in.
        let mut files = files(&out);
        files.remove(Path::new("checkpoint.mlc"));
        (state_hash(&output), files)
    };
    let alone = write("a", 1, 1);
    assert!(write("b", 3, 2) == alone);
    assert!(write("c", 1, 3) == alone);
}

#[test]
fn what_is_wrong_is_told_once() {
    let output = run(3, &["run", "no_such_scene.ron"]);
    assert_eq!(output.status.code(), Some(2));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(text.matches("no_such_scene.ron").count(), 1, "{text}");
    let output = run(2, &["check", &scene("cantilever.ron")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("this command runs in one process, found 2"));
}

/// The process of a rank of the run with these arguments.
fn process_of(folder: &str) -> Option<u32> {
    let processes =
        fs::read_dir("/proc").ok()?.filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    let mut ranks = processes.filter(|id: &u32| {
        let line = fs::read_to_string(format!("/proc/{id}/cmdline")).unwrap_or_default();
        line.contains(folder) && !line.starts_with("mpirun")
    });
    ranks.next()
}

#[cfg(target_os = "linux")]
#[test]
fn a_rank_that_is_killed_ends_all_and_leaves_a_valid_checkpoint() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("run");
    let name = out.display().to_string();
    let arguments = [
        "run",
        &scene("dam_break.ron"),
        "--threads",
        "1",
        "--set",
        "record.checkpoint_every=0.002",
        "--out",
        &name,
    ];
    let child = ranks(2, &arguments).spawn().expect("mpirun");
    let begun = Instant::now();
    while !out.join("checkpoint.mlc").exists() {
        assert!(begun.elapsed() < PATIENCE, "no checkpoint is written");
        std::thread::sleep(Duration::from_millis(20));
    }
    let id = process_of(&name).expect("a rank");
    assert!(Command::new("kill").args(["-9", &id.to_string()]).status().expect("kill").success());
    assert!(!ended(child).status.success());
    assert_success(&run(2, &["resume", &name, "--steps", "5", "--threads", "1"]));
}
