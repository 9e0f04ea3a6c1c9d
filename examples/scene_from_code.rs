//! A scene that a program puts together: one bar in three lengths, each run writing its files, whose probe is
//! read back.
//!
//! `cargo run --release --example scene_from_code`

use std::error::Error;

use meshless::prelude::*;

/// A bar that is fixed at its left end and free at the other; it starts in its first longitudinal mode.
fn scene(length: f64) -> Result<(Scene, Source), SceneError> {
    parse(Source::new(
        "bar.ron",
        format!(
            r#"Scene(
                title: "Bar of {length} m",
                dimension: Two,
                materials: {{ "steel": StVenantKirchhoff(density: 7850.0, young: 210.0e9, poisson: 0.0) }},
                bodies: [
                    Body(name: "bar", material: "steel", shape: Box(min: (0.0, 0.0), max: ({length}, 0.05)), spacing: 0.005,
                         formulation: TotalLagrangian, plugins: [hourglass_control()]),
                ],
                conditions: [
                    Fix(on: Select(face: MinX), axes: [X]),
                    InitialVelocity(on: Select(), value: ("sin(pi/2*x/{length})", None)),
                ],
                time: (end: 1.0),
                probes: [Probe(name: "end", on: Select(face: MaxX), quantity: Displacement)],
            )"#
        ),
    ))
}

/// First time at which the end is back at its place: half the period.
fn half_period(length: f64) -> Result<f64, Box<dyn Error>> {
    let (mut scene, _) = scene(length)?;
    // What is a value in the scene is a field in Rust; the text that errors point to is made from it.
    scene.time.end = 1.5 * 2.0 * length / wave_speed();
    let source = scene.to_source("bar.ron")?;
    let folder = tempfile::tempdir()?;
    let options = BuildOptions::into_folder(folder.path());
    let mut sim = build_with(&scene, &source, &standard_plugins(), &options)?;
    sim.run(|_| true)?;
    sim.finish()?;
    let end = read_series(&folder.path().join("end.csv"))?;
    let (t, x) = (end.numbers("t")?, end.numbers("x")?);
    let back = (1..t.len()).find(|&k| x[k - 1] > 0.0 && x[k] <= 0.0).ok_or("the bar does not swing back")?;
    Ok(t[back - 1] + (t[back] - t[back - 1]) * x[back - 1] / (x[back - 1] - x[back]))
}

/// sqrt(E / rho), m/s.
fn wave_speed() -> f64 {
    (210.0e9_f64 / 7850.0).sqrt()
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("length   half period   expected");
    for length in [0.5, 0.75, 1.0] {
        let (found, expected) = (half_period(length)?, 2.0 * length / wave_speed());
        println!("{length:5.2} m  {:8.2} us   {:8.2} us", 1e6 * found, 1e6 * expected);
        assert!((found / expected - 1.0).abs() < 0.02, "half a period of {found} s");
    }
    Ok(())
}
