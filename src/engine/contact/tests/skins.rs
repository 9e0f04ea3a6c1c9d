//! Contact of skins: no tangential force without friction, Coulomb's force with it, and exact restarts.

use super::{angular_momentum, centre, momentum, simulation};
use crate::scene::Source;
use crate::simulation::{Checkpoint, Simulation};

/// A block that is thrown at an angle onto a longer one, both free.
fn thrown(dimension: &str, (along, down): (f64, f64), contact: &str, end: f64) -> Simulation {
    let (low, high, z) = if dimension == "Two" {
        ("min: (0, 0), max: (0.2, 0.08)", "min: (0.043, 0.0801), max: (0.103, 0.1401)", "")
    } else {
        (
            "min: (0, 0, 0), max: (0.2, 0.08, 0.08)",
            "min: (0.043, 0.0801, 0.02), max: (0.103, 0.1401, 0.06)",
            ", 0.0",
        )
    };
    simulation(&format!(
        r#"(dimension: {dimension},
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "low", material: "soft", shape: Box({low}), spacing: 0.01, formulation: TotalLagrangian),
                (name: "high", material: "soft", shape: Box({high}), spacing: 0.01, formulation: TotalLagrangian,
                 velocity: ({along:?}, {down:?}{z})),
            ],
            contacts: [Contact(between: ("low", "high"), law: Penalty(), {contact})],
            time: (end: {end:?}))"#
    ))
}

/// Impulse across and along the normal on the lower block.
fn impulses(sim: &mut Simulation) -> (f64, f64) {
    sim.run(|_| true).unwrap();
    let (_, velocity) = centre(sim, 0);
    (velocity.x, -velocity.y)
}

#[test]
fn blocks_that_slide_without_friction_feel_no_tangential_force() {
    for dimension in ["Two", "Three"] {
        let (across, along) = impulses(&mut thrown(dimension, (2.0, -0.5), "friction: 0.0", 0.02));
        assert!(along > 0.0 && across.abs() < 0.01 * along, "{dimension}: {across} {along}");
        let bumps = "friction: 0.0, surface: Particles";
        let (across, along) = impulses(&mut thrown(dimension, (2.0, -0.5), bumps, 0.02));
        assert!(across.abs() > 0.02 * along, "{dimension}: rows of bumps: {across} {along}");
    }
}

#[test]
fn blocks_that_slide_with_friction_feel_the_coefficient() {
    for dimension in ["Two", "Three"] {
        let mut sim = thrown(dimension, (1.0, -0.2), "friction: 0.1", 0.02);
        sim.start().unwrap();
        let before = momentum(&sim);
        let (across, along) = impulses(&mut sim);
        assert!((across / along - 0.1).abs() < 0.002, "{dimension}: {across} {along}");
        assert!((momentum(&sim) - before).length() < 1e-12 * before.length());
        assert!(sim.ledger().relative_error().abs() < 1e-3, "{}", sim.ledger().relative_error());
    }
}

/// Two blocks that slide on each other are one body or two: the forces are the same.
#[test]
fn a_body_touches_itself_as_two_bodies_touch_each_other() {
    let place = |one: bool| {
        let [low, high] = ["Box(min: (0, 0), max: (0.2, 0.05))", "Box(min: (0.05, 0.08), max: (0.1, 0.13))"];
        let rest = r#"material: "soft", spacing: 0.01, formulation: TotalLagrangian"#;
        let (bodies, upper) = if one {
            (format!(r#"(name: "low", shape: Union([{low}, {high}]), {rest})"#), "low")
        } else {
            (format!(r#"(name: "low", shape: {low}, {rest}), (name: "high", shape: {high}, {rest})"#), "high")
        };
        let mut sim = simulation(&format!(
            r#"(dimension: Two,
                materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [{bodies}],
                conditions: [InitialVelocity(on: Select(body: "{upper}", within: Box(min: (0, 0.07), max: (1, 1))), value: (1.0, -2.0))],
                contacts: [Contact(between: ("low", "{upper}"), law: Penalty(), friction: 0.3)],
                time: (end: 0.03, step: Fixed(2e-5)))"#
        ));
        sim.start().unwrap();
        let before = (momentum(&sim), angular_momentum(&sim));
        sim.run(|_| true).unwrap();
        assert!(sim.ledger().total_named("friction") > 0.0);
        assert!((momentum(&sim) - before.0).length() < 1e-12 * before.0.length());
        assert!((angular_momentum(&sim) - before.1).length() < 1e-12 * before.1.length());
        assert!(sim.ledger().relative_error().abs() < 1e-3, "{}", sim.ledger().relative_error());
        let all: Vec<_> = (0..sim.world().bodies().len()).map(|k| centre(&sim, k)).collect();
        (all, sim.ledger().total_named("friction"), sim.ledger().total_named("kinetic"))
    };
    let ((one, friction_of_one, kinetic_of_one), (two, friction, kinetic)) = (place(true), place(false));
    // The lower block has four times the mass of the upper one.
    let middle = 0.8 * two[0].0 + 0.2 * two[1].0;
    assert!((one[0].0 - middle).length() < 1e-9, "{} {middle}", one[0].0);
    assert!((friction_of_one / friction - 1.0).abs() < 1e-6, "{friction_of_one} {friction}");
    assert!((kinetic_of_one / kinetic - 1.0).abs() < 1e-6, "{kinetic_of_one} {kinetic}");
}

/// The sides of a sheet two particles thick come near each other as it is stretched, and do not touch.
#[test]
fn a_stretched_sheet_does_not_touch_itself() {
    for (dimension, shape, value) in [
        ("Two", "Box(min: (0, 0), max: (0.2, 0.02))", r#"("4*x", "-0.8*y")"#),
        ("Three", "Box(min: (0, 0, 0), max: (0.1, 0.1, 0.02))", r#"("1.5*x", "1.5*y", "-0.84*z")"#),
    ] {
        let mut sim = simulation(&format!(
            r#"(dimension: {dimension},
                materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [(name: "sheet", material: "soft", shape: {shape}, spacing: 0.01, formulation: TotalLagrangian)],
                conditions: [InitialDisplacement(on: Select(body: "sheet"), value: {value})],
                contacts: [Contact(between: ("sheet", "sheet"), law: Penalty())],
                time: (end: 1e-9, step: Fixed(1e-9)))"#
        ));
        sim.run(|_| true).unwrap();
        assert_eq!(sim.ledger().total_named("contact"), 0.0, "{dimension}");
    }
}

#[test]
fn skins_go_on_exactly_after_a_restart() {
    let make = || thrown("Two", (3.0, -2.0), "friction: 0.3, restitution: 0.8", 0.01);
    let mut whole = make();
    whole.run(|_| true).unwrap();
    let mut first = make();
    first.run(|sim| sim.clock().time < 0.003).unwrap();
    let mut second = make();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.mlc");
    first.save(&path, &Source::new("contact.ron", "")).unwrap();
    second.restore(&Checkpoint::read(&path).unwrap()).unwrap();
    second.run(|_| true).unwrap();
    assert_eq!(whole.state_hash(), second.state_hash());
}

#[test]
fn a_crash_of_two_skins_keeps_energy_momentum_and_angular_momentum() {
    for (dimension, contact) in [
        ("Two", "friction: 0.0"),
        ("Two", "friction: 0.4, restitution: 0.5"),
        ("Three", "friction: 0.4, restitution: 0.5"),
    ] {
        // At a tenth and at a third of the speed of sound.
        for down in [-4.0, -12.0] {
            let mut sim = thrown(dimension, (3.0, down), contact, 0.008);
            sim.start().unwrap();
            let (p, l) = (momentum(&sim), angular_momentum(&sim));
            sim.run(|_| true).unwrap();
            let (q, m) = (momentum(&sim), angular_momentum(&sim));
            assert!((q - p).length() < 1e-12 * p.length(), "{dimension} {contact}: {p} {q}");
            assert!((m - l).length() < 1e-10 * l.length(), "{dimension} {contact}: {l} {m}");
            let error = sim.ledger().relative_error().abs();
            assert!(error < 3e-3, "{dimension} {contact} {down}: {error}");
        }
    }
}

#[test]
fn heat_of_dashpots_between_soft_sheets_is_what_they_take() {
    // They are pressed together by a fifth within the touch: what is booked must not see the stretch of the
    // overlap.
    let error = |restitution: f64| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two,
                materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [
                    (name: "low", material: "soft", shape: Box(min: (0, 0), max: (0.2, 0.04)), spacing: 0.01, formulation: TotalLagrangian),
                    (name: "high", material: "soft", shape: Box(min: (0, 0.041), max: (0.2, 0.081)), spacing: 0.01,
                     formulation: TotalLagrangian, velocity: (3.0, -8.0)),
                ],
                contacts: [Contact(between: ("low", "high"), law: Penalty(), restitution: {restitution})],
                time: (end: 0.006, step: Adaptive(factor: 0.25)))"#
        ));
        sim.run(|_| true).unwrap();
        sim.ledger().relative_error().abs()
    };
    for restitution in [0.5, 0.1] {
        let error = error(restitution);
        assert!(error < 3e-4, "{restitution}: {error}");
    }
}

#[test]
fn a_skin_bounces_off_planes_corners_and_balls_without_loss() {
    for shape in [
        "Box(min: (-0.09, -0.05), max: (0.01, 0.05))",
        "Sphere(center: (0, -0.02), radius: 0.06)",
        "HalfSpace(point: (0, 0.05), normal: (0.1, 1))",
    ] {
        let error = |factor: f64| {
            let mut sim = simulation(&format!(
                r#"(dimension: Two,
                    materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                    bodies: [
                        (name: "block", material: "soft", shape: Box(min: (-0.037, 0.072), max: (0.043, 0.132)), spacing: 0.01,
                         formulation: TotalLagrangian, velocity: (0.5, -9.0)),
                        (name: "tool", material: "soft", shape: {shape}, spacing: 0.01, formulation: Rigid()),
                    ],
                    conditions: [Fix(on: Select(body: "tool"))],
                    contacts: [Contact(between: ("block", "tool"), law: Penalty())],
                    time: (end: 0.012, step: Adaptive(factor: {factor})))"#
            ));
            sim.run(|_| true).unwrap();
            sim.ledger().relative_error().abs()
        };
        let (coarse, fine) = (error(1.0), error(0.125));
        assert!(coarse < 3e-3 && fine < 0.5 * coarse, "{shape}: {coarse} {fine}");
    }
}
