//! Sums in single precision against those in double precision, which have a naive second implementation of
//! their own.

use glam::DVec3;

use crate::formulations::fluid::tests::{column, simulation};
use crate::simulation::Simulation;
use crate::world::{Density, Force, Mass, ParticleId, Position, Pressure, Velocity};

/// A fluid that moves in a tank: friction goes without the spin, with it, or there is none.
fn tank(dimension: &str, viscosity: f64, wall: &str, fluid: &str) -> String {
    let (water, outer, inner) = if dimension == "Two" {
        ("(0, 0), max: (0.9, 0.6)", "(-0.2, -0.2), max: (1.1, 0.8)", "(0, 0), max: (0.9, 1)")
    } else {
        (
            "(0, 0, 0), max: (0.6, 0.5, 0.4)",
            "(-0.2, -0.2, -0.2), max: (0.8, 0.7, 0.6)",
            "(0, 0, 0), max: (0.6, 1, 0.4)",
        )
    };
    format!(
        r#"(dimension: {dimension}, gravity: (0.0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0, viscosity: {viscosity:?})}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: {water}), spacing: 0.05, formulation: Fluid({fluid}),
                 lattice: Relaxed(seed: 3, iterations: 1)),
                (name: "tank", material: "wall", shape: Difference(Box(min: {outer}), Box(min: {inner})),
                 spacing: 0.05, formulation: Wall({wall})),
            ],
            conditions: [InitialVelocity(on: Select(body: "water"), value: ("0.3 + y - 2*x", "0.1 + 3*x"))],
            time: (end: 1.0))"#
    )
}

fn mixed(scene: &str) -> String {
    scene.replacen("(dimension", "(precision: Mixed, dimension", 1)
}

fn double(scene: &str) -> String {
    scene.replacen("(dimension", "(precision: Double, dimension", 1)
}

fn after(scene: &str, steps: u64) -> Simulation {
    let mut sim = simulation(scene);
    sim.run(|sim| sim.clock().step < steps).expect("a run");
    sim
}

/// A column of a body, the water or the tank, by the numbers of its particles.
fn by_id<C: crate::world::Column + Copy>(sim: &Simulation, body: usize) -> Vec<C> {
    let ids = column::<ParticleId>(sim, body);
    let mut rows: Vec<(u64, C)> = ids.iter().map(|id| id.0).zip(column::<C>(sim, body)).collect();
    rows.sort_by_key(|row| row.0);
    rows.into_iter().map(|row| row.1).collect()
}

#[test]
fn forces_are_those_of_double_precision() {
    let kernels = ["", "kernel: wendland_c4", "kernel: wendland_c6", "kernel: quintic_spline"];
    for (dimension, viscosity, wall, fluid) in [
        ("Three", 2.0, "slip: No", kernels[0]),
        ("Three", 1e-3, "slip: No", kernels[1]),
        ("Two", 0.0, "slip: Free", kernels[0]),
        ("Two", 2.0, "slip: No", kernels[2]),
        ("Two", 1e-3, "slip: Free", kernels[3]),
    ] {
        let scene = tank(dimension, viscosity, wall, fluid);
        let (double, single) = (after(&double(&scene), 3), after(&mixed(&scene), 3));
        for body in 0..2 {
            let (a, b) = (by_id::<Force>(&double, body), by_id::<Force>(&single, body));
            let rms = (a.iter().map(|f| f.0.length_squared()).sum::<f64>() / a.len() as f64).sqrt();
            let worst = a.iter().zip(&b).map(|(a, b)| a.0.distance(b.0)).fold(0.0, f64::max);
            assert!(rms > 0.0 && worst < 3e-5 * rms, "{dimension} {viscosity} {fluid}: {worst:e} of {rms:e}");
        }
        // The pressure that walls take on, with the weight of the fluid on the way.
        let (a, b) = (by_id::<Pressure>(&double, 1), by_id::<Pressure>(&single, 1));
        // Of either sign in the fluid, where their means on the wall are small.
        let largest = by_id::<Pressure>(&double, 0).iter().map(|p| p.0.abs()).fold(0.0, f64::max);
        let worst = a.iter().zip(&b).map(|(a, b)| (a.0 - b.0).abs()).fold(0.0, f64::max);
        assert!(largest > 0.0 && worst < 1e-5 * largest, "{worst:e} of {largest:e}");
        // Density changes by the compression of three steps.
        let (a, b) = (by_id::<Density>(&double, 0), by_id::<Density>(&single, 0));
        let change = a.iter().map(|rho| (rho.0 - 1000.0).abs()).fold(0.0, f64::max);
        let worst = a.iter().zip(&b).map(|(a, b)| (a.0 - b.0).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-5 * change, "{worst:e} of {change:e}");
    }
}

/// Without walls, in a periodic box and two bodies: forces add up to nothing.
#[test]
fn pair_forces_cancel() {
    let body = |name: &str, min: &str, max: &str| {
        format!(
            r#"(name: "{name}", material: "{name}", shape: Box(min: {min}, max: {max}), spacing: 0.05,
                formulation: Fluid(pressure: "2e3*cos(6.283185307179586*x)"))"#
        )
    };
    let scene = format!(
        r#"(precision: Mixed, dimension: Three,
            domain: (min: (0, 0, 0), max: (1, 0.5, 0.5), periodic: [X, Y, Z]),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0, viscosity: 2.0),
                         "oil": Fluid(density: 800.0, sound_speed: 40.0, viscosity: 1.0)}},
            bodies: [{}, {}],
            conditions: [InitialVelocity(on: Select(body: "water"), value: ("0.3 + y", "0.1 + sin(6.283185307179586*x)"))],
            time: (end: 1.0))"#,
        body("water", "(0, 0, 0)", "(1, 0.25, 0.5)"),
        body("oil", "(0, 0.25, 0)", "(1, 0.5, 0.5)"),
    );
    let sim = after(&scene, 20);
    let forces: Vec<DVec3> =
        (0..2).flat_map(|body| column::<Force>(&sim, body)).map(|force| force.0).collect();
    let sum: DVec3 = forces.iter().sum();
    // Opposite forces are exact; what is left are the roundings of each particle's sum, some 1e-6 of it,
    // which do not know of each other: three of their deviations.
    let squares: f64 = forces.iter().map(|force| force.length_squared()).sum();
    let most = 3e-6 * squares.sqrt();
    assert!(squares > 0.0 && sum.length() < most, "{:e} {most:e}", sum.length());
}

/// What the water does to the tank is the opposite of what the tank does to the water, with friction and
/// without.
#[test]
fn forces_of_water_and_walls_cancel() {
    for (dimension, viscosity, wall) in
        [("Two", 0.0, "slip: Free"), ("Two", 2.0, "slip: No"), ("Three", 2.0, "slip: No")]
    {
        let sim = after(&mixed(&tank(dimension, viscosity, wall, "")), 20);
        let weight: f64 = column::<Mass>(&sim, 0).iter().map(|m| m.0 * 9.81).sum();
        let forces: Vec<DVec3> =
            (0..2).flat_map(|body| column::<Force>(&sim, body)).map(|force| force.0).collect();
        let sum = forces.iter().sum::<DVec3>() + weight * DVec3::Y;
        let on_walls: DVec3 = column::<Force>(&sim, 1).iter().map(|force| force.0).sum();
        // As above.
        let squares: f64 = forces.iter().map(|force| force.length_squared()).sum();
        let most = 3e-6 * squares.sqrt();
        assert!(on_walls.length() > 1e3 * most, "{dimension} {viscosity}: {on_walls}");
        assert!(sum.length() < most, "{dimension} {viscosity}: {:e} {most:e}", sum.length());
    }
}

/// Particles far apart, a place far from the origin, and removed particles.
#[test]
fn sparse_and_distant_flows_go_on() {
    let scene = |mixed: &str, x: f64| {
        format!(
            r#"({mixed}dimension: Two, gravity: (0.0, -9.81),
            domain: (min: ({}, -0.4), max: ({}, 3), outside: Remove),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0)}},
            bodies: [
                (name: "water", material: "water", shape: Union([Box(min: ({x}, 0), max: ({}, 0.5)), Box(min: ({}, 0), max: ({}, 0.1))]),
                 spacing: 0.05, formulation: Fluid),
            ],
            conditions: [InitialVelocity(on: Select(body: "water"), value: ("0", "-1"))],
            time: (end: 1.0))"#,
            x - 40.0,
            x + 40.0,
            x + 0.5,
            x + 30.0,
            x + 30.1,
        )
    };
    for x in [0.0, 5000.0] {
        let double = after(&scene("precision: Double, ", x), 400);
        let single = after(&scene("precision: Mixed, ", x), 400);
        let (a, b) = (by_id::<Position>(&double, 0), by_id::<Position>(&single, 0));
        let worst = a.iter().zip(&b).map(|(a, b)| a.0.distance(b.0)).fold(0.0, f64::max);
        assert!(worst < 1e-5, "{x}: {worst:e}");
        assert!(single.summary().removed_of.contains_key("water"), "some have left the domain");
    }
}

#[test]
fn spacings_beyond_single_precision_are_refused() {
    let error = |scene: &str| {
        let registry = crate::plugin::Registry::standard();
        let source = crate::scene::Source::new("test.ron", scene);
        let built = crate::scene::parse(source)
            .and_then(|(scene, source)| crate::assembly::build(&scene, &source, &registry));
        built.err().map_or_else(String::new, |error| error.to_string())
    };
    let small = r#"(precision: Mixed, dimension: Two, materials: {"water": Fluid(density: 1000.0, sound_speed: 40.0)},
        bodies: [(name: "water", material: "water", shape: Box(min: (0, 0), max: (1e-7, 1e-7)), spacing: 1e-8, formulation: Fluid)],
        time: (end: 1.0))"#;
    let text = error(small);
    assert!(text.contains("spacings of 0.000001 to 1000000 m") && text.contains("precision"), "{text}");
}

#[test]
fn still_water_stays_still() {
    let scene = mixed(&tank("Two", 0.0, "slip: Free", ""))
        .replace(r#"("0.3 + y - 2*x", "0.1 + 3*x")"#, r#"("0", "0")"#);
    let scene = scene.replace("lattice: Relaxed(seed: 3, iterations: 1)", "lattice: Square");
    let double = scene.replace("precision: Mixed, ", "precision: Double, ");
    let speed = |scene: &str| {
        let sim = after(scene, 200);
        column::<Velocity>(&sim, 0).iter().map(|v| v.0.length()).fold(0.0, f64::max)
    };
    let (double, single) = (speed(&double), speed(&scene));
    // Twelve layers: 1.2e-6 of gravity in a second.
    assert!((single - double).abs() < 1.2e-5, "{single:e} {double:e}");
}

/// A drop that flies and turns keeps its momenta and its energy, and turns its motion into heat of friction
/// alone.
#[test]
fn a_drop_that_turns_keeps_momenta_and_energy() {
    for viscosity in [0.0, 2.0] {
        let mut sim = simulation(&format!(
            r#"(precision: Mixed, dimension: Two,
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0, viscosity: {viscosity:?})}},
                bodies: [(name: "water", material: "water", shape: Sphere(center: (0, 0), radius: 0.5), spacing: 0.05, formulation: Fluid)],
                conditions: [InitialVelocity(on: Select(body: "water"), value: ("3 - 2*y", "2*x"))],
                time: (end: 1.0))"#
        ));
        let momenta = |sim: &Simulation| {
            let (x, v) = (column::<Position>(sim, 0), column::<Velocity>(sim, 0));
            let m = column::<Mass>(sim, 0);
            let sum = |of: &dyn Fn(usize) -> DVec3| (0..x.len()).map(of).sum::<DVec3>();
            let mass: f64 = m.iter().map(|m| m.0).sum();
            let (middle, mean) = (sum(&|k| m[k].0 * x[k].0) / mass, sum(&|k| m[k].0 * v[k].0) / mass);
            (mean, sum(&|k| m[k].0 * (x[k].0 - middle).cross(v[k].0 - mean)).z)
        };
        sim.run(|sim| sim.clock().step < 1).expect("a run");
        let (velocity, spin) = momenta(&sim);
        sim.run(|sim| sim.clock().step < 200).expect("a run");
        let (later_velocity, later_spin) = momenta(&sim);
        // Roundings of the forces of 200 steps.
        assert!(velocity.distance(later_velocity) < 1e-7 * velocity.length(), "{velocity} {later_velocity}");
        assert!((later_spin / spin - 1.0).abs() < 1e-6, "{spin} {later_spin}");
        let error = sim.ledger().relative_error().abs();
        assert!(error < 1e-4, "{error:e}");
        assert!(sim.ledger().total_named("viscosity") >= 0.0);
    }
}
