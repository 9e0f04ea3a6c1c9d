//! Walls and rigid bodies whose motion is prescribed, from their first step on: the sound that they send
//! out, the work that they do.

use glam::DVec3;

use super::{column, double, simulation};
use crate::formulations::fluid::FlowCloud;
use crate::rigid::RigidBodies;
use crate::simulation::Simulation;
use crate::world::{BodyId, Mass, Velocity};

/// Speed of sound, m/s, density, kg/m3, and speed of the piston, m/s.
const SOUND: f64 = 10.0;
const DENSITY: f64 = 1000.0;
const SPEED: f64 = 0.1;
/// Time within which a smooth start is over, s.
const START: f64 = 0.02;
/// Time until the sound comes back from the other end is four times as long, s.
const END: f64 = 0.05;
/// Width of the tube, m.
const WIDTH: f64 = 0.5;

const WALL: &str = r#"material: "wall", formulation: Wall(slip: Free, suction: true)"#;
const RIGID: &str = r#"material: "rubber", formulation: Rigid()"#;

/// A tube of a liquid without friction, one metre long and periodic across, with a piston on the left.
fn tube(piston: &str, speed: &str, spacing: f64, factor: f64) -> Simulation {
    double(&format!(
        r#"(dimension: Two, domain: (min: (-1, 0), max: (2, {WIDTH}), periodic: [Y]),
            materials: {{"liquid": Fluid(density: {DENSITY}, sound_speed: {SOUND}, eos: Linear),
                "rubber": NeoHookean(density: 1500.0, young: 2.0e5, poisson: 0.3)}},
            bodies: [
                (name: "liquid", material: "liquid", spacing: {spacing}, formulation: Fluid(pressure: 0.0),
                 shape: Box(min: (0, 0), max: (1, {WIDTH}))),
                (name: "piston", {piston}, spacing: {spacing}, shape: Box(min: (-0.2, 0), max: (0, {WIDTH}))),
                (name: "end", {WALL}, spacing: {spacing}, shape: Box(min: (1, 0), max: (1.2, {WIDTH}))),
            ],
            conditions: [Velocity(on: Select(body: "piston"), value: ("{speed}", 0.0))],
            time: (end: {END}, step: Adaptive(factor: {factor})))"#
    ))
}

/// Speed of the piston at a time, m/s: at once, or as `smoothstep`.
fn speed(smooth: bool, time: f64) -> f64 {
    let part = if smooth { (time / START).clamp(0.0, 1.0) } else { 1.0 };
    SPEED * part * part * (3.0 - 2.0 * part)
}

fn expression(smooth: bool) -> String {
    if smooth { format!("{SPEED}*smoothstep(t/{START})") } else { SPEED.to_string() }
}

/// Pressure at a piston of that speed in a liquid at rest, Pa: that of a simple wave, of which that of a
/// shock differs by the third power of the Mach number.
fn exact_pressure(speed: f64) -> f64 {
    SOUND * SOUND * DENSITY * ((speed / SOUND).exp() - 1.0)
}

fn force_on_piston(sim: &Simulation) -> DVec3 {
    let cloud = sim.resources().get::<FlowCloud>();
    cloud.forces_on(BodyId(1)).expect("a wet piston").iter().map(|(force, _)| *force).sum()
}

/// Root mean square error of the force of a run over the force, and the error of the work that the piston
/// does on the liquid over that work.
fn errors(piston: &str, smooth: bool, spacing: f64) -> [f64; 2] {
    let mut sim = tube(piston, &expression(smooth), spacing, 1.0);
    sim.start().expect("a start");
    let kinetic = |sim: &Simulation| -> f64 {
        let (m, v) = (column::<Mass>(sim, 1), column::<Velocity>(sim, 1));
        m.iter().zip(&v).map(|(m, v)| 0.5 * m.0 * v.0.length_squared()).sum()
    };
    let at_start = kinetic(&sim);
    let (mut before, mut error, mut size) = (0.0, 0.0, 0.0);
    sim.run(|sim| {
        let time = sim.clock().time;
        let exact = WIDTH * exact_pressure(speed(smooth, time));
        let dt = time - before;
        error += dt * (-force_on_piston(sim).x - exact).powi(2);
        size += dt * exact * exact;
        before = time;
        true
    })
    .expect("a run");
    let part = sim.clock().time / 1000.0;
    let speeds = (0..1000).map(|k| speed(smooth, part * (f64::from(k) + 0.5)));
    let exact_work: f64 = speeds.map(|speed| part * WIDTH * exact_pressure(speed) * speed).sum();
    // A wall has no mass that its constraint speeds up.
    let own = if piston == RIGID { kinetic(&sim) - at_start } else { 0.0 };
    let work = sim.ledger().total_named("constraints") - own;
    [(error / size).sqrt(), work / exact_work - 1.0]
}

/// A body whose motion is prescribed pushes the liquid as a wall does. The pressure of its particles lacked
/// its acceleration, which is known like that of a wall: forces were off by 25 and 8 %, walls by 10 and 4
/// %.
#[test]
fn a_piston_that_starts_smoothly_has_the_force_of_its_sound_wave() {
    for piston in [WALL, RIGID] {
        let [coarse, fine] = [0.05, 0.025].map(|spacing| errors(piston, true, spacing));
        assert!(coarse[0] < 0.15 && fine[0] < 0.06, "{piston}: {coarse:?} {fine:?}");
        assert!(coarse[1].abs() < 0.04 && fine[1].abs() < 0.015, "{piston}: {coarse:?} {fine:?}");
    }
}

/// At once: the front rings, as it is as steep as particles can tell, and the work has the error of that.
#[test]
fn a_piston_that_starts_at_once_does_the_work_of_its_shock() {
    for piston in [WALL, RIGID] {
        let [coarse, fine] = [0.05, 0.0125].map(|spacing| errors(piston, false, spacing)[1]);
        assert!(coarse.abs() < 0.04 && fine.abs() < 0.01, "{piston}: {coarse} {fine}");
    }
}

/// Momentum is what the force has given, from the first step on, and the first step has no error in the
/// balance but that of the leapfrog: with the square of the step, over the work of that step, which itself
/// has one.
#[test]
fn the_first_step_of_a_piston_is_booked_as_it_is_done() {
    for (piston, smooth) in [(WALL, false), (RIGID, false), (RIGID, true)] {
        let first = |factor: f64| {
            let mut sim = tube(piston, &expression(smooth), 0.05, factor);
            sim.run(|sim| sim.clock().step < 1).expect("a step");
            let [balance, work] =
                [sim.ledger().balance_error(), sim.ledger().total_named("constraints")].map(f64::abs);
            balance / work
        };
        let (long, short) = (first(1.0), first(0.5));
        assert!(long < 0.02 && short < 0.3 * long, "{piston}, {smooth}: {long} {short}");
        let mut sim = tube(piston, &expression(smooth), 0.05, 1.0);
        let (mut impulse, mut force, mut time, mut first) = (DVec3::ZERO, DVec3::ZERO, 0.0, true);
        sim.run(|sim| {
            let now = force_on_both(sim);
            let dt = sim.clock().time - time;
            impulse -= if first { 0.5 * dt * now } else { 0.5 * dt * (force + now) };
            (force, time, first) = (now, sim.clock().time, false);
            let momentum: DVec3 =
                column::<Mass>(sim, 0).iter().zip(column::<Velocity>(sim, 0)).map(|(m, v)| m.0 * v.0).sum();
            let scale = DENSITY * WIDTH * SPEED;
            assert!((momentum - impulse).length() < 1e-12 * scale, "{piston}: {momentum} {impulse}");
            sim.clock().step < 10
        })
        .expect("a run");
    }
}

fn force_on_both(sim: &Simulation) -> DVec3 {
    let cloud = sim.resources().get::<FlowCloud>();
    let on = |body| cloud.forces_on(BodyId(body)).map_or(DVec3::ZERO, |f| f.iter().map(|(f, _)| *f).sum());
    on(1) + on(2)
}

/// A force that is there at once, on a body in a drop: all together have its impulse, from the first step
/// on.
#[test]
fn a_body_that_is_pushed_from_the_start_gives_on_its_impulse() {
    let mut sim = double(
        r#"(dimension: Two, materials: {"oil": Fluid(density: 1000.0, sound_speed: 10.0, viscosity: 30.0),
                "rubber": NeoHookean(density: 1500.0, young: 2.0e5, poisson: 0.3)},
            bodies: [
                (name: "oil", material: "oil", shape: Ring(center: (0, 0), inner: 0.2, outer: 0.5), spacing: 0.04,
                 formulation: Fluid(pressure: "0")),
                (name: "core", material: "rubber", shape: Sphere(center: (0, 0), radius: 0.2), spacing: 0.04, formulation: Rigid()),
            ],
            conditions: [Force(on: Select(body: "core"), value: (50.0, -20.0))],
            time: (end: 0.1))"#,
    );
    sim.run(|sim| {
        let bodies = sim.resources().get::<RigidBodies>();
        let of_core: DVec3 = bodies.iter().map(|body| body.mass * body.state.velocity).sum();
        let (m, v) = (column::<Mass>(sim, 0), column::<Velocity>(sim, 0));
        let of_oil: DVec3 = m.iter().zip(&v).map(|(m, v)| m.0 * v.0).sum();
        let exact = sim.clock().time * DVec3::new(50.0, -20.0, 0.0);
        let error = (of_core + of_oil - exact).length();
        assert!(error <= 1e-10 * exact.length(), "{}: {error}", sim.clock().step);
        true
    })
    .expect("a run");
    assert!(sim.ledger().relative_error().abs() < 5e-3);
}

/// Slowly: the work of a piston is `integral p dV`, and the liquid has it. Rates of compression and forces
/// both have the sum of w x^2 over a square lattice, 0.9974 with the default support, and the factor of
/// pressures, its inverse.
#[test]
fn the_work_of_a_slow_piston_is_that_of_the_pressure_on_its_way() {
    let ratio: f64 = 1.0 / 0.98;
    let exact = SOUND * SOUND * DENSITY * (ratio.ln() + 1.0 / ratio - 1.0);
    for piston in [WALL, RIGID] {
        for spacing in [0.125, 0.0625, 0.03125] {
            let mut sim = simulation(&format!(
                r#"(dimension: Two, domain: (min: (-2, 0), max: (3, 1), periodic: [Y]),
                    materials: {{"liquid": Fluid(density: {DENSITY}, sound_speed: {SOUND}, eos: Linear),
                        "rubber": NeoHookean(density: 1500.0, young: 2.0e5, poisson: 0.3)}},
                    bodies: [
                        (name: "liquid", material: "liquid", spacing: {spacing}, formulation: Fluid, shape: Box(min: (0, 0), max: (1, 1))),
                        (name: "piston", {piston}, spacing: {spacing}, shape: Box(min: (-0.5, 0), max: (0, 1))),
                        (name: "end", {WALL}, spacing: {spacing}, shape: Box(min: (1, 0), max: (1.5, 1))),
                    ],
                    conditions: [Velocity(on: Select(body: "piston"), value: ("0.02/1.5*(1 - cos(2*pi*t/1.5))", 0.0))],
                    time: (end: 1.5))"#
            ));
            sim.run(|_| true).expect("a run");
            for account in ["constraints", "compression"] {
                let found = sim.ledger().total_named(account) / exact;
                assert!((found - 1.0).abs() < 1e-3, "{piston} {spacing} {account}: {found}");
            }
            let walls = sim.ledger().total_named("wall_pressure") / exact;
            assert!(walls.abs() < 1e-4, "{piston} {spacing}: {walls}");
        }
    }
}

/// The same between walls along which the piston slides. Its edges are those of a wall: the fluid there
/// presses on particles of the tank, which move as the piston does, whether it is thick or has two layers. A
/// rigid body had 0.88, 0.96 and 0.97 of the work, with the pressure of gaps in the place of that.
#[test]
fn the_work_of_a_slow_piston_between_walls_is_that_of_the_pressure_on_its_way() {
    let ratio: f64 = 1.0 / 0.98;
    let exact = SOUND * SOUND * DENSITY * (ratio.ln() + 1.0 / ratio - 1.0);
    for (piston, layers) in [(WALL, 4.0), (RIGID, 4.0), (RIGID, 2.0)] {
        for spacing in [0.125, 0.0625, 0.03125] {
            let back = -layers * spacing;
            let thick = 4.0 * spacing;
            let (low, high) = (-thick, 1.0 + thick);
            let mut sim = simulation(&format!(
                r#"(dimension: Two,
                    materials: {{"liquid": Fluid(density: {DENSITY}, sound_speed: {SOUND}, eos: Linear),
                        "rubber": NeoHookean(density: 1500.0, young: 2.0e5, poisson: 0.3)}},
                    bodies: [
                        (name: "liquid", material: "liquid", spacing: {spacing}, formulation: Fluid, shape: Box(min: (0, 0), max: (1, 1))),
                        (name: "piston", {piston}, spacing: {spacing}, shape: Box(min: ({back}, 0), max: (0, 1))),
                        (name: "tank", {WALL}, spacing: {spacing},
                         shape: Difference(Box(min: (-1, {low}), max: ({high}, {high})), Box(min: (-2, 0), max: (1, 1)))),
                    ],
                    conditions: [Velocity(on: Select(body: "piston"), value: ("0.02/1.5*(1 - cos(2*pi*t/1.5))", 0.0))],
                    time: (end: 1.5))"#
            ));
            sim.run(|_| true).expect("a run");
            for account in ["constraints", "compression"] {
                let found = sim.ledger().total_named(account) / exact;
                assert!((found - 1.0).abs() < 0.01, "{piston} {layers} {spacing} {account}: {found}");
            }
            let walls = sim.ledger().total_named("wall_pressure") / exact;
            assert!(walls.abs() < 1e-3, "{piston} {layers} {spacing}: {walls}");
        }
    }
}

/// A box, 10 across, that is pushed along the floor by three spacings: nothing but its buoyancy acts across,
/// to the noise of a pressure that nothing diffuses. In the closed tank without gravity, beside walls with
/// suction, its edges count as those of walls; a third to all of the pressure on its side acted across
/// before. In the open tank they must not: the force had a half of the buoyancy with them.
#[test]
fn a_box_that_is_pushed_along_the_floor_has_its_buoyancy() {
    for (gravity, pressure, suction, height, exact, size) in [
        ("gravity: (0, -9.81),", "", "", 1.0, 392.4, 392.4),
        ("", "(pressure: \"4000\")", ", suction: true", 0.4, 0.0, 800.0),
    ] {
        let top = if height > 0.5 { 0.6 } else { 0.46 };
        let mut sim = simulation(&format!(
            r#"(dimension: Two, {gravity}
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 30.0),
                    "rubber": NeoHookean(density: 1500.0, young: 2.0e5, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.02, formulation: Fluid{pressure},
                     shape: Difference(Box(min: (0, 0), max: (1.2, 0.4)), Box(min: (0.4, 0), max: (0.6, 0.2)))),
                    (name: "box", material: "rubber", formulation: Rigid(), spacing: 0.02, shape: Box(min: (0.4, 0), max: (0.6, 0.2))),
                    (name: "tank", material: "wall", formulation: Wall(slip: Free{suction}), spacing: 0.02,
                     shape: Difference(Box(min: (-0.06, -0.06), max: (1.26, {top})), Box(min: (0, 0), max: (1.2, {height})))),
                ],
                conditions: [Velocity(on: Select(body: "box"), value: ("0.05*smoothstep(t/0.3)", 0.0))],
                time: (end: 1.35))"#
        ));
        let (mut sum, mut count) = (0.0, 0.0);
        sim.run(|sim| {
            if sim.clock().time > 1.0 {
                sum += force_on_piston(sim).y;
                count += 1.0;
            }
            true
        })
        .expect("a run");
        let error = (sum / count - exact) / size;
        assert!(error.abs() < 0.1, "{gravity}: {error}");
    }
}
