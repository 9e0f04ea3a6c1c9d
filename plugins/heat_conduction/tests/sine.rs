//! Decay of sines in bars of every formulation, heat that is conserved, and the stable step.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Mass, ReferencePosition, Temperature};

const FORMULATIONS: [&str; 3] = ["TotalLagrangian()", "UpdatedLagrangian()", "Eulerian()"];

/// Density, specific heat and conductivity: a diffusivity of 1e-4 m2/s.
const HEAT: &str = "specific_heat: 500.0, conductivity: 50.0";
const DIFFUSIVITY: f64 = 1e-4;

fn simulation(text: &str) -> Simulation {
    let registry = Registry::standard().with(heat_conduction::register);
    let built =
        parse(Source::new("bar.ron", text)).and_then(|(scene, source)| build(&scene, &source, &registry));
    built.unwrap_or_else(|error| panic!("{error}"))
}

/// A bar of 1 x 0.3 m with `n` particles along it; `more` goes into the scene.
fn bar(formulation: &str, n: usize, temperature: &str, more: &str) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1, poisson: 0.3)}},
            bodies: [(name: "bar", material: "soft", shape: Box(min: (0, 0), max: (1, 0.3)), spacing: {:?}, formulation: {formulation},
                      plugins: [heat_conduction({HEAT}, temperature: "{temperature}")])],
            {more} time: (end: 250.0))"#,
        1.0 / n as f64
    ))
}

/// Places in the reference configuration, temperatures and masses.
fn particles(sim: &Simulation) -> Vec<(f64, f64, f64)> {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (x, t) = (view.read::<ReferencePosition>().unwrap(), view.read::<Temperature>().unwrap());
    let m = view.read::<Mass>().unwrap();
    rows.map(|row| (x[row].0.x, t[row].0, m[row].0)).collect()
}

fn heat(sim: &Simulation) -> f64 {
    particles(sim).iter().map(|(_, t, m)| 500.0 * t * m).sum()
}

/// Amplitude of a shape in the temperatures: their projection on it.
fn amplitude(sim: &Simulation, shape: impl Fn(f64) -> f64) -> f64 {
    let all = particles(sim);
    let square: f64 = all.iter().map(|(x, ..)| shape(*x).powi(2)).sum();
    all.iter().map(|(x, t, _)| shape(*x) * (t - 300.0)).sum::<f64>() / square
}

/// The rate at which an amplitude of 10 has decayed, over the one wanted, less one.
fn rate_error(sim: &Simulation, shape: impl Fn(f64) -> f64, wanted: f64) -> f64 {
    -(amplitude(sim, shape) / 10.0).ln() / sim.clock().time / wanted - 1.0
}

#[test]
fn a_sine_decays_at_the_rate_of_the_closed_form_and_no_heat_is_lost() {
    let pi = std::f64::consts::PI;
    for formulation in FORMULATIONS {
        let mut errors = Vec::new();
        for n in [10, 20, 40] {
            let domain = "domain: (min: (0, -1), max: (1, 1), periodic: [X]),";
            let mut sim = bar(formulation, n, "300 + 10*sin(2*pi*x)", domain);
            sim.start().unwrap();
            let before = heat(&sim);
            sim.run(|_| true).unwrap();
            errors.push(rate_error(&sim, |x| (2.0 * pi * x).sin(), DIFFUSIVITY * (2.0 * pi).powi(2)).abs());
            assert!((heat(&sim) / before - 1.0).abs() < 1e-13, "{formulation} {n}");
            assert!(sim.ledger().balance_error().abs() < 1e-10 * before, "{}", sim.ledger().balance_error());
        }
        assert!(
            errors[2] < 0.03 && errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]),
            "{formulation} {errors:?}"
        );
    }
}

#[test]
fn no_heat_leaves_a_surface() {
    let pi = std::f64::consts::PI;
    for formulation in FORMULATIONS {
        let errors = [10, 20, 40].map(|n| {
            let mut sim = bar(formulation, n, "300 + 10*cos(pi*x)", "");
            sim.start().unwrap();
            let before = heat(&sim);
            sim.run(|_| true).unwrap();
            assert!((heat(&sim) / before - 1.0).abs() < 1e-13, "{formulation}");
            // Nothing but round-off is out of balance: no warning.
            assert!(
                sim.ledger().relative_error().abs() < 0.01,
                "{formulation} {}",
                sim.ledger().relative_error()
            );
            rate_error(&sim, |x| (pi * x).cos(), DIFFUSIVITY * pi * pi).abs()
        });
        assert!(errors[2] < 0.03 && errors.is_sorted_by(|a, b| a > b), "{formulation} {errors:?}");
    }
}

#[test]
fn a_stretched_bar_conducts_along_its_present_length() {
    // To 0.6 to 2 times its length, so short a time that it has not begun to move: the volume has changed as
    // much, and a cosine decays by k/(rho c) pi^2 over the stretch. Where layers are twice as far apart as
    // particles in them, Lagrangian neighbourhoods have pairs that would conduct from cold to hot.
    let pi = std::f64::consts::PI;
    for formulation in FORMULATIONS {
        for (stretch, allowed) in [(0.6, 0.01), (1.0, 0.01), (1.3, 0.01), (1.4, 0.01), (2.0, 0.1)] {
            let stretched = format!(
                r#"conditions: [InitialDisplacement(on: Select(), value: ("{}*x", None))],"#,
                stretch - 1.0
            );
            let mut sim = bar(formulation, 40, "300 + 10*cos(pi*x)", &stretched);
            sim.run(|sim| sim.clock().time < 0.3).unwrap();
            let error = rate_error(&sim, |x| (pi * x).cos(), DIFFUSIVITY * pi * pi / stretch);
            assert!(error.abs() < allowed, "{formulation} {stretch} {error}");
        }
    }
}

#[test]
fn thin_bars_conduct_as_thick_ones() {
    // Three particles across, in the plane and in space; all of them beside free sides.
    let pi = std::f64::consts::PI;
    for formulation in FORMULATIONS {
        for (dimension, min, max) in [("Two", "0, 0", "1, 0.1"), ("Three", "0, 0, 0", "1, 0.1, 0.1")] {
            let mut sim = simulation(&format!(
                r#"(dimension: {dimension}, materials: {{"soft": NeoHookean(density: 1000, young: 1, poisson: 0.3)}},
                    bodies: [(name: "bar", material: "soft", shape: Box(min: ({min}), max: ({max})), spacing: 0.0333333333333, formulation: {formulation},
                              plugins: [heat_conduction({HEAT}, temperature: "300 + 10*cos(pi*x)")])],
                    time: (end: 100.0))"#
            ));
            sim.run(|_| true).unwrap();
            let error = rate_error(&sim, |x| (pi * x).cos(), DIFFUSIVITY * pi * pi);
            assert!(error.abs() < 0.01, "{formulation} {dimension} {error}");
        }
    }
}

#[test]
fn no_heat_is_lost_at_a_symmetry_plane_of_an_irregular_lattice() {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1, poisson: 0.3)}},
            bodies: [(name: "bar", material: "soft", shape: Box(min: (0, 0), max: (1, 0.3)), spacing: 0.05, lattice: Relaxed(), formulation: TotalLagrangian(),
                      plugins: [heat_conduction({HEAT}, temperature: "300 + 100*y")])],
            conditions: [Symmetry(plane: Y, at: 0.0)], time: (end: 50.0))"#
    ));
    sim.start().unwrap();
    let before = heat(&sim);
    sim.run(|_| true).unwrap();
    assert!((heat(&sim) / before - 1.0).abs() < 1e-13, "{}", heat(&sim) / before - 1.0);
}

#[test]
fn its_stable_step_limits_that_of_the_run() {
    // A hundred times the diffusivity: waves would allow longer steps.
    let mut sim = simulation(
        r#"(dimension: Three, materials: {"soft": NeoHookean(density: 1000, young: 1, poisson: 0.3)},
            bodies: [(name: "bar", material: "soft", shape: Box(min: (0, 0, 0), max: (1, 0.4, 0.4)), spacing: 0.1, formulation: TotalLagrangian(),
                      plugins: [heat_conduction(specific_heat: 500.0, conductivity: 5000.0, temperature: "300 + 100*step(x - 0.5)")])],
            time: (end: 60.0))"#,
    );
    sim.run(|_| true).unwrap();
    assert!(sim.clock().dt < 1e-2 / 1e-2 && sim.clock().dt > 0.02, "{}", sim.clock().dt);
    // After six decay times all is even, and nothing has swung.
    let all = particles(&sim);
    assert!(all.iter().all(|(_, t, _)| (t - 350.0).abs() < 3.0), "{all:?}");
}

/// A body that hardly moves has next to no energy but the rounding errors of its heat: no instability.
#[test]
fn round_off_of_heat_is_no_growth_of_energy() {
    for formulation in FORMULATIONS {
        let drift = r#"conditions: [InitialVelocity(on: Select(), value: ("1e-14", "0"))],"#;
        let mut sim = bar(formulation, 20, "300 + 100*cos(pi*x)", drift);
        sim.run(|sim| sim.clock().step < 100).unwrap_or_else(|error| panic!("{formulation}: {error}"));
    }
}

#[test]
fn what_it_lacks_is_said() {
    let registry = Registry::standard().with(heat_conduction::register);
    let scene = |plugin: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1, poisson: 0.3)}},
                bodies: [(name: "bar", material: "soft", shape: Box(min: (0, 0), max: (1, 0.3)), spacing: 0.1, formulation: TotalLagrangian(),
                          plugins: [{plugin}])], time: (end: 1.0))"#
        );
        let built =
            parse(Source::new("bar.ron", text)).and_then(|(scene, source)| build(&scene, &source, &registry));
        match built {
            Ok(_) => panic!("{plugin}: no error"),
            Err(error) => error.to_string(),
        }
    };
    for (plugin, expected) in [
        ("heat_conduction()", "needs a `conductivity`"),
        ("heat_conduction(conductivity: 10.0)", "has no specific heat"),
        ("heat_conduction(conductivity: -1.0, specific_heat: 1.0)", "must not be negative"),
        (r#"heat_conduction(materials: {"sofd": 1.0}, specific_heat: 1.0)"#, "no material `sofd`"),
    ] {
        let error = scene(plugin);
        assert!(error.contains(expected), "{plugin}: {error}");
    }
}
