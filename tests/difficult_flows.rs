//! Flows that were silently wrong: thin bodies beside shifting, curved interfaces, walls that single
//! particles passed, tilted surfaces, rows that break up.

mod common;

use common::simulation;
use meshless::scene::Source;
use meshless::simulation::Simulation;
use meshless::world::{BodyId, Position, Removed, Velocity};

fn built(text: &str) -> Simulation {
    simulation(&Source::new("scene.ron", text))
}

fn run(sim: &mut Simulation, end: f64) {
    sim.run(|sim| sim.clock().time < end).unwrap_or_else(|error| panic!("{error:#}"));
}

fn says(sim: &Simulation, part: &str) -> bool {
    sim.warnings().iter().any(|text| text.contains(part))
}

/// Asserts that the first body has all of its particles, and that their centres are within a box, m.
fn assert_within(sim: &Simulation, low: [f64; 3], high: [f64; 3]) {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (x, removed) = (view.read::<Position>().expect("places"), view.read::<Removed>().expect("marks"));
    for row in rows {
        let x = x[row].0.to_array();
        let inside = (0..3).all(|k| (low[k]..=high[k]).contains(&x[k]));
        assert!(removed[row] == Removed::NO && inside, "{x:?}");
    }
}

/// A soft beam, two particles of the oil thick, in a driven channel whose oil is shifted, in `sub_steps` or
/// one step for all.
fn shifted_beam(time: &str) -> Simulation {
    built(&format!(
        r#"(dimension: Two, domain: (min: (0.0, -0.06), max: (0.4, 0.16), periodic: [X]),
        materials: {{"oil": Fluid(density: 1000.0, sound_speed: 4.0, viscosity: 1.0), "rubber": NeoHookean(density: 1200.0, young: 40000.0, poisson: 0.4)}},
        bodies: [
            (name: "oil", material: "oil", shape: Difference(Box(min: (0.0, 0.0), max: (0.4, 0.1)), Box(min: (0.15, 0.0), max: (0.16, 0.05))), spacing: 0.005,
             formulation: Fluid, plugins: [density_diffusion(), particle_shifting(), tensile_control()]),
            (name: "beam", material: "rubber", shape: Box(min: (0.15, -0.02), max: (0.16, 0.05)), spacing: 0.0025, formulation: TotalLagrangian,
             plugins: [hourglass_control()]),
            (name: "lower", material: "wall", shape: Difference(Box(min: (0.0, -0.02), max: (0.4, 0.0)), Box(min: (0.15, -0.04), max: (0.16, 1.0))),
             spacing: 0.005, formulation: Wall(slip: No, suction: true)),
            (name: "upper", material: "wall", shape: Box(min: (0.0, 0.1), max: (0.4, 0.12)), spacing: 0.005, formulation: Wall(slip: No, suction: true)),
        ],
        conditions: [
            Fix(on: Select(body: "beam", within: Box(min: (-1, -1), max: (1, 0.0)))),
            BodyForce(on: Select(body: "oil"), value: ("0.6*smoothstep(t/0.3)", 0.0)),
        ],
        time: ({time}))"#
    ))
}

#[test]
fn shifting_beside_a_thin_body_is_no_source_of_energy() {
    for (time, end) in [("end: 0.75", 0.75), ("end: 0.4, sub_steps: 1", 0.4)] {
        let mut sim = shifted_beam(time);
        run(&mut sim, end);
        let [given, drive] = ["particle_shifting", "body_force"].map(|name| sim.ledger().total_named(name));
        // It gave 1.3 times what the drive supplied; here some millionths.
        assert!(-given < 1e-3 * drive, "{time}: {given} of {drive}");
        assert_within(&sim, [f64::NEG_INFINITY, 0.0, f64::NEG_INFINITY], [f64::INFINITY, 0.1, f64::INFINITY]);
        assert!(!says(&sim, "is inside of"), "{time}: {:?}", sim.warnings());
    }
}

#[test]
fn a_curved_interface_is_shifted_without_tensile_control() {
    // Half a wave of the interface, as a polygon with sides of a spacing.
    let wave: Vec<String> = (0..=40)
        .map(|k| f64::from(k) * 0.0125)
        .map(|x| format!("({x:?}, {:?})", 0.5 + 0.02 * (4.0 * std::f64::consts::PI * x).cos()))
        .collect();
    let back: Vec<String> = wave.iter().rev().cloned().collect();
    let mut sim = built(&format!(
        r#"(dimension: Two, gravity: (0.0, -9.81),
        materials: {{"heavy": Fluid(density: 1000.0, sound_speed: 60.0, viscosity: 0.5), "light": Fluid(density: 500.0, sound_speed: 60.0, viscosity: 0.25)}},
        bodies: [
            (name: "light", material: "light", shape: Polygon(points: [(0.0, 0.0), (0.5, 0.0), {}]), spacing: 0.0125, formulation: Fluid),
            (name: "heavy", material: "heavy", shape: Polygon(points: [(0.5, 1.0), (0.0, 1.0), {}]), spacing: 0.0125, formulation: Fluid),
            (name: "tank", material: "wall", shape: Difference(Box(min: (-0.05, -0.05), max: (0.55, 1.05)), Box(min: (0, 0), max: (0.5, 1.0))),
             spacing: 0.0125, formulation: Wall(slip: Free, suction: true)),
        ],
        plugins: [density_diffusion(), particle_shifting()],
        time: (end: 0.025))"#,
        back.join(", "),
        wave.join(", ")
    ));
    // It exploded within 18 steps.
    run(&mut sim, 0.025);
    assert!(sim.clock().step >= 190, "{}", sim.clock().step);
    for body in [BodyId(0), BodyId(1)] {
        let (view, rows) = sim.world().body_view(body);
        let velocity = view.read::<Velocity>().expect("velocities");
        let fastest = rows.map(|row| velocity[row].0.length()).fold(0.0, f64::max);
        // What falls freely has 0.25 m/s.
        assert!(fastest < 0.25, "{fastest} m/s");
    }
}

#[test]
fn no_particle_of_a_dam_break_in_space_passes_a_wall() {
    let mut sim = built(
        r#"(dimension: Three, gravity: (0.0, 0.0, -9.81), domain: (min: (-0.5, -0.5, -0.5), max: (1.7, 0.9, 2.0), outside: Remove),
        materials: {"water": Fluid(density: 1000.0, viscosity: 1e-3)},
        bodies: [
            (name: "water", material: "water", shape: Box(min: (0.0, 0.0, 0.0), max: (0.3, 0.4, 0.4)), spacing: 0.04, formulation: Fluid,
             plugins: [density_diffusion(), artificial_viscosity(alpha: 0.02, beta: 0.0)]),
            (name: "tank", material: "wall", spacing: 0.04, formulation: Wall(slip: Free),
             shape: Difference(Box(min: (-0.16, -0.16, -0.16), max: (1.36, 0.56, 0.6)), Box(min: (0.0, 0.0, 0.0), max: (1.2, 0.4, 1.0)))),
        ],
        time: (end: 1.0))"#,
    );
    run(&mut sim, 1.0);
    assert_within(&sim, [0.0; 3], [1.2, 0.4, 0.6]);
    assert!(sim.warnings().is_empty(), "{:?}", sim.warnings());
}

#[test]
fn a_dam_break_without_plugins_says_what_it_lacks_and_what_comes_of_it() {
    let mut sim = built(
        r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (-0.5, -0.5), max: (2.1, 3.0), outside: Remove),
        materials: {"water": Fluid(density: 1000.0, viscosity: 1e-3)},
        bodies: [
            (name: "water", material: "water", shape: Box(min: (0.0, 0.0), max: (0.4, 0.4)), spacing: 0.02, formulation: Fluid),
            (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(slip: Free),
             shape: Difference(Box(min: (-0.08, -0.08), max: (1.68, 1.0)), Box(min: (0.0, 0.0), max: (1.6, 2.0)))),
        ],
        time: (end: 2.0))"#,
    );
    run(&mut sim, 1e-9);
    assert!(says(&sim, "nothing diffuses the density of `water`"), "{:?}", sim.warnings());
    run(&mut sim, 2.0);
    let walls = sim.ledger().total_named("wall_pressure");
    let told =
        ["has reached a Mach number of", "`wall_pressure` has produced energy"].map(|part| says(&sim, part));
    assert!(walls > 0.0 || told == [true; 2], "{walls} J: {:?}", sim.warnings());
}

#[test]
fn a_channel_whose_rows_break_up_says_that_friction_is_off() {
    let mut sim = built(
        r#"(dimension: Two, domain: (min: (0.0, -0.12), max: (0.18, 0.42), periodic: [X]),
        materials: {"oil": Fluid(density: 800.0, sound_speed: 5.0, viscosity: 2.4)},
        bodies: [
            (name: "oil", material: "oil", shape: Box(min: (0.0, 0.0), max: (0.18, 0.3)), spacing: 0.015, formulation: Fluid, plugins: [density_diffusion()]),
            (name: "lower", material: "wall", shape: Box(min: (0.0, -0.06), max: (0.18, 0.0)), spacing: 0.015, formulation: Wall(slip: No, suction: true)),
            (name: "upper", material: "wall", shape: Box(min: (0.0, 0.3), max: (0.18, 0.36)), spacing: 0.015, formulation: Wall(slip: No, suction: true)),
        ],
        conditions: [BodyForce(on: Select(body: "oil"), value: (0.13333333333333333, 0.0))],
        time: (end: 30.0))"#,
    );
    run(&mut sim, 30.0);
    let (view, rows) = sim.world().body_view(BodyId(0));
    let velocity = view.read::<Velocity>().expect("velocities");
    let count = rows.len() as f64;
    let mean = rows.map(|row| velocity[row].0.x).sum::<f64>() / count;
    // rho g H^2 / (12 mu) with H = 0.3 m.
    let error = mean / (800.0 * 0.13333333333333333 * 0.09 / (12.0 * 2.4)) - 1.0;
    let text = "the particles of `oil` have become uneven";
    assert!(error.abs() < 0.015 || says(&sim, text), "{error}: {:?}", sim.warnings());
}

/// How much the pressure at a side wall shakes from 1 to 3 s while water sloshes, Pa: rms deviation from its
/// mean over 0.1 s. The surface is tilted at the start.
fn noise(formulation: &str) -> f64 {
    let surface: Vec<String> = (0..=60)
        .map(|k| 1.2 - 0.02 * f64::from(k))
        .map(|x| format!("({x:?}, {:?})", 0.4 + 0.02 * (std::f64::consts::PI * x / 1.2).cos()))
        .collect();
    let mut sim = built(&format!(
        r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (-0.5, -0.5), max: (1.7, 1.5)),
        materials: {{"water": Fluid(density: 1000.0, viscosity: 0.001)}},
        bodies: [
            (name: "water", material: "water", shape: Polygon(points: [(0.0, 0.0), (1.2, 0.0), {}]), spacing: 0.02, formulation: {formulation},
             plugins: [density_diffusion(), artificial_viscosity(alpha: 0.02, beta: 0.0)]),
            (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(slip: Free),
             shape: Difference(Box(min: (-0.08, -0.08), max: (1.28, 0.6)), Box(min: (0.0, 0.0), max: (1.2, 1.0)))),
        ],
        probes: [Probe(name: "p", at: (0.0, 0.1), quantity: PressureSensor(diameter: 0.04, normal: (1, 0)), every: 1.0)],
        time: (end: 3.0))"#,
        surface.join(", ")
    ));
    let mut samples: Vec<f64> = Vec::new();
    sim.run(|sim| {
        if sim.clock().time >= 0.95 + 0.01 * samples.len() as f64 {
            samples.push(sim.measure("p").expect("a probe")[0].1);
        }
        sim.clock().time < 3.0
    })
    .unwrap_or_else(|error| panic!("{error:#}"));
    let off = |window: &[f64]| (window[5] - window.iter().sum::<f64>() / window.len() as f64).powi(2);
    let squares: Vec<f64> = samples.windows(11).map(off).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn water_below_a_tilted_surface_starts_as_quietly_as_from_its_stated_pressure() {
    let own = noise("Fluid");
    let stated = noise(r#"Fluid(pressure: "9810*(0.4 + 0.02*cos(pi*x/1.2) - y)")"#);
    // From the pressure below its highest point it was 141 Pa.
    assert!(own < 1.1 * stated && own < 18.0, "{own} Pa, {stated} Pa");
}

#[test]
fn the_force_on_a_wedge_that_enters_water_is_that_of_the_similarity_solution() {
    let mut sim = built(
        r#"(dimension: Two, domain: (min: (-1.5, -1.5), max: (1.5, 1.5), outside: Remove),
        materials: {"water": Fluid(density: 1000.0, sound_speed: 50.0), "steel": Steel()},
        bodies: [
            (name: "water", material: "water", shape: Box(min: (-1.0, -1.0), max: (1.0, 0.0)), spacing: 0.01, formulation: Fluid(pressure: 0.0),
             plugins: [density_diffusion(), artificial_viscosity(alpha: 0.02, beta: 0.0)]),
            (name: "wedge", material: "steel", shape: Polygon(points: [(0.0, 0.005), (0.3, 0.1782050807568877), (-0.3, 0.1782050807568877)]), spacing: 0.01, lattice: Regular,
             formulation: Wall(slip: Free), velocity: (0.0, -1)),
            (name: "tank", material: "wall", shape: Difference(Box(min: (-1.04, -1.04), max: (1.04, 0.3)), Box(min: (-1.0, -1.0), max: (1.0, 1.0))),
             spacing: 0.01, formulation: Wall(slip: Free)),
        ],
        probes: [Probe(name: "f", on: Select(body: "wedge"), quantity: FluidForce, every: 1.0)],
        time: (end: 0.1))"#,
    );
    let mut ratios = Vec::new();
    sim.run(|sim| {
        let time = sim.clock().time;
        if time >= 0.06 {
            // The tip touches the water at 5 ms.
            ratios.push(sim.measure("f").expect("a probe")[1].1 / (1000.0 * (time - 0.005)));
        }
        time < 0.1
    })
    .unwrap_or_else(|error| panic!("{error:#}"));
    let error = ratios.iter().sum::<f64>() / ratios.len() as f64 / 14.139 - 1.0;
    // 16 % before; the walls of this tank are near, which makes 6 % of it.
    assert!(error.abs() < 0.1, "{error}");
}

/// Product of the semi-axes of a drop of 1 m in radius, drawn out to some three times its length, and whether
/// the user has been told that its particles are drawn apart.
fn drawn_drop(lattice: &str) -> (f64, bool) {
    let mut sim = built(&format!(
        r#"(dimension: Two, materials: {{"water": Fluid(density: 1.0, sound_speed: 10.0)}},
        bodies: [(name: "drop", material: "water", shape: Sphere(center: (0, 0), radius: 1.0), spacing: 0.08, lattice: {lattice},
                  formulation: Fluid(pressure: "0.5*max(1 - x*x - y*y, 0)"), plugins: [density_diffusion()])],
        conditions: [InitialVelocity(on: Select(), value: ("x", "-y"))],
        record: (every: 0.1), time: (end: 1.6))"#
    ));
    run(&mut sim, 1.6);
    let (view, rows) = sim.world().body_view(BodyId(0));
    let x = view.read::<Position>().expect("places");
    let count = rows.len() as f64;
    // Twice the root mean square of the coordinates, as for an ellipse that is evenly filled.
    let [a, b] =
        [0, 1].map(|k| 2.0 * (rows.clone().map(|row| x[row].0[k].powi(2)).sum::<f64>() / count).sqrt());
    assert!((2.5..3.5).contains(&a), "{a}");
    (a * b, says(&sim, "have been drawn apart"))
}

/// A liquid keeps its area, which is one in units of pi.
#[test]
fn a_lattice_that_is_drawn_apart_is_warned_of_and_a_relaxed_one_is_not() {
    let (area, told) = drawn_drop("Regular");
    assert!(area < 1.05 || told, "silently {area}");
    let (area, told) = drawn_drop("Relaxed(seed: 1, iterations: 30)");
    assert!((area - 1.0).abs() < 0.03 && !told, "{area}, told: {told}");
}

/// Velocity of a disc that a force drives along a channel without flux, 2.7 times as wide, over that of Faxen
/// (1946), at a speed of sound, m/s, in the mean of the last passage of sound through the channel (it swings
/// with that period) or of 25 s; and whether the user has been told that the oil is compressed.
fn driven_disc(sound: f64) -> (f64, bool) {
    let (radius, half, velocity) = (0.1, 0.8 / 3.0, 1e-4);
    let k: f64 = radius / half;
    let resistance = (1.0 / k).ln() - 0.9157 + 1.7244 * k.powi(2) - 1.7302 * k.powi(4) + 2.4056 * k.powi(6)
        - 4.5913 * k.powi(8);
    let force = 4.0 * std::f64::consts::PI * velocity / resistance;
    let end = 4.0 * half;
    let mut sim = built(&format!(
        r#"(dimension: Two, domain: (min: (-{end:?}, -1.0), max: ({end:?}, 1.0), periodic: [X]), parameters: {{"h": {half:?}, "dx": "h/8"}},
        materials: {{"oil": Fluid(density: 1000.0, sound_speed: {sound:?}, viscosity: 1.0), "plastic": NeoHookean(density: 1000.0, young: 1e6, poisson: 0.3)}},
        bodies: [
            (name: "oil", material: "oil", shape: Difference(Box(min: (-{end:?}, "-h"), max: ({end:?}, "h")), Sphere(center: (0, 0), radius: {radius:?})),
             spacing: "dx", formulation: Fluid, plugins: [density_diffusion(), particle_shifting()]),
            (name: "walls", material: "wall", shape: Difference(Box(min: (-{end:?}, "-h - 3*dx"), max: ({end:?}, "h + 3*dx")), Box(min: (-9, "-h"), max: (9, "h"))),
             spacing: "dx", formulation: Wall(slip: No, suction: true)),
            (name: "disc", material: "plastic", shape: Sphere(center: (0, 0), radius: {radius:?}), spacing: "dx", formulation: Rigid()),
        ],
        conditions: [Force(on: Select(body: "disc"), value: ({force:?}, 0.0)), MeanVelocity(bodies: ["oil", "disc"], value: (0.0, None))],
        time: (end: 30.0))"#
    ));
    let period = (2.0 * end / sound).min(25.0);
    let place = |sim: &Simulation| {
        let (view, rows) = sim.world().body_view(BodyId(2));
        (sim.clock().time, view.read::<Position>().expect("places")[rows.start].0.x)
    };
    run(&mut sim, 30.0 - period);
    let before = place(&sim);
    run(&mut sim, 30.0);
    let after = place(&sim);
    let speed = (after.1 - before.1) / (after.0 - before.0);
    (speed / velocity, says(&sim, "is compressed unevenly"))
}

/// The disc compresses the oil around it alone: the standard deviation over all of it was 1 %.
#[test]
fn a_small_body_that_compresses_the_oil_around_it_is_warned_of() {
    let (ratio, told) = driven_disc(0.006);
    assert!(ratio < 1.1 || told, "silently {ratio}");
    let (ratio, told) = driven_disc(0.1);
    assert!((ratio - 1.0).abs() < 0.1 && !told, "{ratio}, told: {told}");
}
