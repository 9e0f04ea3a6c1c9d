//! Bodies that fail, with the standard plugins about them.

use meshless::record::StateHash;
use meshless::scene::{Source, parse};
use meshless::simulation::Simulation;
use meshless::world::{BodyId, Damage};
use meshless::{plugin, standard_plugins};

/// A notched strip of metal that is pulled apart, with the given plugins.
fn strip(plugins: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"metal": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Linear(yield_stress: 2e8, modulus: 5e8),
                                     heating: (specific_heat: 900))}},
            bodies: [(name: "strip", material: "metal", spacing: 1e-3, formulation: TotalLagrangian, plugins: [{plugins}],
                      shape: Difference(Box(min: (0, 0), max: (0.04, 0.01)), Box(min: (0.019, 0.008), max: (0.021, 0.011))))],
            conditions: [Velocity(on: Select(face: MinX), value: ("0", "0")), Velocity(on: Select(face: MaxX), value: ("40", "0")),
                         InitialVelocity(on: Select(), value: ("1000*x", None))],
            time: (end: 1.5e-4))"#
    );
    let (scene, source) = parse(Source::new("strip.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    plugin::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"))
}

fn failed(sim: &Simulation) -> usize {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let damage = view.read::<Damage>().expect("damage");
    rows.filter(|&row| damage[row].0 >= 1.0).count()
}

const FAILURE: &str =
    "failure(criterion: JohnsonCook(d1: 0.02, d2: 0.1, d3: -1.5), growth: CrackSpeed(), then: ";

#[test]
fn a_metal_strip_breaks_and_the_books_close() {
    for (then, error) in [("NoTension", 1e-2), ("NoDeviator", 1e-2), ("Removed", 3e-3)] {
        let mut sim = strip(&format!("hourglass_control(), {FAILURE}{then})"));
        sim.run(|_| true).unwrap_or_else(|error| panic!("{then}: {error}"));
        let (failed, ledger) = (failed(&sim), sim.ledger());
        assert!((5..300).contains(&failed), "{then}: {failed}");
        assert!(ledger.total_named("plastic_work") > 0.0 && ledger.total_named("fracture") > 0.0, "{then}");
        assert!(ledger.relative_error().abs() < error, "{then}: {}", ledger.relative_error());
    }
}

#[test]
fn the_order_of_plugins_in_the_scene_does_not_matter() {
    let hash = |plugins: &str| -> StateHash {
        let mut sim = strip(plugins);
        sim.run(|sim| sim.clock().step < 400).expect("a run");
        assert!(failed(&sim) > 0, "nothing has failed after {} s", sim.clock().time);
        sim.state_hash()
    };
    let failure = format!("{FAILURE}Removed)");
    assert_eq!(
        hash(&format!("{failure}, hourglass_control()")),
        hash(&format!("hourglass_control(), {failure}"))
    );
}
