//! Gauges of solids against prescribed fields.

use crate::assembly::{BuildOptions, build, build_with};
use crate::plugin::Registry;
use crate::scene::{Source, parse};

/// A block of 0.1 x 0.05 m under an affine displacement, with one probe `p`.
fn text(probe: &str) -> String {
    format!(
        r#"(dimension: Two, gravity: (0, -10),
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "b", material: "soft", shape: Box(min: (0, 0), max: (0.1, 0.05)), spacing: 0.0125, formulation: TotalLagrangian)],
            conditions: [InitialDisplacement(on: Select(body: "b"), value: ("0.01 + 0.1*x + 0.2*y", "-0.02 + 0.05*x - 0.1*y"))],
            probes: [Probe(name: "p", {probe})], time: (end: 1e-6, step: Fixed(1e-6)))"#
    )
}

/// The first row of the series of the probe, with the names of the columns, without time.
fn first(probe: &str) -> Vec<(String, f64)> {
    first_of(text(probe))
}

pub(super) fn first_of(text: String) -> Vec<(String, f64)> {
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let options = BuildOptions::into_folder(folder.path());
    let mut sim =
        build_with(&scene, &source, &Registry::standard(), &options).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).unwrap();
    sim.finish().unwrap();
    let csv = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
    let (names, row) = csv.split_once('\n').unwrap();
    let names = names.split(',').map(|name| name.split('[').next().unwrap_or_default().trim().to_owned());
    let row = row.lines().next().unwrap().split(',').map(|value| value.parse().unwrap());
    names.zip(row).skip(1).collect()
}

#[track_caller]
fn near(found: &[(String, f64)], wanted: &[(&str, f64)]) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for ((name, value), (wanted_name, wanted)) in found.iter().zip(wanted) {
        assert!(name == wanted_name && (value - wanted).abs() < 1e-12, "{found:?} {wanted:?}");
    }
}

#[test]
fn the_mean_position_of_a_rigid_body_is_its_mass_centre() {
    // The particles of a triangle are those of a lattice whose places it contains.
    let found = first_of(
        r#"(dimension: Two, materials: {"m": Steel},
            bodies: [(name: "b", material: "m", shape: Polygon(points: [(0, 0), (0.9, 0), (0, 0.6)]), spacing: 0.1, formulation: Rigid())],
            probes: [(name: "p", on: Select(body: "b"), quantity: Position)], time: (end: 1e-6, step: Fixed(1e-6)))"#
            .to_owned(),
    );
    near(&found, &[("x", 0.3), ("y", 0.2)]);
}

/// Walls have no mass.
#[test]
fn a_wall_has_the_mean_of_its_places() {
    let of = |quantity: &str| {
        first_of(format!(
            r#"(dimension: Two, materials: {{"m": Fluid(density: 1000, sound_speed: 10)}},
                bodies: [(name: "f", material: "m", shape: Box(min: (0, 1), max: (0.4, 1.2)), spacing: 0.1, formulation: Fluid),
                    (name: "w", material: "wall", shape: Box(min: (0, 0), max: (0.8, 0.4)), spacing: 0.1, formulation: Wall(slip: Free), velocity: (0.5, 0))],
                probes: [(name: "p", on: Select(body: "w"), quantity: {quantity})], time: (end: 1e-6, step: Fixed(1e-6)))"#
        ))
    };
    near(&of("Position"), &[("x", 0.4), ("y", 0.2)]);
    near(&of("Velocity"), &[("x", 0.5), ("y", 0.0)]);
}

#[test]
fn a_point_of_a_body_has_the_linear_field_exactly_at_its_corners_too() {
    let at = |x: f64, y: f64| [("x", 0.01 + 0.1 * x + 0.2 * y), ("y", -0.02 + 0.05 * x - 0.1 * y)];
    for (x, y) in [(0.1, 0.05), (0.0, 0.0), (0.033, 0.021), (0.0, 0.05)] {
        let probe = format!(r#"at: ({x}, {y}), follows: "b", quantity: Displacement"#);
        near(&first(&probe), &at(x, y));
    }
}

#[test]
fn surfaces_have_means_and_extremes() {
    let face = r#"on: Select(body: "b", surface: Facing((1, 0)))"#;
    let mean = first(&format!("{face}, quantity: Displacement"));
    near(&mean, &[("x", 0.01 + 0.01 + 0.2 * 0.025), ("y", -0.02 + 0.005 - 0.0025)]);
    // The part ends within the second facet of 12.5 mm, and includes its border to 1e-9 of its place.
    let part =
        r#"on: Select(body: "b", surface: Facing((1, 0)), within: Box(min: (0.05, 0), max: (0.2, 0.02)))"#;
    let mean = first(&format!("{part}, quantity: Displacement"));
    let wanted = [0.01 + 0.01 + 0.2 * 0.01, -0.02 + 0.005 - 0.001];
    assert!(mean.iter().zip(wanted).all(|((_, value), wanted)| (value - wanted).abs() < 1e-9), "{mean:?}");
    // The middles of four facets of 12.5 mm: the highest is at 43.75 mm.
    let y = 0.04375;
    let (ux, uy) = (0.01 + 0.01 + 0.2 * y, -0.02 + 0.005 - 0.1 * y);
    near(
        &first(&format!(r#"{face}, take: Maximum, quantity: Field("displacement.x")"#)),
        &[("displacement.x", ux), ("x", 0.1 + ux), ("y", y + uy)],
    );
}

#[test]
fn particles_have_extremes_with_their_places() {
    let (x, y) = (0.1 - 0.00625, 0.05 - 0.00625);
    let (ux, uy) = (0.01 + 0.1 * x + 0.2 * y, -0.02 + 0.05 * x - 0.1 * y);
    near(
        &first(r#"on: Select(body: "b"), take: Maximum, quantity: Field("displacement.x")"#),
        &[("displacement.x", ux), ("x", x + ux), ("y", y + uy)],
    );
    let (x, y) = (0.00625, y);
    let uy_low = -0.02 + 0.05 * x - 0.1 * y;
    let ux_low = 0.01 + 0.1 * x + 0.2 * y;
    near(
        &first(r#"on: Select(body: "b"), take: Minimum, quantity: Field("displacement.y")"#),
        &[("displacement.y", uy_low), ("x", x + ux_low), ("y", y + uy_low)],
    );
}

#[test]
fn a_line_has_a_column_for_each_place() {
    let probe = |follows: &str| {
        format!(
            r#"line: (from: (0, 0.02), to: (0.1, 0.02), points: 3), {follows} quantity: Field("displacement.x")"#
        )
    };
    let ux = |x: f64| 0.01 + 0.1 * x + 0.2 * 0.02;
    let names = ["displacement.x at 0 m", "displacement.x at 0.05 m", "displacement.x at 0.1 m"];
    near(
        &first(&probe(r#"follows: "b","#)),
        &[(names[0], ux(0.0)), (names[1], ux(0.05)), (names[2], ux(0.1))],
    );
    // Without a body the places are those of space, where other points of the body are now.
    let in_space = first(&probe(""));
    assert!((in_space[1].1 - ux(0.05)).abs() > 1e-3, "{in_space:?}");
}

#[test]
fn two_points_have_a_relative_displacement_and_a_distance() {
    let two = |quantity: &str| {
        format!(
            r#"at: (0.1, 0.05), follows: "b", relative_to: (at: (0, 0.05), follows: "b"), quantity: {quantity}"#
        )
    };
    near(&first(&two("Displacement")), &[("x", 0.01), ("y", 0.005)]);
    near(&first(&two("Distance")), &[("distance", 0.11f64.hypot(0.005))]);
    let ends = first(
        r#"on: Select(body: "b", face: MaxX), relative_to: (on: Select(body: "b", face: MinX)), quantity: Position"#,
    );
    near(&ends, &[("x", 1.1 * 0.0875), ("y", 0.05 * 0.0875)]);
}

#[test]
fn a_moment_is_that_about_the_stated_point() {
    let moment = first(r#"on: Select(body: "b"), quantity: Moment(about: (0.3, 0.1))"#);
    // Inner forces have none: what is left is the weight of 50 N at the middle of the displaced block.
    let middle = 0.05 + 0.01 + 0.1 * 0.05 + 0.2 * 0.025;
    assert!((moment[0].1 - (middle - 0.3) * -50.0).abs() < 1e-9, "{moment:?}");
}

#[test]
fn a_probe_where_nothing_is_is_an_error_that_says_where_the_body_is() {
    let error = |probe: &str| {
        let (scene, source) = parse(Source::new("test.ron", text(probe))).unwrap_or_else(|e| panic!("{e}"));
        match build(&scene, &source, &Registry::standard()) {
            Err(problems) => problems.to_string(),
            Ok(_) => String::new(),
        }
    };
    let space = error(r#"at: (5, 5), quantity: Field("stress.xx")"#);
    assert!(
        space.contains("no particle with `stress.xx` is near") && space.contains("extends from"),
        "{space}"
    );
    let body = error(r#"at: (0.2, 0), follows: "b", quantity: Field("stress.xx")"#);
    assert!(body.contains("body `b` has no point"), "{body}");
    let line = error(r#"line: (from: (3, 3), to: (4, 4), points: 9), quantity: Field("stress.xx")"#);
    assert!(line.contains("near the line"), "{line}");
    assert_eq!(error(r#"at: (5, 5), may_be_empty: true, quantity: Field("stress.xx")"#), "");
    let tensor = error(r#"on: Select(body: "b"), take: Maximum, quantity: Field("stress")"#);
    assert!(tensor.contains("a tensor has no minimum or maximum"), "{tensor}");
}

#[test]
fn options_that_do_not_fit_are_errors() {
    for (probe, message) in [
        (
            r#"at: (0, 0), line: (from: (0, 0), to: (1, 0), points: 3), quantity: Displacement"#,
            "one of `on`, `at` and `line`",
        ),
        (
            r#"line: (from: (0, 0), to: (1, 0), points: 1), quantity: Displacement"#,
            "`points` must be from 2 to 1000",
        ),
        (r#"on: Select(body: "b"), follows: "b", quantity: Displacement"#, "`follows` needs a point"),
        (r#"at: (0, 0), take: Maximum, quantity: Displacement"#, "`take` needs a selection"),
        (r#"at: (0, 0), follows: "b", quantity: Distance"#, "`Distance` needs `relative_to`"),
        (r#"at: (0, 0), follows: "b", relative_to: (), quantity: Distance"#, "one of `on` and `at`"),
        (r#"at: (0, 0), follows: "c", quantity: Displacement"#, "unknown body `c`"),
        (r#"on: Select(body: "b", surface: All), quantity: Force"#, "surface"),
    ] {
        let problems = match parse(Source::new("test.ron", text(probe))) {
            Err(problems) => problems.to_string(),
            Ok((scene, source)) => match build(&scene, &source, &Registry::standard()) {
                Err(problems) => problems.to_string(),
                Ok(_) => panic!("{probe} is accepted"),
            },
        };
        assert!(problems.contains(message), "{probe}: {problems}");
    }
}
