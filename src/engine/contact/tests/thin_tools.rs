//! Tools thinner than the distance of the points of a skin: they bounce off, and do not pass between points.

use glam::DVec3;

use super::{centre, momentum, simulation};
use crate::rigid::RigidBodies;
use crate::scene::Source;
use crate::simulation::{Checkpoint, Simulation};
use crate::world::{BodyId, Mass, Position, Velocity};

/// Angular momentum of a block of particles and of a rigid body about the origin, kg m2/s.
fn angular_momentum(sim: &Simulation) -> DVec3 {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (m, x) = (view.read::<Mass>().unwrap(), view.read::<Position>().unwrap());
    let v = view.read::<Velocity>().unwrap();
    let of_block: DVec3 = rows.map(|row| m[row].0 * x[row].0.cross(v[row].0)).sum();
    let bodies = sim.resources().get::<RigidBodies>();
    let tool = &bodies[0];
    of_block + tool.mass * tool.state.center.cross(tool.state.velocity) + tool.state.angular_momentum
}

/// An elastic block that a thin rigid body hits, both free. The velocity of the thin one before and after,
/// m/s, and the errors of momentum, angular momentum and energy, over those at the start.
fn hit(dimension: &str, tool: &str, spacing: f64, contact: &str) -> ([f64; 2], [f64; 3]) {
    hit_by(dimension, tool, spacing, 1e4, contact)
}

/// The same with a body of that density, kg/m3.
fn hit_by(dimension: &str, tool: &str, spacing: f64, density: f64, contact: &str) -> ([f64; 2], [f64; 3]) {
    let mut sim = block_and_tool(dimension, tool, spacing, density, contact);
    let speed = centre(&sim, 1).1.y;
    let (before, spin) = (momentum(&sim), angular_momentum(&sim));
    sim.run(|_| true).expect("a run");
    let size = before.length();
    let errors = [
        (momentum(&sim) - before).length() / size,
        (angular_momentum(&sim) - spin).length() / size,
        sim.ledger().relative_error().abs(),
    ];
    ([speed, centre(&sim, 1).1.y], errors)
}

fn block_and_tool(dimension: &str, tool: &str, spacing: f64, density: f64, contact: &str) -> Simulation {
    let is_plane = dimension == "Two";
    let (block, velocity) = if is_plane {
        ("Box(min: (-0.5, -0.5), max: (0.5, 0))", "(0, -0.5)")
    } else {
        ("Box(min: (-0.4, -0.6, -0.4), max: (0.4, 0, 0.4))", "(0, -0.5, 0)")
    };
    simulation(&format!(
        r#"(dimension: {dimension},
            materials: {{
                "soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3),
                "stiff": NeoHookean(density: {density}, young: 1e9, poisson: 0.3),
            }},
            bodies: [
                (name: "block", material: "soft", shape: {block}, spacing: 0.1,
                 formulation: TotalLagrangian),
                (name: "tool", material: "stiff", shape: {tool}, spacing: {spacing}, velocity: {velocity},
                 formulation: Rigid()),
            ],
            contacts: [Contact(between: ("block", "tool"){contact})], time: (end: 0.1))"#
    ))
}

/// A blade, turned by 10 degrees; a ball, a needle with a flat end, a wire and a blade in space: a twentieth
/// of a spacing thick or less.
const TOOLS: [(&str, &str, f64); 5] = [
    ("Two", "Rotate(shape: Box(min: (0.013, 0.001), max: (0.018, 0.4)), angle_degrees: 10)", 0.0025),
    ("Three", "Sphere(center: (0.013, 0.003, 0.027), radius: 0.002)", 0.001),
    ("Three", "Cylinder(from: (0.013, 0.001, 0.027), to: (0.013, 0.3, 0.027), radius: 0.002)", 0.002),
    ("Three", "Cylinder(from: (-0.2, 0.003, 0.027), to: (0.2, 0.003, 0.027), radius: 0.002)", 0.002),
    ("Three", "Box(min: (-0.22, 0.001, 0.027), max: (0.2, 0.1, 0.031))", 0.002),
];

#[test]
fn thin_tools_bounce_off_between_the_points_of_a_skin() {
    for (dimension, tool, spacing) in TOOLS {
        let ([before, after], [momentum, spin, balance]) = hit(dimension, tool, spacing, "");
        assert!(before < 0.0 && after > 0.1 * before.abs(), "{tool}: {before} to {after} m/s");
        assert!(momentum < 1e-12 && spin < 1e-12, "{tool}: {momentum}, {spin}");
        assert!(balance < 1e-3, "{tool}: {balance}");
    }
}

#[test]
fn friction_and_dashpot_of_thin_tools_keep_momenta() {
    for (dimension, tool, spacing) in TOOLS {
        let contact = ", friction: 0.3, restitution: 0.5";
        let ([_, after], [momentum, spin, balance]) = hit(dimension, tool, spacing, contact);
        assert!(after > 0.0, "{tool}: {after} m/s");
        assert!(momentum < 1e-12 && spin < 1e-12, "{tool}: {momentum}, {spin}");
        assert!(balance < 1e-3, "{tool}: {balance}");
    }
}

#[test]
fn thin_tools_go_on_exactly_after_a_restart() {
    for (dimension, tool, spacing) in TOOLS {
        let make = || block_and_tool(dimension, tool, spacing, 1e4, ", friction: 0.3, restitution: 0.5");
        let mut whole = make();
        whole.run(|sim| sim.clock().time < 0.06).expect("a run");
        let mut first = make();
        // While they touch.
        first.run(|sim| sim.ledger().total_named("contact") == 0.0).expect("a run");
        assert!(first.clock().time < 0.05, "{tool}: they do not touch");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.mlc");
        first.save(&path, &Source::new("thin.ron", "")).unwrap();
        let mut second = make();
        second.restore(&Checkpoint::read(&path).unwrap()).unwrap();
        second.run(|sim| sim.clock().time < 0.06).expect("a run");
        assert_eq!(whole.state_hash(), second.state_hash(), "{tool}");
    }
}

#[test]
fn light_bodies_bounce_off_with_what_they_had() {
    for (dimension, tool) in [
        ("Two", "Box(min: (-0.22, 0.001), max: (0.22, 0.2))"),
        ("Two", "Sphere(center: (0.02, 0.301), radius: 0.3)"),
        ("Three", "Sphere(center: (0.02, 0.101, 0.01), radius: 0.1)"),
    ] {
        for density in [10.0, 0.1] {
            let ([_, after], [momentum, _, balance]) = hit_by(dimension, tool, 0.05, density, "");
            assert!(after > 0.0 && after < 0.51, "{tool} {density}: {after} m/s");
            assert!(momentum < 1e-11 && balance < 5e-3, "{tool} {density}: {momentum}, {balance}");
        }
    }
}

/// Strain energy of a block, or of the half of it beside a symmetry plane, into which a blade or a needle in
/// the plane is pressed, J.
fn pressed(dimension: &str, tool: &str, spacing: f64, half: bool) -> f64 {
    let is_plane = dimension == "Two";
    let (from, symmetry) = if half { ("0", "Symmetry(plane: X, at: 0),") } else { ("-0.4", "") };
    let (shape, velocity) = if is_plane {
        (format!("Box(min: ({from}, -0.4), max: (0.4, 0))"), r#"("0", "-0.5")"#)
    } else {
        (format!("Box(min: ({from}, -0.4, -0.3), max: (0.4, 0, 0.3))"), r#"("0", "-0.5", "0")"#)
    };
    let mut sim = simulation(&format!(
        r#"(dimension: {dimension},
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "soft", shape: {shape}, spacing: 0.1, formulation: TotalLagrangian),
                (name: "tool", material: "soft", shape: {tool}, spacing: {spacing}, formulation: Rigid()),
            ],
            conditions: [{symmetry} Velocity(on: Select(body: "tool"), value: {velocity})],
            contacts: [Contact(between: ("block", "tool"))], time: (end: 0.05))"#
    ));
    sim.run(|_| true).expect("a run");
    sim.ledger().total_named("strain")
}

#[test]
fn half_a_block_at_a_symmetry_plane_is_pressed_like_the_whole() {
    for (dimension, tool, spacing) in [
        ("Two", "Box(min: (-0.005, 0), max: (0.005, 0.2))", 0.005),
        ("Two", "Polygon(points: [(0, 0), (0.004, 0.2), (-0.004, 0.2)])", 0.002),
        ("Three", "Cylinder(from: (0, 0, 0.01), to: (0, 0.2, 0.01), radius: 0.004)", 0.004),
    ] {
        let [whole, half] = [false, true].map(|half| pressed(dimension, tool, spacing, half));
        assert!(whole > 1.0 && (2.0 * half / whole - 1.0).abs() < 1e-3, "{tool}: {half} of {whole} J");
    }
}

/// Whether a block into which a tool is pressed by a depth, m, is warned of its edge.
fn is_told(dimension: &str, formulation: &str, tool: &str, depth: f64) -> bool {
    let (shape, velocity) = if dimension == "Two" {
        ("Box(min: (-0.4, -0.8), max: (0.4, 0))", format!(r#"("0", "-{depth:?}/0.2")"#))
    } else {
        ("Box(min: (-0.4, -0.6, -0.2), max: (0.4, 0, 0.2))", format!(r#"("0", "-{depth:?}/0.2", "0")"#))
    };
    let mut sim = simulation(&format!(
        r#"(dimension: {dimension},
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "soft", shape: {shape}, spacing: 0.1, formulation: {formulation}),
                (name: "tool", material: "soft", shape: {tool}, spacing: 0.02, formulation: Rigid()),
            ],
            conditions: [Velocity(on: Select(body: "tool"), value: {velocity}),
                         Fix(on: Select(body: "block", face: MinY))],
            contacts: [Contact(between: ("block", "tool"))], time: (end: 0.2))"#
    ));
    sim.run(|_| true).expect("a run");
    sim.warnings().iter().any(|text| text.contains("an edge of `tool`, sharper than 70 degrees"))
}

#[test]
fn sharp_edges_that_draw_the_surface_along_are_warned_of() {
    let wedge = "Polygon(points: [(0.013, 0), (0.36, 0.6), (-0.33, 0.6)])";
    for formulation in ["TotalLagrangian", "Eulerian()"] {
        assert!(is_told("Two", formulation, wedge, 0.2), "{formulation}");
    }
    let wedge = "Extrusion(polygon: [(0.013, 0), (0.36, 0.6), (-0.33, 0.6)], from: -0.3, to: 0.3)";
    assert!(is_told("Three", "TotalLagrangian", wedge, 0.2));
    // A right angle, and an acute one that lies on the block.
    assert!(!is_told("Two", "TotalLagrangian", "Box(min: (-0.15, 0), max: (0.15, 0.3))", 0.2));
    assert!(!is_told("Two", "TotalLagrangian", "Polygon(points: [(-0.3, 0), (0.3, 0), (0.3, 0.16)])", 0.03));
}
