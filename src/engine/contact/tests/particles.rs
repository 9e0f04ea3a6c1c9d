//! Contact between particles.

use super::{centre, momentum, simulation};
use crate::simulation::Simulation;
use crate::world::{BodyId, Position, ReferencePosition};

/// Two blocks, the upper one thrown obliquely onto the lower one; `contact` goes into the contact.
fn thrown(dimension: &str, contact: &str) -> Simulation {
    let (low, high, z) = if dimension == "Two" {
        ("min: (0, 0), max: (0.1, 0.04)", "min: (0.023, 0.041), max: (0.083, 0.081)", "")
    } else {
        (
            "min: (0, 0, 0), max: (0.1, 0.04, 0.04)",
            "min: (0.023, 0.041, 0.01), max: (0.083, 0.081, 0.05)",
            ", 0.1",
        )
    };
    simulation(&format!(
        r#"(dimension: {dimension},
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3),
                        "hard": NeoHookean(density: 2000, young: 3e6, poisson: 0.2)}},
            bodies: [
                (name: "low", material: "soft", shape: Box({low}), spacing: 0.01, formulation: TotalLagrangian),
                (name: "high", material: "hard", shape: Box({high}), spacing: 0.01, formulation: TotalLagrangian,
                 velocity: (0.5, -1.0{z})),
            ],
            contacts: [Contact(between: ("low", "high"), {contact})],
            time: (end: 0.01))"#
    ))
}

#[test]
fn momentum_is_exact_and_the_books_close() {
    for (dimension, contact) in [
        ("Two", "law: Penalty()"),
        ("Two", "law: Penalty(), friction: 0.3, restitution: 0.5"),
        ("Three", "law: Hertz(), friction: 0.3, restitution: 0.8"),
    ] {
        let mut sim = thrown(dimension, contact);
        sim.start().unwrap();
        let before = momentum(&sim);
        sim.run(|_| true).unwrap();
        let error = (momentum(&sim) - before).length() / before.length();
        assert!(error < 1e-12, "{dimension} {contact}: momentum {error}");
        let (_, low) = centre(&sim, 0);
        let (_, high) = centre(&sim, 1);
        assert!(low.y < -0.2 && high.y > low.y, "{dimension} {contact}: {low} {high}");
        let lost = sim.ledger().total_named("friction");
        assert_eq!(lost > 0.0, contact.contains("friction"), "{lost}");
        assert_eq!(sim.ledger().total_named("contact_damping") > 0.0, contact.contains("restitution"));
        assert!(sim.ledger().relative_error().abs() < 5e-3, "{contact}: {}", sim.ledger().relative_error());
    }
}

#[test]
fn without_a_contact_bodies_pass_through_each_other() {
    let mut sim = thrown("Two", "law: Penalty(stiffness: 1e-9)");
    sim.run(|_| true).unwrap();
    assert!((centre(&sim, 1).1.y + 1.0).abs() < 1e-6);
}

#[test]
fn ten_times_the_usual_speed_does_not_tunnel() {
    // A third of the wave speed: a particle would cross the other block in a few steps of the bonds.
    let mut sim = simulation(
        r#"(dimension: Two,
            materials: {"soft": StVenantKirchhoff(density: 1000, young: 1e6, poisson: 0.3)},
            bodies: [
                (name: "low", material: "soft", shape: Box(min: (0, 0), max: (0.1, 0.05)), spacing: 0.01,
                 formulation: TotalLagrangian),
                (name: "high", material: "soft", shape: Box(min: (0.033, 0.06), max: (0.073, 0.1)), spacing: 0.01,
                 formulation: TotalLagrangian, velocity: (0.0, -10.0)),
            ],
            contacts: [Contact(between: ("low", "high"), law: Penalty(), restitution: 0.2)],
            time: (end: 0.012))"#,
    );
    sim.run(|_| true).unwrap();
    let ((low, v), (high, u)) = (centre(&sim, 0), centre(&sim, 1));
    assert!(high.y > low.y + 0.02 && u.y >= v.y, "{low} {high} {v} {u}");
}

#[test]
fn a_body_touches_itself() {
    // The arms of a fork are driven towards each other, farther than the gap is wide.
    let scene = |contacts: &str| {
        format!(
            r#"(dimension: Two,
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "fork", material: "soft", spacing: 0.01, formulation: TotalLagrangian,
                shape: Difference(Box(min: (0, 0), max: (0.2, 0.1)), Box(min: (0.04, 0.04), max: (0.21, 0.06))))],
            conditions: [
                Velocity(on: Select(within: Box(min: (0.16, 0.0), max: (0.21, 0.01))), value: (None, "1.5*smoothstep(t/0.005)")),
                Velocity(on: Select(within: Box(min: (0.16, 0.09), max: (0.21, 0.1))), value: (None, "-1.5*smoothstep(t/0.005)")),
            ],
            {contacts} time: (end: 0.012))"#
        )
    };
    // Distance of the particles that face each other across the gap, less than nothing where they have
    // passed.
    let gap = |sim: &Simulation| {
        let (view, rows) = sim.world().body_view(BodyId(0));
        let x = view.read::<Position>().unwrap();
        let reference = view.read::<ReferencePosition>().unwrap();
        let face = |y: f64| {
            let mut face: Vec<usize> = rows
                .clone()
                .filter(|&row| (reference[row].0.y - y).abs() < 1e-6 && reference[row].0.x > 0.05)
                .collect();
            face.sort_by(|&a, &b| reference[a].0.x.total_cmp(&reference[b].0.x));
            face
        };
        let pairs = face(0.035).into_iter().zip(face(0.065));
        pairs.map(|(low, high)| x[high].0.y - x[low].0.y).fold(f64::MAX, f64::min)
    };
    let mut through = simulation(&scene(""));
    through.run(|_| true).unwrap();
    assert!(gap(&through) < 0.002, "{}", gap(&through));
    let mut held = simulation(&scene(r#"contacts: [Contact(between: ("fork", "fork"), law: Penalty())],"#));
    held.run(|_| true).unwrap();
    assert!(gap(&held) > 0.005, "{}", gap(&held));
    assert!(held.ledger().relative_error().abs() < 5e-3, "{}", held.ledger().relative_error());
}
