//! Valid scene texts and their meaning.

use glam::DVec3;

use super::super::*;
use super::{everything, smallest_with};

fn read(source: Source) -> Scene {
    parse(source).unwrap_or_else(|error| panic!("{error}")).0
}

#[test]
fn every_part_is_read() {
    let scene = read(everything());
    assert_eq!(scene.title, "Dam break on an elastic plate");
    assert_eq!(scene.dimension, Dimension::Two);
    let domain = scene.domain.as_ref().unwrap();
    assert_eq!((domain.max, domain.outside), (Vec3::new(1.7, 1.0, 0.0), Outside::Remove));
    assert_eq!(domain.periodic, [Axis::X]);
    assert_eq!(scene.gravity.0, DVec3::new(0.0, -9.81, 0.0));
    assert_eq!(scene.materials["rubber"].text(), "NeoHookean(density: 1161.5, young: 3.5e6, poisson: 0.45)");
    let names: Vec<_> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["water", "plate", "tank", "tool"]);
    let plate = scene.body("plate").unwrap();
    assert_eq!((plate.spacing, plate.velocity), (0.0025, Some(Vec3::new(0.0, 1.0, 0.0))));
    assert_eq!((plate.formulation.name(), plate.plugins[0].name()), ("TotalLagrangian", "hourglass_control"));
    assert_eq!(scene.contacts[0].between, ("plate".into(), "tank".into()));
    assert_eq!(
        scene.time,
        Time { end: 1.0, step: StepRule::Adaptive { factor: 0.9 }, sub_steps: 200, stop_when: vec![] }
    );
    let on = scene.probes[1].on.as_ref().unwrap();
    assert_eq!((on.body.as_deref(), on.face), (Some("tool"), Some(Face::MinY)));
    assert_eq!(scene.probes[2].at, Some(Vec3::new(1.6, 0.012, 0.0)));
    assert_eq!(scene.probes[2].quantity, Quantity::Field("pressure".into()));
    assert_eq!(scene.record.fields, ["pressure", "von_mises"]);
}

#[test]
fn defaults() {
    let scene = read(smallest_with(""));
    assert_eq!(scene.gravity, Vec3::default());
    assert_eq!(scene.time.step, StepRule::Adaptive { factor: 1.0 });
    assert_eq!((scene.record.every, scene.record_interval()), (None, 0.01));
    assert!(scene.domain.is_none() && scene.plugins.is_empty() && scene.probes.is_empty());
    let touching = read(smallest_with("contacts: [Contact(between: (\"a\", \"a\"))],"));
    assert_eq!(touching.contacts[0].law.text(), "Penalty");
    let step = |text: &str| {
        let text = smallest_with("").text.replace("end: 1", &format!("end: 1, step: {text}"));
        read(Source::new("step.ron", text)).time.step
    };
    assert_eq!(step("Fixed(1e-6)"), StepRule::Fixed(1e-6));
    assert_eq!(step("Adaptive"), StepRule::Adaptive { factor: 1.0 });
    assert_eq!(step("Adaptive()"), StepRule::Adaptive { factor: 1.0 });
}

#[test]
fn a_scene_survives_being_written() {
    let scene = read(everything());
    let again = read(scene.to_source("again.ron").unwrap());
    assert_eq!(again, scene);
}

#[test]
fn texts_numbers_and_comments() {
    for (text, expected) in [
        (r#""a\tb\"c\\\u{e9}\x41""#, "a\tb\"c\\éA"),
        (r###"r##"raw "# \n"##"###, r##"raw "# \n"##),
        ("\"one \\\n      line\"", "one line"),
        ("\"// no comment /*\"", "// no comment /*"),
        ("/* a /* b */ */ \"x\" // \"y\"\n", "x"),
    ] {
        assert_eq!(read(smallest_with(&format!("title: {text},"))).title, expected);
    }
    for (text, expected) in [
        ("1_000", 1000.0),
        ("0x1F", 31.0),
        ("0b101", 5.0),
        ("+2.5", 2.5),
        (".5", 0.5),
        ("1.", 1.0),
        ("1e-3", 1e-3),
    ] {
        assert_eq!(
            read(smallest_with(&format!("record: (every: {text})"))).record.every,
            Some(expected),
            "{text}"
        );
    }
}

#[test]
fn as_ron_reads_it() {
    // The `ron` crate reads the scenes alike.
    let scene = read(everything());
    let text = scene.to_source("again.ron").unwrap().text;
    let value: ron::Value = ron::from_str(&text).unwrap();
    assert!(matches!(value, ron::Value::Map(_)), "{value:?}");
    assert!(ron::from_str::<ron::Value>(&everything().text).is_ok());
}

#[test]
fn places_are_lines_and_columns_of_characters() {
    let source = Source::new("x.ron", "(\n  títle: 1,\r\n  x: 2)");
    let at = |needle: &str| source.line_column(source.text.find(needle).unwrap());
    assert_eq!((at("("), at("t"), at("1"), at("x: 2")), ((1, 1), (2, 3), (2, 10), (3, 3)));
    assert_eq!(source.line_column(1000), (3, 8));
}

#[test]
fn two_problems_of_one_block() {
    let text = smallest_with("").text.replace("end: 1", "end: later, step: Adaptive(factor: high)");
    let error = parse(Source::new("x.ron", text)).unwrap_err();
    assert_eq!(error.problems.len(), 2, "{error}");
    assert_eq!(error.source.folder(), std::path::Path::new(""));
}

#[test]
fn deep_nesting_is_refused() {
    for (open, close) in [("(", ")"), ("[", "]"), ("a(b: ", ")")] {
        let text = format!("{}1{}", open.repeat(5000), close.repeat(5000));
        let error = parse(Source::new("deep.ron", text)).unwrap_err();
        assert!(error.problems[0].message.contains("nest deeper"), "{}", error.problems[0].message);
    }
}

#[test]
fn problems_are_found_by_path() {
    let source = everything();
    let text_at = |path: &str| &source.text[Problem::at_path(path, "").span(&source).unwrap()];
    assert_eq!(text_at("bodies[1].shape.min"), "(0.8, 0.0)");
    assert_eq!(text_at("bodies.plate.spacing"), "0.0025");
    assert_eq!(text_at("materials.water.density"), "1000.0");
    assert_eq!(text_at("materials.water.eos.gamma"), "7.0");
    assert_eq!(text_at("bodies.water.plugins.density_diffusion.model"), "Antuono");
    assert_eq!(text_at("bodies[2].shape[1].max"), "(1.6, 1.0)");
    assert_eq!(text_at("conditions[1].value[1]"), "\"-0.1*min(t/0.01, 1)\"");
    assert_eq!(text_at("probes.reaction.on.body"), "\"tool\"");
    assert_eq!(text_at("time.step.factor"), "0.9");
    // A value that is not written is shown at its parent.
    assert_eq!(text_at("bodies.tool.velocity"), "Body");
    assert_eq!(text_at("nowhere"), "Scene");
}
