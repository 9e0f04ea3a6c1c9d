//! Values replaced from outside.

use super::super::*;
use super::{everything, smallest_with};

fn with(source: &Source, path: &str, value: &str) -> Scene {
    let source =
        source.with_override(path, value).unwrap_or_else(|problem| panic!("{}", problem.render(source)));
    parse(source).unwrap_or_else(|error| panic!("{path}: {error}")).0
}

#[test]
fn values_are_replaced() {
    let source = everything();
    assert_eq!(with(&source, "time.end", "0.5").time.end, 0.5);
    assert_eq!(with(&source, "bodies[1].spacing", "0.005").bodies[1].spacing, 0.005);
    assert_eq!(with(&source, "bodies.plate.spacing", "0.005").bodies[1].spacing, 0.005);
    assert_eq!(
        with(&source, "bodies.plate.formulation", "Eulerian").bodies[1].formulation.name(),
        "Eulerian"
    );
    assert_eq!(with(&source, "title", "A \"new\" one").title, "A \"new\" one");
    assert_eq!(with(&source, "title", "\"quoted\"").title, "quoted");
    assert_eq!(with(&source, "time.step", "Fixed(1e-6)").time.step, StepRule::Fixed(1e-6));
    assert_eq!(with(&source, "gravity[1]", "-1").gravity.0.y, -1.0);
    assert_eq!(with(&source, "probes.tip.quantity", "Velocity").probes[0].quantity, Quantity::Velocity);
    let young = with(&source, "materials.rubber.young", "1e6");
    assert_eq!(young.materials["rubber"].text(), "NeoHookean(density: 1161.5, young: 1e6, poisson: 0.45)");
    let value = with(&source, "conditions[1].value[1]", "-0.2*t");
    assert!(
        value.conditions[1].text().contains("(None, \"-0.2*t\", None)"),
        "{}",
        value.conditions[1].text()
    );
}

#[test]
fn fields_are_added() {
    let source = everything();
    let text = |path: &str, value: &str| {
        let scene = with(&source, path, value);
        (scene.bodies[1].plugins[0].text().to_owned(), scene.bodies[1].formulation.text().to_owned())
    };
    assert_eq!(text("bodies.plate.plugins.hourglass_control.alpha", "10").0, "hourglass_control(alpha: 10)");
    assert_eq!(text("bodies.plate.formulation.kernel", "Cubic").1, "TotalLagrangian(kernel: Cubic)");
    assert_eq!(
        with(&source, "bodies.tool.velocity", "(1, 0)").bodies[3].velocity,
        Some(Vec3::new(1.0, 0.0, 0.0))
    );
    assert_eq!(with(&source, "materials.lead", "Neo(density: 3)").materials.len(), 4);
    assert_eq!(with(&smallest_with(""), "record.every", "0.25").record.every, Some(0.25));
    assert_eq!(with(&smallest_with(""), "time.step", "Fixed(0.1)").time.step, StepRule::Fixed(0.1));
    assert_eq!(with(&smallest_with(""), "title", "\"t\"").title, "t");
}

#[test]
fn entries_of_lists_are_counted_in_brackets_or_after_a_dot() {
    let source = everything();
    let bracket = source.with_override("bodies[1].spacing", "0.005").unwrap();
    let dot = source.with_override("bodies.1.spacing", "0.005").unwrap();
    assert_eq!(bracket.text, dot.text);
}

#[test]
fn lines_stay() {
    let source = everything();
    let changed = source.with_override("bodies.plate.spacing", "0.005\n\n").unwrap();
    assert_eq!(changed.text.lines().count(), source.text.lines().count());
}

#[test]
fn paths_that_lead_nowhere() {
    let source = everything();
    for (path, value, message, help) in [
        ("bodies.plat.spacing", "1", "there is no `plat` here", "did you mean `plate`?"),
        ("bodies[7].spacing", "1", "there is no entry 7 here", "there are 4 entries"),
        (
            "bodies.zzzzzz.spacing",
            "1",
            "there is no `zzzzzz` here",
            "entries can be counted too, from [0] to [3]",
        ),
        ("tim.end", "1", "there is no `tim` here", "did you mean `time`?"),
        ("time.end.x", "1", "there is no `x` here", ""),
        ("", "1", "does not start with the path of a value", "paths look like"),
        ("bodies[x]", "1", "does not start with the path of a value", ""),
        ("time.end", "1 2", "cannot be read: expected the end of the text", ""),
        ("time.end", "(1", "cannot be read: this `(` is never closed", ""),
    ] {
        let problem = source.with_override(path, value).expect_err(path);
        let shown = problem.render(&source);
        assert!(shown.contains(message) && shown.contains(help), "{path}: {shown}");
        assert!(shown.contains(path) && shown.contains("everything.ron"), "{shown}");
    }
    let misspelt = source.with_override("time.edn", "1").unwrap();
    let error = parse(misspelt).unwrap_err().to_string();
    assert!(
        error.contains("unknown field `edn` of `Time`") && error.contains("did you mean `end`?"),
        "{error}"
    );
    let twice = smallest_with("conditions: [Fix(on: Select()), Fix(on: Select())]");
    let problem = twice.with_override("conditions.Fix.on", "Select()").unwrap_err();
    assert!(problem.message.contains("2 entries here are called `Fix`"), "{}", problem.message);
}
