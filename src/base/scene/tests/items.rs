//! Items, which a registry resolves later.

use serde::Deserialize;

use super::super::*;
use super::smallest_with;

#[derive(Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Control {
    alpha: f64,
    form: Form,
    only: Option<u32>,
    inner: Option<Item>,
    value: PerAxis<Expression>,
}

#[derive(Debug, Default, PartialEq, Deserialize)]
enum Form {
    #[default]
    Variational,
    Paper {
        factor: f64,
    },
}

#[derive(Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Elastic {
    density: f64,
    poisson: f64,
}

/// The scene with this plugin, and the plugin.
fn plugin(text: &str) -> (Source, Item) {
    let source = smallest_with(&format!("\n    plugins: [\n        {text},\n    ],\n"));
    let (scene, source) = parse(source).unwrap_or_else(|error| panic!("{error}"));
    (source, scene.plugins[0].clone())
}

#[test]
fn parameters_and_defaults() {
    for text in ["control", "control()", "control( /* none */ )", "control(alpha: 0)"] {
        let (_, item) = plugin(text);
        assert_eq!(item.name(), "control");
        assert_eq!(item.parse::<Control>().unwrap(), Control::default(), "{text}");
    }
    let (_, item) = plugin(
        "control(alpha: 5, form: Paper(factor: 2.0), only: 3, inner: Other(x: 1), value: (None, \"2*t\"))",
    );
    let control: Control = item.parse().unwrap();
    assert_eq!((control.alpha, control.form, control.only), (5.0, Form::Paper { factor: 2.0 }, Some(3)));
    assert_eq!(control.inner.unwrap().text(), "Other(x: 1)");
    let [x, y, z] = control.value.0;
    assert_eq!((x, y.unwrap().eval(glam::DVec3::ZERO, 3.0), z), (None, 6.0, None));
}

#[test]
fn errors_stand_at_their_place() {
    for (text, message, at) in [
        ("control(alpah: 5.0)", "unknown field `alpah`", "alpah"),
        ("control(alpha: \"five\")", "unknown name `five` in the expression", "five"),
        ("control(alpha: 1, alpha: 2)", "field `alpha` is given twice", "alpha: 2"),
        ("control(form: Papr)", "unknown variant `Papr`", "Papr"),
        ("control(form: Paper(fctor: 1))", "unknown field `fctor` of `Paper`", "fctor"),
        ("control(form: Paper)", "missing field `factor` of `Paper`", "Paper"),
        (
            "control(form: Variational(1))",
            "expected `Variational`, which has no parameters",
            "Variational(1)",
        ),
        ("control(only: -3)", "expected a whole number, zero or more, found the number -3", "-3"),
        ("control(only: 1.5)", "expected a whole number, zero or more, found the number 1.5", "1.5"),
        ("control(5.0)", "found `control(...)`", "control(5.0)"),
        ("control(value: (\"x\", \"2*q\"))", "unknown name `q` in the expression", "q"),
        ("control(value: (r#\"sin(x,y)\"#, 0))", "`sin` takes one argument, found 2", "sin"),
        ("control(value: (\"x\"))", "expected an entry for each axis", "(\"x\")"),
        ("control(value: (x, 1))", "expected a number or an expression in double quotes, found `x`", "x, 1"),
        ("control(alpha: NaN)", "must be finite, found NaN", "NaN"),
    ] {
        let (source, item) = plugin(text);
        let problems = item.parse::<Control>().expect_err(text);
        assert_eq!(problems.len(), 1, "{text}: {problems:?}");
        let span = problems[0].span(&source).unwrap();
        assert!(problems[0].message.contains(message), "{text}: {}", problems[0].message);
        let item_at = source.text.find(text).unwrap();
        assert_eq!(span.start, item_at + text.find(at).unwrap(), "{text}: {}", problems[0].render(&source));
    }
}

#[test]
fn all_problems_of_an_item_are_found() {
    let (source, item) = plugin("control(alpha: true, form: Nothing, onyl: 3, value: 1)");
    let messages: Vec<_> =
        item.parse::<Control>().unwrap_err().iter().map(|problem| problem.render(&source)).collect();
    assert_eq!(messages.len(), 4, "{}", messages.join("\n"));
    let (_, item) = plugin("control(inner: Other(x: 1), form: Paper(factor: no), alpha: no, only: no)");
    assert_eq!(item.parse::<Control>().unwrap_err().len(), 3);
    let (_, item) = plugin("elastic(densty: 1.0)");
    let problems = item.parse::<Elastic>().unwrap_err();
    let messages: Vec<_> = problems.iter().map(|problem| problem.message.as_str()).collect();
    // The density is there, only misspelt; the other is not.
    assert!(messages.contains(&"unknown field `densty` of `Elastic`"), "{messages:?}");
    assert!(!messages.iter().any(|message| message.contains("missing field `density`")), "{messages:?}");
}

#[test]
fn semantic_problems_stand_at_the_parameter() {
    let (source, item) = plugin("elastic(density: 1.0, poisson: 0.5)");
    let shown = item.problem("poisson", "the Poisson ratio is 0.5", "it must be below 0.5").render(&source);
    assert!(shown.contains("small.ron:8:40") && shown.contains("= help: it must be below 0.5"), "{shown}");
    let span = |problem: Problem| source.text[problem.span(&source).unwrap()].to_owned();
    assert_eq!(span(item.problem("young", "", "")), "elastic");
    assert_eq!(span(item.problem_with_name("")), "elastic");
    assert_eq!(item.parse::<Elastic>().unwrap(), Elastic { density: 1.0, poisson: 0.5 });
}

#[test]
fn items_from_code() {
    let item: Item = "elastic(density: 2, poisson: 0.1)".parse().unwrap();
    assert_eq!(item.parse::<Elastic>().unwrap().density, 2.0);
    for text in ["", "1.0", "\"elastic\"", "elastic(", "[elastic]", "elastic elastic"] {
        assert!(text.parse::<Item>().is_err(), "{text}");
    }
}
