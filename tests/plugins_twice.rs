//! Every plugin on two bodies of a scene, each with parameters of its own.

mod common;

use common::simulation;
use meshless::plugin::EntryKind;
use meshless::scene::Source;
use meshless::standard_plugins;
use meshless::world::BodyId;

/// What the bodies are made of that a plugin is meant for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    Fluids,
    Solids,
}

/// For every plugin of bodies: what it is for, and parameters for the first and the second body.
const PLUGINS: &[(&str, Of, [&str; 2])] = &[
    ("artificial_viscosity", Of::Fluids, ["alpha: 0.02", "alpha: 0.05"]),
    ("artificial_viscosity", Of::Solids, ["", "alpha: 0.5"]),
    ("density_diffusion", Of::Fluids, ["", "delta: 0.05"]),
    ("density_diffusion", Of::Fluids, ["model: Molteni", ""]),
    ("particle_shifting", Of::Fluids, ["", "strength: 2.0"]),
    ("tensile_control", Of::Fluids, ["", ""]),
    ("xsph", Of::Fluids, ["", "epsilon: 0.2"]),
    ("hourglass_control", Of::Solids, ["", "form: Combined"]),
    ("hourglass_control", Of::Solids, ["form: Viscous", "form: Ganzenmueller2015"]),
    ("hessian_stabilization", Of::Solids, ["", "eta: 0.6, form: Vidal2007"]),
    (
        "failure",
        Of::Solids,
        ["criterion: MaximumPrincipalStrain(limit: 0.02)", "criterion: MaximumPrincipalStress(limit: 1e4)"],
    ),
    (
        "failure",
        Of::Solids,
        [
            "criterion: MaximumPrincipalStrain(limit: 0.02), then: RemovedAtSurface",
            "criterion: MaximumPrincipalStrain(limit: 0.03), then: RemovedAtSurface",
        ],
    ),
    ("remove_fragments", Of::Solids, ["", "minimum_volume_ratio: 0.3, particles: 3"]),
    (
        "heat_conduction",
        Of::Solids,
        ["conductivity: 10.0, specific_heat: 500.0", "conductivity: 1.0, specific_heat: 900.0"],
    ),
    ("local_damping", Of::Solids, ["rate: 10.0", "mode: Relaxation(stop: false)"]),
    ("local_damping", Of::Fluids, ["rate: 10.0", "rate: 5.0"]),
];

/// Plugins that write files: one of a kind serves a whole scene.
const RECORDERS: &[&str] = &["rerun_recorder"];

fn scene(of: Of, first: &str, second: &str) -> Source {
    let (formulation, of_body) = match of {
        Of::Fluids => ("Fluid", ["water", "oil"]),
        Of::Solids => ("TotalLagrangian", ["rubber", "cork"]),
    };
    let text = format!(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "oil": Fluid(density: 800.0, sound_speed: 20.0),
                         "rubber": NeoHookean(density: 1100.0, young: 1e6, poisson: 0.3),
                         "cork": NeoHookean(density: 500.0, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "a", material: "{}", shape: Box(min: (0, 0), max: (0.4, 0.3)), spacing: 0.05,
                 formulation: {formulation}, plugins: [{first}]),
                (name: "b", material: "{}", shape: Box(min: (0.4, 0), max: (0.8, 0.3)), spacing: 0.05,
                 formulation: {formulation}, plugins: [{second}]),
            ],
            conditions: [InitialVelocity(on: Select(), value: ("sin(9*y)", "0.5*sin(7*x)"))],
            time: (end: 1.0))"#,
        of_body[0], of_body[1]
    );
    Source::new("twice.ron", text)
}

#[test]
fn every_plugin_runs_on_two_bodies_of_a_scene() {
    for (name, of, [first, second]) in PLUGINS {
        let (first, second) = (format!("{name}({first})"), format!("{name}({second})"));
        let mut sim = simulation(&scene(*of, &first, &second));
        sim.run(|sim| sim.clock().step < 20).unwrap_or_else(|error| panic!("{first}, {second}: {error}"));
        assert_eq!(sim.clock().step, 20, "{first}, {second}");
    }
}

#[test]
fn no_plugin_is_missing_here() {
    for entry in standard_plugins().entries(EntryKind::Plugin) {
        let known = RECORDERS.contains(&entry.name) || PLUGINS.iter().any(|(name, ..)| *name == entry.name);
        assert!(known, "`{}` is run on one body alone: add it to the list", entry.name);
    }
}

/// All plugins of fluids on both of two fluids at once.
#[test]
fn all_plugins_of_fluids_run_together_on_two_fluids() {
    let all = "density_diffusion(), particle_shifting(), tensile_control(), xsph(), artificial_viscosity(alpha: 0.02), local_damping(rate: 1.0)";
    let mut sim = simulation(&scene(Of::Fluids, all, all));
    sim.run(|sim| sim.clock().step < 20).expect("a run");
}

/// Each of two fluids is displaced by a plugin of its own: their energies have accounts of their own.
#[test]
fn displaced_fluids_have_accounts_of_their_own() {
    for (first, second) in [("xsph()", "particle_shifting()"), ("particle_shifting()", "xsph()")] {
        let mut sim = simulation(&scene(Of::Fluids, first, second));
        sim.run(|sim| sim.clock().step < 20).expect("a run");
        let of = |plugin: &str, body: usize| {
            let accounts = sim.ledger().accounts();
            let account = accounts.iter().find(|account| plugin.starts_with(&account.name));
            account.expect("an account").of(BodyId(body))
        };
        assert!(of(first, 0) != 0.0 || of(second, 1) != 0.0, "{first} {second}: nothing is booked");
        assert_eq!((of(first, 1), of(second, 0)), (0.0, 0.0), "{first} {second}");
    }
}
