//! C3: restitution of a spring and dashpot.

use anyhow::{Context, Result};
use meshless_engine::contact::damping_ratio;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{rows, run, state};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "C3", title: "restitution", resolutions: &[4], ci_resolution: 4, run: restitution };

const REFERENCE: &str = include_str!("../../../tests/validation/restitution/reference.csv");
const SOURCE: &str = "integrated motion without tension, reference.csv";
/// Drop height, m.
const FALL: f64 = 0.1;

fn restitution(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for row in rows(REFERENCE) {
        let number = |k: usize| row[k].parse::<f64>().context("a number");
        let (zeta, e, duration) = (number(0)?, number(4)?, number(5)?);
        checks.push(Check::new(
            format!("damping ratio of restitution {e:.4}"),
            damping_ratio(e),
            zeta,
            Tolerance::Absolute(1e-4),
            "1",
            SOURCE,
        ));
        for law in ["Penalty(stiffness: 1.0e6)", "Hertz(modulus: 1.0e9)"] {
            let (first, second, time) = bounces(registry, law, e, across)?;
            let law = law.split('(').next().unwrap_or(law);
            let near = |name: String, measured, reference, unit| {
                Check::new(name, measured, reference, Tolerance::Relative(0.02), unit, SOURCE)
            };
            checks.push(near(format!("{law}, e = {e:.4}: rebound over approach"), first, e, "1"));
            if e > 0.5 {
                let height = e.powi(4) * FALL;
                checks.push(near(
                    format!("{law}, e = {e:.4}: height after two bounces"),
                    second,
                    height,
                    "m",
                ));
            }
            if law == "Penalty" {
                checks.push(near(
                    format!("{law}, e = {e:.4}: time of contact times frequency"),
                    time,
                    duration,
                    "1",
                ));
            }
        }
    }
    Ok(checks)
}

/// Ratio of the speeds of the first bounce, height after the second one, m, time of the first contact times
/// the frequency of the undamped spring.
fn bounces(registry: &Registry, law: &str, e: f64, across: usize) -> Result<(f64, f64, f64)> {
    let mut simulation = Template::new(
        "tests/validation/restitution/scene.ron",
        include_str!("../../../tests/validation/restitution/scene.ron"),
    )
    .set("bodies.ball.spacing", 0.02 / across as f64)?
    .set("contacts[0].law", law)?
    .set("contacts[0].restitution", e)?
    .set("time.end", 0.05 + (2.0 * FALL / 9.81).sqrt() * (1.0 + 2.0 * e + e * e))?
    .build(registry)?;
    let (mut contacts, mut touching, mut approach, mut rebound) = (0, false, 0.0, 0.0);
    let (mut begin, mut duration, mut height) = (0.0, 0.0, 0.0f64);
    run(&mut simulation, |simulation| {
        let ball = state(simulation, "ball")?;
        let pushed = ball.force.z > -0.5 * 9.81 * 0.0329;
        let time = simulation.clock().time;
        if pushed && !touching {
            contacts += 1;
            begin = time;
        }
        if !pushed && touching && contacts == 1 {
            rebound = ball.velocity.z;
            duration = time - begin;
        }
        if !pushed && contacts == 0 {
            approach = -ball.velocity.z;
        }
        if contacts == 2 {
            height = height.max(ball.center.z - 0.01);
        }
        touching = pushed;
        Ok(())
    })?;
    let mass: f64 = 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
    Ok((rebound / approach, height, duration * (1.0e6 / mass).sqrt()))
}
