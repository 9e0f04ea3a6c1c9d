//! Gauges and fields of flows whose answers are known.

use crate::assembly::{BuildOptions, build, build_with};
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::world::{BodyId, Mass, Velocity};

fn text(bodies: &str, velocity: &str, gravity: &str, probes: &str) -> String {
    format!(
        r#"(dimension: Two, gravity: {gravity}, domain: (min: (-1, -1), max: (3, 3)),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0, viscosity: 1.0), "light": Fluid(density: 100.0, sound_speed: 40.0), "rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [{bodies}],
            conditions: [InitialVelocity(on: Select(body: "water"), value: ({velocity}))],
            probes: [{probes}], time: (end: 0.001, step: Fixed(0.001)))"#
    )
}

const WATER: &str = r#"(name: "water", material: "water", shape: Box(min: (0, 0), max: (1, 0.5)), spacing: 0.025, formulation: Fluid)"#;
const TANK: &str = r#"(name: "tank", material: "wall", spacing: 0.025, formulation: Wall(),
    shape: Difference(Box(min: (-0.1, -0.1), max: (1.1, 0.8)), Box(min: (0, 0), max: (1, 1))))"#;

/// The first row of the series of the probe `p`, with the names of the columns, without time.
fn first(text: &str) -> Vec<(String, f64)> {
    measured(text).0
}

/// The first and the last row of the series of the probe `p`, and the warnings of the run.
fn measured(text: &str) -> (Vec<(String, f64)>, Vec<f64>, Vec<String>) {
    let (scene, source) = parse(Source::new("test.ron", text.to_owned())).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let options = BuildOptions::into_folder(folder.path());
    let mut sim =
        build_with(&scene, &source, &Registry::standard(), &options).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).unwrap();
    let warnings = sim.finish().unwrap().warnings;
    let csv = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
    let (names, rows) = csv.split_once('\n').unwrap();
    let names = names.split(',').map(|name| name.split('[').next().unwrap_or_default().to_owned());
    let numbers = |row: &str| row.split(',').map(|value| value.parse().unwrap()).collect::<Vec<f64>>();
    let first = names.zip(numbers(rows.lines().next().unwrap())).skip(1).collect();
    (first, numbers(rows.lines().last().unwrap())[1..].to_vec(), warnings)
}

fn at(quantity: &str, place: &str) -> String {
    format!(r#"Probe(name: "p", {place}, quantity: {quantity})"#)
}

fn near(found: &[(String, f64)], wanted: &[(&str, f64)], margin: f64) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for ((name, value), (wanted_name, wanted)) in found.iter().zip(wanted) {
        assert!(name == wanted_name && (value - wanted).abs() < margin, "{found:?}");
    }
}

#[test]
fn the_level_in_a_tank_is_where_the_water_ends() {
    let scene = |place: &str| {
        text(&format!("{WATER}, {TANK}"), r#""0", "0""#, "(0, -9.81)", &at("WaterLevel()", place))
    };
    near(&first(&scene("at: (0.37, 0)")), &[("level", 0.5), ("wet", 0.5)], 0.003);
    near(&first(&scene("at: (0.0, 0.2)")), &[("level", 0.3), ("wet", 0.3)], 0.003);
    near(&first(&scene("at: (0.4, 0.6)")), &[("level", 0.0), ("wet", 0.0)], 1e-12);
}

/// A plate two spacings thick, whose sides have pressures of their own.
fn plate(formulation: &str) -> String {
    format!(
        r#"(name: "plate", material: "rubber", shape: Box(min: (0.5, 0), max: (0.55, 0.7)), spacing: 0.025, formulation: {formulation})"#
    )
}

/// It stands out of the water.
#[test]
fn the_level_beside_a_thin_plate_is_that_of_the_water() {
    let plate = plate("TotalLagrangian");
    let water = WATER.replace(
        "Box(min: (0, 0), max: (1, 0.5))",
        "Difference(Box(min: (0, 0), max: (1, 0.5)), Box(min: (0.5, 0), max: (0.55, 0.7)))",
    );
    for x in [0.49, 0.485, 0.565, 0.58] {
        let level = at("WaterLevel()", &format!("at: ({x}, 0)"));
        let bodies = format!("{water}, {TANK}, {plate}");
        let found = first(&text(&bodies, r#""0", "0""#, "(0, -9.81)", &level));
        near(&found, &[("level", 0.5), ("wet", 0.5)], 0.003);
    }
}

#[test]
fn a_sensor_shows_the_weight_of_the_water_above_it() {
    let scene = |place: &str, sensor: &str| {
        text(&format!("{WATER}, {TANK}"), r#""0", "0""#, "(0, -9.81)", &at(sensor, place))
    };
    let floor = first(&scene("at: (0.3, 0)", "PressureSensor(diameter: 0.1, normal: (0, 1))"));
    near(&floor, &[("pressure", 4905.0)], 15.0);
    let side = first(&scene("at: (1, 0.2)", "PressureSensor(diameter: 0.05, normal: (-1, 0))"));
    near(&side, &[("pressure", 2943.0)], 15.0);
    let dry = first(&scene("at: (1, 0.7)", "PressureSensor(normal: (-1, 0))"));
    near(&dry, &[("pressure", 0.0)], 1e-12);
}

#[test]
fn the_floor_bears_the_weight_and_each_side_half_of_its_square() {
    let scene = |on: &str, quantity: &str| {
        text(&format!("{WATER}, {TANK}"), r#""0", "0""#, "(0, -9.81)", &at(quantity, on))
    };
    let all = first(&scene(r#"on: Select(body: "tank")"#, "FluidForce"));
    let weight = 1000.0 * 9.81 * 0.5;
    assert!((all[1].1 + weight).abs() < 0.02 * weight && all[0].1.abs() < 1e-6 * weight, "{all:?}");
    // What the fluid does to itself and its walls is nothing in all.
    let water = first(&scene(r#"on: Select(body: "water")"#, "FluidForce"));
    assert!((all[1].1 + water[1].1).abs() < 1e-5 * weight, "{all:?} {water:?}");
    let right = r#"on: Select(body: "tank", within: Box(min: (1, -1), max: (2, 2)))"#;
    let push = 0.5 * 1000.0 * 9.81 * 0.25;
    let force = first(&scene(right, "FluidForce"));
    assert!((force[0].1 - push).abs() < 0.05 * push, "{force:?}");
    // It acts at a third of the depth, to within a part of the spacing.
    let torque = first(&scene(right, "FluidTorque(about: (1, 0))"));
    let height = -torque[0].1 / force[0].1;
    assert!((height - 0.5 / 3.0).abs() < 0.03, "{torque:?}");
}

#[test]
fn the_torque_on_a_tank_is_about_the_centre_of_its_volume() {
    let left = WATER.replace("(1, 0.5)", "(0.5, 0.5)");
    let torque = first(&text(
        &format!("{left}, {TANK}"),
        r#""0", "0""#,
        "(0, -9.81)",
        &at("Torque", r#"on: Select(body: "tank")"#),
    ));
    // The weight acts at x = 0.25, the pressure on the left side at a third of the depth; the centre of the
    // rectangle 1.2 by 0.9 without that of 1 by 0.8 is at x = 0.5.
    let (outer, inner) = (1.2 * 0.9, 1.0 * 0.8);
    let height = (outer * 0.35 - inner * 0.4) / (outer - inner);
    let weight = 1000.0 * 9.81 * 0.25;
    let push = 0.5 * 1000.0 * 9.81 * 0.25;
    let wanted = weight * 0.25 + push * (0.5 / 3.0 - height);
    assert!((torque[0].1 - wanted).abs() < 0.03 * wanted, "{torque:?} {wanted}");
}

/// A tank that glides away with its water by eight spacings.
#[test]
fn gauges_that_follow_a_tank_show_what_they_show_at_rest() {
    let scene = |quantity: &str, place: &str| {
        let tank = TANK.replace("Wall(),", "Wall(), velocity: (4, 0),");
        let text = text(&format!("{WATER}, {tank}"), r#""4", "0""#, "(0, -9.81)", &at(quantity, place));
        measured(&text.replace("(end: 0.001, step: Fixed(0.001))", "(end: 0.05, step: Fixed(0.0002))"))
    };
    let sensor = "PressureSensor(diameter: 0.05, normal: (-1, 0))";
    let left = |warnings: &[String]| warnings.iter().filter(|text| text.contains("`tank` has moved")).count();
    let (_, side, warnings) = scene(sensor, r#"at: (1, 0.2), follows: "tank""#);
    assert!((side[0] - 2943.0).abs() < 30.0 && left(&warnings) == 0, "{side:?} {warnings:?}");
    // In the middle, where the tank has no particle.
    let (_, level, _) = scene("WaterLevel()", r#"at: (0.5, 0.2), follows: "tank""#);
    assert!((level[0] - 0.3).abs() < 0.005, "{level:?}");
    let (_, _, warnings) = scene(sensor, "at: (1, 0.2)");
    assert_eq!(left(&warnings), 1, "{warnings:?}");
    // The wall on the left comes over this one.
    let (_, dry, warnings) = scene("WaterLevel()", "at: (0.15, 0.2)");
    assert!(dry[0] == 0.0 && left(&warnings) == 1, "{dry:?} {warnings:?}");
    // The wall slides along itself below this one.
    let (_, floor, warnings) = scene("PressureSensor(normal: (0, 1))", "at: (0.6, 0)");
    assert!((floor[0] - 4905.0).abs() < 50.0 && left(&warnings) == 0, "{floor:?} {warnings:?}");
}

/// Water stands higher on one side of a thin plate.
#[test]
fn a_sensor_that_follows_a_thin_plate_shows_the_pressure_on_its_side() {
    let plate = plate("Rigid()");
    let water = WATER.replace(
        "Box(min: (0, 0), max: (1, 0.5))",
        "Union([Box(min: (0, 0), max: (0.5, 0.5)), Box(min: (0.55, 0), max: (1, 0.25))])",
    );
    let fix = r#"conditions: [Fix(on: Select(body: "plate")), "#;
    for (x, normal, wanted) in [(0.5, -1, 9810.0 * 0.4), (0.55, 1, 9810.0 * 0.15)] {
        let sensor = format!("PressureSensor(diameter: 0.05, normal: ({normal}, 0))");
        for follows in ["", r#", follows: "plate""#] {
            let probe = at(&sensor, &format!("at: ({x}, 0.1){follows}"));
            let text = text(&format!("{water}, {TANK}, {plate}"), r#""0", "0""#, "(0, -9.81)", &probe);
            let found = first(&text.replace("conditions: [", fix));
            assert!((found[0].1 - wanted).abs() < 0.02 * 9810.0 * 0.4, "{x} {follows} {found:?} {wanted}");
        }
    }
}

/// A tank that is lifted at half of gravity, and water that starts with the pressure of one and a half: the
/// kernel at the floor reaches over particles half to two and a half spacings above it.
#[test]
fn a_sensor_that_follows_an_accelerated_floor_feels_its_acceleration() {
    let water = WATER.replace("Fluid)", r#"Fluid(pressure: "1000*1.5*9.81*(0.5 - y)"))"#);
    let lift = r#"conditions: [Displacement(on: Select(body: "tank"), value: (0, "0.25*9.81*t*t")), "#;
    let sensor = at("PressureSensor(normal: (0, 1))", r#"at: (0.6, 0), follows: "tank""#);
    let text = text(&format!("{water}, {TANK}"), r#""0", "0""#, "(0, -9.81)", &sensor)
        .replace("conditions: [", lift)
        .replace("(end: 0.001, step: Fixed(0.001))", "(end: 0.002, step: Fixed(0.0002))");
    let (_, floor, _) = measured(&text);
    let wanted = 1000.0 * 1.5 * 9.81 * 0.5;
    assert!((floor[0] - wanted).abs() < 0.002 * wanted, "{floor:?} {wanted}");
}

/// Half a metre of two liquids: what a sensor adds to the pressure of the particles in front of it is the
/// weight of their own liquid, whichever the scene names first.
#[test]
fn a_sensor_below_two_liquids_shows_the_weight_of_both() {
    let water = WATER.replace("(1, 0.5)", "(1, 0.25)");
    let light = WATER.replace("(0, 0)", "(0, 0.25)").replace(r#""water""#, r#""light""#);
    for liquids in [format!("{light}, {water}"), format!("{water}, {light}")] {
        let sensor = at("PressureSensor(diameter: 0.1, normal: (0, 1))", "at: (0.5, 0)");
        let bodies = format!("{liquids}, {TANK}");
        let found = first(&text(&bodies, r#""0", "0""#, "(0, -9.81)", &sensor));
        near(&found, &[("pressure", 9.81 * (1000.0 + 100.0) * 0.25)], 15.0);
    }
}

#[test]
fn the_flux_through_a_plane_is_speed_times_height() {
    let scene = |quantity: &str| text(WATER, r#""2", "1""#, "(0, 0)", &at(quantity, "at: (0.512, 0.1)"));
    near(&first(&scene("Flux(normal: (1, 0))")), &[("flux", 1.0)], 1e-9);
    near(&first(&scene("Flux(normal: (0, -3))")), &[("flux", -1.0)], 1e-9);
    let part = "Flux(normal: (1, 0), within: Box(min: (0, 0.25), max: (1, 1)))";
    near(&first(&scene(part)), &[("flux", 0.5)], 1e-9);
}

/// The border of a part may lie anywhere among the particles, which are 25 mm apart.
#[test]
fn the_flux_through_a_part_of_a_plane_is_that_of_its_length() {
    for (low, high) in [(0.2501, 0.4), (0.1, 0.1375), (0.2625, 0.2875), (0.3, 0.31)] {
        let part = format!("Flux(normal: (1, 0), within: Box(min: (-1, {low}), max: (0.512, {high})))");
        let probe = at(&part, "at: (0.512, 0.1)");
        let found = first(&text(WATER, r#""2", "1""#, "(0, 0)", &probe));
        near(&found, &[("flux", 2.0 * (high - low))], 0.07 * 2.0 * 0.025);
    }
}

/// A channel 1 m long and 0.5 m high that is periodic along x.
fn in_a_periodic_channel(velocity: &str, gravity: &str, probe: &str) -> f64 {
    let domain = "domain: (min: (0, -1), max: (1, 3), periodic: [X])";
    let text = text(WATER, velocity, gravity, probe);
    first(&text.replace("domain: (min: (-1, -1), max: (3, 3))", domain))[0].1
}

/// The plane that rises by a quarter crosses the channel within two periods, wherever it starts.
#[test]
fn the_flux_through_an_oblique_plane_of_a_periodic_channel_is_that_of_all_of_it() {
    for (place, normal) in
        [("at: (0.5, 0.25)", "(1, 0)"), ("at: (0.9, 0)", "(1, 4)"), ("at: (0.1, 0.5)", "(-1, 4)")]
    {
        let probe = at(&format!("Flux(normal: {normal})"), place);
        let flux = in_a_periodic_channel(r#""2", "0""#, "(0, 0)", &probe);
        let wanted = if normal.starts_with("(-") { -1.0 } else { 1.0 };
        assert!((flux - wanted).abs() < 0.02, "{place} {normal}: {flux}");
    }
    // A part of a level plane, on the other side of the domain.
    let part = "Flux(normal: (0, 1), within: Box(min: (0.7, 0), max: (0.9, 0.5)))";
    for x in [0.8, 0.1, 5.3] {
        let probe = at(part, &format!("at: ({x}, 0.25)"));
        let flux = in_a_periodic_channel(r#""0", "3""#, "(0, 0)", &probe);
        assert!((flux - 0.2 * 3.0).abs() < 1e-9, "{x}: {flux}");
    }
    // A part of an oblique plane: where it is, and not where its images are.
    let part = "Flux(normal: (1, 4), within: Box(min: (0.2, 0), max: (0.6, 0.5)))";
    let flux = in_a_periodic_channel(r#""2", "0""#, "(0, 0)", &at(part, "at: (0.4, 0.25)"));
    assert!((flux - 2.0 * 0.1).abs() < 0.01, "{flux}");
}

/// A film on a slope of 60 degrees is twice as deep against gravity as across, and the gauge leaves the
/// domain on its way up.
#[test]
fn the_level_of_a_film_on_a_slope_is_that_beyond_the_period_too() {
    let gravity = "(8.495709211125343, -4.905)";
    let depth = in_a_periodic_channel(r#""0", "0""#, gravity, &at("WaterLevel()", "at: (0.8, 0)"));
    assert!((depth - 1.0).abs() < 0.005, "{depth}");
}

#[test]
fn a_turning_box_has_twice_its_rate_as_vorticity_and_its_outer_layer_as_surface() {
    let probe = |quantity: &str| at(quantity, r#"on: Select(within: Box(min: (0, 0), max: (1, 0.0249)))"#);
    let scene = |quantity: &str| text(WATER, r#""-3*y", "3*x""#, "(0, 0)", &probe(quantity));
    let vorticity = scene("Field(\"vorticity.z\")");
    near(&first(&vorticity), &[("vorticity.z", 6.0)], 6e-6);
    let precise = vorticity.replacen("(dimension", "(precision: Double, dimension", 1);
    near(&first(&precise), &[("vorticity.z", 6.0)], 1e-9);
    near(&first(&scene("Field(\"free_surface\")")), &[("free_surface", 1.0)], 1e-12);
    let inside =
        at("Field(\"free_surface\")", "on: Select(within: Box(min: (0.03, 0.03), max: (0.97, 0.47)))");
    near(&first(&text(WATER, r#""-3*y", "3*x""#, "(0, 0)", &inside)), &[("free_surface", 0.0)], 1e-12);
    let tank = at(
        "Field(\"free_surface\")",
        r#"on: Select(body: "water", within: Box(min: (0, 0), max: (1, 0.47)))"#,
    );
    let full = text(&format!("{WATER}, {TANK}"), r#""0", "0""#, "(0, -9.81)", &tank);
    near(&first(&full), &[("free_surface", 0.0)], 1e-12);
}

#[test]
fn probes_of_flows_that_make_no_sense_are_refused() {
    let error = |text: &str| {
        let built = parse(Source::new("test.ron", text.to_owned()))
            .and_then(|(scene, source)| build(&scene, &source, &Registry::standard()));
        built.err().map(|error| error.to_string()).unwrap_or_default()
    };
    let still = |probe: &str| error(&text(WATER, r#""1", "0""#, "(0, 0)", probe));
    assert!(still(&at("WaterLevel()", "at: (0, 0)")).contains("no direction up"));
    assert!(still(&at("Flux(normal: (0, 0))", "at: (0, 0)")).contains("must not be a zero vector"));
    assert!(
        still(&at("PressureSensor(diameter: -1.0, normal: (1, 0))", "at: (0, 0)"))
            .contains("must be at least 0")
    );
    assert!(still(&at("Flux(normal: (1, 0))", "on: Select()")).contains("not on a selection"));
    assert!(still(&at("FluidForce", "at: (0, 0)")).contains("not at a point"));
}

/// Fluid and solid meet at x = 1: a point on either side shows its own velocity, though its reach goes
/// across.
#[test]
fn a_field_at_a_point_is_that_of_one_phase() {
    let block = r#"(name: "block", material: "rubber", shape: Box(min: (1, 0), max: (1.3, 0.5)), spacing: 0.025, formulation: TotalLagrangian)"#;
    let speed = |place: &str| {
        let probe = at(r#"Field("velocity.x")"#, place);
        first(&text(&format!("{WATER}, {block}"), r#""2", "0""#, "(0, 0)", &probe))[0].1
    };
    let (fluid, solid) = (speed("at: (0.98, 0.25)"), speed("at: (1.02, 0.25)"));
    assert!((fluid - 2.0).abs() < 1e-9 && solid.abs() < 1e-9, "{fluid} {solid}");
}

#[test]
fn a_sensor_that_a_drop_hits_has_no_pressure_where_it_is_dry() {
    let drop = r#"(name: "water", material: "water", shape: Box(min: (0.95, 0.2), max: (1, 0.25)), spacing: 0.025, formulation: Fluid(pressure: 1000.0))"#;
    let scene = |height: f64| {
        let probe = at("PressureSensor(normal: (-1, 0))", &format!("at: (1, {height})"));
        first(&text(&format!("{drop}, {TANK}"), r#""0", "0""#, "(0, 0)", &probe))
    };
    near(&scene(0.225), &[("pressure", 1000.0)], 30.0);
    // 0.4 spacings beside the drop its four particles have W V = .109, .025, .013 and .002, and 0.8 / 2 would
    // be a full face.
    near(&scene(0.26), &[("pressure", 1000.0 * 0.149 / 0.4)], 15.0);
}

#[test]
fn means_of_the_force_on_a_floor_are_the_momentum_that_falling_water_loses() {
    let scene = r#"(dimension: Two, precision: Double, domain: (min: (0, -1), max: (0.5, 1), periodic: [X]),
        materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0)},
        bodies: [
            (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.5, 0.25)), spacing: 0.025, formulation: Fluid, velocity: (0, -1)),
            (name: "floor", material: "wall", shape: Box(min: (0, -0.1), max: (0.5, 0)), spacing: 0.025, formulation: Wall()),
        ],
        probes: [Probe(name: "p", on: Select(body: "floor"), mean: true, every: 0.02, quantity: FluidForce)], time: (end: 0.1))"#;
    let (scene, source) = parse(Source::new("test.ron", scene.to_owned())).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let options = BuildOptions::into_folder(folder.path());
    let mut sim =
        build_with(&scene, &source, &Registry::standard(), &options).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).unwrap();
    sim.finish().unwrap();
    let csv = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
    let rows = csv.lines().skip(1).map(|line| line.split(',').map(|value| value.parse::<f64>().unwrap()));
    let rows: Vec<Vec<f64>> = rows.map(Iterator::collect).collect();
    assert_eq!(rows.len(), 6);
    let impulse: f64 = rows.windows(2).map(|pair| pair[1][2] * (pair[1][0] - pair[0][0])).sum();
    let (view, water) = sim.world().body_view(BodyId(0));
    let (mass, velocity) = (view.read::<Mass>().unwrap(), view.read::<Velocity>().unwrap());
    let gained: f64 = water.map(|row| mass[row].0 * (velocity[row].0.y + 1.0)).sum();
    assert!(gained > 50.0 && (gained + impulse).abs() < 1e-9 * gained, "{gained} {impulse}");
}
