//! Decay against the closed form, relaxation against an independent way to the static solution.

use meshless_engine::assembly::build;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::{Checkpoint, Simulation};
use meshless_engine::world::{BodyId, Position, ReferencePosition, Velocity};

fn build_text(text: &str) -> Result<Simulation, String> {
    let registry = Registry::standard().with(hourglass_control::register).with(crate::register);
    parse(Source::new("test.ron", text))
        .and_then(|(scene, source)| build(&scene, &source, &registry))
        .map_err(|error| error.to_string())
}

fn simulation(text: &str) -> Simulation {
    build_text(text).unwrap_or_else(|error| panic!("{error}"))
}

fn account(sim: &Simulation, name: &str) -> f64 {
    let accounts = sim.ledger().accounts();
    accounts.iter().find(|account| account.name == name).map_or(0.0, |account| account.total())
}

/// Young's modulus, Pa, density, kg/m3, and size, m, of the cantilever.
const YOUNG: f64 = 1e6;
const DENSITY: f64 = 1000.0;
const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.125;

/// A cantilever in plane strain, four particles across, with a shear force at its end.
fn cantilever(force: &str, damping: &str, end: f64) -> String {
    format!(
        "Scene(dimension: Two,
        materials: {{\"rubber\": StVenantKirchhoff(density: {DENSITY:?}, young: {YOUNG:?}, poisson: 0.3)}},
        bodies: [Body(name: \"beam\", material: \"rubber\", shape: Box(min: (0.0, 0.0), max: ({LENGTH:?}, {HEIGHT:?})),
            spacing: 0.03125, formulation: TotalLagrangian, plugins: [hourglass_control()])],
        conditions: [Fix(on: Select(face: MinX)), Force(on: Select(face: MaxX), value: (0.0, {force}))],
        plugins: [{damping}], time: (end: {end:?}))"
    )
}

/// First circular frequency of the cantilever, 1/s (Euler-Bernoulli).
fn first_frequency() -> f64 {
    let plane_modulus = YOUNG / (1.0 - 0.3 * 0.3);
    3.516 / LENGTH.powi(2) * (plane_modulus * HEIGHT.powi(2) / (12.0 * DENSITY)).sqrt()
}

fn tip(sim: &Simulation) -> f64 {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let x = view.read::<Position>().expect("positions");
    let reference = view.read::<ReferencePosition>().expect("positions");
    let loaded = rows.filter(|&row| reference[row].0.x > LENGTH - 0.03125);
    let moved: Vec<f64> = loaded.map(|row| x[row].0.y - reference[row].0.y).collect();
    moved.iter().sum::<f64>() / moved.len() as f64
}

#[test]
fn velocity_decays_at_the_rate_within_the_window_and_every_joule_is_booked() {
    let text = "Scene(dimension: Two,
        materials: {\"rubber\": StVenantKirchhoff(density: 1000.0, young: 1.0e6, poisson: 0.3)},
        bodies: [Body(name: \"block\", material: \"rubber\", shape: Box(min: (0.0, 0.0), max: (1.0, 1.0)),
            spacing: 0.125, formulation: TotalLagrangian, velocity: (2.0, 1.0),
            plugins: [local_damping(rate: 30.0, from: 0.01005, until: 0.05005)])],
        time: (end: 0.1, step: Fixed(1.0e-4)))";
    let mut sim = simulation(text);
    sim.run(|_| true).expect("a run");
    let (view, rows) = sim.world().body_view(BodyId(0));
    let wanted = DVec3::new(2.0, 1.0, 0.0) * (-30.0_f64 * 0.04).exp();
    for v in &view.read::<Velocity>().expect("velocities")[rows] {
        assert!((v.0 - wanted).length() < 1e-12, "{}", v.0);
    }
    let lost = 0.5 * 1000.0 * (5.0 - wanted.length_squared());
    assert!((account(&sim, "local_damping") - lost).abs() < 1e-9 * lost);
    assert!(sim.ledger().relative_error().abs() < 1e-12);
}

#[test]
fn prescribed_motion_is_not_damped() {
    let text = "Scene(dimension: Two,
        materials: {\"rubber\": StVenantKirchhoff(density: 1000.0, young: 1.0e6, poisson: 0.3)},
        bodies: [Body(name: \"block\", material: \"rubber\", shape: Box(min: (0.0, 0.0), max: (1.0, 1.0)),
            spacing: 0.125, formulation: TotalLagrangian, velocity: (0.0, 1.0))],
        conditions: [Velocity(on: Select(), value: (2.0, None))],
        plugins: [local_damping(rate: 30.0)], time: (end: 0.1, step: Fixed(1.0e-4)))";
    let mut sim = simulation(text);
    sim.run(|_| true).expect("a run");
    let (view, rows) = sim.world().body_view(BodyId(0));
    for v in &view.read::<Velocity>().expect("velocities")[rows] {
        assert!((v.0 - DVec3::new(2.0, (-3.0_f64).exp(), 0.0)).length() < 1e-12, "{}", v.0);
    }
}

/// The tip deflection under 100 N/m by a constant rate, long after the motion has decayed.
fn static_tip() -> f64 {
    let omega = first_frequency();
    let text = cantilever("-100.0", &format!("local_damping(rate: {:?})", 1.9 * omega), 30.0 / omega);
    let mut sim = simulation(&text);
    sim.run(|_| true).expect("a run");
    assert!(account(&sim, "kinetic") < 1e-16 * account(&sim, "strain"));
    tip(&sim)
}

#[test]
fn relaxation_finds_the_static_solution_of_a_cantilever_in_few_periods() {
    let wanted = static_tip();
    let period = 2.0 * std::f64::consts::PI / first_frequency();
    let ramp = 1.5 * period;
    for (force, damping) in [
        ("-100.0".to_owned(), "local_damping(mode: Relaxation())".to_owned()),
        (format!("\"-100*smoothstep(t/{ramp})\""), format!("local_damping(mode: Relaxation(after: {ramp}))")),
    ] {
        let mut sim = simulation(&cantilever(&force, &damping, 20.0 * period));
        sim.run(|_| true).expect("a run");
        let periods = sim.clock().time / period;
        let error = tip(&sim) / wanted - 1.0;
        assert!(
            sim.stop_reason().is_some_and(|reason| reason.contains("in static equilibrium")),
            "{periods} periods"
        );
        assert!(error.abs() < 1e-5, "{error:e}");
        assert!(periods < 5.0, "{periods}");
        let balance = sim.ledger().relative_error();
        assert!(balance.abs() < 1e-3, "{balance:e}");
    }
}

#[test]
fn a_restart_amid_a_relaxation_continues_bit_for_bit() {
    let text = cantilever("-100.0", "local_damping(mode: Relaxation())", 10.0);
    let (mut whole, mut first, mut second) = (simulation(&text), simulation(&text), simulation(&text));
    for _ in 0..101 {
        first.step().expect("a step");
    }
    let path = std::env::temp_dir().join(format!("local_damping_restart_{}", std::process::id()));
    first.save(&path, &Source::new("test.ron", text)).expect("a checkpoint");
    second.restore(&Checkpoint::read(&path).expect("a checkpoint")).expect("a restart");
    std::fs::remove_file(&path).expect("a checkpoint");
    whole.run(|_| true).expect("a run");
    second.run(|_| true).expect("a run");
    assert_eq!(whole.state_hash(), second.state_hash());
    assert_eq!(whole.stop_reason(), second.stop_reason());
}

#[test]
fn wrong_parameters_are_refused_at_their_place() {
    for (damping, wanted) in [
        ("local_damping(rate: -1.0)", "`rate` must not be negative, found -1 1/s"),
        ("local_damping()", "`rate` is missing"),
        ("local_damping(rate: 1.0, mode: Relaxation())", "it finds its rate itself"),
        (
            "local_damping(rate: 1.0, from: 2.0, until: 1.0)",
            "`until` must be later than `from`, found 1 s and 2 s",
        ),
        ("local_damping(mode: Relaxation(tolerance: 0.0))", "`tolerance` must be from 1e-12 to 0.1, found 0"),
        ("local_damping(mode: Relaxation(after: -1.0))", "`after` must not be negative, found -1 s"),
    ] {
        match build_text(&cantilever("1.0", damping, 1.0)) {
            Ok(_) => panic!("{damping} is accepted"),
            Err(error) => assert!(error.contains(wanted), "{damping}:\n{error}"),
        }
    }
}

#[test]
fn the_scene_beside_the_plugin_comes_to_rest() {
    let mut sim = simulation(include_str!("../scene.ron"));
    sim.run(|_| true).expect("a run");
    assert!(
        sim.stop_reason().is_some_and(|reason| reason.contains("in static equilibrium")),
        "{}",
        sim.clock().time
    );
}

#[test]
fn rigid_bodies_that_go_on_moving_are_named() {
    let text = r#"(dimension: Two, gravity: (0.0, -10.0), materials: {"rubber": NeoHookean(density: 1000.0, young: 1e6, poisson: 0.3)},
        bodies: [
            (name: "block", material: "rubber", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.02, formulation: TotalLagrangian),
            (name: "weight", material: "rubber", shape: Box(min: (0, 0.1), max: (0.2, 0.2)), spacing: 0.02, formulation: Rigid()),
            (name: "floor", material: "rubber", shape: Box(min: (0, -0.1), max: (0.2, 0.0)), spacing: 0.02, formulation: Rigid()),
        ],
        conditions: [Fix(on: Select(body: "floor"))],
        contacts: [(between: ("block", "weight")), (between: ("block", "floor"))],
        plugins: [local_damping(rate: 100.0)], time: (end: 0.001))"#;
    let mut sim = simulation(text);
    sim.run(|_| true).expect("a run");
    let named = |name: &str| {
        sim.warnings().iter().any(|text| text.contains(&format!("does not act on rigid body `{name}`")))
    };
    assert!(named("weight") && !named("floor"), "{:?}", sim.warnings());
}

/// Two cantilevers that touch, the upper one loaded at its end, and a block that nothing loads.
fn beams_and_block(own: &str, common: &str, end: f64) -> String {
    let beam = |name: &str, from: f64, formulation: &str| {
        format!(
            "Body(name: \"{name}\", material: \"rubber\", shape: Box(min: (0.0, {from:?}), max: ({LENGTH:?}, {:?})),
                spacing: 0.03125, formulation: {formulation}, plugins: [hourglass_control(), {own}])",
            from + HEIGHT
        )
    };
    format!(
        "Scene(dimension: Two,
        materials: {{\"rubber\": StVenantKirchhoff(density: {DENSITY:?}, young: {YOUNG:?}, poisson: 0.3)}},
        bodies: [{}, {}, {}], contacts: [Contact(between: (\"upper\", \"lower\"))],
        conditions: [Fix(on: Select(face: MinX)), Force(on: Select(body: \"upper\", face: MaxX), value: (0.0, -10.0))],
        plugins: [{common}], time: (end: {end:?}))",
        beam("upper", 0.0, "TotalLagrangian"),
        beam("lower", -HEIGHT, "UpdatedLagrangian()"),
        beam("block", 1.0, "TotalLagrangian"),
    )
}

#[test]
fn bodies_that_relax_share_their_rate_and_their_end_wherever_the_plugin_is_stated() {
    let relaxation = "local_damping(mode: Relaxation(tolerance: 1e-3))";
    let mut own = simulation(&beams_and_block(relaxation, "", 20.0));
    let mut common = simulation(&beams_and_block("", relaxation, 20.0));
    for sim in [&mut own, &mut common] {
        sim.run(|_| true).expect("a run");
        assert!(sim.stop_reason().is_some_and(|reason| reason.contains("in static equilibrium")));
        assert!(sim.warnings().iter().all(|text| !text.contains("to rest")), "{:?}", sim.warnings());
    }
    // The sums over bodies are taken in another order.
    assert!((tip(&own) / tip(&common) - 1.0).abs() < 1e-6, "{} {}", tip(&own), tip(&common));
    assert!((own.clock().time / common.clock().time - 1.0).abs() < 1e-6);
}

#[test]
fn a_relaxation_that_has_not_come_to_rest_at_the_end_says_so() {
    let told = |damping: &str, end: f64| {
        let mut sim = simulation(&cantilever("-10.0", damping, end));
        sim.run(|_| true).expect("a run");
        let told = sim.warnings().iter().find(|text| text.contains("has not brought the bodies to rest"));
        (told.cloned(), tip(&sim))
    };
    assert!(told("local_damping(mode: Relaxation(stop: false))", 0.2).0.is_none());
    assert!(told("local_damping(rate: 1.0)", 0.2).0.is_none());
    let (_, whole) = told("local_damping(mode: Relaxation())", 20.0);
    let percent = |text: &str| -> f64 {
        let (_, rest) = text.split_once("are some ").expect("how much");
        rest.split(' ').next().and_then(|number| number.parse().ok()).expect("a number")
    };
    for end in [0.8, 1.6] {
        let (text, found) = told("local_damping(mode: Relaxation())", end);
        let (off, said) = (100.0 * (1.0 - found / whole), percent(&text.expect("a warning")));
        assert!(said > off && said < 2.0 * off, "{end} s: {said} % said, {off} % off");
    }
    let (text, found) = told("local_damping(mode: Relaxation())", 3.0);
    assert!(text.is_none() && (found / whole - 1.0).abs() < 1e-3, "{text:?} {}", found / whole - 1.0);
}

#[test]
fn a_fluid_that_is_to_lose_its_motion_is_not_said_to_shake() {
    let text = "(dimension: Two, materials: {\"water\": Fluid(density: 1000.0, sound_speed: 20.0)},
        bodies: [(name: \"drop\", material: \"water\", shape: Box(min: (0, 0), max: (0.2, 0.2)), spacing: 0.02,
            velocity: (1.0, 0.5), formulation: Fluid, plugins: [local_damping(rate: 3.0)])], time: (end: 0.5))";
    let mut sim = simulation(text);
    sim.run(|_| true).expect("a run");
    let kept = (-2.0 * 3.0 * sim.clock().time).exp();
    let start = 0.5 * 40.0 * 1.25;
    let damped = account(&sim, "local_damping");
    assert!((damped - start * (1.0 - kept)).abs() < 1e-9 * start, "{damped}");
    assert!(!sim.warnings().iter().any(|text| text.contains("has been lost")), "{:?}", sim.warnings());
}
