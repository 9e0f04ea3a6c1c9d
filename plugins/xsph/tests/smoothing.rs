//! The displacement against a naive second implementation; a zero coefficient changes nothing.

#[path = "../../../tests/common/periodic_flow.rs"]
mod periodic_flow;

use meshless_engine::assembly::build;
use meshless_engine::formulations::fluid::DensityShift;
use meshless_engine::glam::DVec3;
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::Position;
use meshless_engine::world::{Density, Mass, Velocity};
use periodic_flow::{VORTICES, column};

fn simulation(precision: &str, plugins: &str) -> Simulation {
    periodic_flow::simulation(xsph::register, precision, plugins, ("Square", VORTICES))
}

#[test]
fn particles_move_with_the_mean_velocity_around_them() {
    compare("Double", 1e-12);
    // Moves are some 1e-3, of which single precision knows 1e-7 and less where they cancel.
    compare("Mixed", 1e-9);
}

fn compare(precision: &str, most: f64) {
    let run = |plugins: &str| {
        let mut sim = simulation(precision, plugins);
        sim.run(|sim| sim.clock().step < 1).expect("a step");
        sim
    };
    let (with, without) = (run("xsph(epsilon: 0.4)"), run(""));
    let (dt, epsilon) = (with.clock().dt, 0.4);
    let (x, v) = (column::<Position>(&without), column::<Velocity>(&without));
    let (m, rho) = (column::<Mass>(&without), column::<Density>(&without));
    let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
    let h = 0.075;
    let near = |i: usize| -> Vec<(usize, f64, DVec3)> {
        let of = |j: usize| {
            let d = x[j].0 - x[i].0;
            (j, m[j].0 / rho[j].0, d - d.round())
        };
        (0..x.len()).filter(|j| *j != i).map(of).collect()
    };
    let moves: Vec<DVec3> = (0..x.len())
        .map(|i| {
            let (mut sum, mut middle, mut moment, mut spread) =
                (DVec3::ZERO, DVec3::ZERO, [[0.0; 2]; 2], [[0.0; 2]; 2]);
            for (j, volume, d) in near(i) {
                let (w, g) = (volume * kernel.w(d.length(), h), volume * kernel.pair_weight(d.length(), h));
                let apart = v[j].0 - v[i].0;
                (sum, middle) = (sum + w * apart, middle + w * d);
                for (row, along) in [d.x, d.y].into_iter().enumerate() {
                    for (column, across) in [d.x, d.y].into_iter().enumerate() {
                        moment[row][column] += g * along * across;
                    }
                    spread[0][row] += g * apart.x * along;
                    spread[1][row] += g * apart.y * along;
                }
            }
            let [[xx, xy], [_, yy]] = moment;
            let determinant = xx * yy - xy * xy;
            // The velocity gradient times the first moment.
            let solved = [
                (yy * middle.x - xy * middle.y) / determinant,
                (xx * middle.y - xy * middle.x) / determinant,
            ];
            let linear = |row: usize| spread[row][0] * solved[0] + spread[row][1] * solved[1];
            epsilon * dt * (sum - DVec3::new(linear(0), linear(1), 0.0))
        })
        .collect();
    let shifts = column::<DensityShift>(&with);
    for (i, moved) in column::<Position>(&with).iter().enumerate() {
        let wanted = x[i].0 + moves[i];
        assert!(moved.0.distance(wanted) < most, "{precision} {i}: {} {wanted}", moved.0);
        // Halfway along the displacements, the density follows to their second order.
        let dilation: f64 = near(i)
            .into_iter()
            .map(|(j, volume, d)| {
                let apart = moves[j] - moves[i];
                let middle = d + 0.5 * apart;
                volume * kernel.pair_weight(middle.length(), h) * apart.dot(middle)
            })
            .sum();
        let wanted = -rho[i].0 * dilation;
        assert!(
            (shifts[i].0 - wanted).abs() < 1e4 * most + 1e-3 * wanted.abs(),
            "{i}: {} {wanted}",
            shifts[i].0
        );
    }
    let largest = shifts.iter().map(|shift| shift.0.abs()).fold(0.0, f64::max);
    assert!(
        largest > if precision == "Double" { 1e-6 } else { 0.0 },
        "the density follows nothing: {largest}"
    );
}

/// The mean of the velocities around a particle at the surface is not its own, where the velocity is linear:
/// such a motion must not change the shape of a drop.
#[test]
fn a_linear_velocity_moves_no_particle() {
    for velocity in [r#"("-0.3*y", "0.3*x")"#, r#"("0.2*x + 0.1*y", "-0.2*y")"#] {
        let run = |plugins: &str| {
            let text = format!(
                r#"(dimension: Two, materials: {{"water": Fluid(density: 1000, sound_speed: 1)}},
                    bodies: [(name: "drop", material: "water", shape: Sphere(center: (0, 0), radius: 0.1), spacing: 0.0125, formulation: Fluid, plugins: [{plugins}])],
                    conditions: [InitialVelocity(on: Select(body: "drop"), value: {velocity})],
                    time: (end: 1, step: Fixed(1e-4)))"#
            );
            let mut registry = Registry::standard();
            xsph::register(&mut registry);
            let (scene, source) = parse(Source::new("test.ron", text)).expect("a scene");
            let mut sim = build(&scene, &source, &registry).expect("a simulation");
            sim.run(|sim| sim.clock().step < 1).expect("a step");
            sim
        };
        let (with, without) = (run("xsph()"), run(""));
        for (a, b) in column::<Position>(&with).iter().zip(column::<Position>(&without)) {
            assert!(a.0.distance(b.0) < 1e-10, "{velocity}: {} {}", a.0, b.0);
        }
    }
}

/// Displacements leave velocities alone, and what they supply is lost by a friction of opposite forces
/// between neighbours: momentum is exact. Angular momentum changes as particles are displaced across their
/// velocity.
#[test]
fn a_drop_keeps_its_momentum_and_its_volume() {
    let text = r#"(dimension: Two, precision: Double, materials: {"water": Fluid(density: 1000, sound_speed: 20)},
            bodies: [(name: "drop", material: "water", shape: Sphere(center: (0, 0), radius: 0.1), spacing: 0.005, formulation: Fluid, plugins: [xsph(), density_diffusion()])],
            conditions: [InitialVelocity(on: Select(body: "drop"), value: ("0.3 + sin(40*y)", "0.5*cos(30*x) + 3*x"))],
            time: (end: 0.05))"#;
    let mut registry = Registry::standard();
    xsph::register(&mut registry);
    density_diffusion::register(&mut registry);
    let (scene, source) = parse(Source::new("test.ron", text)).expect("a scene");
    let mut sim = build(&scene, &source, &registry).expect("a simulation");
    // Momentum, angular momentum and volume; the sums of their sizes.
    let sums = |sim: &Simulation| {
        let (x, v) = (column::<Position>(sim), column::<Velocity>(sim));
        let (m, rho) = (column::<Mass>(sim), column::<Density>(sim));
        let (mut momentum, mut size, mut angular, mut angular_size, mut volume) =
            (DVec3::ZERO, 0.0, 0.0, 0.0, 0.0);
        for i in 0..x.len() {
            let (p, arm) = (m[i].0 * v[i].0, x[i].0);
            (momentum, size) = (momentum + p, size + p.length());
            (angular, angular_size) = (angular + arm.cross(p).z, angular_size + arm.length() * p.length());
            volume += m[i].0 / rho[i].0;
        }
        (momentum, size, angular, angular_size, volume)
    };
    let (momentum, size, angular, angular_size, volume) = sums(&sim);
    sim.run(|_| true).expect("a run");
    let (momentum_after, _, angular_after, _, volume_after) = sums(&sim);
    assert!(momentum_after.distance(momentum) < 1e-12 * size, "{momentum} {momentum_after}");
    assert!(
        (angular_after - angular).abs() < 1e-3 * angular_size,
        "{angular} {angular_after} of {angular_size}"
    );
    assert!((volume_after / volume - 1.0).abs() < 1e-3, "{volume} {volume_after}");
}

#[test]
fn off_is_as_if_it_were_not_there() {
    let hash = |plugins: &str| {
        let mut sim = simulation("Mixed", plugins);
        sim.run(|sim| sim.clock().step < 10).expect("a run");
        sim.state_hash()
    };
    assert_eq!(hash(""), hash("xsph(epsilon: 0.0)"));
    assert_ne!(hash(""), hash("xsph()"));
}
