//! The force against a naive second implementation, and the properties of every viscosity.

use glam::{DVec2, DVec3};
use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Force, Mass, Position, ReferenceVolume, Velocity};

const SPACING: f64 = 0.1;
const DENSITY: f64 = 1000.0;

fn simulation(plugins: &str, end: f64) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"m": StVenantKirchhoff(density: {DENSITY:?}, young: 1.0e6, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.2, 0.8)), spacing: {SPACING:?},
                      lattice: Relaxed(seed: 7), formulation: TotalLagrangian(support: 2.6), plugins: [{plugins}])],
            time: (end: {end:?}))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut registry = Registry::standard();
    artificial_viscosity::register(&mut registry);
    hourglass_control::register(&mut registry);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

/// Gives every particle the velocity that `field` has at its place.
fn set_velocity(sim: &Simulation, field: impl Fn(DVec3) -> DVec3) {
    let (view, _) = sim.world().body_view(BodyId(0));
    let position = view.read::<Position>().expect("positions");
    let mut velocity = view.write::<Velocity>().expect("velocities");
    for (v, x) in velocity.iter_mut().zip(position.iter()) {
        v.0 = field(x.0);
    }
}

fn rough(x: DVec3) -> DVec3 {
    DVec3::new((17.0 * x.x + 5.0 * x.y).sin(), (11.0 * x.y - 23.0 * x.x).cos(), 0.0) * 3.0
}

fn smooth(x: DVec3) -> DVec3 {
    DVec3::new((5.0 * x.x).cos(), (4.0 * x.y).sin(), 0.0) * 3.0
}

/// Force of the viscosity: the difference between the forces with and without it, at the start.
fn viscous_force(field: impl Fn(DVec3) -> DVec3 + Copy, plugins: &str) -> (Vec<DVec3>, Simulation) {
    let mut with = simulation(plugins, 1.0);
    let mut without = simulation("", 1.0);
    for sim in [&mut with, &mut without] {
        set_velocity(sim, field);
        sim.start().expect("a start");
    }
    let force = |sim: &Simulation| {
        let (view, _) = sim.world().body_view(BodyId(0));
        view.read::<Force>().expect("forces").iter().map(|f| f.0).collect::<Vec<_>>()
    };
    let difference = force(&with).iter().zip(force(&without)).map(|(a, b)| a - b).collect();
    (difference, with)
}

#[test]
fn the_force_is_that_of_a_naive_sum_over_all_pairs() {
    let (alpha, beta) = (0.7, 1.3);
    let (force, sim) = viscous_force(rough, &format!("artificial_viscosity(alpha: {alpha}, beta: {beta})"));
    let (view, _) = sim.world().body_view(BodyId(0));
    let x = view.read::<Position>().expect("positions");
    let volume = view.read::<ReferenceVolume>().expect("volumes");
    let (support, h) = (2.6 * SPACING, 1.3 * SPACING);
    let c = (1.0e6 * 0.7 / (1.3 * 0.4) / DENSITY).sqrt();
    let largest = force.iter().map(|f| f.length()).fold(0.0, f64::max);
    assert!(largest > 0.0);
    for i in 0..force.len() {
        let mut naive = DVec2::ZERO;
        for j in (0..force.len()).filter(|&j| j != i) {
            let d = (x[j].0 - x[i].0).truncate();
            let r = d.length();
            let closing = (rough(x[j].0) - rough(x[i].0)).truncate().dot(d);
            if r < support && closing < 0.0 {
                let mu = h * closing / (r * r + 0.01 * h * h);
                let slope = 30.0 / (std::f64::consts::PI * support.powi(5)) * (support - r).powi(2);
                let size = volume[i].0 * volume[j].0 * DENSITY * (alpha * c * mu - beta * mu * mu) * slope;
                naive += size * d / r;
            }
        }
        // Pair weights are kept in single precision.
        assert!(
            (force[i].truncate() - naive).length() < 2e-7 * largest,
            "particle {i}: {} {naive}",
            force[i]
        );
    }
}

#[test]
fn it_keeps_momentum_and_takes_energy() {
    let (force, sim) = viscous_force(rough, "artificial_viscosity()");
    let sum: DVec3 = force.iter().sum();
    let size: f64 = force.iter().map(|f| f.length()).sum();
    assert!(sum.length() < 1e-13 * size);
    let (view, _) = sim.world().body_view(BodyId(0));
    let velocity = view.read::<Velocity>().expect("velocities");
    let power: f64 = force.iter().zip(velocity.iter()).map(|(f, v)| f.dot(v.0)).sum();
    assert!(power < 0.0);
}

#[test]
fn a_rigid_motion_meets_no_force() {
    let spin = |x: DVec3| DVec3::new(2.0, -1.0, 0.0) + DVec3::Z.cross(x) * 4.0;
    let (force, _) = viscous_force(spin, "artificial_viscosity()");
    let (reference, _) = viscous_force(rough, "artificial_viscosity()");
    let largest = reference.iter().map(|f| f.length()).fold(0.0, f64::max);
    assert!(force.iter().all(|f| f.length() < 1e-12 * largest));
}

#[test]
fn without_coefficients_nothing_changes_bit_for_bit() {
    let hash = |plugins| {
        let mut sim = simulation(plugins, 2e-3);
        set_velocity(&sim, rough);
        sim.run(|_| true).expect("a run");
        sim.state_hash()
    };
    assert_eq!(hash("artificial_viscosity(alpha: 0, beta: 0)"), hash(""));
    assert_ne!(hash("artificial_viscosity()"), hash(""));
}

#[test]
fn the_ledger_names_what_it_takes() {
    let mut sim = simulation("artificial_viscosity(), hourglass_control()", 0.02);
    set_velocity(&sim, smooth);
    sim.run(|_| true).expect("a run");
    let (view, _) = sim.world().body_view(BodyId(0));
    let mass = view.read::<Mass>().expect("masses");
    let x = view.read::<meshless_engine::world::ReferencePosition>().expect("positions");
    let start: f64 = mass.iter().zip(x.iter()).map(|(m, x)| 0.5 * m.0 * smooth(x.0).length_squared()).sum();
    let ledger = sim.ledger();
    let taken = ledger.total_named("artificial_viscosity");
    assert!(taken > 0.05 * start && taken < start);
    let left = ledger.total_named("kinetic") + ledger.total_named("strain") + ledger.total_named("hourglass");
    assert!((left + taken - start).abs() < 2e-3 * start, "{left} + {taken} of {start}");
}

#[test]
fn a_viscosity_that_drowns_a_flow_is_warned_of() {
    let warnings = |parameters: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [(name: "water", material: "water", shape: Box(min: (0, 0), max: (4, 2)), spacing: 0.1, formulation: Fluid,
                          plugins: [artificial_viscosity({parameters})])],
                time: (end: 1.0))"#
        );
        let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let mut registry = Registry::standard();
        artificial_viscosity::register(&mut registry);
        let sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
        sim.warnings()
            .iter()
            .filter(|text| text.contains("dominates the flow of `water`"))
            .cloned()
            .collect::<Vec<_>>()
    };
    // u L / nu with u = 2 m/s, L = 2 m and nu = alpha h c_0 / 8 = 0.375 m2/s.
    let default = warnings("");
    assert!(default.len() == 1 && default[0].contains("Reynolds number of 11 "), "{default:?}");
    assert!(warnings("alpha: 0.02, beta: 0.0").is_empty());
}
