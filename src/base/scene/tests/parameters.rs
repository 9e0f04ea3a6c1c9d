//! Names for numbers, and functions by points.

use glam::DVec3;

use super::super::*;
use super::smallest_with;

/// The smallest scene with these parameters, a run that ends at `end` and further fields.
fn scene(parameters: &str, end: &str, fields: &str) -> Source {
    let source = smallest_with(&format!("parameters: {{{parameters}}}, {fields}"));
    Source::new("small.ron", source.text.replace("end: 1", &format!("end: {end}")))
}

fn read(source: Source) -> Scene {
    parse(source).unwrap_or_else(|error| panic!("{error}")).0
}

/// The message and the text that it points at.
fn fault(source: &Source) -> (String, String) {
    let error = parse(source.clone()).expect_err("a bad scene");
    let problem = &error.problems[0];
    let span = problem.span(source).expect("a place");
    (problem.message.clone(), source.text[span].to_owned())
}

#[test]
fn expressions_stand_wherever_a_number_does() {
    let fields = "gravity: (0, \"-2*g\"), record: (every: \"h/2\"),
        contacts: [(between: (\"a\", \"a\"), law: Penalty(stiffness: \"1/dx\"), friction: \"ratio\")],";
    let source = scene("\"h\": \"10*dx\", \"dx\": 0.005, \"g\": 9.81, \"ratio\": 0.25", "\"4*h\"", fields);
    let scene = read(source);
    assert_eq!(scene.time.end, 0.2);
    assert_eq!(scene.gravity.0, DVec3::new(0.0, -19.62, 0.0));
    assert_eq!(scene.record.every, Some(0.025));
    assert_eq!(scene.contacts[0].friction, 0.25);
    assert_eq!(scene.parameter_values()["h"], 0.05);
}

/// A plugin of a third party.
#[derive(Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Control {
    alpha: f64,
    count: u32,
    value: PerAxis<Expression>,
    nested: Option<Item>,
}

#[test]
fn plugins_use_the_names_too() {
    let fields = "plugins: [control(alpha: \"3*a\", count: \"2*n\", value: (\"a*x + n*t\", None),
        nested: other(alpha: \"a\", count: \"n\", value: (\"a\", 1), nested: None))],";
    let scene = read(scene("\"a\": 0.5, \"n\": 3", "1", fields));
    let control: Control = scene.plugins[0].parse().unwrap();
    assert_eq!((control.alpha, control.count), (1.5, 6));
    let value = control.value.0[0].as_ref().unwrap();
    assert_eq!(value.eval(DVec3::new(2.0, 0.0, 0.0), 10.0), 31.0);
    let nested: Control = control.nested.unwrap().parse().unwrap();
    assert_eq!((nested.alpha, nested.count), (0.5, 3));
    assert!(nested.value.0[0].as_ref().unwrap().is_constant());
    // A scene that is written and read again is the same.
    let again = read(scene.to_source("again.ron").unwrap());
    assert_eq!(again.plugins[0].parse::<Control>().unwrap().alpha, 1.5);
}

#[test]
fn faults_point_at_their_place() {
    for (parameters, end, message, place) in [
        ("\"t\": 1", "1", "`t` is already a variable, constant or function", "\"t\""),
        ("\"sin\": 1", "1", "`sin` is already a variable, constant or function", "\"sin\""),
        ("\"e\": 1", "1", "`e` is already a variable, constant or function", "\"e\""),
        ("\"d x\": 1", "1", "cannot stand in an expression", "\"d x\""),
        (
            "\"a\": \"2*b\", \"b\": \"a+c\", \"c\": 1",
            "1",
            "parameter `a` depends on itself: a -> b -> a",
            "\"2*b\"",
        ),
        ("\"a\": \"a\"", "1", "parameter `a` depends on itself: a -> a", "\"a\""),
        ("\"a\": \"2*q\"", "1", "unknown name `q`", "q"),
        ("\"a\": \"2*t\"", "1", "must be constant, found `t`", "t"),
        ("\"a\": \"1/0\"", "1", "must be finite, found inf", "1/0"),
        ("\"a\": true", "1", "expected a number or an expression", "true"),
        ("\"a\": 1", "\"2*aa\"", "unknown name `aa`", "aa"),
        ("\"a\": 1", "\"2*x\"", "must be constant, found `x`", "x"),
        ("\"a\": 1", "a", "expected a number or an expression in double quotes, found `a`", "a"),
        ("\"a\": 1", "\"-a\"", "must be greater than 0, found -1", "\"-a\""),
    ] {
        let (found, at) = fault(&scene(parameters, end, ""));
        assert!(found.contains(message), "{parameters}, {end}: {found}");
        assert_eq!(at, place, "{parameters}, {end}: {found}");
    }
}

#[test]
fn parameters_are_set_from_outside() {
    let source = scene("\"dx\": 0.005, \"h\": \"10*dx\"", "\"h\"", "");
    let with = |path: &str, value: &str| source.with_override(path, value);
    assert_eq!(read(with("parameters.dx", "0.01").unwrap()).time.end, 0.1);
    assert_eq!(read(with("parameters.h", "20*dx").unwrap()).time.end, 0.1);
    assert_eq!(read(with("parameters.dx", "1/50").unwrap()).time.end, 0.2);
    assert_eq!(read(with("time.end", "3*dx").unwrap()).time.end, 0.015);
    let problem = with("parameters.dy", "0.01").unwrap_err();
    assert!(
        problem.message.contains("there is no `dy` here") && problem.help[0].contains("`dx`"),
        "{problem:?}"
    );
    let bad = with("parameters.dx", "10*hh").unwrap();
    let error = parse(bad).unwrap_err().to_string();
    assert!(error.contains("given by `--set parameters.dx=10*hh`"), "{error}");
}

#[test]
fn tables_are_functions() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pull.csv"), "t[s],u[m],force[N]\n0,5,0\n0.1,6,10\n0.3,7,-10\n")
        .unwrap();
    let fields = "plugins: [control(alpha: \"ramp_up(0.5)\", count: 1, value: (\"2*pull(t)\", \"ramp_up(t)\"))],
        tables: { \"pull\": (file: \"pull.csv\", value: \"force\"), \"ramp_up\": (points: [(0, 0), (\"late\", 4)]) },";
    let source = scene("\"late\": 1", "1", fields);
    let source = Source::new(folder.path().join("small.ron").display().to_string(), source.text);
    let control: Control = read(source).plugins[0].parse().unwrap();
    assert_eq!(control.alpha, 2.0);
    let pull = control.value.0[0].as_ref().unwrap();
    for (t, force) in
        [(-1.0, 0.0), (0.0, 0.0), (0.05, 10.0), (0.1, 20.0), (0.2, 0.0), (0.3, -20.0), (9.0, -20.0)]
    {
        assert!((pull.eval(DVec3::ZERO, t) - force).abs() < 1e-12, "{t}");
    }
    assert!(pull.depends_on_time() && pull.eval(DVec3::ZERO, f64::NAN).is_nan());
}

#[test]
fn faults_of_tables() {
    for (tables, message, place) in [
        ("\"a\": (file: \"nothing.csv\")", "cannot read the table", "\"nothing.csv\""),
        (
            "\"a\": (points: [(0, 1), (0, 2)])",
            "the variable must increase, found 0 after 0 at point 2",
            "[(0, 1), (0, 2)]",
        ),
        ("\"a\": ()", "a table needs `file` or `points`", "()"),
        ("\"dx\": (points: [(0, 1)])", "`dx` is both a parameter and a table", "\"dx\""),
        ("\"min\": (points: [(0, 1)])", "`min` is already", "\"min\""),
        ("\"a\": (points: [(0, \"t\")])", "must be constant, found `t`", "t"),
    ] {
        let (found, at) = fault(&scene("\"dx\": 1", "1", &format!("tables: {{{tables}}},")));
        assert!(found.contains(message), "{tables}: {found}");
        assert_eq!(at, place, "{tables}: {found}");
    }
}
