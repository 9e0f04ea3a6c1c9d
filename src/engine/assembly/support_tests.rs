//! Held particles stand on the edge that the scene states.

use glam::DVec3;

use super::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, Force, PlasticStrain, ReferencePosition};

/// A strip from x = -0.03 to 0.1 with a spacing of 0.01, with that condition.
fn strip(condition: &str) -> Simulation {
    strip_of("TotalLagrangian", 0.3, condition)
}

fn strip_of(formulation: &str, poisson: f64, condition: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two, gravity: (0, -10),
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: {poisson:?})}},
            bodies: [(name: "strip", material: "soft", shape: Box(min: (-0.03, 0), max: (0.1, 0.04)), spacing: 0.01,
                formulation: {formulation})],
            conditions: [{condition}],
            time: (end: 0.05))"#
    );
    let (scene, source) = parse(Source::new("supports.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"))
}

/// The places of the particles along the strip, and how many are not in the lattice.
fn columns(sim: &Simulation) -> (Vec<f64>, usize) {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let x = view.read::<ReferencePosition>().unwrap();
    let is_off =
        |x: DVec3| [x.x, x.y].iter().any(|c| ((c / 0.01 - 0.5).round() - (c / 0.01 - 0.5)).abs() > 1e-3);
    let off = rows.clone().filter(|&row| is_off(x[row].0)).count();
    let mut all: Vec<f64> = rows.map(|row| x[row].0.x).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    (all, off)
}

#[test]
fn the_outermost_held_particles_stand_on_the_stated_edge() {
    for (end, column, expected) in
        [(0.0, 2, 0.0), (0.0025, 2, 0.0025), (-0.004, 2, -0.004), (0.0055, 3, 0.0055)]
    {
        let box_of = format!("Box(min: (-1, -1), max: ({end:?}, 1))");
        for condition in [
            "Fix(on: Select(within: SHAPE))",
            "Displacement(on: Select(within: SHAPE), value: (0, 0))",
            "Velocity(on: Select(within: SHAPE), value: (0, 0))",
        ] {
            let (x, off) = columns(&strip(&condition.replace("SHAPE", &box_of)));
            assert!((x[column] - expected).abs() < 1e-6, "{condition} {end}: {x:?}");
            assert!(x.len() == 13 && off <= 4, "{condition} {end}: {off}");
        }
    }
}

#[test]
fn other_supports_leave_particles_in_their_lattice() {
    for condition in [
        "Fix(on: Select(within: Box(min: (-1, -1), max: (0, 1))), edge: Particles)",
        "Fix(on: Select(within: Box(min: (-1, -1), max: (0, 1))), axes: [X])",
        "Velocity(on: Select(within: Box(min: (-1, -1), max: (0, 1))), value: (None, 0))",
        "Fix(on: Select(face: MinX), edge: Particles)",
        "Symmetry(plane: X, at: -0.03), Fix(on: Select(face: MinX), axes: [X])",
        "Fix(on: Select(within: Box(min: (-1, -1), max: (1, 1))))",
        "InitialVelocity(on: Select(within: Box(min: (-1, -1), max: (0, 1))), value: (0, 1))",
    ] {
        assert_eq!(columns(&strip(condition)).1, 0, "{condition}");
    }
}

#[test]
fn edges_between_axes_are_met_along_their_normal() {
    // Above y = 0.015 the edge is half-way between two diagonals of the lattice.
    let sim = strip(
        "Fix(on: Select(within: Polygon(points: [(-1, -1), (0.02, -1), (0.02, 0.015), (1.005, 1), (-1, 1)])))",
    );
    let (view, rows) = sim.world().body_view(BodyId(0));
    let x = view.read::<ReferencePosition>().unwrap();
    let near = rows.map(|row| x[row].0).filter(|x| x.y > 0.021 && (x.x - x.y - 0.005).abs() < 1e-6);
    assert!(near.count() >= 1);
}

#[test]
fn a_strip_that_swings_in_its_clamp_keeps_its_energy() {
    let mut sim = strip("Fix(on: Select(within: Box(min: (-1, -1), max: (0, 1))))");
    sim.run(|_| true).unwrap();
    let error = sim.ledger().relative_error().abs();
    assert!(error < 1e-3, "{error}");
}

#[test]
fn a_side_is_held_where_it_is() {
    for (condition, moved) in [
        ("Fix(on: Select(face: MinX))", 4),
        ("Fix(on: Select(face: MinX), axes: [X])", 4),
        ("Velocity(on: Select(face: MinX), value: (None, 0))", 4),
        ("Velocity(on: Select(face: MinX), value: (0, None)), Fix(on: Select(face: MinX), axes: [Y])", 4),
        (
            "Displacement(on: Select(face: MinX, within: Box(min: (-1, -1), max: (1, 0.02))), value: (0, 0))",
            2,
        ),
    ] {
        let (x, off) = columns(&strip(condition));
        assert!((x[0] + 0.03).abs() < 2e-6 && off == moved, "{condition}: {x:?} {off}");
    }
    // A disc has no side: its outermost particles stay.
    let text = r#"(dimension: Two, materials: {"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)},
        bodies: [(name: "disc", material: "soft", shape: Sphere(center: (0, 0), radius: 0.1), spacing: 0.01, formulation: TotalLagrangian)],
        conditions: [Fix(on: Select(face: MinX))], time: (end: 0.05))"#;
    let (scene, source) = parse(Source::new("supports.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let (x, _) = columns(&build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}")));
    assert!(x[0] > -0.099, "{x:?}");
}

/// Without lateral contraction the energy of a uniform strain is that of the part of the strip that is not
/// held.
#[test]
fn what_is_stretched_up_to_its_support_has_the_energy_of_that_length() {
    let strain = 1e-4;
    let within = |end: f64| format!("Fix(on: Select(within: Box(min: (-1, -1), max: ({end:?}, 1))))");
    let cases = [-0.004, -0.0025, 0.0, 0.001, 0.0025, 0.005, 0.0055].map(|end| (end, within(end)));
    for (edge, condition) in cases.into_iter().chain([(-0.03, "Fix(on: Select(face: MinX))".to_owned())]) {
        for formulation in ["TotalLagrangian", "UpdatedLagrangian()"] {
            let stretch = format!(
                "{condition}, InitialDisplacement(on: Select(within: Box(min: ({:?}, -1), max: (1, 1))), value: (\"{strain}*(x - {edge:?})\", \"0\"))",
                edge + 1e-5
            );
            let mut sim = strip_of(formulation, 0.0, &stretch);
            sim.step().unwrap();
            let strain_energy = sim.ledger().stored_at_start();
            let expected = 0.5 * 1e6 * strain * strain * 0.04 * (0.1 - edge);
            assert!(
                (strain_energy / expected - 1.0).abs() < 2e-3,
                "{formulation} {condition}: {strain_energy} {expected}"
            );
        }
    }
}

#[test]
fn supports_that_end_in_the_lattice_are_told() {
    let within = "Fix(on: Select(within: Box(min: (-1, -1), max: (0, 1))), axes: [X])";
    let side = "Fix(on: Select(face: MinX))";
    for (formulation, condition, expected) in [
        ("TotalLagrangian", within, Some("4 % softer")),
        ("Eulerian", within, None),
        ("Eulerian", side, None),
        ("TotalLagrangian", side, None),
        ("TotalLagrangian", "Fix(on: Select(within: Box(min: (-1, -1), max: (0, 1))))", None),
        ("TotalLagrangian", "Fix(on: Select(), axes: [Y])", None),
    ] {
        // Half a spacing is 3.8 % of 0.13 m, a spacing 7.7 %.
        let sim = strip_of(formulation, 0.3, condition);
        let told =
            sim.warnings().iter().find(|warning| warning.contains("softer") || warning.contains("stiffer"));
        assert_eq!(told.is_some(), expected.is_some(), "{formulation} {condition}: {:?}", sim.warnings());
        assert!(told.is_none_or(|told| told.contains(expected.unwrap_or_default())), "{told:?}");
    }
}

#[test]
fn a_side_that_is_held_beside_a_fluid_is_told() {
    let told = |condition: &str, more: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3), "water": Fluid(density: 1000, sound_speed: 10)}},
                bodies: [(name: "strip", material: "soft", shape: Box(min: (0, 0), max: (0.2, 0.04)), spacing: 0.01, formulation: TotalLagrangian), {more}],
                conditions: [{condition}], time: (end: 0.05))"#
        );
        let (scene, source) = parse(Source::new("supports.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.warnings().iter().any(|text| text.contains("`strip` is held by a side in a scene with fluids"))
    };
    let water = r#"(name: "water", material: "water", shape: Box(min: (0, 0.04), max: (0.2, 0.1)), spacing: 0.01, formulation: Fluid)"#;
    let (side, part) =
        ("Fix(on: Select(face: MinX))", "Fix(on: Select(within: Box(min: (0, 0), max: (0.03, 1))))");
    assert!(told(side, water) && !told(side, "") && !told(part, water));
}

#[test]
fn a_side_of_particles_from_a_file_that_is_held_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let cells = (0..80).map(|k| (0.005 + 0.01 * f64::from(k % 20), 0.005 + 0.01 * f64::from(k / 20)));
    let csv: String = cells.map(|(x, y)| format!("{x},{y},1e-4\n")).collect();
    std::fs::write(folder.path().join("strip.csv"), format!("x,y,volume\n{csv}")).unwrap();
    let told = |shape: &str, condition: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [(name: "strip", material: "soft", shape: {shape}, spacing: 0.01, formulation: TotalLagrangian)],
                conditions: [{condition}], time: (end: 0.05))"#
        );
        let name = folder.path().join("scene.ron").to_string_lossy().into_owned();
        let (scene, source) = parse(Source::new(name, text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        // Half a spacing of the 0.19 m between the outermost particles.
        sim.warnings().iter().any(|text| text.contains("is 2.6 % stiffer for each side"))
    };
    let (points, side) = (r#"Points(file: "strip.csv")"#, "Fix(on: Select(face: MinX))");
    let moved = format!("Translate(shape: {points}, by: (1, 0))");
    assert!(
        told(points, side) && told(&moved, side) && told(points, "Fix(on: Select(face: MinX), axes: [X])")
    );
    let part = "Fix(on: Select(within: Box(min: (0, 0), max: (0.03, 1))))";
    assert!(!told(points, part) && !told("Box(min: (0, 0), max: (0.2, 0.04))", side));
}

#[test]
fn metal_that_a_side_draws_along_its_normal_alone_is_warned_of() {
    let metal = "J2(density: 7850, young: 2e11, poisson: 0.3, hardening: Perfect(yield_stress: 4e8))";
    let rubber = "NeoHookean(density: 1000, young: 1e6, poisson: 0.3)";
    let drawn =
        "Fix(on: Select(face: MinX), axes: [X]), Velocity(on: Select(face: MaxX), value: (1.0, None))";
    let in_lattice = "Velocity(on: Select(face: MaxX), value: (1.0, None), edge: Particles)";
    for (formulation, material, conditions, expected) in [
        ("Eulerian()", metal, drawn, 1),
        (
            "Eulerian()",
            metal,
            "Symmetry(plane: X, at: 0), Velocity(on: Select(face: MaxX), value: (1.0, None))",
            1,
        ),
        ("Eulerian()", metal, "Symmetry(plane: X, at: 0)", 0),
        (
            "Eulerian()",
            metal,
            "Fix(on: Select(face: MinX)), Velocity(on: Select(face: MaxX), value: (1.0, 0))",
            0,
        ),
        ("Eulerian()", metal, "Fix(on: Select(face: MinX), axes: [Y])", 0),
        ("Eulerian()", rubber, drawn, 0),
        ("TotalLagrangian", metal, drawn, 0),
        ("UpdatedLagrangian()", metal, drawn, 0),
        ("UpdatedLagrangian(update: Every(1))", metal, drawn, 1),
        ("UpdatedLagrangian(update: Adaptive(change: 0.5))", metal, drawn, 1),
        ("UpdatedLagrangian(update: Every(1))", rubber, drawn, 0),
        ("TotalLagrangian, lattice: Hexagonal", metal, drawn, 1),
        ("TotalLagrangian, lattice: Relaxed()", metal, drawn, 1),
        ("TotalLagrangian, lattice: Relaxed()", rubber, drawn, 0),
        ("TotalLagrangian, lattice: BodyFitted()", metal, drawn, 0),
        ("TotalLagrangian", metal, in_lattice, 1),
    ] {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": {material}}}, conditions: [{conditions}], time: (end: 1e-5),
                bodies: [(name: "bar", material: "m", shape: Box(min: (0, 0), max: (0.1, 0.04)), spacing: 0.01,
                    formulation: {formulation})])"#
        );
        let (scene, source) = parse(Source::new("drawn.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        let told = sim.warnings().iter().filter(|warning| warning.contains("drawn along its normal alone"));
        assert_eq!(told.count(), expected, "{formulation} {material} {conditions}: {:?}", sim.warnings());
    }
}

/// A strain without lateral contraction makes a uniform stress along x: no particle is pushed along x but
/// those that the supports hold.
#[test]
fn a_uniform_stress_is_in_balance_beside_what_is_held() {
    let (young, strain, spacing, edge) = (1e6, 1e-4, 0.01, -0.03);
    for formulation in
        ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()", "TotalLagrangian(neighbors: 12)"]
    {
        let mut sim = strip_of(
            formulation,
            0.0,
            &format!(
                "Displacement(on: Select(face: MinX), value: (0, None)), Fix(on: Select(face: MaxX), axes: [X]),
                InitialDisplacement(on: Select(within: Box(min: ({:?}, -1), max: (1, 1))), value: (\"{strain}*(x - {edge:?})\", \"0\"))",
                edge + 1e-5
            ),
        );
        sim.step().unwrap();
        let (view, rows) = sim.world().body_view(BodyId(0));
        let (x, force) = (view.read::<ReferencePosition>().unwrap(), view.read::<Force>().unwrap());
        let is_free = |row: &usize| x[*row].0.x > edge + 1e-4 && x[*row].0.x < 0.0999;
        let pushes = rows.filter(is_free).map(|row| force[row].0.x.abs());
        let most = pushes.fold(0.0, f64::max) / (young * strain * spacing);
        assert!(most < 2e-3, "{formulation}: {most}");
    }
}

/// The plastic strain of every particle of a bar over their mean, minimum and maximum: it is drawn by two
/// sides held along their normals.
fn spread_of_plastic_strain(formulation: &str) -> (f64, f64) {
    let text = format!(
        r#"(dimension: Three,
            materials: {{"metal": J2(density: 7850, young: 2e11, poisson: 0.3, hardening: Linear(yield_stress: 4e8, modulus: 1e9))}},
            bodies: [(name: "bar", material: "metal", shape: Box(min: (0, 0, 0), max: (0.02, 0.01, 0.01)), spacing: 0.0025,
                formulation: {formulation})],
            conditions: [Velocity(on: Select(face: MinX), value: ("-1", None, None)), Velocity(on: Select(face: MaxX), value: ("1", None, None)),
                InitialVelocity(on: Select(), value: ("100*(x - 0.01)", None, None))],
            time: (end: 4e-4))"#
    );
    let (scene, source) = parse(Source::new("drawn.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).unwrap();
    let (view, rows) = sim.world().body_view(BodyId(0));
    let strain = view.read::<PlasticStrain>().unwrap();
    let all = || rows.clone().map(|row| strain[row].0);
    let mean = all().sum::<f64>() / rows.len() as f64;
    assert!(mean > 0.03, "{mean}");
    (all().fold(f64::INFINITY, f64::min) / mean, all().fold(0.0, f64::max) / mean)
}

/// Without what the shares balance, 2.3 to 2.5 at the sides and down to 0.05 in the middle, in all
/// formulations.
#[test]
fn metal_drawn_by_its_sides_strains_evenly() {
    // Kernels of Eulerian bodies see the layers move apart.
    for (formulation, tolerance) in
        [("TotalLagrangian", 0.01), ("UpdatedLagrangian()", 0.01), ("Eulerian()", 0.3)]
    {
        let (least, most) = spread_of_plastic_strain(formulation);
        assert!(least > 1.0 - tolerance && most < 1.0 + tolerance, "{formulation}: {least} {most}");
    }
}

/// The plastic strain of every particle of a block over that of uniform shear, minimum and maximum: it is
/// sheared between two sides that are held along all axes and have no edges, for it spans a period along x
/// and, in space, lies between two symmetry planes.
fn spread_in_shear(dimension: usize, formulation: &str) -> (f64, f64) {
    let (strain, rate, young, poisson, strength, hardening) = (0.07, 1e3, 70e9, 0.3, 4e8, 1e9);
    let (name, low, high, planes) = match dimension {
        2 => ("Two", "(0, 0)", "(0.01, 0.01)", ""),
        _ => (
            "Three",
            "(0, 0, 0)",
            "(0.01, 0.01, 0.005)",
            "Symmetry(plane: Z, at: 0.0), Symmetry(plane: Z, at: 0.005),",
        ),
    };
    let text = format!(
        r#"(dimension: {name}, domain: (min: (0, -1, -1), max: (0.01, 1, 1), periodic: [X]),
            materials: {{"metal": J2(density: 2700, young: {young}, poisson: {poisson},
                hardening: Linear(yield_stress: {strength}, modulus: {hardening}))}},
            bodies: [(name: "block", material: "metal", shape: Box(min: {low}, max: {high}), spacing: 0.00125,
                formulation: {formulation}, plugins: [])],
            conditions: [{planes} Fix(on: Select(face: MinY)), Velocity(on: Select(face: MaxY), value: ("{rate}*0.01", 0, 0)),
                InitialVelocity(on: Select(), value: ("{rate}*y", 0, 0))],
            time: (end: {}))"#,
        strain / rate
    );
    let (scene, source) = parse(Source::new("sheared.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).unwrap();
    let shear: f64 = young / (2.0 * (1.0 + poisson));
    let uniform = (shear * strain * 3f64.sqrt() - strength) / (hardening + 3.0 * shear);
    let (view, rows) = sim.world().body_view(BodyId(0));
    let all = view.read::<PlasticStrain>().unwrap();
    let of = || rows.clone().map(|row| all[row].0 / uniform);
    (of().fold(f64::INFINITY, f64::min), of().fold(0.0, f64::max))
}

/// With shares of one, 1.7 of the uniform strain at the sides and 0.35 in the third layer, at any spacing.
#[test]
fn metal_sheared_between_sides_without_edges_strains_evenly() {
    for (dimension, formulation) in [
        (2, "TotalLagrangian"),
        (2, "UpdatedLagrangian()"),
        (2, "Eulerian()"),
        (3, "TotalLagrangian"),
        (3, "Eulerian()"),
    ] {
        let (least, most) = spread_in_shear(dimension, formulation);
        assert!(least > 0.98 && most < 1.02, "{dimension}, {formulation}: {least} {most}");
    }
}

/// Far from the ends of a long strip. With shares of one, 1.5 of the mean at the sides and 0.4 in the third
/// layer.
#[test]
fn metal_sheared_between_clamps_strains_evenly() {
    for (formulation, tolerance) in [("TotalLagrangian", 0.03), ("Eulerian()", 0.15)] {
        let text = format!(
            r#"(dimension: Two,
                materials: {{"metal": J2(density: 2700, young: 70e9, poisson: 0.3,
                    hardening: Linear(yield_stress: 4e8, modulus: 1e9))}},
                bodies: [(name: "strip", material: "metal", shape: Box(min: (0, 0), max: (0.16, 0.01)),
                    spacing: 0.00125, formulation: {formulation})],
                conditions: [Fix(on: Select(face: MinY)), Velocity(on: Select(face: MaxY), value: (10, 0)),
                    InitialVelocity(on: Select(), value: ("1e3*y", 0))],
                time: (end: 7e-5))"#
        );
        let (scene, source) = parse(Source::new("clamped.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.run(|_| true).unwrap();
        assert!(sim.warnings().is_empty(), "{:?}", sim.warnings());
        let (view, rows) = sim.world().body_view(BodyId(0));
        let (place, strain) =
            (view.read::<ReferencePosition>().unwrap(), view.read::<PlasticStrain>().unwrap());
        let middle = rows.filter(|&row| (place[row].0.x - 0.08).abs() < 0.01);
        let mut layers = [(0.0, 0.0); 8];
        for row in middle {
            let layer = &mut layers[((place[row].0.y / 0.00125) as usize).min(7)];
            *layer = (layer.0 + strain[row].0, layer.1 + 1.0);
        }
        let means = layers.map(|(sum, count)| sum / count);
        let mean = means.iter().sum::<f64>() / 8.0;
        assert!(means.iter().all(|layer| (layer / mean - 1.0).abs() < tolerance), "{formulation}: {means:?}");
    }
}
