//! A pressure in the bore of a ring that can fail.

use meshless::prelude::DVec3;
use meshless::scene::{Source, parse};
use meshless::simulation::Simulation;
use meshless::world::{BodyId, Position};
use meshless::{assembly, standard_plugins};

/// A ring with that plugin list, with a pressure in its bore that grows to 0.2 of Young's modulus.
fn pressed_from_within(plugins: &str, end: f64) -> Simulation {
    let text = format!(
        r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "ring", material: "soft", shape: Ring(center: (0, 0), inner: 0.03, outer: 0.05), spacing: 0.004, lattice: Concentric,
                      formulation: TotalLagrangian, plugins: [hourglass_control(), {plugins}])],
            conditions: [Pressure(on: Select(body: "ring", surface: Inner), value: "2e5*smoothstep(t/0.004)")],
            time: (end: {end:?}))"#
    );
    let (scene, source) = parse(Source::new("ring.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut sim =
        assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).unwrap_or_else(|error| panic!("{error}"));
    sim
}

#[test]
fn a_pressure_acts_in_the_bore_of_a_body_that_can_fail_until_the_bore_does() {
    let places = |sim: &Simulation| {
        let (view, _) = sim.world().body_view(BodyId(0));
        view.read::<Position>().expect("places").iter().map(|x| x.0).collect::<Vec<DVec3>>()
    };
    let failure = |limit: f64| format!("failure(criterion: MaximumPrincipalStrain(limit: {limit:?}))");
    let [whole, fragile] = ["", &failure(9.0)].map(|plugins| pressed_from_within(plugins, 0.003));
    assert!(fragile.warnings().is_empty(), "{:?}", fragile.warnings());
    for (a, b) in places(&whole).iter().zip(places(&fragile)) {
        assert!(a.abs_diff_eq(b, 1e-12), "{a} {b}");
    }
    let burst = pressed_from_within(&failure(0.15), 0.006);
    let told =
        |text: &&String| text.contains("the pressure on body `ring` leaves out the parts of the surface");
    assert_eq!(burst.warnings().iter().filter(told).count(), 1, "{:?}", burst.warnings());
    let error = burst.ledger().relative_error();
    assert!(error.abs() < 5e-3, "{error}");
}
