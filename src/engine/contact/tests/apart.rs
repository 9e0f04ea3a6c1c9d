//! Bodies that start far apart, and meet: by flight, by rotation, across a periodic side.

use super::{angular_momentum, centre, momentum, simulation};
use crate::scene::Source;
use crate::simulation::{Checkpoint, Simulation};

/// Bodies far apart and one that flies between them; `kind` are formulation and surface.
fn far_apart([formulation, surface]: [&str; 2], bodies: &str, domain: &str, end: f64) -> Simulation {
    let bodies = bodies.replace("KIND", formulation);
    simulation(&format!(
        r#"(dimension: Two, {domain}
            materials: {{"rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [{bodies}],
            contacts: [Contact(between: ("*", "*"), surface: {surface})],
            time: (end: {end}))"#
    ))
}

const KINDS: [[&str; 2]; 4] = [
    ["TotalLagrangian", "Skin"],
    ["TotalLagrangian", "Particles"],
    ["Eulerian", "Particles"],
    ["Rigid()", "Skin"],
];

fn disc(name: &str, x: f64, y: f64, speed: f64) -> String {
    format!(
        r#"(name: "{name}", material: "rubber", shape: Sphere(center: ({x}, {y}), radius: 0.04), spacing: 0.01, formulation: KIND, velocity: ({speed}, 0)),"#
    )
}

#[test]
fn momentum_passes_along_a_row_of_distant_discs() {
    // The first is stopped by the second, and that by the third: equal masses exchange their velocities, but
    // for the energy of vibrations.
    for kind in KINDS {
        let row =
            disc("first", 0.0, 0.0, 2.0) + &disc("second", 0.4, 0.0, 0.0) + &disc("third", 0.8, 0.0, 0.0);
        let mut sim = far_apart(kind, &row, "", 0.45);
        sim.start().unwrap();
        let before = momentum(&sim);
        sim.run(|_| true).unwrap();
        let speeds = [0, 1, 2].map(|body| centre(&sim, body).1.x);
        assert!(speeds[0] < 0.3 && speeds[1] < 0.3 && speeds[2] > 1.6, "{kind:?}: {speeds:?}");
        assert!((momentum(&sim) - before).length() < 1e-11 * before.length(), "{kind:?}");
        assert!(sim.ledger().relative_error().abs() < 5e-3, "{kind:?}: {}", sim.ledger().relative_error());
    }
}

#[test]
fn a_turning_arm_hits_what_its_end_passes() {
    // The arm turns about its middle by a quarter before its end meets the disc, 24 spacings above it.
    let starts = r#"conditions: [InitialVelocity(on: Select(body: "arm"), value: ("-2*y", "2*x"))],"#;
    for (kind, starts) in [("TotalLagrangian", starts), ("Rigid(spin: (0, 0, 2))", "")] {
        let disc = disc("disc", 0.05, 0.28, 0.0).replace("KIND", "TotalLagrangian");
        let mut sim = simulation(&format!(
            r#"(dimension: Two, {starts}
                materials: {{"rubber": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "arm", material: "rubber", shape: Box(min: (-0.3, -0.03), max: (0.3, 0.03)), spacing: 0.01, formulation: {kind}),
                    {disc}
                ],
                contacts: [Contact(between: ("arm", "disc"))],
                time: (end: 0.9))"#
        ));
        sim.start().unwrap();
        let before = angular_momentum(&sim).z;
        sim.run(|_| true).unwrap();
        let (_, velocity) = centre(&sim, 1);
        assert!(velocity.x < -0.2, "{kind}: {velocity}");
        if kind == "TotalLagrangian" {
            let change = (angular_momentum(&sim).z - before).abs();
            assert!(change < 1e-9 * before.abs(), "{kind}: {change} of {before}");
        }
    }
}

#[test]
fn discs_meet_behind_a_distant_periodic_side() {
    for kind in KINDS {
        let pair = disc("left", 0.1, 0.0, -1.0) + &disc("right", 0.7, 0.0, 0.0);
        let domain = "domain: (min: (0, -1), max: (1, 1), periodic: [X]),";
        let mut sim = far_apart(kind, &pair, domain, 0.5);
        sim.run(|_| true).unwrap();
        let speeds = [0, 1].map(|body| centre(&sim, body).1.x);
        assert!(speeds[0] > -0.2 && speeds[1] < -0.8, "{kind:?}: {speeds:?}");
    }
}

#[test]
fn a_run_resumed_in_flight_is_that_without_interruption() {
    for kind in KINDS {
        let row = disc("first", 0.0, 0.0, 2.0) + &disc("second", 0.3, 0.0, 0.0);
        let scene = || far_apart(kind, &row, "", 0.2);
        let (mut whole, mut first, mut second) = (scene(), scene(), scene());
        whole.run(|_| true).unwrap();
        first.run(|sim| sim.clock().time < 0.05).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.mlc");
        first.save(&path, &Source::new("contact.ron", "")).unwrap();
        second.restore(&Checkpoint::read(&path).unwrap()).unwrap();
        second.run(|_| true).unwrap();
        assert_eq!(second.state_hash(), whole.state_hash(), "{kind:?}");
        assert!(centre(&whole, 1).1.x > 1.0, "{kind:?}: no impact");
    }
}
