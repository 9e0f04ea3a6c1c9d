//! Loads and motions that last for less than a step of the bodies that they act on.

use super::tests::simulation;
use crate::world::{BodyId, Mass, Position, ReferencePosition, Velocity};

/// A soft block, 16 by 8 particles, whose steps are 4 ms (Lagrangian), or water that fills a periodic domain.
fn scene(formulation: &str, condition: &str) -> String {
    let (material, domain) = match formulation {
        "Fluid" => (
            "Fluid(density: 1000.0, sound_speed: 10.0)",
            "domain: Domain(min: (0, 0), max: (1, 0.5), periodic: [X, Y]),",
        ),
        _ => ("NeoHookean(density: 1000.0, young: 1e5, poisson: 0.3)", ""),
    };
    format!(
        "Scene(dimension: Two, {domain} materials: {{\"m\": {material}}},
        bodies: [Body(name: \"block\", material: \"m\", shape: Box(min: (0, 0), max: (1, 0.5)),
            spacing: 0.0625, formulation: {formulation})],
        conditions: [{condition}], time: (end: 0.15))"
    )
}

/// Mean velocity and mean displacement of the block along x at the end, and the number of steps.
fn ended(formulation: &str, condition: &str) -> (f64, f64, u64) {
    let mut sim = simulation(&scene(formulation, condition));
    sim.run(|_| true).expect("the run ends");
    let (view, rows) = sim.world().body_view(BodyId(0));
    let mass = &view.read::<Mass>().expect("masses")[rows.clone()];
    let velocity = &view.read::<Velocity>().expect("velocities")[rows.clone()];
    let total: f64 = mass.iter().map(|m| m.0).sum();
    let momentum: f64 = mass.iter().zip(velocity).map(|(m, v)| m.0 * v.0.x).sum();
    let moved = if view.has::<ReferencePosition>() {
        let (place, start) = (view.read::<Position>(), view.read::<ReferencePosition>());
        let (place, start) = (&place.expect("places")[rows.clone()], &start.expect("places")[rows]);
        place.iter().zip(start).map(|(x, start)| x.0.x - start.0.x).sum::<f64>() / place.len() as f64
    } else {
        0.0
    };
    (momentum / total, moved, sim.clock().step)
}

/// A factor that is one for `length` from 50 ms on, as text.
fn blow(length: f64) -> String {
    format!("step(t - 0.05)*step({} - t)", 0.05 + length)
}

#[test]
fn a_blow_shorter_than_a_step_has_its_impulse() {
    for formulation in ["TotalLagrangian", "UpdatedLagrangian", "Eulerian", "Fluid"] {
        for length in [3e-3, 1e-4, 1e-5] {
            // 0.1 m/s in all.
            let force = format!("{}*{}", 0.1 / length, blow(length));
            let (v, ..) = ended(formulation, &format!("BodyForce(on: Select(), value: (\"{force}\", None))"));
            assert!((v / 0.1 - 1.0).abs() < 0.07, "{formulation}, {length} s: {v} m/s instead of 0.1");
        }
    }
    for length in [3e-3, 1e-4] {
        // 500 kg/m, loaded along half a metre.
        let traction = format!("{}*{}", 0.1 * 500.0 / 0.5 / length, blow(length));
        let on = "on: Select(face: MinX)";
        for load in [
            format!("Traction({on}, value: (\"{traction}\", None))"),
            format!("Pressure({on}, value: \"{traction}\")"),
            format!("Force({on}, value: (\"0.5*{traction}\", None))"),
        ] {
            let (v, ..) = ended("TotalLagrangian", &load);
            assert!((v / 0.1 - 1.0).abs() < 0.07, "{load}: {v} m/s instead of 0.1");
        }
    }
}

#[test]
fn a_motion_shorter_than_a_step_is_made() {
    for length in [3e-3, 1e-4] {
        let velocity = format!("{}*{}", 1e-3 / length, blow(length));
        let (_, moved, _) =
            ended("TotalLagrangian", &format!("Velocity(on: Select(), value: (\"{velocity}\", 0))"));
        assert!((moved / 1e-3 - 1.0).abs() < 0.07, "{length} s: {moved} m instead of 1e-3");
    }
}

/// Ramps, jumps and swings of fifty steps and more leave the steps as they are.
#[test]
fn what_does_not_turn_back_within_steps_does_not_shorten_them() {
    let steps = |force: &str| {
        ended("TotalLagrangian", &format!("BodyForce(on: Select(), value: (\"{force}\", None))")).2
    };
    let still = steps("0.1");
    for force in ["0.1*step(t - 0.05)", "0.1*smoothstep((t - 0.05)/0.001)", "0.1*t", "0.1*sin(2*pi*t/0.25)"] {
        assert_eq!(steps(force), still, "{force}");
    }
}
