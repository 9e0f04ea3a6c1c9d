//! The energy of contact springs that are loaded at the start becomes kinetic energy.

use super::simulation;

/// Balance error over the energy of the springs, some oscillations of the contact after a block starts at
/// rest within something else.
fn error(other: &str, contact: &str) -> f64 {
    let held = if other.contains("Rigid") { r#"conditions: [Fix(on: Select(body: "other"))],"# } else { "" };
    let mut sim = simulation(&format!(
        r#"(dimension: Two,
            materials: {{"soft": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "soft", shape: Box(min: (0, -0.001), max: (0.06, 0.059)), spacing: 0.01, formulation: TotalLagrangian),
                (name: "other", material: "soft", spacing: 0.01, {other}),
            ],
            contacts: [Contact(between: ("block", "other"), {contact})],
            {held}
            time: (end: 0.0005))"#
    ));
    sim.run(|_| true).unwrap();
    assert!(sim.ledger().largest() > 1.0 && sim.ledger().total_named("contact") == 0.0);
    sim.ledger().relative_error().abs()
}

#[test]
fn blocks_that_start_pressed_keep_the_energy_of_the_springs_as_they_let_go() {
    let tool = "shape: Box(min: (-0.05, -0.05), max: (0.1, 0)), formulation: Rigid()";
    let block = "shape: Box(min: (0, -0.06), max: (0.06, 0)), formulation: TotalLagrangian";
    for (other, contact) in
        [(tool, ""), (block, ""), (tool, "surface: Particles"), (block, "surface: Particles")]
    {
        let error = error(other, contact);
        assert!(error < 2e-3, "{other}, {contact}: {error}");
    }
}
