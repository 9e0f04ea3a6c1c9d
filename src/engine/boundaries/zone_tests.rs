//! Relaxation zones: the law of decay, a channel between an outlet and an inlet, restarts, and errors.

use glam::DVec3;

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::{Checkpoint, Simulation};
use crate::world::{BodyId, Mass, Position, Velocity};

fn build_text(text: &str) -> Result<Simulation, String> {
    parse(Source::new("zone.ron", text))
        .and_then(|(scene, source)| build(&scene, &source, &Registry::standard()))
        .map_err(|error| error.to_string())
}

fn simulation(text: &str) -> Simulation {
    build_text(text).unwrap_or_else(|error| panic!("{error}"))
}

/// Positions and velocities of the first body, and its mean velocity by mass.
fn flow(sim: &Simulation) -> (Vec<(DVec3, DVec3)>, DVec3) {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (x, v) = (view.read::<Position>().unwrap(), view.read::<Velocity>().unwrap());
    let mass = view.read::<Mass>().unwrap();
    let momentum: DVec3 = rows.clone().map(|row| mass[row].0 * v[row].0).sum();
    let all: f64 = rows.clone().map(|row| mass[row].0).sum();
    (rows.map(|row| (x[row].0, v[row].0)).collect(), momentum / all)
}

/// A drop that moves too slowly for its particles to act on each other within the run.
#[test]
fn each_particle_decays_at_the_rate_of_its_place() {
    let mut sim = simulation(
        r#"(dimension: Two, materials: {"water": Fluid(density: 1000, sound_speed: 1e-4)},
            bodies: [(name: "water", material: "water", spacing: 0.1, formulation: Fluid, velocity: (1e-8, 2e-8),
                      shape: Box(min: (0, 0), max: (0.3, 2)))],
            conditions: [RelaxationZone(min: (-1, 0.5), max: (1, 1.5), along: (0, 3), value: ("3e-8*x", None), rate: 4),
                         RelaxationZone(min: (-1, 1.5), max: (1, 2), along: (0, -1), value: (0, 0), rate: 2)],
            time: (end: 0.5, step: Fixed(0.01)))"#,
    );
    sim.run(|_| true).unwrap();
    for (x, v) in flow(&sim).0 {
        let expected = if x.y > 1.5 {
            let s = (2.0 - x.y) / 0.5;
            DVec3::new(1e-8, 2e-8, 0.0) * (-2.0 * s * s * 0.5f64).exp()
        } else {
            let s = (x.y - 0.5).max(0.0);
            let decay = (-4.0 * s * s * 0.5f64).exp();
            DVec3::new(3e-8 * x.x + (1e-8 - 3e-8 * x.x) * decay, 2e-8, 0.0)
        };
        assert!(v.distance(expected) < 1e-5 * 2e-8, "{x} {v} {expected}");
    }
    let supplied = sim.ledger().total_named("relaxation_zone");
    assert!(supplied < 0.0 && sim.ledger().relative_error().abs() < 1e-9, "{supplied}");
}

/// A channel 0.1 m high with no-slip walls and a bar across a quarter of it; Re 10.
fn channel(spacing: f64, value: &str, start: &str, end: f64) -> String {
    format!(
        r#"(dimension: Two, domain: (min: (-0.2, -1), max: (0.4, 1), periodic: [X]),
            materials: {{"oil": Fluid(density: 1000, viscosity: 1, sound_speed: 2)}},
            bodies: [(name: "oil", material: "oil", spacing: {spacing}, formulation: Fluid(pressure: 40),
                      shape: Difference(Box(min: (-0.2, 0), max: (0.4, 0.1)), Box(min: (0.1, 0), max: (0.14, 0.03)))),
                     (name: "walls", material: "none", spacing: {spacing}, formulation: Wall(slip: No, suction: true),
                      shape: Union([Box(min: (-0.2, -0.04), max: (0.4, 0)), Box(min: (0.1, 0), max: (0.14, 0.03)),
                                    Box(min: (-0.2, 0.1), max: (0.4, 0.14))]))],
            conditions: [{start} RelaxationZone(min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: ({value}, 0))],
            time: (end: {end}))"#
    )
}

const PROFILE: &str = r#""0.6*y*(0.1 - y)/0.01""#;

#[test]
fn an_inlet_has_the_flux_and_the_profile_that_are_given_and_every_joule_is_booked() {
    let start = format!(r#"InitialVelocity(on: Select(body: "oil"), value: ({PROFILE}, 0)),"#);
    let mut sim = simulation(&channel(0.005, PROFILE, &start, 3.0));
    assert!(sim.warnings().iter().all(|text| !text.contains("RelaxationZone")), "{:?}", sim.warnings());
    let (mut mean, mut last, mut time) = (0.0, [0.0; 10], 0.0);
    sim.run(|sim| {
        if sim.clock().time > 2.0 {
            let (dt, (particles, all)) = (sim.clock().dt, flow(sim));
            // The flux of the whole channel is that through every plane: the mean over its length.
            mean += dt * all.x * particles.len() as f64 * 25e-6 / 0.6;
            for (k, sum) in last.iter_mut().enumerate() {
                let row = particles
                    .iter()
                    .filter(|(x, _)| (-0.04..0.0).contains(&((x.x + 0.2).rem_euclid(0.6) - 0.2)));
                let row = row.filter(|(x, _)| (x.y / 0.01) as usize == k);
                let (n, excess) =
                    row.fold((0.0, 0.0), |(n, sum), (x, v)| (n + 1.0, sum + v.x - 60.0 * x.y * (0.1 - x.y)));
                *sum += dt * excess / f64::max(n, 1.0);
            }
            time += dt;
        }
        true
    })
    .unwrap();
    let flux = mean / time;
    // The mean in the zone is that of particles, which are uneven by 1 % without shifting.
    assert!((flux / 0.01 - 1.0).abs() < 0.015, "{flux}");
    for excess in last {
        assert!((excess / time).abs() < 0.003, "{:?}", last.map(|sum| sum / time));
    }
    assert!(sim.ledger().relative_error().abs() < 0.01, "{}", sim.ledger().relative_error());
    assert!(sim.ledger().total_named("relaxation_zone") > 0.0);
}

#[test]
fn a_value_that_ceases_to_be_finite_is_an_error_that_names_the_zone() {
    let mut sim = simulation(&channel(0.01, r#""sqrt(0.05 - t)""#, "", 0.1));
    let error = sim.run(|_| true).expect_err("a value without limit").to_string();
    assert!(error.contains("`RelaxationZone` failed: the value must be finite, found (NaN"), "{error}");
}

#[test]
fn a_restart_goes_on_bit_for_bit() {
    let text = channel(0.01, PROFILE, "", 0.3);
    let (mut whole, mut first, mut second) = (simulation(&text), simulation(&text), simulation(&text));
    for _ in 0..37 {
        first.step().expect("a step");
    }
    let path = std::env::temp_dir().join(format!("relaxation_zone_{}", std::process::id()));
    first.save(&path, &Source::new("zone.ron", text)).expect("a checkpoint");
    second.restore(&Checkpoint::read(&path).expect("a checkpoint")).expect("a restart");
    std::fs::remove_file(&path).expect("a checkpoint");
    whole.run(|_| true).expect("a run");
    second.run(|_| true).expect("a run");
    assert_eq!(whole.state_hash(), second.state_hash());
}

#[test]
fn a_flow_that_does_not_fit_is_noticed() {
    let mut closed = channel(0.01, "0.1", "", 3.2);
    closed = closed.replace("Box(min: (0.1, 0), max: (0.14, 0.03))", "Box(min: (0.1, 0), max: (0.14, 0.1))");
    let mut sim = simulation(&closed);
    sim.run(|_| true).unwrap();
    for message in ["does not hold its velocity", "m/s off its velocity, which sends out a sound wave"] {
        assert!(sim.warnings().iter().any(|text| text.contains(message)), "{:?}", sim.warnings());
    }
}

#[test]
fn what_cannot_work_is_an_error_or_a_warning_at_check() {
    let whole = channel(0.01, "0.1", "", 1.0);
    let zone = "min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (0.1, 0)";
    assert!(whole.contains(zone));
    let error = |wrong: &str| build_text(&whole.replace(zone, wrong)).err().unwrap_or_default();
    for (wrong, message) in [
        ("min: (0, 0), max: (0, 0.1), along: (1, 0), value: (0.1, 0)", "`max` must exceed `min`"),
        ("min: (-0.2, 0), max: (0, 0.1), along: (0, 0), value: (0.1, 0)", "`along` must not be zero"),
        ("min: (-0.2, 0), max: (0, 0.1), along: (0, 1), value: (0.1, 0)", "`rate` is missing"),
        (
            "min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (0.1, 0), rate: -1",
            "`rate` must be positive",
        ),
        ("min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (\"1/(y - y)\", 0)", "must be finite"),
        ("min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (None, None)", "no axis has a value"),
        (
            "body: \"walls\", min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (0.1, 0)",
            "`walls` is not a fluid",
        ),
        ("body: \"wine\", min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (0.1, 0)", "wine"),
    ] {
        assert!(error(wrong).contains(message), "{wrong}\n{}", error(wrong));
    }
    for (odd, message) in [
        ("min: (-0.2, 0.2), max: (0, 0.3), along: (1, 0), value: (0.1, 0)", "no fluid is in the"),
        ("min: (-0.2, 0), max: (-0.15, 0.1), along: (1, 0), value: (0.1, 0)", "less than 10 spacings"),
        ("min: (-0.2, 0), max: (0, 0.1), along: (-1, 0), value: (0.1, 0)", "is against `along`"),
        ("min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (None, 0)", "nothing holds the flux"),
        ("min: (-0.2, 0), max: (0, 0.08), along: (1, 0), value: (0.1, 0)", "can flow past the zone"),
        (
            "min: (-0.2, 0), max: (0, 0.1), along: (1, 0), value: (\"0.1*smoothstep(10*t)\", 0)",
            "compresses it by",
        ),
    ] {
        let sim = simulation(&whole.replace(zone, odd));
        assert!(sim.warnings().iter().any(|text| text.contains(message)), "{odd}\n{:?}", sim.warnings());
    }
    let bar = "Box(min: (0.1, 0), max: (0.14, 0.03))";
    // Of the six rows within 3 spacings of the middle of the bar, four lack 0.3, with weights of 1/2 and 5/6.
    let in_zone = simulation(&whole.replace(bar, "Box(min: (-0.1, 0), max: (-0.06, 0.03))"));
    let is_uneven = |sim: &Simulation| {
        sim.warnings().iter().any(|text| text.contains("is 27 % less 120 mm behind its beginning"))
    };
    assert!(is_uneven(&in_zone) && !is_uneven(&simulation(&whole)), "{:?}", in_zone.warnings());
    let twice =
        whole.replace("conditions: [", r#"conditions: [MeanVelocity(bodies: ["oil"], value: (0.1, None)), "#);
    let error = build_text(&twice).err().unwrap_or_default();
    assert!(error.contains("has a mean velocity along x already, by a `MeanVelocity`"), "{error}");
}

/// A column of liquid without friction whose velocity swings by a third of its mean, in twelve times the time
/// of sound through the period.
#[test]
fn a_flux_follows_one_that_pulsates() {
    let zone = |from: f64, to: f64| {
        let value = "0.1*(1 + 0.3*sin(2*pi*t/1.2))";
        format!(
            r#"RelaxationZone(min: ({from}, 0), max: ({to}, 0.1), along: (1, 0), value: ("{value}", 0)),"#
        )
    };
    assert_follows(&zone(-0.2, 0.0));
    assert_follows(&(zone(-0.2, 0.0) + &zone(0.0, 0.2)));
}

fn assert_follows(zones: &str) {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, domain: (min: (-0.2, -1), max: (0.4, 1), periodic: [X]),
            materials: {{"oil": Fluid(density: 1000, sound_speed: 6)}},
            bodies: [(name: "oil", material: "oil", spacing: 0.01, formulation: Fluid(pressure: 40), velocity: (0.1, 0),
                      shape: Box(min: (-0.2, 0), max: (0.4, 0.1))),
                     (name: "walls", material: "none", spacing: 0.01, formulation: Wall(slip: Free, suction: true),
                      shape: Union([Box(min: (-0.2, -0.04), max: (0.4, 0)), Box(min: (-0.2, 0.1), max: (0.4, 0.14))]))],
            conditions: [{zones}],
            time: (end: 3.6))"#
    ));
    let (mut sine, mut cosine, mut time) = (0.0, 0.0, 0.0);
    sim.run(|sim| {
        let (dt, t) = (sim.clock().dt, sim.clock().time);
        if t > 1.2 {
            let (phase, flow) = (2.0 * std::f64::consts::PI * t / 1.2, flow(sim).1.x);
            (sine, cosine, time) =
                (sine + dt * flow * phase.sin(), cosine + dt * flow * phase.cos(), time + dt);
        }
        true
    })
    .unwrap();
    let (sine, cosine) = (2.0 * sine / time / 0.03, 2.0 * cosine / time / 0.03);
    assert!((sine - 1.0).abs() < 0.05 && cosine.abs() < 0.1, "{sine} {cosine}");
}
