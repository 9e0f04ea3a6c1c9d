//! X6: an elastic slab between two layers of oil whose walls slide to and fro.

use anyhow::{Context, Result};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "X6",
    title: "elastic slab between oscillating viscous layers",
    resolutions: &[16, 20, 40],
    ci_resolution: 16,
    run: viscous_layers,
};

const SLAB: &str = include_str!("../../../tests/validation/viscous_layers/reference.csv");
/// Speed of the walls, m/s, their angular frequency, 1/s, and the evaluated time: the last four seconds are
/// two periods. At 12 s the transient of the start still is 2 %.
const SPEED: f64 = 0.4;
const OMEGA: f64 = std::f64::consts::PI;
const FROM: f64 = 22.0;

fn viscous_layers(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 0.2 / across as f64;
    let (length, wall) = (8.0 * spacing, 0.4 + 4.0 * spacing);
    let path = "tests/validation/viscous_layers/scene.ron";
    let text = include_str!("../../../tests/validation/viscous_layers/scene.ron");
    let mut template = Template::new(path, text).set("domain.max", format!("({length}, 1.0)"))?;
    for (name, low, high) in [
        ("upper_oil", 0.2, 0.4),
        ("lower_oil", -0.4, -0.2),
        ("slab", -0.2, 0.2),
        ("upper_wall", 0.4, wall),
        ("lower_wall", -wall, -0.4),
    ] {
        template = template
            .set(&format!("bodies.{name}.spacing"), spacing)?
            .set(&format!("bodies.{name}.shape.min"), format!("(0.0, {low})"))?
            .set(&format!("bodies.{name}.shape.max"), format!("({length}, {high})"))?;
    }
    let mut simulation = template.build(registry)?;
    let slab = body(&simulation, "slab")?;
    let sides = [0.2, -0.2].map(|y| MaterialPoint::new(&simulation, slab, DVec3::new(0.5 * length, y, 0.0)));
    let [upper, lower] = sides;
    let (upper, lower) = (upper?, lower?);
    // Displacement of the interface, as amplitudes in phase and out of phase with the velocity of the walls.
    let (mut sine, mut cosine, mut time) = (0.0, 0.0, FROM);
    let balance = run(&mut simulation, |simulation| {
        let now = simulation.clock().time;
        if now > FROM {
            let x = 0.5 * (upper.displacement(simulation)?.x - lower.displacement(simulation)?.x);
            let phase = OMEGA * now;
            sine += x * phase.sin() * (now - time);
            cosine += x * phase.cos() * (now - time);
            time = now;
        }
        Ok(())
    })?;
    let half = 0.5 * (time - FROM);
    // The velocity is 90 degrees ahead of the displacement.
    let (sine, cosine) = (sine / half * OMEGA, cosine / half * OMEGA);
    let amplitude = sine.hypot(cosine) / SPEED;
    let phase = sine.atan2(-cosine).to_degrees();
    let of = |name| -> Result<f64> {
        let rows = Record::read(SLAB, "y", name)?.0;
        Ok(rows.iter().find(|row| (row.0 - 0.2).abs() < 1e-9).context("the reference lacks the interface")?.1)
    };
    let source = "closed form, Parthasarathy, Bhosale, Gazzola 2022";
    Ok(vec![
        Check::new(
            "speed of the interface over that of the walls",
            amplitude,
            of("abs/V")?,
            Tolerance::Relative(0.03),
            "1",
            source,
        )
        .converging(),
        Check::new("its phase", phase, of("phase_deg")?, Tolerance::Absolute(3.0), "degrees", source),
        balance.check(Kind::Smooth),
    ])
}
