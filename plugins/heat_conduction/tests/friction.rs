//! Two endless strips that rub on each other heat up like half-spaces with a constant flux through their
//! surface.

use std::f64::consts::PI;

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, ReferencePosition, Temperature};

/// Pressure, Pa, speed, m/s, and coefficient of friction.
const PRESSURE: f64 = 1e4;
const SPEED: f64 = 1.0;
const FRICTION: f64 = 0.3;
/// Conductivity, W/(m K), density, kg/m3, and specific heat, J/(kg K).
const CONDUCTIVITY: f64 = 30.0;
const DENSITY: f64 = 1000.0;
const SPECIFIC_HEAT: f64 = 500.0;
/// Length of the run and of the smooth rise of the pressure, s: nothing damps the strips, and from 0.085 s on
/// they chatter.
const END: f64 = 0.08;
const RISE: f64 = 0.005;

fn rubbing() -> Simulation {
    let conduction = format!(
        "plugins: [heat_conduction(specific_heat: {SPECIFIC_HEAT:?}, conductivity: {CONDUCTIVITY:?}, temperature: 300)]"
    );
    let text = format!(
        r#"(dimension: Two, domain: (min: (0, -1), max: (0.01, 1), periodic: [X]),
            materials: {{"soft": J2(density: {DENSITY:?}, young: 1e6, poisson: 0.3, hardening: Linear(yield_stress: 5e4, modulus: 0), heating: (specific_heat: {SPECIFIC_HEAT:?}, temperature: 300))}},
            bodies: [
                (name: "lower", material: "soft", shape: Box(min: (0, -0.012), max: (0.01, 0)), spacing: 0.001, formulation: TotalLagrangian, {conduction}),
                (name: "upper", material: "soft", shape: Box(min: (0, 0), max: (0.01, 0.012)), spacing: 0.001, formulation: TotalLagrangian, velocity: ({SPEED:?}, 0), {conduction}),
            ],
            conditions: [
                Fix(on: Select(body: "lower", face: MinY)),
                Velocity(on: Select(body: "upper", face: MaxY), value: ({SPEED:?}, None)),
                Traction(on: Select(body: "upper", face: MaxY), value: (0, "-{PRESSURE:?}*smoothstep(t/{RISE:?})")),
            ],
            contacts: [Contact(between: ("upper", "lower"), friction: {FRICTION:?}, restitution: 0.5, friction_heat: 0.5)],
            time: (end: {END:?}))"#
    );
    let registry = Registry::standard().with(heat_conduction::register);
    let (scene, source) = parse(Source::new("rubbing.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &registry).unwrap_or_else(|e| panic!("{e}"))
}

/// Rise of the temperature at a depth, m, below the surface of a half-space through which a flux, W/m2, has
/// come for a time, s (H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids (1959), section 2.9).
fn rise(flux: f64, depth: f64, time: f64) -> f64 {
    let root = (CONDUCTIVITY / (DENSITY * SPECIFIC_HEAT) * time).sqrt();
    let xi = depth / (2.0 * root);
    2.0 * flux * root / CONDUCTIVITY * ((-xi * xi).exp() / PI.sqrt() - xi * erfc(xi))
}

/// The complementary error function (M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions (1964),
/// 7.1.26, to 1.5e-7).
fn erfc(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.3275911 * x);
    let [a, b, c, d, e] = [0.254829592, -0.284496736, 1.421413741, -1.453152027, 1.061405429];
    t * (a + t * (b + t * (c + t * (d + t * e)))) * (-x * x).exp()
}

#[test]
fn strips_that_rub_are_warmed_as_half_spaces() {
    let mut sim = rubbing();
    sim.run(|_| true).unwrap();
    assert!(sim.warnings().is_empty(), "{:?}", sim.warnings());
    let (flux, time) = (0.5 * FRICTION * PRESSURE * SPEED, END - 0.5 * RISE);
    for body in [0, 1] {
        let (view, rows) = sim.world().body_view(BodyId(body));
        let (x, now) = (view.read::<ReferencePosition>().unwrap(), view.read::<Temperature>().unwrap());
        // The heat of friction goes into the first two layers; the flux begins with the pressure.
        for row in rows.filter(|&row| x[row].0.y.abs() > 0.002) {
            let depth = x[row].0.y.abs();
            let (found, wanted) = (now[row].0 - 300.0, rise(flux, depth, time));
            let error = (found - wanted).abs() / rise(flux, 0.0, time);
            assert!(error < 0.03, "body {body}, {depth} m: {found} K, {wanted} K");
        }
    }
}
