//! Blocks that leave their domain.

use glam::DVec3;

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{
    BodyId, DeformationGradient, Force, Mass, PhaseId, PiolaStress, Position, Removed, Velocity,
};

/// A block of 8 x 4 particles, 0.08 m long, that starts at the origin; `more` goes into the scene.
fn block(more: &str) -> Simulation {
    let text = format!(
        r#"Scene(
    dimension: Two,
    materials: {{"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)}},
    bodies: [
        Body(name: "block", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.08, 0.04)), spacing: 0.01,
             formulation: TotalLagrangian),
    ],
    {more}
)"#
    );
    let (scene, source) = parse(Source::new("block.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"))
}

const DOMAIN: &str = "domain: (min: (-1.0, -1.0), max: (0.1, 1.0), outside: Remove),";

fn account(sim: &Simulation, name: &str) -> f64 {
    sim.ledger().accounts().iter().find(|a| a.name == name).map_or(f64::NAN, |a| a.of(BodyId(0)))
}

#[test]
fn a_body_that_has_left_as_a_whole_is_warned_of() {
    let told = |end: f64| {
        let moves = r#"conditions: [InitialVelocity(on: Select(body: "block"), value: ("2.0", "0.5"))]"#;
        let mut sim = block(&format!("{DOMAIN} {moves}, time: (end: {end:?}),"));
        sim.run(|_| true).unwrap();
        sim.warnings()
            .iter()
            .filter(|text| text.contains("all particles of `block` have been removed"))
            .count()
    };
    // It is 0.08 m long and starts 0.02 m before the side.
    assert_eq!(told(0.03), 0);
    assert_eq!(told(0.06), 1);
}

#[test]
fn a_block_that_drifts_out_of_the_domain_leaves_column_by_column_and_feels_nothing() {
    let scene = "conditions: [InitialVelocity(on: Select(body: \"block\"), value: (\"2.0\", \"0.5\"))], time: (end: 0.025),";
    let mut sim = block(&format!("{DOMAIN} {scene}"));
    sim.run(|_| true).unwrap();
    let view = sim.world().phase(PhaseId(0));
    let (x, v) = (view.read::<Position>().unwrap(), view.read::<Velocity>().unwrap());
    let removed = view.read::<Removed>().unwrap();
    let mass = view.read::<Mass>().unwrap()[0].0;
    // The block is 0.05 m to the right: columns that began beyond 0.05 m are out.
    let gone = removed.iter().filter(|row| **row == Removed::YES).count();
    assert_eq!(gone, 3 * 4);
    assert_eq!(sim.summary().removed_of["block"], gone);
    for k in 0..x.len() {
        if removed[k] == Removed::YES {
            assert!(x[k].0.x > 0.1 && x[k].0.x < 0.1 + 2.0 * 2.0 * sim.clock().dt, "{}", x[k].0);
            assert_eq!(v[k].0, DVec3::ZERO);
        } else {
            assert!((v[k].0 - DVec3::new(2.0, 0.5, 0.0)).length() < 1e-11, "{}", v[k].0);
        }
    }
    let taken = gone as f64 * 0.5 * mass * 4.25;
    assert!((account(&sim, "removed") - taken).abs() < 1e-9 * taken);
    assert!(sim.ledger().relative_error().abs() < 1e-12, "{}", sim.ledger().relative_error());
}

/// The whole step of gravity is booked before a particle leaves: with its kinetic energy at mid-step half of
/// that was lost.
#[test]
fn the_books_close_exactly_when_what_falls_freely_leaves() {
    let scene = "gravity: (30.0, 0.0), conditions: [InitialVelocity(on: Select(body: \"block\"), value: (\"2.0\", \"0.5\"))], time: (end: 0.025),";
    let mut sim = block(&format!("{DOMAIN} {scene}"));
    sim.run(|_| true).unwrap();
    assert!((4..28).contains(&sim.summary().removed_of["block"]));
    assert!(sim.ledger().relative_error().abs() < 1e-12, "{}", sim.ledger().relative_error());
}

#[test]
fn the_books_close_when_strained_particles_leave() {
    // It stretches and turns while it leaves: what the cut bonds held goes with the particles.
    let scene = "conditions: [InitialVelocity(on: Select(body: \"block\"), value: (\"2.0 + 20*x - 10*y\", \"10*x\"))],
                 time: (end: 0.02, step: Adaptive(factor: 0.5)),";
    let mut sim = block(&format!("{DOMAIN} {scene}"));
    sim.run(|sim| sim.summary().removed_of.is_empty()).unwrap();
    assert!(account(&sim, "strain") > 1e-3 * account(&sim, "kinetic"), "nothing is strained");
    sim.run(|_| true).unwrap();
    let removed = sim.summary().removed_of["block"];
    assert!((4..28).contains(&removed), "{removed}");
    assert!(sim.ledger().relative_error().abs() < 1e-3, "{}", sim.ledger().relative_error());
    let view = sim.world().phase(PhaseId(0));
    let flags = view.read::<Removed>().unwrap();
    let (gradient, stress) =
        (view.read::<DeformationGradient>().unwrap(), view.read::<PiolaStress>().unwrap());
    let force = view.read::<Force>().unwrap();
    for k in (0..flags.len()).filter(|&k| flags[k] == Removed::YES) {
        assert_eq!(gradient[k].0, glam::DMat3::IDENTITY);
        assert!(stress[k].0.abs_diff_eq(glam::DMat3::ZERO, 1e-9));
        assert_eq!(force[k].0, DVec3::ZERO);
    }
}

#[test]
fn loads_gravity_and_prescribed_motion_let_go_of_removed_particles() {
    let scene = "gravity: (0.0, -10.0), conditions: [
                     Velocity(on: Select(body: \"block\", face: MaxX), value: (\"3.0\", \"0.0\")),
                     Traction(on: Select(body: \"block\", face: MaxX), value: (None, \"100.0\")),
                 ], time: (end: 0.02),";
    let mut sim = block(&format!("{DOMAIN} {scene}"));
    sim.run(|_| true).unwrap();
    let view = sim.world().phase(PhaseId(0));
    let flags = view.read::<Removed>().unwrap();
    let (v, force) = (view.read::<Velocity>().unwrap(), view.read::<Force>().unwrap());
    // The face has left after 0.008 s.
    let gone: Vec<usize> = (0..flags.len()).filter(|&k| flags[k] == Removed::YES).collect();
    assert!(gone.len() >= 4);
    assert!(gone.iter().all(|&k| v[k].0 == DVec3::ZERO && force[k].0 == DVec3::ZERO));
}

#[test]
fn a_particle_whose_neighbours_have_gone_flies_on() {
    // Only the left column is left in the domain at the end: a line of particles has no deformation gradient.
    let scene = "conditions: [InitialVelocity(on: Select(body: \"block\"), value: (\"2.0\", \"0.0\"))], time: (end: 0.043),";
    let mut sim = block(&format!("{DOMAIN} {scene}"));
    sim.run(|_| true).unwrap();
    assert_eq!(sim.summary().removed_of["block"], 7 * 4);
    let view = sim.world().phase(PhaseId(0));
    let v = view.read::<Velocity>().unwrap();
    assert_eq!(v.iter().filter(|v| (v.0.x - 2.0).abs() < 1e-11).count(), 4);
}

#[test]
fn bodies_of_every_formulation_leave_particle_by_particle() {
    for formulation in
        ["TotalLagrangian", "UpdatedLagrangian", "UpdatedLagrangian(update: Every(3))", "Eulerian"]
    {
        let text = format!(
            r#"(dimension: Two, {DOMAIN} materials: {{"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)}},
                bodies: [(name: "block", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.08, 0.08)), spacing: 0.01, formulation: {formulation}, velocity: (2.0, 0.3))],
                time: (end: 0.1))"#
        );
        let (scene, source) = parse(Source::new("block.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.run(|_| true).unwrap_or_else(|error| panic!("{formulation}: {error}"));
        let (view, rows) = sim.world().body_view(BodyId(0));
        let removed = view.read::<Removed>().expect("a column");
        assert!(removed[rows].iter().all(|removed| *removed != Removed::NO), "{formulation}");
    }
}

#[test]
fn a_rigid_body_leaves_as_a_whole_with_its_energy() {
    let at = |end: f64| {
        let text = format!(
            r#"(dimension: Two, gravity: (0.0, -10.0), {DOMAIN} materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
                bodies: [(name: "block", material: "wood", shape: Box(min: (0, 0), max: (0.08, 0.04)), spacing: 0.01, velocity: (2, 0), formulation: Rigid(spin: (0, 0, 1)))],
                time: (end: {end:?}))"#
        );
        let (scene, source) = parse(Source::new("block.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.run(|_| true).unwrap();
        let (view, rows) = sim.world().body_view(BodyId(0));
        let removed = view.read::<Removed>().unwrap();
        (
            rows.filter(|row| removed[*row] == Removed::YES).count(),
            account(&sim, "removed"),
            account(&sim, "kinetic"),
            sim.ledger().relative_error(),
        )
    };
    // Half of it is outside after 0.03 s, all of it after 0.05 s: with m (v^2 + (g t)^2) / 2 + I w^2 / 2 and
    // a mass of 1.6 kg.
    let (gone, removed, kinetic, error) = at(0.035);
    assert!(gone == 0 && removed == 0.0 && error.abs() < 1e-6, "{gone} {removed} {error}");
    assert!(kinetic > 3.2, "{kinetic}");
    let (gone, removed, kinetic, error) = at(0.1);
    let expected = 0.5 * 1.6 * (4.0 + 0.25) + 0.5 * 1.6 * (0.0064 + 0.0016) / 12.0;
    assert!(gone == 32 && kinetic == 0.0, "{gone} {kinetic}");
    assert!((removed / expected - 1.0).abs() < 0.02, "{removed} {expected}");
    assert!(error.abs() < 1e-3, "{error}");
}
