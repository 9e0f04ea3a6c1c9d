//! The commands and the Python code of docs/from-a-run-to-a-figure.md do what the page says.
#![cfg(all(unix, feature = "rerun"))]

use std::path::Path;
use std::process::Command;

/// What the page has read from the recording is in the ParaView file and in the probe, too.
const COMPARISON: &str = r#"
assert np.allclose(places[max(places)].reshape(-1, 3), frame.points, atol=1e-6)
assert np.allclose(stress[max(stress)], frame.point_data["von_mises"].ravel(), rtol=1e-5)
assert abs(max(places) - tip["t[s]"].iloc[-1]) < 1e-9
start, end = (places[at(places)].reshape(-1, 3) for at in (min, max))
near = np.hypot(start[:, 0] - 0.6, start[:, 1] - 0.025) < 0.004
assert near.sum() == 2
assert np.abs((end - start)[near, 1] - tip["y[m]"].iloc[-1]).min() < 1e-7
"#;

/// The code blocks of a language, one after the other.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    let after = page.split(&fence).skip(1);
    after.filter_map(|rest| rest.split("```").next()).map(str::to_owned).collect()
}

#[test]
fn the_page_on_figures_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/from-a-run-to-a-figure.md")).expect("the page");
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::os::unix::fs::symlink(root.join("assets"), folder.path().join("assets")).expect("a link");
    let program = Path::new(env!("CARGO_BIN_EXE_meshless")).parent().expect("its folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let run = |command: &mut Command| {
        let output = command.current_dir(folder.path()).env("PATH", &path).output().expect("it starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    for block in blocks(&page, "sh") {
        run(Command::new("sh").args(["-e", "-c", &block]));
    }
    for picture in ["cantilever.png", "smooth.png"] {
        assert!(folder.path().join(picture).is_file(), "{picture}");
    }
    let python = std::env::var("MESHLESS_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let packages = Command::new(&python).args(["-c", "import rerun, pandas, matplotlib, meshio"]).output();
    if !packages.is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: {python} lacks rerun-sdk, pandas, matplotlib or meshio");
        return;
    }
    let code = blocks(&page, "python").concat() + COMPARISON;
    run(Command::new(&python).args(["-c", &code]));
    for figure in ["tip.pdf", "stress.png"] {
        assert!(folder.path().join(figure).is_file(), "{figure}");
    }
}
