//! Every plugin of fluids on coarse variants of every shipped flow; `meshless validate sweep` takes the flows
//! as they are.

use meshless::standard_plugins;
use meshless_validation::sweep::{flows, sweep_of, warnings_of};

/// Steps of each run.
const STEPS: u64 = 300;

/// The flows, each with what makes it coarse.
const COARSE: &[(&str, &[(&str, &str)])] = &[
    ("abrasive_flow", &[]),
    ("abrasive_flow_3d", &[]),
    (
        "dam_break",
        &[
            ("bodies.water.spacing", "0.06"),
            ("bodies.tank.spacing", "0.06"),
            ("bodies.tank.shape[0].min", "(-0.18, -0.18)"),
            ("bodies.tank.shape[0].max", "(3.42, 1.8)"),
        ],
    ),
    (
        "dam_break_3d",
        &[
            ("bodies.water.spacing", "0.05"),
            ("bodies.tank.spacing", "0.05"),
            ("bodies.tank.shape[0].min", "(-0.15, -0.15, -0.15)"),
            ("bodies.tank.shape[0].max", "(1.35, 0.75, 0.45)"),
        ],
    ),
    (
        "dam_break_obstacle",
        &[
            ("bodies.water.spacing", "0.008"),
            ("bodies.plate.spacing", "0.006"),
            ("bodies.tank.spacing", "0.008"),
            ("bodies.tank.shape[0].min", "(-0.024, -0.024)"),
            ("bodies.tank.shape[0].max", "(0.608, 0.36)"),
        ],
    ),
    (
        "elastic_gate",
        &[
            ("bodies.water.spacing", "0.005"),
            ("bodies.gate.spacing", "0.0025"),
            ("bodies.gate.shape.max", "(0.105, 0.085)"),
            ("bodies.tank.spacing", "0.005"),
            ("bodies.tank.shape[0][0].min", "(-0.02, 0.0)"),
            ("bodies.tank.shape[0][1].min", "(-0.02, -0.02)"),
            ("bodies.tank.shape[0][2].max", "(0.12, 0.2)"),
        ],
    ),
    (
        "floating_box",
        &[
            ("bodies.water.spacing", "0.025"),
            ("bodies.box.spacing", "0.025"),
            ("bodies.tank.spacing", "0.025"),
            ("bodies.tank.shape[0].min", "(-0.1, -0.1)"),
            ("bodies.tank.shape[0].max", "(1.1, 0.5)"),
        ],
    ),
    (
        "sloshing",
        &[
            ("bodies.water.spacing", "0.05"),
            ("bodies.tank.spacing", "0.05"),
            ("bodies.tank.shape[0].min", "(-0.15, -0.15)"),
            ("bodies.tank.shape[0].max", "(1.15, 0.9)"),
        ],
    ),
    ("taylor_green", &[("bodies.fluid.spacing", "0.05")]),
    ("vortex_street", &[("parameters.dx", "0.025")]),
    (
        "water_on_plate",
        &[
            ("bodies.water.spacing", "0.05"),
            ("bodies.plate.spacing", "0.025"),
            ("bodies.left.spacing", "0.05"),
            ("bodies.left.shape.min", "(-0.15, 0.0)"),
            ("bodies.right.spacing", "0.05"),
            ("bodies.right.shape.max", "(1.15, 2.2)"),
        ],
    ),
    ("water_wheel", &[]),
];

/// Flows that are as they are shipped take few.
fn steps(set: &[(&str, &str)]) -> u64 {
    if set.is_empty() { STEPS / 10 } else { STEPS }
}

#[test]
fn every_shipped_flow_is_swept() {
    for entry in std::fs::read_dir("assets/scenes").expect("the scenes") {
        let path = entry.expect("an entry").path();
        let text = std::fs::read_to_string(&path).expect("a scene");
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
        if text.contains("formulation: Fluid") {
            assert!(flows().any(|flow| flow == name), "{name}");
            assert!(COARSE.iter().any(|(flow, _)| *flow == name), "{name}");
        }
    }
}

/// Checks one of two halves of the flows: tests of one file run side by side.
fn plugins_keep_the_volume_and_give_no_energy(half: usize) {
    let mut failed = Vec::new();
    for (_, (flow, set)) in COARSE.iter().enumerate().filter(|(k, _)| k / 2 % 2 == half) {
        let steps = steps(set);
        match sweep_of(&standard_plugins(), flow, set, steps) {
            Ok(checks) => {
                let wrong = checks.into_iter().filter(|check| !check.passes());
                failed.extend(wrong.map(|check| format!("{}: {}", check.name, check.measured)));
            }
            Err(error) => failed.push(format!("{flow}: {error}")),
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn plugins_keep_the_volume_and_give_no_energy_in_coarse_flows() {
    plugins_keep_the_volume_and_give_no_energy(0);
}

#[test]
fn plugins_keep_the_volume_and_give_no_energy_in_other_coarse_flows() {
    plugins_keep_the_volume_and_give_no_energy(1);
}

/// Whether it says that a liquid with the true speed of sound passes the edges of a rectangle at a quarter of
/// it, which it does: no other speed of sound would be that of the liquid.
fn is_of_sound(flow: &str, warning: &str) -> bool {
    flow == "abrasive_flow" && warning.contains("Mach number")
}

/// Whether it says that a plate is too thin for its fluid, as it is in these variants alone.
fn is_of_coarseness(flow: &str, warning: &str) -> bool {
    ["dam_break_obstacle", "elastic_gate", "water_on_plate"].contains(&flow)
        && warning.contains("it stirs fluid at rest")
}

#[test]
fn coarse_variants_of_shipped_flows_give_no_warnings() {
    let mut told = Vec::new();
    for (flow, set) in COARSE {
        match warnings_of(&standard_plugins(), flow, set, steps(set)) {
            Ok(warnings) => {
                let expected = |text: &String| is_of_sound(flow, text) || is_of_coarseness(flow, text);
                let others = warnings.into_iter().filter(|text| !expected(text));
                told.extend(others.map(|text| format!("{flow}: {text}")));
            }
            Err(error) => told.push(format!("{flow}: {error}")),
        }
    }
    assert!(told.is_empty(), "{told:#?}");
}
