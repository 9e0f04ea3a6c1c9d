//! Errors of a scene in its requested output, found without writing anything.

use super::*;
use crate::assembly::build;

fn error(from: &str, to: &str) -> String {
    let (scene, source) = cantilever(|t| {
        assert!(t.contains(from));
        t.replace(from, to)
    });
    build(&scene, &source, &Registry::standard()).map(|_| ()).unwrap_err().to_string()
}

/// The line under the excerpt, from its first caret on.
fn marked(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let at = lines.iter().position(|line| line.contains('^')).unwrap();
    let (start, end) = (lines[at].find('^').unwrap(), lines[at].rfind('^').unwrap() + 1);
    lines[at - 1][start..end].to_owned()
}

#[test]
fn unknown_fields_are_told_with_the_nearest_name() {
    let text = error(r#""von_mises""#, r#""von_mise""#);
    assert!(
        text.contains("unknown field `von_mise`") && text.contains("did you mean `von_mises`?"),
        "{text}"
    );
    assert!(text.contains("known here: `deformation_gradient`, `displacement`"), "{text}");
    assert_eq!(marked(&text), r#""von_mise""#);
    let text = error(r#"Field("stress.xx")"#, r#"Field("strss.xx")"#);
    assert!(text.contains("did you mean `stress`?") && marked(&text) == r#""strss.xx""#, "{text}");
}

#[test]
fn unknown_components_are_told_with_the_known_ones() {
    let text = error(r#""velocity""#, r#""velocity.w""#);
    assert!(text.contains("`velocity` has no component `w`"), "{text}");
    assert!(text.contains("its components are x, y, z"), "{text}");
    let text = error(r#"Field("stress.xx")"#, r#"Field("speed.x")"#);
    assert!(text.contains("it is a number: write `speed`"), "{text}");
}

#[test]
fn tensors_are_for_paraview() {
    let text = error(r#""velocity"], checkpoint_every: 0.005, vtk: true"#, r#""stress"]"#);
    assert!(text.contains("the field `stress` is a tensor") && text.contains("`stress.xx`"), "{text}");
    let (scene, source) = cantilever(|t| t.replace(r#""velocity""#, r#""stress""#));
    assert!(build(&scene, &source, &Registry::standard()).is_ok());
}

#[test]
fn selections_of_probes_are_checked() {
    let text = error(
        "on: Select(nearest: (0.08, 0.03))",
        "on: Select(within: Box(min: (1.0, 1.0), max: (2.0, 2.0)))",
    );
    assert!(text.contains("the selection is empty"), "{text}");
    let text = error(
        r#"Probe(name: "energies", quantity"#,
        r#"Probe(name: "energies", on: Select(face: MinX), quantity"#,
    );
    assert!(text.contains("holds 3 of the 24 particles of body `beam`"), "{text}");
    assert!(text.contains("energies are kept for whole bodies"), "{text}");
}

#[test]
fn all_faults_are_told_at_once() {
    let (scene, source) =
        cantilever(|t| t.replace("von_mises", "vonmises").replace("stress.xx", "stress.xw"));
    let error = build(&scene, &source, &Registry::standard()).map(|_| ()).unwrap_err();
    assert_eq!(error.problems.len(), 2);
}

#[test]
fn a_probe_where_nothing_is_is_refused() {
    let error = |point: &str| {
        let scene = cantilever(|text| text.replace("at: (0.04, 0.012)", &format!("at: {point}")));
        build(&scene.0, &scene.1, &Registry::standard())
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    assert_eq!([error("(0.04, 0.012)"), error("(0.09, 0.012)")], ["", ""]);
    assert!(error("(5.0, 5.0)").contains("no particle with `stress.xx` is near"));
}
