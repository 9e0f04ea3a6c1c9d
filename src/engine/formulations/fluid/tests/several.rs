//! Several fluids in one scene, and fluids in what a mesh bounds.

use std::fmt::Write as _;

use glam::DVec3;

use super::{column, double, pressure_factor, simulation};
use crate::assembly::build;
use crate::formulations::fluid::FlowCloud;
use crate::kernels::{Kernel, KernelName};
use crate::plugin::Registry;
use crate::scene::load;
use crate::world::{Density, Force, Mass, Position, Pressure, ReferencePosition, Velocity};

#[test]
fn two_fluids_press_on_each_other_with_opposite_forces() {
    let mut sim = double(
        r#"(dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 3.0),
                        "oil": Fluid(density: 800.0, sound_speed: 30.0, viscosity: 40.0)},
            bodies: [
                (name: "water", material: "water", spacing: 0.05, formulation: Fluid(pressure: "300*cos(6*x)"),
                 shape: Box(min: (0, 0), max: (1, 0.5)), lattice: Relaxed(seed: 1, iterations: 1)),
                (name: "oil", material: "oil", spacing: 0.05, formulation: Fluid(pressure: "200*sin(5*y)"),
                 shape: Box(min: (0, 0.5), max: (1, 1)), lattice: Relaxed(seed: 2, iterations: 1)),
            ],
            conditions: [InitialVelocity(on: Select(), value: ("sin(7*y)", "0.5*cos(9*x)"))],
            time: (end: 1.0))"#,
    );
    sim.start().expect("a start");
    let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
    let viscosity: [f64; 2] = [3.0, 40.0];
    let (mut all, mut scale) = (Vec::new(), 0.0_f64);
    for body in 0..2 {
        let (x, v) = (column::<Position>(&sim, body), column::<Velocity>(&sim, body));
        let (rho, m) = (column::<Density>(&sim, body), column::<Mass>(&sim, body));
        let (p, f) = (column::<Pressure>(&sim, body), column::<Force>(&sim, body));
        for k in 0..x.len() {
            all.push((body, x[k].0, v[k].0, p[k].0, m[k].0 / rho[k].0, f[k].0));
            scale = scale.max(f[k].0.length());
        }
    }
    // x_ij, 2 mu_ij V_j w_ij and v_ij of the neighbours of a particle, and who they are.
    let neighbors = |i: usize| {
        let (a, x_a, v_a, ..) = all[i];
        let all = all.iter().enumerate();
        let of =
            move |(j, &(b, x_b, v_b, _, volume_b, _)): (usize, &(usize, DVec3, DVec3, f64, f64, DVec3))| {
                let x = (x_b - x_a).map(|x| x - x.round());
                let r = x.length();
                let mean = 2.0 * viscosity[a] * viscosity[b] / (viscosity[a] + viscosity[b]);
                (r > 0.0 && r < 0.15).then(|| {
                    let weight = -kernel.dw_dr(r, 0.075) / r * volume_b;
                    (j, x, weight, mean, v_b - v_a)
                })
            };
        all.filter_map(of).collect::<Vec<_>>()
    };
    let spin = |i: usize| {
        let (mut momentum, mut inertia) = (0.0, 0.0);
        for (_, x, weight, mean, v) in neighbors(i) {
            momentum += weight * mean * x.cross(v).z;
            inertia += weight * mean * x.length_squared();
        }
        (momentum / inertia, inertia)
    };
    let fits: Vec<(f64, f64)> = (0..all.len()).map(spin).collect();
    let sharpened = |i: usize| {
        let (own, inertia) = fits[i];
        let of = |(j, x, weight, mean, _): (usize, DVec3, f64, f64, DVec3)| {
            0.5 * weight * mean * x.length_squared() * (own - fits[j].0)
        };
        own + neighbors(i).into_iter().map(of).sum::<f64>() / inertia
    };
    let spins: Vec<f64> = (0..all.len()).map(sharpened).collect();
    let moments = |i: usize| {
        neighbors(i).into_iter().fold((DVec3::ZERO, 0.0), |(first, trace), (_, x, weight, ..)| {
            (first + weight * x, trace + weight * x.length_squared())
        })
    };
    let factor = pressure_factor((0..all.len()).map(moments), 0.075, 2);
    for (i, &(_, _, _, p_a, volume_a, found)) in all.iter().enumerate() {
        let mut sum = DVec3::ZERO;
        for (j, x, weight, mean, v) in neighbors(i) {
            let turning = 0.5 * (spins[i] + spins[j]) * DVec3::new(-x.y, x.x, 0.0);
            sum += volume_a * weight * (4.0 * mean * (v - turning) - factor * (p_a + all[j].3) * x);
        }
        assert!(found.distance(sum) < 1e-11 * scale, "{found} {sum}");
    }
    let momentum = |sim: &crate::simulation::Simulation| -> DVec3 {
        let of = |body| {
            let (m, v) = (column::<Mass>(sim, body), column::<Velocity>(sim, body));
            m.iter().zip(&v).map(|(m, v)| m.0 * v.0).sum::<DVec3>()
        };
        of(0) + of(1)
    };
    let before = momentum(&sim);
    sim.run(|sim| sim.clock().step < 100).expect("a run");
    assert!((momentum(&sim) - before).length() < 1e-10 * 900.0, "{before} {}", momentum(&sim));
    assert!(sim.ledger().relative_error().abs() < 2e-3, "{}", sim.ledger().relative_error());
}

#[test]
fn oil_lies_on_water() {
    let spacing = 0.025;
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, viscosity: 5.0), "oil": Fluid(density: 800.0, viscosity: 5.0)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.3, 0.2)), spacing: {spacing},
                 formulation: Fluid),
                (name: "oil", material: "oil", shape: Box(min: (0, 0.2), max: (0.3, 0.4)), spacing: {spacing}, formulation: Fluid),
                (name: "tank", material: "wall", spacing: {spacing}, formulation: Wall(),
                 shape: Difference(Box(min: (-0.1, -0.1), max: (0.4, 0.5)), Box(min: (0, 0), max: (0.3, 1)))),
            ],
            time: (end: 2.0))"#
    ));
    sim.run(|sim| sim.clock().time < 1.5).expect("a run");
    let full = 9.81 * (800.0 * 0.2 + 1000.0 * 0.2);
    let mut square = 0.0;
    let (water, oil) = (column::<Position>(&sim, 0), column::<Position>(&sim, 1));
    for (body, x) in [(0, &water), (1, &oil)] {
        for (x, p) in x.iter().zip(column::<Pressure>(&sim, body)) {
            let above = (0.4 - x.0.y).min(0.2);
            let below = (0.2 - x.0.y).max(0.0);
            square += ((p.0 - 9.81 * (800.0 * above + 1000.0 * below)) / full).powi(2);
        }
    }
    let rms = (square / (water.len() + oil.len()) as f64).sqrt();
    assert!(rms < 0.02, "pressure is off by {rms} of that at the bottom");
    let highest = water.iter().map(|x| x.0.y).fold(0.0, f64::max);
    let lowest = oil.iter().map(|x| x.0.y).fold(1.0, f64::min);
    assert!(highest < 0.2 && lowest > 0.2, "water up to {highest}, oil down to {lowest}");
    for body in 0..2 {
        let fastest = column::<Velocity>(&sim, body).iter().map(|v| v.0.length()).fold(0.0, f64::max);
        assert!(fastest < 0.02, "{fastest}");
    }
}

/// An open tank with walls and a floor 0.15 m thick, 0.3 m wide and 0.45 m deep inside, as text of an STL
/// file.
fn tank_mesh() -> String {
    let square = |low: f64, high: f64, y: f64| {
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, z)| DVec3::new(x, y, z))
    };
    let (outer, inner) = (
        [square(-0.15, 0.45, -0.15), square(-0.15, 0.45, 0.45)],
        [square(0.0, 0.3, 0.0), square(0.0, 0.3, 0.45)],
    );
    let mut faces = vec![outer[0], {
        let mut floor = inner[0];
        floor.reverse();
        floor
    }];
    for k in 0..4 {
        let next = (k + 1) % 4;
        faces.push([outer[0][next], outer[0][k], outer[1][k], outer[1][next]]);
        faces.push([inner[0][k], inner[0][next], inner[1][next], inner[1][k]]);
        faces.push([outer[1][next], outer[1][k], inner[1][k], inner[1][next]]);
    }
    let mut text = "solid tank\n".to_owned();
    for [a, b, c, d] in faces {
        for corners in [[a, b, c], [a, c, d]] {
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
            writeln!(text, "facet normal {} {} {}\nouter loop", normal.x, normal.y, normal.z).expect("text");
            for corner in corners {
                writeln!(text, "vertex {} {} {}", corner.x, corner.y, corner.z).expect("text");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid tank\n"
}

#[test]
fn a_tank_from_a_mesh_holds_water() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("tank.stl"), tank_mesh()).expect("a file");
    let scene = r#"(dimension: Three, gravity: (0.0, -9.81, 0.0),
        materials: {"water": Fluid(density: 1000.0, viscosity: 5.0)},
        bodies: [
            (name: "water", material: "water", shape: Box(min: (0, 0, 0), max: (0.3, 0.3, 0.3)), spacing: 0.05, formulation: Fluid),
            (name: "tank", material: "wall", shape: Mesh(file: "tank.stl"), spacing: 0.05, formulation: Wall()),
        ],
        time: (end: 1.0))"#;
    let path = folder.path().join("tank.ron");
    std::fs::write(&path, scene).expect("a file");
    let built = load(&path, &[]).and_then(|(scene, source)| build(&scene, &source, &Registry::standard()));
    let mut sim = built.unwrap_or_else(|error| panic!("{error}"));
    let walls = column::<Position>(&sim, 1);
    let hollow = |x: &DVec3| x.x > 0.0 && x.x < 0.3 && x.z > 0.0 && x.z < 0.3 && x.y > 0.0;
    assert!(
        walls.len() == 12 * 12 * 12 - 6 * 6 * 9 && !walls.iter().any(|x| hollow(&x.0)),
        "{}",
        walls.len()
    );
    let (mut pressure, mut count) = (0.0, 0.0);
    sim.run(|sim| {
        if sim.clock().time > 0.6 {
            for (x, p) in column::<Position>(sim, 0).iter().zip(column::<Pressure>(sim, 0)) {
                if x.0.y < 0.05 {
                    pressure += p.0 + 9810.0 * x.0.y;
                    count += 1.0;
                }
            }
        }
        sim.clock().time < 1.0
    })
    .expect("a run");
    let error = pressure / count / (9810.0 * 0.3) - 1.0;
    // Six layers: the surface is known to a part of one.
    assert!(error.abs() * 6.0 < 0.25, "pressure at the bottom is off by {error}");
    let water = column::<Position>(&sim, 0);
    assert!(water.iter().all(|x| hollow(&x.0) && x.0.y < 0.31), "some water has leaked");
    assert_eq!(sim.resources().get::<FlowCloud>().fluid, 216);
}

#[test]
fn half_a_plate_carries_half_the_water() {
    let deflection = |low: f64, left: &str| {
        let (water, plate) = (low.max(-0.3), low.max(-0.4));
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0.0, -9.81),
                materials: {{"water": Fluid(density: 1000.0, viscosity: 5.0), "rubber": NeoHookean(density: 1100, young: 2e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: ({water}, 0), max: (0.3, 0.3)), spacing: 0.025, formulation: Fluid),
                    (name: "plate", material: "rubber", shape: Box(min: ({plate}, -0.1), max: (0.4, 0)), spacing: 0.025,
                     formulation: TotalLagrangian),
                    (name: "walls", material: "wall", spacing: 0.025, formulation: Wall(),
                     shape: Union([Box(min: ({}, {}), max: ({water}, 0.4)), Box(min: (0.3, 0), max: (0.4, 0.4))])),
                ],
                conditions: [Fix(on: Select(body: "plate", within: Box(min: (0.3, -1), max: (1, 1)))), {left}],
                time: (end: 0.1))"#,
            water - 0.1,
            if low < 0.0 { 0.0 } else { -0.1 },
        ));
        sim.run(|_| true).expect("a run");
        assert!(sim.ledger().relative_error().abs() < 2e-3, "{}", sim.ledger().relative_error());
        let (at, now) = (column::<ReferencePosition>(&sim, 1), column::<Position>(&sim, 1));
        let middle = (0..at.len()).filter(|&k| (0.0..0.02).contains(&at[k].0.x) && at[k].0.y < -0.08);
        let moved: Vec<f64> = middle.map(|k| now[k].0.y - at[k].0.y).collect();
        assert_eq!(moved.len(), 1);
        moved[0]
    };
    let whole =
        deflection(-0.4, r#"Fix(on: Select(body: "plate", within: Box(min: (-1, -1), max: (-0.3, 1))))"#);
    let half = deflection(0.0, "Symmetry(plane: X, at: 0.0)");
    // The last half support of the half plate lacks water to press on it.
    assert!(whole < -1e-2 && (half / whole - 1.0).abs() < 0.05, "{half} {whole}");
}

#[test]
fn patterns_of_contacts_leave_out_fluids_and_pairs_of_walls() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {"water": Fluid(density: 1000.0, viscosity: 5.0), "steel": Steel, "rubber": NeoHookean(density: 1100, young: 1e6, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.6, 0.1)), spacing: 0.025, formulation: Fluid),
                (name: "floor", material: "wall", shape: Box(min: (-0.1, -0.1), max: (0.7, 0)), spacing: 0.025, formulation: Wall()),
                (name: "left", material: "wall", shape: Box(min: (-0.1, 0), max: (0, 0.4)), spacing: 0.025, formulation: Wall()),
                (name: "right", material: "wall", shape: Box(min: (0.6, 0), max: (0.7, 0.4)), spacing: 0.025, formulation: Wall()),
                (name: "block", material: "steel", shape: Box(min: (0.1, 0.2), max: (0.2, 0.3)), spacing: 0.025, formulation: Rigid()),
                (name: "sheet", material: "rubber", shape: Box(min: (0.3, 0.2), max: (0.4, 0.3)), spacing: 0.025, formulation: TotalLagrangian),
            ],
            contacts: [Contact(between: ("*", "*"), law: Penalty(stiffness: 1e6))],
            time: (end: 0.01))"#,
    );
    sim.run(|_| true).expect("a run");
}
