//! Flattened particles: contact at the surface of the body, as the gradient of an energy.

use glam::{DMat3, DVec3};

use super::{angular_momentum, momentum, simulation};
use crate::contact::bodies::shape::{ParticleShape, Proximity, of_pair, on_surface, squared_stretch};
use crate::simulation::Simulation;
use crate::world::{BodyId, DeformationGradient};

const FIRST: DMat3 = DMat3::from_cols_array(&[1.3, 0.1, -0.2, 0.05, 0.8, 0.1, 0.3, 0.0, 0.9]);
const SECOND: DMat3 = DMat3::from_cols_array(&[0.9, -0.3, 0.1, 0.2, 1.4, 0.0, 0.1, 0.2, 0.6]);

fn ellipsoid(radius: f64, f: DMat3) -> ParticleShape {
    ParticleShape { radius, gradient: Some(f) }
}

/// d f / d q of a function of a vector or matrix, by central differences, contracted with `along`.
fn slope(f: impl Fn(f64) -> f64) -> f64 {
    (f(1e-6) - f(-1e-6)) / 2e-6
}

#[test]
fn the_force_at_the_point_of_contact_is_the_gradient_of_the_overlap_of_two_particles() {
    let x = DVec3::new(0.9, -0.7, 1.1);
    let (r, s) = (1.1, 0.8);
    let near = |x: DVec3, f: DMat3, g: DMat3| of_pair(x, ellipsoid(r, f), ellipsoid(s, g));
    let here = near(x, FIRST, SECOND);
    let force = here.scale * here.normal;
    for way in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.3, -1.0, 0.4)] {
        let found = slope(|h| near(x + h * way, FIRST, SECOND).overlap);
        assert!((found - force.dot(way)).abs() < 1e-8, "{found}");
        for arm in [DVec3::X, DVec3::Y, DVec3::Z] {
            // Work of the force on the point of contact, x_i + F_i A_i, while F_i changes.
            let change = |h: f64| DMat3::from_cols(way * arm.x, way * arm.y, way * arm.z) * h;
            let of_first = slope(|h| near(x, FIRST + change(h), SECOND).overlap);
            assert!((of_first + force.dot(way) * arm.dot(here.arms[0])).abs() < 1e-8, "{of_first}");
            let of_second = slope(|h| near(x, FIRST, SECOND + change(h)).overlap);
            assert!((of_second - force.dot(way) * arm.dot(here.arms[1])).abs() < 1e-8, "{of_second}");
        }
    }
    // Both sides see it at one place.
    let apart = x + SECOND * here.arms[1] - FIRST * here.arms[0];
    assert!(apart.length() < 1e-12, "{apart}");
}

#[test]
fn the_force_on_a_plane_is_the_gradient_of_the_overlap_and_acts_on_the_plane() {
    let normal = DVec3::new(0.2, -0.4, 0.9).normalize();
    let near = |distance: f64, f: DMat3| on_surface(distance, normal, ellipsoid(1.1, f));
    for distance in [0.7, -0.2] {
        let here = near(distance, FIRST);
        let force = here.scale * normal;
        assert!((slope(|h| near(distance + h, FIRST).overlap) + here.scale).abs() < 1e-8);
        assert!(((FIRST * here.arms[0]).dot(normal) + distance).abs() < 1e-12);
        for way in [DVec3::X, DVec3::Y, DVec3::Z] {
            for arm in [DVec3::X, DVec3::Y, DVec3::Z] {
                let change = DMat3::from_cols(way * arm.x, way * arm.y, way * arm.z);
                let found = slope(|h| near(distance, FIRST + change * h).overlap);
                assert!((found + force.dot(way) * arm.dot(here.arms[0])).abs() < 1e-8, "{found}");
            }
        }
    }
}

#[test]
fn a_particle_that_turns_stays_a_sphere_and_a_pressed_one_reaches_as_far_as_its_material() {
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.8);
    let other = ellipsoid(0.7, turn.transpose());
    let x = DVec3::new(0.9, 0.2, -0.4);
    let sphere = |radius: f64| ParticleShape { radius, gradient: None };
    let (turned, plain) = (of_pair(x, ellipsoid(0.6, turn), other), of_pair(x, sphere(0.6), sphere(0.7)));
    let near = |near: &Proximity| near.scale * near.normal;
    assert!(
        (turned.overlap - (1.3 - x.length())).abs() < 1e-12 && (turned.overlap - plain.overlap).abs() < 1e-12
    );
    assert!(
        (near(&turned) - near(&plain)).length() < 1e-12 && (near(&plain) + x.normalize()).length() < 1e-12
    );
    // Flat to a fifth and turned: two of them touch at a fifth, beside each other at the stretch.
    let flat = turn * DMat3::from_diagonal(DVec3::new(2.0, 1.5, 0.2));
    for (axis, stretch) in [(DVec3::X, 2.0), (DVec3::Y, 1.5), (DVec3::Z, 0.2)] {
        let along = turn * axis;
        let touching = of_pair(along * (1.2 * stretch), ellipsoid(0.6, flat), ellipsoid(0.6, flat));
        assert!(touching.overlap.abs() < 1e-12 && (touching.normal + along).length() < 1e-12);
        assert!((touching.scale * stretch - 1.0).abs() < 1e-12);
        assert!(on_surface(0.6 * stretch, along, ellipsoid(0.6, flat)).overlap.abs() < 1e-12);
    }
    let stretch = |f: DMat3| squared_stretch(&DeformationGradient(f)).sqrt();
    assert!((stretch(DMat3::from_diagonal(DVec3::new(0.3, 1.7, 1.0))) - 1.7).abs() < 1e-12);
    assert!((stretch(turn) - 1.0).abs() < 1e-12);
    assert!(stretch(flat) >= 2.0);
}

/// Two soft blocks thrown at each other so fast that their faces are pressed flat.
fn crash(dimension: &str, contact: &str, factor: f64) -> Simulation {
    let (low, high, z) = if dimension == "Two" {
        ("min: (0, 0), max: (0.1, 0.05)", "min: (0.023, 0.051), max: (0.083, 0.101)", "")
    } else {
        (
            "min: (0, 0, 0), max: (0.1, 0.05, 0.04)",
            "min: (0.023, 0.051, 0.01), max: (0.083, 0.101, 0.05)",
            ", 0.5",
        )
    };
    simulation(&format!(
        r#"(dimension: {dimension},
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "low", material: "soft", shape: Box({low}), spacing: 0.01, formulation: TotalLagrangian),
                (name: "high", material: "soft", shape: Box({high}), spacing: 0.01, formulation: TotalLagrangian,
                 velocity: (3.0, -12.0{z})),
            ],
            contacts: [Contact(between: ("low", "high"), {contact})],
            time: (end: 0.008, step: Adaptive(factor: {factor})))"#
    ))
}

fn least_stretch(sim: &Simulation) -> f64 {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let gradient = view.read::<DeformationGradient>().unwrap();
    rows.map(|row| gradient[row].0.y_axis.y).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_crash_of_two_blocks_keeps_energy_momentum_and_angular_momentum() {
    for (dimension, contact) in [
        ("Two", "law: Penalty(), surface: Particles"),
        ("Two", "law: Penalty(), surface: Particles, friction: 0.4, restitution: 0.5"),
        ("Three", "law: Penalty(), surface: Particles, friction: 0.4, restitution: 0.5"),
    ] {
        let mut sim = crash(dimension, contact, 0.5);
        sim.start().unwrap();
        let (p, l) = (momentum(&sim), angular_momentum(&sim));
        let mut flattest = 1.0f64;
        sim.run(|sim| {
            flattest = flattest.min(least_stretch(sim));
            true
        })
        .unwrap();
        assert!(flattest < 0.85, "{flattest}");
        let (q, m) = (momentum(&sim), angular_momentum(&sim));
        assert!((q - p).length() < 1e-12 * p.length(), "{dimension} {contact}: {p} {q}");
        assert!((m - l).length() < 1e-10 * l.length(), "{dimension} {contact}: {l} {m}");
        let error = sim.ledger().relative_error().abs();
        assert!(error < 3e-3, "{dimension} {contact}: {error}");
        assert_eq!(sim.ledger().total_named("friction") > 0.0, contact.contains("friction"));
    }
}

#[test]
fn what_the_books_of_a_crash_miss_is_the_error_of_the_leapfrog() {
    let error = |factor: f64| {
        let mut sim = crash("Two", "law: Penalty(), surface: Particles", factor);
        sim.run(|_| true).unwrap();
        sim.ledger().relative_error().abs()
    };
    let (coarse, fine) = (error(0.5), error(0.125));
    assert!(coarse < 2e-4 && fine < 0.3 * coarse, "{coarse} {fine}");
}

#[test]
fn a_block_bounces_off_a_turned_plane_without_loss() {
    let mut sim = simulation(
        r#"(dimension: Two,
            materials: {"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)},
            bodies: [
                (name: "block", material: "soft", shape: Box(min: (0.0, 0.002), max: (0.06, 0.062)), spacing: 0.01,
                 formulation: TotalLagrangian, velocity: (2.0, -8.0)),
                (name: "table", material: "soft", shape: Box(min: (-0.5, -0.5), max: (0.5, 0)), spacing: 0.25,
                 formulation: Rigid(), velocity: (0.0, 1.0)),
            ],
            contacts: [Contact(between: ("block", "table"), law: Penalty(), surface: Particles, friction: 0.3, restitution: 0.7)],
            time: (end: 0.012))"#,
    );
    sim.start().unwrap();
    let p = momentum(&sim);
    sim.run(|_| true).unwrap();
    assert!((momentum(&sim) - p).length() < 1e-12 * p.length());
    // Of 3.6 and 500 kg.
    let kinetic = 0.5 * (3.6 * (2.0_f64.powi(2) + 8.0_f64.powi(2)) + 500.0);
    let error = sim.ledger().balance_error().abs() / kinetic;
    assert!(error < 1e-3 && sim.ledger().total_named("friction") > 0.0, "{error}");
}

#[test]
fn a_block_that_is_pressed_against_a_corner_or_a_ball_gets_back_what_it_gave() {
    // At a corner the force has a kink, which costs an order of the leapfrog. By how much depends on when it
    // is met: the worst of three steps counts.
    for (shape, turn) in [
        ("Box(min: (-0.09, -0.05), max: (0.01, 0.05))", 20.0),
        ("Sphere(center: (0, -0.02), radius: 0.06)", 0.0),
    ] {
        let error = |factor: f64| {
            let mut sim = simulation(&format!(
                r#"(dimension: Two,
                    materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                    bodies: [
                        (name: "block", material: "soft", shape: Box(min: (-0.037, 0.072), max: (0.043, 0.132)), spacing: 0.01,
                         formulation: TotalLagrangian, velocity: (0.5, -9.0)),
                        (name: "tool", material: "soft", shape: {shape}, spacing: 0.01, formulation: Rigid(spin: (0, 0, {turn:?}))),
                    ],
                    contacts: [Contact(between: ("block", "tool"), law: Penalty(factor: 2), surface: Particles)],
                    time: (end: 0.012, step: Adaptive(factor: {factor})))"#
            ));
            sim.start().unwrap();
            let p = momentum(&sim);
            sim.run(|_| true).unwrap();
            assert!((momentum(&sim) - p).length() < 1e-12 * p.length());
            sim.ledger().relative_error().abs()
        };
        let worst = |factors: [f64; 3]| factors.map(error).into_iter().fold(0.0, f64::max);
        let (coarse, fine) = (worst([1.0, 0.7, 0.5]), worst([0.0625, 0.045, 0.03]));
        assert!(coarse < 3e-3 && fine < 0.2 * coarse, "{shape}: {coarse} {fine}");
    }
}
