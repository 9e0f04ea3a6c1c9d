//! Bodies that fail, with the standard plugins about them.

mod common;

use common::momentum;
use meshless::glam::DMat3;
use meshless::prelude::DVec3;
use meshless::record::StateHash;
use meshless::scene::{Source, parse};
use meshless::simulation::Simulation;
use meshless::world::{
    BodyId, Damage, DeformationGradient, HourglassModulus, PiolaStress, Position, ReferencePosition, Removed,
    Temperature, Velocity,
};
use meshless::{assembly, standard_plugins};

/// A notched strip of metal that is pulled apart, with the given plugins.
fn strip(plugins: &str) -> Simulation {
    strip_of("TotalLagrangian", plugins)
}

fn strip_of(formulation: &str, plugins: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"metal": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Linear(yield_stress: 2e8, modulus: 5e8),
                                     heating: (specific_heat: 900))}},
            bodies: [(name: "strip", material: "metal", spacing: 1e-3, formulation: {formulation}, plugins: [{plugins}],
                      shape: Difference(Box(min: (0, 0), max: (0.04, 0.01)), Box(min: (0.019, 0.008), max: (0.021, 0.011))))],
            conditions: [Velocity(on: Select(face: MinX), value: ("0", "0")), Velocity(on: Select(face: MaxX), value: ("40", "0")),
                         InitialVelocity(on: Select(), value: ("1000*x", None))],
            time: (end: 1.5e-4))"#
    );
    let (scene, source) = parse(Source::new("strip.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"))
}

/// A strip in flight that breaks, with that form of the control.
fn flying(form: &str, then: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two, materials: {{"brittle": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "strip", material: "brittle", shape: Box(min: (0, 0), max: (1.0, 0.4)), spacing: 0.04,
                      formulation: TotalLagrangian,
                      plugins: [hourglass_control(form: {form}),
                                failure(criterion: MaximumPrincipalStrain(limit: 0.05), growth: CrackSpeed(), then: {then})])],
            conditions: [InitialVelocity(on: Select(), value: ("0.3*(x - 0.5)*(1 + x)", "0.05*sin(9*x)"))],
            time: (end: 10.0))"#
    );
    let (scene, source) = parse(Source::new("strip.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"))
}

fn failed(sim: &Simulation) -> usize {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let damage = view.read::<Damage>().expect("damage");
    rows.filter(|&row| damage[row].0 >= 1.0).count()
}

const FAILURE: &str =
    "failure(criterion: JohnsonCook(d1: 0.02, d2: 0.1, d3: -1.5), growth: CrackSpeed(), then: ";

#[test]
fn a_metal_strip_breaks_and_the_books_close() {
    for (then, error) in [("NoTension", 1e-2), ("NoDeviator", 1e-2), ("Removed", 3e-3)] {
        let mut sim = strip(&format!("hourglass_control(), {FAILURE}{then})"));
        sim.run(|_| true).unwrap_or_else(|error| panic!("{then}: {error}"));
        let (failed, ledger) = (failed(&sim), sim.ledger());
        assert!((5..300).contains(&failed), "{then}: {failed}");
        assert!(ledger.total_named("plastic_work") > 0.0 && ledger.total_named("fracture") > 0.0, "{then}");
        assert!(ledger.relative_error().abs() < error, "{then}: {}", ledger.relative_error());
    }
}

#[test]
fn a_failure_strain_that_follows_temperature_is_told_of_a_metal_without_one() {
    let told = |heating: &str| {
        let text = format!(
            r#"(dimension: Two,
                materials: {{"metal": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Perfect(yield_stress: 2e8) {heating})}},
                bodies: [(name: "block", material: "metal", spacing: 1e-3, formulation: Eulerian, shape: Box(min: (0, 0), max: (0.01, 0.01)),
                          plugins: [failure(criterion: JohnsonCook(d1: 0.1, d2: 1.0, d3: -0.5, d5: 1.6, reference_temperature: 293, melt_temperature: 900))])],
                time: (end: 1.0))"#
        );
        let (scene, source) = parse(Source::new("block.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let sim =
            assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
        sim.warnings()
            .iter()
            .any(|text| text.contains("`d5` of the failure strain has no effect in body `block`"))
    };
    assert!(told(""));
    assert!(!told(", heating: (specific_heat: 900)"));
}

#[test]
fn fragments_of_a_brittle_bar_do_not_pull_on_each_other() {
    let text = include_str!("../assets/scenes/brittle_bar.ron");
    let text = text
        .replace("then: Removed", "then: NoDeviator")
        .replace("rerun_recorder(color_by: \"max_principal_stretch\")", "");
    assert!(text.contains("NoDeviator"), "the scene has changed");
    let (scene, source) =
        parse(Source::new("brittle_bar.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut sim =
        assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).unwrap_or_else(|error| panic!("{error}"));
    assert!(failed(&sim) > 200, "{}", failed(&sim));
    assert!(sim.ledger().relative_error().abs() < 1e-2, "{}", sim.ledger().relative_error());
}

#[test]
fn the_order_of_plugins_in_the_scene_does_not_matter() {
    let hash = |plugins: &str| -> StateHash {
        let mut sim = strip(plugins);
        sim.run(|sim| sim.clock().step < 400).expect("a run");
        assert!(failed(&sim) > 0, "nothing has failed after {} s", sim.clock().time);
        sim.state_hash()
    };
    let failure = format!("{FAILURE}Removed)");
    assert_eq!(
        hash(&format!("{failure}, hourglass_control()")),
        hash(&format!("hourglass_control(), {failure}"))
    );
}

#[test]
fn cracks_keep_momentum_and_books_with_every_control() {
    for form in ["Variational", "Ganzenmueller2015", "Viscous", "Combined"] {
        for then in ["NoTension", "NoDeviator", "Removed"] {
            let mut sim = flying(form, then);
            sim.start().expect("a start");
            let (start, size) = momentum(&sim);
            sim.run(|sim| sim.clock().step < 400).unwrap_or_else(|error| panic!("{form} {then}: {error}"));
            assert!(failed(&sim) > 20, "{form} {then}: {}", failed(&sim));
            let drift = momentum(&sim).0.distance(start);
            // What is removed takes its momentum along.
            assert!(then == "Removed" || drift < 1e-12 * size, "{form} {then}: {drift} of {size}");
            let error = sim.ledger().relative_error();
            assert!(error.abs() < 1e-2, "{form} {then}: balance error {error}");
        }
    }
}

/// Whether each particle of a block of 7 x 5 at (0.1, 0.1), (0.2, 0.1) and so on has been removed after some
/// steps at rest, when those that are named have failed.
fn left_of_block(formulation: &str, failed: &[(i32, i32)]) -> Vec<(i32, i32)> {
    let text = format!(
        r#"(dimension: Two, materials: {{"glass": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "block", material: "glass", shape: Box(min: (0.05, 0.05), max: (0.75, 0.55)), spacing: 0.1, formulation: {formulation},
                      plugins: [failure(criterion: MaximumPrincipalStrain(limit: 0.5), then: RemovedAtSurface)])],
            time: (end: 10.0))"#
    );
    let (scene, source) = parse(Source::new("block.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut sim =
        assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
    let place = |sim: &Simulation, row: usize| {
        let x = sim.world().body_view(BodyId(0)).0.read::<ReferencePosition>().expect("places")[row].0 * 10.0;
        (x.x.round() as i32, x.y.round() as i32)
    };
    let rows = sim.world().body_view(BodyId(0)).1;
    for row in rows.clone() {
        if failed.contains(&place(&sim, row)) {
            sim.world().body_view(BodyId(0)).0.write::<Damage>().expect("damage")[row].0 = 1.0;
        }
    }
    sim.run(|sim| sim.clock().step < 6).expect("a run");
    let view = sim.world().body_view(BodyId(0)).0;
    let removed = view.read::<Removed>().expect("a column");
    rows.filter(|&row| removed[row] == Removed::YES).map(|row| place(&sim, row)).collect()
}

#[test]
fn what_has_failed_is_worn_off_from_the_surface_inwards() {
    for formulation in ["TotalLagrangian()", "UpdatedLagrangian()", "Eulerian()"] {
        // Inside of the block, and with a sound layer above.
        assert_eq!(left_of_block(formulation, &[(4, 3)]), [], "{formulation}");
        assert_eq!(left_of_block(formulation, &[(4, 3), (4, 4), (5, 4)]), [], "{formulation}");
        // At a face, a corner, and layer by layer below a part of a face.
        assert_eq!(left_of_block(formulation, &[(4, 5), (4, 2)]), [(4, 5)], "{formulation}");
        assert_eq!(left_of_block(formulation, &[(1, 1)]), [(1, 1)], "{formulation}");
        let pit = [(3, 4), (4, 4), (5, 4), (3, 5), (4, 5), (5, 5)];
        let mut found = left_of_block(formulation, &pit);
        found.sort_by_key(|(x, y)| (*y, *x));
        assert_eq!(found, pit, "{formulation}");
    }
}

/// Rows that have failed, and the largest deviator of their Cauchy stress, Pa.
fn failed_rows(sim: &Simulation) -> (Vec<usize>, f64) {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let damage = view.read::<Damage>().expect("damage");
    let (f, p) =
        (view.read::<DeformationGradient>().expect("F"), view.read::<PiolaStress>().expect("stresses"));
    let failed: Vec<usize> = rows.filter(|&row| damage[row].0 >= 1.0).collect();
    let deviator = |&k: &usize| {
        let cauchy = p[k].0 * f[k].0.transpose() * (1.0 / f[k].0.determinant());
        let mean = (cauchy.x_axis.x + cauchy.y_axis.y + cauchy.z_axis.z) / 3.0;
        (cauchy - DMat3::from_diagonal(DVec3::splat(mean)))
            .to_cols_array()
            .into_iter()
            .fold(0.0, |a: f64, b| a.max(b.abs()))
    };
    let largest = failed.iter().map(deviator).fold(0.0, f64::max);
    (failed, largest)
}

#[test]
fn what_johnson_and_cook_have_failed_has_no_deviator_and_no_control_for_good_in_every_formulation() {
    let failure = "failure(criterion: JohnsonCook(d1: 0.02, d2: 0.1, d3: -1.5, d5: 0.5, reference_temperature: 293, melt_temperature: 900), then: NoDeviator)";
    for formulation in ["TotalLagrangian", "UpdatedLagrangian(update: Every(10))", "Eulerian()"] {
        let mut sim = strip_of(formulation, &format!("hourglass_control(), {failure}"));
        let mut before: Vec<usize> = Vec::new();
        for k in 1..=12 {
            sim.run(|sim| sim.clock().time < f64::from(k) * 1e-5)
                .unwrap_or_else(|error| panic!("{formulation}: {error}"));
            let (failed, deviator) = failed_rows(&sim);
            // The flow stress is 200 MPa.
            assert!(deviator < 1.0, "{formulation}: a deviator of {deviator} Pa");
            assert!(before.iter().all(|row| failed.contains(row)), "{formulation}: damage heals");
            let (view, _) = sim.world().body_view(BodyId(0));
            let modulus = view.read::<HourglassModulus>().expect("moduli");
            assert!(
                before.iter().all(|&row| modulus[row].0 == 0.0),
                "{formulation}: the control holds what has failed"
            );
            before = failed;
        }
        assert!((5..300).contains(&before.len()), "{formulation}: {} have failed", before.len());
        let (view, rows) = sim.world().body_view(BodyId(0));
        let temperature = view.read::<Temperature>().expect("temperatures");
        let hottest = rows.map(|row| temperature[row].0).fold(0.0, f64::max);
        // At least 0.9 times 200 MPa times a strain of 0.02 over the heat capacity, on top of 293 K.
        assert!(hottest > 294.4, "{formulation}: {hottest} K");
        assert!(
            sim.ledger().relative_error().abs() < 2e-2,
            "{formulation}: {}",
            sim.ledger().relative_error()
        );
    }
}

/// A rubber plate, part of which fails and is then shot through: rubble must not press by areas that it has
/// no more.
#[test]
fn rubble_that_flies_apart_makes_no_energy() {
    let text = r#"(dimension: Three, materials: {"m": StVenantKirchhoff(density: 1000, young: 1e7, poisson: 0.3)},
        bodies: [
            (name: "plate", material: "m", shape: Box(min: (0, 0, 0), max: (0.01, 0.08, 0.08)), spacing: 0.005, formulation: TotalLagrangian,
             plugins: [hourglass_control(), failure(criterion: MaximumPrincipalStrain(limit: 0.08))]),
            (name: "bullet", material: "m", shape: Box(min: (-0.0205, 0.03, 0.033), max: (-0.0005, 0.05, 0.053)), spacing: 0.005,
             formulation: TotalLagrangian, velocity: (40, 0.3, 0), plugins: [hourglass_control()]),
        ],
        contacts: [Contact(between: ("plate", "bullet"), law: Penalty())],
        time: (end: 0.008))"#;
    let (scene, source) =
        parse(Source::new("plate.ron", text.to_owned())).unwrap_or_else(|error| panic!("{error}"));
    let mut sim =
        assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).unwrap_or_else(|error| panic!("{error}"));
    assert!(failed(&sim) > 20, "{}", failed(&sim));
    let ledger = sim.ledger();
    assert!(ledger.total_named("strain") > 0.0, "{} J", ledger.total_named("strain"));
    assert!(ledger.relative_error().abs() < 1e-2, "{}", ledger.relative_error());
}

/// Two halves of a strip that have been drawn apart at a row of failed particles: each of them is only
/// turned, and has no error.
#[test]
fn the_hourglass_residual_does_not_see_the_sides_of_a_crack_part() {
    let text = r#"(dimension: Two, materials: {"m": StVenantKirchhoff(density: 1000, young: 1e7, poisson: 0.3)},
        bodies: [(name: "strip", material: "m", shape: Box(min: (0, 0), max: (0.16, 0.05)), spacing: 0.01, formulation: TotalLagrangian,
                  plugins: [hourglass_control(), failure(criterion: MaximumPrincipalStrain(limit: 0.05))])],
        time: (end: 1),
        probes: [Probe(name: "error", on: Select(body: "strip"), take: Maximum, quantity: Field("hourglass_residual"))])"#;
    let (scene, source) =
        parse(Source::new("strip.ron", text.to_owned())).unwrap_or_else(|error| panic!("{error}"));
    let mut sim =
        assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
    sim.start().expect("a start");
    {
        let (view, rows) = sim.world().body_view(BodyId(0));
        let mut place = view.write::<Position>().expect("positions");
        let mut gradient = view.write::<DeformationGradient>().expect("gradients");
        let mut damage = view.write::<Damage>().expect("damage");
        let turn = DMat3::from_rotation_z(0.2);
        for row in rows {
            let x = place[row].0;
            // Two columns of the lattice fail: no bond is longer than the gap.
            damage[row].0 = f64::from(u8::from((x.x - 0.08).abs() < 0.01));
            if x.x > 0.09 {
                (place[row].0, gradient[row].0) = (turn * x + DVec3::new(0.03, 0.0, 0.0), turn);
            }
        }
    }
    let shown = sim.measure("error").expect("a probe");
    assert!(shown[0].1 < 1e-12, "{shown:?}");
}

#[test]
fn what_contacts_of_removed_particles_held_is_booked() {
    let anvils = [
        r#"(name: "anvil", material: "hard", shape: Box(min: (-0.01, -0.003), max: (0.02, 0)), spacing: 1e-3, formulation: Rigid)"#,
        r#"(name: "anvil", material: "hard", shape: Box(min: (-0.002, -0.006), max: (0.014, 0)), spacing: 1e-3,
            formulation: TotalLagrangian, plugins: [hourglass_control()])"#,
    ];
    for anvil in anvils {
        let text = format!(
            r#"(dimension: Two, materials: {{"brittle": NeoHookean(density: 1000, young: 1e9, poisson: 0.3),
                                             "hard": NeoHookean(density: 1000, young: 2e9, poisson: 0.3)}},
                bodies: [(name: "block", material: "brittle", shape: Box(min: (0, 0), max: (0.01, 0.01)), spacing: 1e-3,
                          formulation: TotalLagrangian, velocity: (100, -150),
                          plugins: [hourglass_control(), failure(criterion: MaximumPrincipalStrain(limit: 0.05), then: Removed)]),
                         {anvil}],
                contacts: [Contact(between: ("block", "anvil"), law: Penalty(), friction: 0.3)],
                conditions: [Fix(on: Select(body: "anvil", within: Box(min: (-1, -1), max: (1, -0.004))))],
                time: (end: 1e-5, step: Adaptive(factor: 0.2)))"#
        );
        let text = if anvil.contains("Rigid") {
            text.replace(r#", within: Box(min: (-1, -1), max: (1, -0.004))"#, "")
        } else {
            text
        };
        let (scene, source) = parse(Source::new("crash.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let mut sim =
            assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
        let (mut last, mut largest) = (0.0, 0.0_f64);
        sim.run(|sim| {
            let error = sim.ledger().relative_error();
            largest = largest.max((error - last).abs());
            last = error;
            true
        })
        .unwrap_or_else(|error| panic!("{error}"));
        let (view, _) = sim.world().body_view(BodyId(0));
        let gone =
            view.read::<Removed>().expect("a column").iter().filter(|row| **row == Removed::YES).count();
        assert!(gone > 20, "{gone}");
        // What the leapfrog misses where a particle breaks at once; a particle in contact holds up to a
        // hundredth of the energy.
        assert!(largest < 1.5e-3 && last.abs() < 2e-3, "{anvil}: {largest} in a step, {last} in the end");
    }
}

/// A block that slides without friction on another one, flat on flat, under its weight, and can fail at that
/// strain; in steps of that share of the usual ones.
fn sliding(contact: &str, limit: f64, factor: f64) -> Simulation {
    let end = if limit < 0.01 { 0.004 } else { 0.06 };
    let text = format!(
        r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "base", material: "soft", shape: Box(min: (0, 0), max: (0.15, 0.03)), spacing: 0.005, formulation: TotalLagrangian,
                      plugins: [hourglass_control()]),
                     (name: "block", material: "soft", shape: Box(min: (0.0413, 0.03), max: (0.0713, 0.06)), spacing: 0.005, formulation: TotalLagrangian,
                      velocity: (0.5, 0), plugins: [hourglass_control(), failure(criterion: MaximumPrincipalStrain(limit: {limit:?}))])],
            contacts: [(between: ("block", "base"), law: Penalty(){contact})],
            conditions: [Fix(on: Select(body: "base", face: MinY)), BodyForce(on: Select(body: "block"), value: (0, -200))],
            time: (end: {end:?}, step: Adaptive(factor: {factor:?})))"#
    );
    let (scene, source) = parse(Source::new("sliding.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"))
}

/// Mean velocity of the sliding block along the face, m/s.
fn speed(sim: &Simulation) -> f64 {
    let (view, rows) = sim.world().body_view(BodyId(1));
    let velocity = view.read::<Velocity>().expect("velocities");
    rows.clone().map(|row| velocity[row].0.x).sum::<f64>() / rows.len() as f64
}

#[test]
fn a_body_that_can_fail_slides_on_its_surface_until_it_does() {
    let mut sim = sliding("", 0.5, 1.0);
    sim.run(|_| true).unwrap_or_else(|error| panic!("{error}"));
    // Its particles would have stopped it: without friction it keeps 0.5 m/s.
    assert!((speed(&sim) - 0.5).abs() < 2e-3, "{}", speed(&sim));
    assert!(sim.ledger().relative_error().abs() < 1e-3, "{}", sim.ledger().relative_error());
    assert!(sim.warnings().is_empty(), "{:?}", sim.warnings());
}

#[test]
fn a_skin_whose_particle_fails_hands_its_energy_over_to_particles() {
    // The step in which it does closes to the square of its length.
    let jump = |factor: f64| {
        let mut sim = sliding(", friction: 0.3", 0.006, factor);
        let total = |sim: &Simulation, name: &str| sim.ledger().total_named(name);
        let (mut contact, mut error, mut jump) = (0.0, 0.0, None);
        sim.run(|sim| {
            let changed = total(sim, "contact_surface");
            if changed != 0.0 && jump.is_none() {
                // What the skin held is held by particles, or stands in an account of its own.
                let after = total(sim, "contact");
                assert!(
                    (after + changed - contact).abs() < 0.1 * contact,
                    "{contact} J, {after} and {changed} J"
                );
                jump = Some(sim.ledger().balance_error() - error);
            }
            (contact, error) = (total(sim, "contact"), sim.ledger().balance_error());
            true
        })
        .unwrap_or_else(|error| panic!("{error}"));
        let told = |text: &&String| text.contains("no longer with its surface from 3.4");
        assert_eq!(sim.warnings().iter().filter(told).count(), 1, "{:?}", sim.warnings());
        jump.expect("a particle of the skin fails")
    };
    let (coarse, fine) = (jump(0.4), jump(0.2));
    assert!(coarse.abs() < 2e-4 && fine.abs() < 0.3 * coarse.abs(), "{coarse} {fine}");
}

/// A brittle block that hits a rigid floor, in steps of that share of the usual ones; the largest change of
/// the balance in a step, and the last.
fn crashed(factor: f64) -> (f64, f64) {
    let text = format!(
        r#"(dimension: Two, materials: {{"brittle": NeoHookean(density: 1000, young: 1e9, poisson: 0.3)}},
            bodies: [(name: "block", material: "brittle", shape: Box(min: (0, 0), max: (0.01, 0.01)), spacing: 1e-3, formulation: TotalLagrangian, velocity: (100, -150),
                      plugins: [hourglass_control(), failure(criterion: MaximumPrincipalStrain(limit: 0.05), then: Removed)]),
                     (name: "floor", material: "brittle", shape: Box(min: (-0.01, -0.003), max: (0.02, 0)), spacing: 1e-3, formulation: Rigid)],
            contacts: [Contact(between: ("block", "floor"), law: Penalty(), friction: 0.3)],
            conditions: [Fix(on: Select(body: "floor"))],
            time: (end: 1e-5, step: Adaptive(factor: {factor:?})))"#
    );
    let (scene, source) = parse(Source::new("crash.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut sim =
        assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
    let (mut last, mut largest) = (0.0, 0.0_f64);
    sim.run(|sim| {
        let error = sim.ledger().relative_error();
        largest = largest.max((error - last).abs());
        last = error;
        true
    })
    .unwrap_or_else(|error| panic!("{error}"));
    (largest, last)
}

#[test]
fn nothing_is_lost_silently_where_particles_that_touch_are_removed() {
    // What is left is the error of the leapfrog, which falls with the square of the step. Released energy
    // that was booked twice left 1e-3 in one step of any length.
    let ([coarse, fine], [large, small]) = ([0.25, 0.1].map(crashed), [1.0, 0.25].map(|f| crashed(f).1));
    assert!(coarse.0 < 5e-5 && fine.0 < 1e-5, "{coarse:?} {fine:?}");
    assert!(small.abs() < 0.2 * large.abs() && fine.1.abs() < 3e-5, "{large} {small} {fine:?}");
}

/// A block with that plugin list that is drawn by a traction of 0.1 MPa on one side, above that symmetry
/// plane, in steps of that share of the usual ones.
fn drawn(plugins: &str, conditions: &str, factor: f64) -> Simulation {
    let text = format!(
        r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "block", material: "soft", shape: Box(min: (0, 0), max: (0.1, 0.03)), spacing: 0.005, formulation: TotalLagrangian, plugins: [hourglass_control(), {plugins}])],
            conditions: [Traction(on: Select(body: "block", face: MaxX), value: (1e5, 0)), {conditions}],
            time: (end: 0.004, step: Adaptive(factor: {factor:?})))"#
    );
    let (scene, source) = parse(Source::new("drawn.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_traction_acts_on_the_surface_of_a_body_that_can_fail_as_on_any_other() {
    let places = |plugins: &str| {
        let mut sim = drawn(plugins, "Symmetry(plane: Y, at: 0)", 1.0);
        sim.run(|_| true).unwrap_or_else(|error| panic!("{error}"));
        assert!(sim.warnings().is_empty(), "{:?}", sim.warnings());
        let (view, _) = sim.world().body_view(BodyId(0));
        view.read::<Position>().expect("places").iter().map(|x| x.0).collect::<Vec<DVec3>>()
    };
    let fragile = places("failure(criterion: MaximumPrincipalStrain(limit: 0.9))");
    for (a, b) in places("").iter().zip(fragile) {
        assert!(a.abs_diff_eq(b, 1e-12), "{a} {b}");
    }
}

#[test]
fn a_traction_goes_on_where_the_surface_that_it_acts_on_fails() {
    let balance = |factor: f64| {
        let mut sim = drawn("failure(criterion: MaximumPrincipalStrain(limit: 0.06))", "", factor);
        sim.run(|_| true).unwrap_or_else(|error| panic!("{error}"));
        let told =
            |text: &&String| text.contains("the traction on body `block` acts on particles and no longer");
        assert_eq!(sim.warnings().iter().filter(told).count(), 1, "{:?}", sim.warnings());
        // All of the time the force is the traction times the side.
        let impulse = 1e5 * 0.03 * sim.clock().time;
        let momentum = momentum(&sim).0;
        assert!((momentum.x / impulse - 1.0).abs() < 1e-9, "{momentum} {impulse}");
        sim.ledger().relative_error().abs()
    };
    let (coarse, fine) = (balance(1.0), balance(0.25));
    assert!(coarse < 1e-2 && fine < 0.5 * coarse, "{coarse} {fine}");
}
