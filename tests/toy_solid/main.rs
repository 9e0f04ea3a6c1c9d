//! A formulation of solids that is one file and one line of registration has all that solids have: hourglass
//! control, pair terms, contact, coupling to a fluid, symmetry, failure, checkpoints. It is a naive second
//! implementation of the method of `TotalLagrangian` and moves its bodies alike.

mod toy;

use meshless::assembly::build;
use meshless::prelude::*;
use meshless::world::Damage;
use toy::Toy;

fn simulation(text: &str) -> Simulation {
    let mut registry = standard_plugins();
    registry.formulation::<Toy>();
    let built = parse(Source::new("toy.ron", text));
    let built = built.and_then(|(scene, source)| build(&scene, &source, &registry));
    built.unwrap_or_else(|error| panic!("{error}"))
}

fn run(text: &str, steps: u64) -> Simulation {
    let mut sim = simulation(text);
    sim.run(|sim| sim.clock().step < steps).expect("a run");
    assert_eq!(sim.clock().step, steps);
    sim
}

fn positions(sim: &Simulation) -> Vec<DVec3> {
    let bodies = (0..sim.world().bodies().len()).map(|k| sim.world().body_view(BodyId(k)));
    let of_body = |(view, rows): (meshless::world::PhaseView<'_>, std::ops::Range<usize>)| {
        view.read::<Position>().expect("a column")[rows].iter().map(|x| x.0).collect::<Vec<_>>()
    };
    bodies.flat_map(of_body).collect()
}

/// Runs the scene, in which bodies move by `FORMULATION`, with this formulation and with `TotalLagrangian`:
/// the particles move alike, to a share of what they have moved. Gives both.
fn alike(text: &str, steps: u64, tolerance: f64) -> [Simulation; 2] {
    let start = positions(&simulation(&text.replace("FORMULATION", "Toy")));
    let [toy, full] =
        ["Toy", "TotalLagrangian"].map(|formulation| run(&text.replace("FORMULATION", formulation), steps));
    let (a, b) = (positions(&toy), positions(&full));
    let largest = |pairs: &mut dyn Iterator<Item = f64>| pairs.fold(0.0, f64::max);
    let moved = largest(&mut a.iter().zip(&start).map(|(x, start)| x.distance(*start)));
    let apart = largest(&mut a.iter().zip(&b).map(|(a, b)| a.distance(*b)));
    assert!(moved > 0.0 && apart < tolerance * moved, "{apart} m apart after {moved} m");
    let (toy_end, end) = (toy.clock().time, full.clock().time);
    assert!((toy_end / end - 1.0).abs() < tolerance, "{toy_end} s, {end} s");
    [toy, full]
}

const RUBBER: &str = r#""rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)"#;

#[test]
fn it_has_hourglass_control_pair_terms_symmetry_and_contact() {
    let text = format!(
        r#"(dimension: Two, gravity: (0, -9.81), materials: {{{RUBBER}}},
            bodies: [
                (name: "low", material: "rubber", shape: Box(min: (0, 0), max: (0.5, 0.3)), spacing: 0.05, formulation: FORMULATION,
                 lattice: Relaxed(seed: 3, iterations: 2)),
                (name: "high", material: "rubber", shape: Box(min: (0.025, 0.3), max: (0.425, 0.5)), spacing: 0.05, formulation: FORMULATION,
                 velocity: (0.5, -3)),
                (name: "ball", material: "rubber", shape: Sphere(center: (0.7, 0.2), radius: 0.1), spacing: 0.05, formulation: Rigid(),
                 velocity: (-8, 0)),
            ],
            contacts: [Contact(between: ("low", "high"), law: Penalty(), friction: 0.3, restitution: 0.7),
                       Contact(between: ("low", "ball"), law: Penalty(), friction: 0.3)],
            conditions: [Symmetry(plane: Y, at: 0.0), Fix(on: Select(body: "low", face: MinX), edge: Particles),
                         InitialVelocity(on: Select(body: "low"), value: ("0", "sin(20*x)*y"))],
            plugins: [hourglass_control(), artificial_viscosity()],
            time: (end: 1))"#
    );
    let sims = alike(&text, 200, 1e-7);
    for sim in sims {
        let ledger = sim.ledger();
        for account in ["hourglass", "artificial_viscosity", "friction", "strain"] {
            assert!(ledger.total_named(account) > 0.0, "{account}");
        }
        assert!(ledger.relative_error().abs() < 2e-2, "{}", ledger.relative_error());
    }
}

/// The upper half of a block on a plane of symmetry moves as that of the whole block does, and not as half a
/// block without a plane.
#[test]
fn half_a_body_on_a_plane_of_symmetry_moves_as_the_whole_one() {
    let block = |low: f64, plane: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{{RUBBER}}},
                bodies: [(name: "block", material: "rubber", shape: Box(min: (0, {low:?}), max: (0.5, 0.3)), spacing: 0.05, formulation: Toy)],
                conditions: [{plane} InitialVelocity(on: Select(), value: ("1.5*cos(9*x)", "6*y*sin(7*x)"))],
                plugins: [hourglass_control()], time: (end: 1))"#
        );
        positions(&run(&text, 150))
    };
    let whole = block(-0.3, "");
    let farthest = |half: &[DVec3]| {
        let beside = |x: &DVec3| whole.iter().map(|y| x.distance(*y)).fold(f64::INFINITY, f64::min);
        half.iter().map(beside).fold(0.0, f64::max)
    };
    let (with, without) = (block(0.0, "Symmetry(plane: Y, at: 0.0),"), block(0.0, ""));
    assert_eq!((with.len(), without.len(), whole.len()), (60, 60, 120));
    assert!(farthest(&with) < 1e-9, "{} m apart", farthest(&with));
    assert!(farthest(&without) > 1e-4, "without a plane only {} m apart", farthest(&without));
}

/// Bodies that would fly through each other bounce.
#[test]
fn its_bodies_do_not_enter_each_other() {
    let scene = |contact: &str| {
        let body = |name: &str, x: f64, v: f64| {
            format!(
                r#"(name: "{name}", material: "rubber", shape: Box(min: ({x:?}, 0), max: ({:?}, 0.3)), spacing: 0.05, formulation: Toy, velocity: ({v:?}, 0))"#,
                x + 0.3
            )
        };
        let (left, right) = (body("left", 0.0, 2.0), body("right", 0.31, -2.0));
        let text = format!(
            r#"(dimension: Two, materials: {{{RUBBER}}}, bodies: [{left}, {right}], contacts: [{contact}],
                plugins: [hourglass_control()], time: (end: 0.1))"#
        );
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("a run");
        let x = positions(&sim);
        let mean = |part: &[DVec3]| part.iter().map(|x| x.x).sum::<f64>() / part.len() as f64;
        mean(&x[36..]) - mean(&x[..36])
    };
    let (bounced, entered) = (scene(r#"Contact(between: ("left", "right"), law: Penalty())"#), scene(""));
    // The middles start 0.31 m apart and come 0.4 m closer in 0.1 s where nothing is in the way.
    assert!((entered + 0.09).abs() < 1e-9, "{entered}");
    assert!(bounced > 0.3, "{bounced}");
}

#[test]
fn it_is_coupled_to_fluids_in_short_steps() {
    let text = format!(
        r#"(dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 2.0), {RUBBER}}},
            bodies: [
                (name: "water", material: "water", spacing: 0.05, formulation: Fluid,
                 shape: Difference(Box(min: (0, 0), max: (1, 1)), Box(min: (0.35, 0.35), max: (0.65, 0.65)))),
                (name: "block", material: "rubber", spacing: 0.05, formulation: FORMULATION,
                 shape: Box(min: (0.35, 0.35), max: (0.65, 0.65)), plugins: [hourglass_control()]),
            ],
            conditions: [InitialVelocity(on: Select(body: "water"), value: ("sin(2*pi*y)", "0.3"))],
            time: (end: 1))"#
    );
    for sim in alike(&text, 60, 1e-7) {
        assert!(sim.sub_steps().is_some_and(|(_, short)| short > sim.clock().step));
        assert!(sim.ledger().total_named("strain") > 0.0);
        assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
    }
}

/// A strip that is pulled apart.
const STRIP: &str = r#"(dimension: Two,
    materials: {"metal": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Linear(yield_stress: 2e8, modulus: 5e8))},
    bodies: [(name: "strip", material: "metal", shape: Box(min: (0, 0), max: (0.02, 0.006)), spacing: 0.001, formulation: FORMULATION,
              plugins: [failure(criterion: MaximumPrincipalStrain(limit: 0.02), growth: CrackSpeed(), then: NoTension)])],
    conditions: [InitialVelocity(on: Select(), value: ("6000*(x - 0.01)", "30*sin(300*x)"))],
    time: (end: 1))"#;

#[test]
fn its_particles_flow_and_fail() {
    for sim in alike(STRIP, 150, 1e-6) {
        let ledger = sim.ledger();
        assert!(ledger.total_named("plastic_work") > 0.0 && ledger.total_named("fracture") > 0.0);
        let damage = sim.world().body_view(BodyId(0)).0.read::<Damage>().expect("a column");
        let failed = damage.iter().filter(|damage| damage.0 == 1.0).count();
        assert!((1..damage.len()).contains(&failed), "{failed} of {} have failed", damage.len());
    }
}

#[test]
fn it_goes_on_from_a_checkpoint_with_the_same_bits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("state.mlc");
    let text = STRIP.replace("FORMULATION", "Toy");
    let whole = run(&text, 120);
    run(&text, 47).save(&path, &Source::new("toy.ron", text.clone())).expect("a checkpoint");
    let mut second = simulation(&text);
    second.restore(&Checkpoint::read(&path).expect("a checkpoint")).expect("a restart");
    second.run(|sim| sim.clock().step < 120).expect("a run");
    assert_eq!(whole.state_hash(), second.state_hash());
}

#[test]
fn two_formulations_of_solids_share_a_scene_and_touch() {
    let body = |name: &str, x: f64, formulation: &str, v: f64| {
        format!(
            r#"(name: "{name}", material: "rubber", shape: Box(min: ({x:?}, 0), max: ({:?}, 0.3)), spacing: 0.05, formulation: {formulation},
                velocity: ({v:?}, 0))"#,
            x + 0.4
        )
    };
    let scene = |first: &str, second: &str| {
        format!(
            r#"(dimension: Two, materials: {{{RUBBER}}}, bodies: [{}, {}],
                contacts: [Contact(between: ("left", "right"), law: Penalty(), friction: 0.2)],
                conditions: [InitialVelocity(on: Select(body: "left"), value: ("2", "3*sin(30*x)"))],
                plugins: [hourglass_control()], time: (end: 1))"#,
            body("left", 0.0, first, 2.0),
            body("right", 0.4, second, -2.0)
        )
    };
    let full = positions(&run(&scene("TotalLagrangian", "TotalLagrangian"), 150));
    for (first, second) in [("Toy", "TotalLagrangian"), ("TotalLagrangian", "Toy")] {
        let sim = run(&scene(first, second), 150);
        let apart = positions(&sim).iter().zip(&full).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(apart < 1e-8, "{first}, {second}: {apart} m apart");
        let account = sim.ledger().accounts().iter().find(|account| account.name == "hourglass");
        let hourglass = account.expect("an account");
        assert!((0..2).all(|k| hourglass.of(BodyId(k)) > 0.0), "{first}, {second}");
    }
}
