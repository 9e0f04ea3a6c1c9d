//! Shapes and lattices as text.

use crate::scene::Vec3;
use crate::shapes::{Lattice, Shape};

fn options() -> [ron::Options; 2] {
    use ron::extensions::Extensions;
    let unwrap =
        Extensions::UNWRAP_NEWTYPES | Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME;
    [ron::Options::default(), ron::Options::default().with_default_extension(unwrap)]
}

fn both(text: &str) -> Shape {
    let [plain, unwrapped] = options().map(|options| options.from_str::<Shape>(text).unwrap());
    assert_eq!(plain, unwrapped);
    let again: Shape = ron::from_str(&ron::to_string(&plain).unwrap()).unwrap();
    assert_eq!(plain, again);
    plain
}

#[test]
fn every_form_reads_and_writes() {
    assert_eq!(
        both("Box(min: (0.0, 0.0), max: (1.0, 2.0))"),
        Shape::Box { min: Vec3::new(0.0, 0.0, 0.0), max: Vec3::new(1.0, 2.0, 0.0) }
    );
    for text in [
        "Sphere(center: (0.0, 0.0, 1.0), radius: 2)",
        "HalfSpace(point: (0, 0, 1), normal: (0, 0, 1))",
        "Cylinder(from: (0, 0, 0), to: (0, 0, 1), radius: 0.5)",
        "Ring(center: (0, 0), inner: 1, outer: 2)",
        "Tube(from: (0, 0, 0), to: (0, 0, 1), inner: 0.5, outer: 1)",
        "Shell(center: (0, 0, 1), inner: 0.5, outer: 1)",
        "Polygon(points: [(0, 0), (1, 0), (0, 1)])",
        "Extrusion(polygon: [(0, 0), (1, 0), (0, 1)], from: 0, to: 2)",
        "Union([Sphere(center: (0, 0), radius: 1), Sphere(center: (1, 0), radius: 1)])",
        "Intersection([Sphere(center: (0, 0), radius: 1), Sphere(center: (1, 0), radius: 1)])",
        "Difference(Box(min: (0, 0), max: (1, 1)), Union([Box(min: (0.1, 0.1), max: (0.9, 1.0))]))",
        "Translate(shape: Box(min: (0, 0), max: (1, 1)), by: (1, 1))",
        "Rotate(shape: Box(min: (0, 0), max: (1, 1)), angle_degrees: 30)",
        "Rotate(shape: Box(min: (0, 0, 0), max: (1, 1, 1)), axis: (1, 0, 0), angle_degrees: 30, about: (1, 1, 1))",
        "Scale(shape: Sphere(center: (0, 0), radius: 1), by: (1, 2))",
        "Points(file: \"particles.csv\")",
    ] {
        both(text);
    }
}

#[test]
fn unknown_names_and_fields_are_refused() {
    for text in [
        "Circle(center: (0, 0), radius: 1)",
        "Sphere(center: (0, 0), radius: 1, height: 2)",
        "Sphere(radius: 1)",
    ] {
        for options in options() {
            assert!(options.from_str::<Shape>(text).is_err(), "{text}");
        }
    }
}

#[test]
fn lattices() {
    for (text, lattice) in [
        ("Automatic", Lattice::Automatic),
        ("Regular", Lattice::Regular),
        ("Square", Lattice::Regular),
        ("Cubic", Lattice::Regular),
        ("Hexagonal", Lattice::Hexagonal),
        ("Concentric", Lattice::Concentric),
        ("BodyFitted()", Lattice::BodyFitted { iterations: 20 }),
        ("Relaxed()", Lattice::Relaxed { seed: 0, iterations: 6 }),
        ("Relaxed(seed: 7, iterations: 2)", Lattice::Relaxed { seed: 7, iterations: 2 }),
    ] {
        for options in options() {
            assert_eq!(options.from_str::<Lattice>(text).unwrap(), lattice);
        }
    }
    assert_eq!(Lattice::default(), Lattice::Automatic);
}

#[test]
fn errors_point_at_the_text_of_the_scene() {
    use crate::scene::{Problem, Source, parse};
    for (shape, wrong) in [
        ("Box(min: (0, 0), max: (0, 1))", "(0, 1)"),
        ("Union([Sphere(center: (0, 0), radius: 1), Sphere(center: (9, 0), radius: -2)])", "-2"),
        ("Difference(Box(min: (0, 0), max: (1, 1)), Ring(center: (0, 0), inner: 5, outer: 4))", "5"),
        ("Translate(shape: Intersection([Sphere(center: (0, 0), radius: -3)]), by: (1, 1))", "-3"),
        ("Rotate(shape: Sphere(center: (0, 0), radius: 1), axis: (0, 0, 0), angle_degrees: 5)", "(0, 0, 0)"),
        ("Polygon(points: [(0, 0), (1, 0)])", "[(0, 0), (1, 0)]"),
        ("Points(file: \"none.csv\")", "\"none.csv\""),
    ] {
        let text = format!(
            "Scene(dimension: Two, materials: {{\"m\": A()}}, time: (end: 1.0),
            bodies: [Body(name: \"b\", material: \"m\", shape: {shape}, spacing: 0.1, lattice: Square, formulation: B())])"
        );
        let (scene, source) = parse(Source::new("test.ron", text)).unwrap();
        let body = &scene.bodies[0];
        let folder = std::path::Path::new(".");
        let error = crate::shapes::fill(
            &body.shape,
            crate::shapes::Filling {
                lattice: body.lattice,
                spacing: body.spacing,
                dimension: scene.dimension,
                folder,
                limit: 1000,
                is_wall: false,
            },
        )
        .unwrap_err();
        let problem = Problem::at_path(format!("bodies[0].{}", error.path), error.kind.to_string());
        assert_eq!(&source.text[problem.span(&source).unwrap()], wrong, "{}", error.path);
    }
}
