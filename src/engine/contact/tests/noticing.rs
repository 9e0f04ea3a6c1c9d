//! Contact that does not hold bodies apart is noticed.

use super::simulation;

/// What the run of a scene in the plane says of particles inside of other bodies.
fn said(bodies: &str, more: &str) -> Vec<String> {
    let mut sim = simulation(&format!(
        r#"(dimension: Two,
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [{bodies}], {more})"#
    ));
    sim.run(|_| true).unwrap();
    sim.warnings().iter().filter(|text| text.contains(" is inside of ")).cloned().collect()
}

/// A soft block, and a plate of that thickness, in spacings, that is driven edge-on into it to a depth of
/// three.
fn cut(formulation: &str, thickness: f64) -> Vec<String> {
    let half = 0.005 * thickness;
    let spacing = 0.005 * thickness.min(2.0);
    said(
        &format!(
            r#"(name: "block", material: "soft", shape: Box(min: (-0.06, -0.1), max: (0.06, 0)), spacing: 0.01,
                formulation: {formulation}),
               (name: "blade", material: "soft", shape: Box(min: ({}, 0.0001), max: ({}, 0.04)), spacing: {spacing},
                formulation: Rigid())"#,
            0.002 - half,
            0.002 + half,
        ),
        r#"conditions: [Fix(on: Select(body: "block", face: MinY)), Velocity(on: Select(body: "blade"), value: (0.0, -3.0))],
           contacts: [Contact(between: ("block", "blade"))], time: (end: 0.01), record: (every: 0.001)"#,
    )
}

#[test]
fn a_blade_thinner_than_the_points_of_a_surface_passes_between_them_with_a_warning() {
    for formulation in ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()"] {
        let [text] = &cut(formulation, 0.1)[..] else { panic!("{formulation}: one warning") };
        assert!(text.contains("of `blade` is inside of `block`"), "{text}");
        assert!(text.contains("smaller particles in `block`"), "{text}");
    }
    assert_eq!(cut("TotalLagrangian", 2.0), [""; 0]);
}

/// A block that falls on something which a law a ten-thousandth as stiff does not stop.
fn thrown_on(floor: &str, face: &str, factor: f64, domain: &str) -> Vec<String> {
    said(
        &format!(
            r#"(name: "block", material: "soft", shape: Box(min: (0.01, 0.001), max: (0.05, 0.041)), spacing: 0.01,
                formulation: TotalLagrangian, velocity: (0.0, -2.0)),
               (name: "floor", material: "soft", {floor})"#
        ),
        &format!(
            r#"{domain} conditions: [Fix(on: Select(body: "floor"{face}))],
               contacts: [Contact(between: ("block", "floor"), law: Penalty(factor: {factor:?}))],
               time: (end: 0.012), record: (every: 0.001)"#
        ),
    )
}

#[test]
fn bodies_in_each_other_are_noticed_for_every_kind_of_floor() {
    let wide = "shape: Box(min: (-0.02, -0.06), max: (0.08, 0)), spacing: 0.01, formulation:";
    let along = "domain: (min: (-0.02, -1), max: (0.08, 1), periodic: [X]),";
    let elastic = ("TotalLagrangian", ", face: MinY", "");
    for (kind, face, domain) in [("Rigid()", "", ""), ("Wall()", "", ""), elastic, ("Rigid()", "", along)] {
        let floor = format!("{wide} {kind}");
        let [text] = &thrown_on(&floor, face, 1e-4, domain)[..] else {
            panic!("{kind} {domain}: one warning")
        };
        assert!(text.contains("is inside of"), "{text}");
        assert_eq!(thrown_on(&floor, face, 1.0, domain), [""; 0], "{kind} {domain}");
    }
}
