//! Debris is removed, and the energy balance closes.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Mass, Position, Removed, Velocity};

const FORMULATIONS: [&str; 4] =
    ["TotalLagrangian()", "UpdatedLagrangian()", "UpdatedLagrangian(update: Every(3))", "Eulerian()"];

/// A body without stiffness to speak of that moves with the velocity `u`, until `end`.
fn flight(formulation: &str, shape: &str, plugin: &str, u: &str, end: f64) -> Result<Simulation, String> {
    flight_beside(formulation, shape, plugin, u, end, "")
}

/// The same with further conditions.
fn flight_beside(
    formulation: &str,
    shape: &str,
    plugin: &str,
    u: &str,
    end: f64,
    conditions: &str,
) -> Result<Simulation, String> {
    let text = format!(
        r#"(dimension: Two, materials: {{"dust": NeoHookean(density: 1, young: 1e-9, poisson: 0)}},
            bodies: [(name: "dust", material: "dust", shape: {shape}, spacing: 0.1, formulation: {formulation}, plugins: [{plugin}])],
            conditions: [InitialVelocity(on: Select(), value: ({u})), {conditions}],
            time: (end: {end:?}, step: Fixed(0.01)))"#
    );
    let (scene, source) = parse(Source::new("dust.ron", text)).map_err(|error| error.to_string())?;
    let mut sim = build(&scene, &source, &Registry::standard().with(remove_fragments::register))
        .map_err(|error| error.to_string())?;
    sim.run(|_| true).map_err(|error| error.to_string())?;
    Ok(sim)
}

/// The number of particles that have been taken out.
fn removed(sim: &Simulation) -> usize {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let removed = view.read::<Removed>().expect("a column");
    rows.filter(|&row| removed[row] == Removed::YES).count()
}

#[test]
fn what_is_crushed_is_taken_out_with_its_energy() {
    // x = X (1 - t): all are at a fifth of their volume at t = 0.8, and inside out at t = 1.
    let square = "Box(min: (-0.3, -0.3), max: (0.3, 0.3))";
    for formulation in FORMULATIONS {
        let run = |end| flight(formulation, square, "remove_fragments()", r#""-x", "0""#, end);
        assert_eq!(removed(&run(0.78).expect("a run")), 0, "{formulation}");
        let sim = run(0.84).expect("a run");
        assert_eq!(removed(&sim), 36, "{formulation}");
        // 12 particles of 0.01 kg at each of three distances: 1/2 m x^2.
        let kinetic: f64 = [0.05f64, 0.15, 0.25].iter().map(|x| 12.0 * 0.5 * 0.01 * x * x).sum();
        let booked = sim.ledger().total_named("removed");
        assert!((booked / kinetic - 1.0).abs() < 1e-4, "{formulation}: {booked} J of {kinetic} J");
        assert!(
            sim.ledger().relative_error().abs() < 1e-6,
            "{formulation}: {}",
            sim.ledger().relative_error()
        );
    }
}

#[test]
fn small_pieces_are_taken_out_and_large_ones_are_not() {
    // Pieces of 4, 6 and 16 particles, far from each other.
    let shape = "Union([Box(min: (0, 0), max: (0.2, 0.2)), Box(min: (2, 0), max: (2.3, 0.2)), Box(min: (4, 0), max: (4.4, 0.4))])";
    for formulation in FORMULATIONS {
        for (plugin, out) in [
            ("remove_fragments()", 4),
            ("remove_fragments(particles: 7)", 10),
            ("remove_fragments(particles: 1)", 0),
        ] {
            let sim = flight(formulation, shape, plugin, r#""1", "0""#, 0.1).expect("a run");
            assert_eq!(removed(&sim), out, "{formulation}, {plugin}");
            let (view, rows) = sim.world().body_view(BodyId(0));
            let (x, v) =
                (view.read::<Position>().expect("places"), view.read::<Velocity>().expect("velocities"));
            let (m, gone) = (view.read::<Mass>().expect("masses"), view.read::<Removed>().expect("a column"));
            let first = |row: usize| x[row].0.x < 1.9;
            assert!(out == 0 || rows.clone().all(|row| first(row) <= (gone[row] == Removed::YES)));
            let momentum: f64 = rows.map(|row| m[row].0 * v[row].0.x).sum();
            assert!((momentum - 0.01 * (26 - out) as f64).abs() < 1e-9, "{formulation}: {momentum}");
        }
    }
}

/// A piece of four particles beside a symmetry plane is one of eight in the whole problem, and in the corner
/// of two planes one of sixteen; elsewhere it stays one of four.
#[test]
fn a_piece_is_one_with_its_mirror_image() {
    let shape = "Union([Box(min: (0, 1), max: (0.2, 1.2)), Box(min: (2, 1), max: (2.2, 1.2)), Box(min: (0, 0), max: (0.2, 0.2))])";
    let planes = "Symmetry(plane: X, at: 0), Symmetry(plane: Y, at: 0)";
    for formulation in FORMULATIONS {
        for (plugin, out) in [
            ("remove_fragments(particles: 4)", 0),
            ("remove_fragments()", 4),
            ("remove_fragments(particles: 9)", 8),
            ("remove_fragments(particles: 17)", 12),
        ] {
            let sim = flight_beside(formulation, shape, plugin, r#""0", "0""#, 0.1, planes).expect("a run");
            assert_eq!(removed(&sim), out, "{formulation}, {plugin}");
        }
    }
}

#[test]
fn parameters_out_of_range_are_refused() {
    let error = |plugin: &str| {
        let square = "Box(min: (0, 0), max: (0.4, 0.4))";
        flight("Eulerian()", square, plugin, r#""0", "0""#, 0.1).err().unwrap_or_default()
    };
    assert!(error("remove_fragments(minimum_volume_ratio: -0.1)").contains("from 0 to 0.9"));
    assert!(error("remove_fragments(particles: 0)").contains("from 1 to 100"));
}
