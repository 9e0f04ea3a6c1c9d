//! Energy and forces of contact between irregular bodies, at the default step.

mod common;

use common::simulation;
use meshless::scene::Source;

#[test]
fn irregular_blocks_slide_without_friction_and_their_energy_is_booked() {
    let text = r#"(dimension: Two,
        materials: {"m": NeoHookean(density: 1000.0, young: 1e6, poisson: 0.3)},
        bodies: [
            (name: "low", material: "m", shape: Box(min: (0, 0), max: (2, 0.4)), spacing: 0.05, formulation: TotalLagrangian, plugins: [hourglass_control()],
             lattice: Relaxed(seed: 1)),
            (name: "up", material: "m", shape: Box(min: (0.5, 0.4), max: (1.1, 0.8)), spacing: 0.05, formulation: TotalLagrangian, plugins: [hourglass_control()],
             lattice: Relaxed(seed: 1)),
        ],
        conditions: [
            Fix(on: Select(body: "low", face: MinY)),
            Velocity(on: Select(body: "up", face: MaxY), value: ("0.1*smoothstep((t - 0.5)/0.2)", "-0.05*(smoothstep(t/0.1) - smoothstep((t - 0.3)/0.1))")),
        ],
        contacts: [Contact(between: ("low", "up"), law: Penalty(), friction: 0.0)],
        plugins: [local_damping(rate: 5.0, until: 0.5)],
        probes: [Probe(name: "held", on: Select(body: "up", face: MaxY), quantity: Force, every: 1.0)],
        time: (end: 4.0))"#;
    let mut sim = simulation(&Source::new("blocks.ron", text));
    let (mut worst, mut squares, mut count) = (0.0f64, 0.0, 0.0);
    sim.run(|sim| {
        worst = worst.max(sim.ledger().balance_error().abs());
        if sim.clock().time > 1.2 {
            let held = sim.measure("held").expect("a probe");
            squares += (held[0].1 / held[1].1).powi(2);
            count += 1.0;
        }
        true
    })
    .expect("a run");
    // It was 3 %.
    let error = worst / sim.ledger().largest();
    assert!(error < 1e-3, "{error}");
    let rms: f64 = (squares / count).sqrt();
    assert!(rms < 0.01, "{rms}");
}

/// Error of the balance of two soft sheets that hit each other with dashpots, over their kinetic energy.
fn sheets(restitution: f64, step: &str) -> f64 {
    let mut sim = simulation(&Source::new(
        "sheets.ron",
        format!(
            r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "low", material: "soft", shape: Box(min: (0, 0), max: (0.2, 0.04)), spacing: 0.01, formulation: TotalLagrangian),
                (name: "high", material: "soft", shape: Box(min: (0, 0.041), max: (0.2, 0.081)), spacing: 0.01,
                 formulation: TotalLagrangian, velocity: (3.0, -8.0)),
            ],
            contacts: [Contact(between: ("low", "high"), law: Penalty(), restitution: {restitution})],
            time: (end: 0.006{step}))"#
        ),
    ));
    sim.run(|_| true).expect("a run");
    // One of 8 kg moves.
    let kinetic = 0.5 * 8.0 * (3.0_f64.powi(2) + 8.0_f64.powi(2));
    sim.ledger().balance_error().abs() / kinetic
}

#[test]
fn heat_of_dashpots_between_soft_sheets_is_booked_at_the_default_step() {
    for restitution in [0.5, 0.1] {
        let error = sheets(restitution, "");
        let halved = sheets(restitution, ", step: Adaptive(factor: 0.5)");
        println!("{restitution}: {error} {halved}");
        // The rule for bodies that hit each other is 1e-2; what is left is the error of the leapfrog.
        assert!(error < 2e-3 && halved < 0.5 * error, "{restitution}: {error} {halved}");
    }
}
