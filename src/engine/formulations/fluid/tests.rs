//! Flows against naive second implementations, closed forms, and the books.

use glam::{DMat3, DVec3};

use crate::assembly::build;
use crate::kernels::{Kernel, KernelName};
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{
    BodyId, Column, Density, Force, Mass, ParticleId, Position, Pressure, ReferenceVolume, Velocity,
};

pub(super) fn simulation(text: &str) -> Simulation {
    let registry = Registry::standard();
    let built =
        parse(Source::new("test.ron", text)).and_then(|(scene, source)| build(&scene, &source, &registry));
    match built {
        Ok(simulation) => simulation,
        Err(error) => panic!("{error}"),
    }
}

pub(super) fn column<C: Column + Copy>(sim: &Simulation, body: usize) -> Vec<C> {
    let (view, rows) = sim.world().body_view(BodyId(body));
    view.read::<C>().expect("a column")[rows].to_vec()
}

fn run(sim: &mut Simulation, steps: u64) {
    sim.run(|sim| sim.clock().step < steps).expect("a run");
}

fn dam(dimension: usize, wall: &str) -> String {
    let (name, water, outer, inner, spacing) = if dimension == 2 {
        ("Two", "(0, 0), max: (0.4, 0.4)", "(-0.12, -0.12), max: (0.92, 0.8)", "(0, 0), max: (0.8, 1)", 0.04)
    } else {
        (
            "Three",
            "(0, 0, 0), max: (0.4, 0.4, 0.4)",
            "(-0.15, -0.15, -0.15), max: (0.75, 0.6, 0.55)",
            "(0, 0, 0), max: (0.6, 1, 0.4)",
            0.05,
        )
    };
    format!(
        r#"(dimension: {name}, gravity: (0.0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, viscosity: 2.0, eos: Tait(gamma: 7.0))}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: {water}), spacing: {spacing:?}, formulation: Fluid,
                 lattice: Relaxed(seed: 3, iterations: 1)),
                (name: "tank", material: "wall", shape: Difference(Box(min: {outer}), Box(min: {inner})),
                 spacing: {spacing:?}, formulation: Wall({wall})),
            ],
            conditions: [InitialVelocity(on: Select(body: "water"), value: ("0.3 + y - 2*x", "0.1 + 3*x"))],
            time: (end: 1.0))"#
    )
}

/// A particle as the second implementation sees it.
struct Particle {
    x: DVec3,
    v: DVec3,
    seen: DVec3,
    p: f64,
    volume: f64,
}

/// The particles of both bodies; walls with pressure and velocity made anew from the fluid.
fn particles(sim: &Simulation, no_slip: bool, kernel: &Kernel, h: f64) -> (Vec<Particle>, Vec<Particle>) {
    let (x, v) = (column::<Position>(sim, 0), column::<Velocity>(sim, 0));
    let (rho, m) = (column::<Density>(sim, 0), column::<Mass>(sim, 0));
    let fluid: Vec<Particle> = column::<Pressure>(sim, 0)
        .iter()
        .enumerate()
        .map(|(k, p)| Particle { x: x[k].0, v: v[k].0, seen: v[k].0, p: p.0, volume: m[k].0 / rho[k].0 })
        .collect();
    let state = sim.resources().get::<super::FlowCloud>().groups[0].fluid().copied().expect("a fluid");
    let (x, volume) = (column::<Position>(sim, 1), column::<ReferenceVolume>(sim, 1));
    let gravity = DVec3::new(0.0, -9.81, 0.0);
    let wall = (0..x.len()).map(|k| {
        let x = x[k].0;
        let (mut total, mut p, mut v, mut moment) = (0.0, 0.0, DVec3::ZERO, DVec3::ZERO);
        for f in &fluid {
            let w = f.volume * kernel.w(f.x.distance(x), h);
            total += w;
            p += w * f.p;
            v += w * f.v;
            moment += w * (state.density + f.p / state.sound_speed.powi(2)) * (x - f.x);
        }
        let (p, seen) = if total > 1e-10 {
            let p = ((p + gravity.dot(moment)) / total).max(0.0);
            (p, if no_slip { -v / total } else { DVec3::ZERO })
        } else {
            (0.0, DVec3::ZERO)
        };
        Particle { x, v: DVec3::ZERO, seen, p, volume: volume[k].0 }
    });
    let wall = wall.collect();
    (fluid, wall)
}

/// Force of b on a, by the formula of the module in ten plain lines.
fn pair_force(a: &Particle, b: &Particle, viscosity: f64, kernel: &Kernel, h: f64) -> DVec3 {
    let x = b.x - a.x;
    let r = x.length();
    if r == 0.0 {
        return DVec3::ZERO;
    }
    let gradient = -kernel.dw_dr(r, h) * x / r;
    let pressure = -(a.p + b.p) * gradient;
    let friction = 2.0 * viscosity * gradient.dot(x) / (r * r) * (b.seen - a.seen);
    a.volume * b.volume * (pressure + friction)
}

/// `mu (grad v)^T` of a particle from all others, with the inverse of the plain moment matrix.
fn transposed_stress(
    a: &Particle,
    all: &[Particle],
    viscosity: f64,
    kernel: &Kernel,
    h: f64,
    plane: bool,
) -> DMat3 {
    let (mut moment, mut stress) = (DMat3::ZERO, DMat3::ZERO);
    for b in all.iter().filter(|b| b.x != a.x) {
        let x = b.x - a.x;
        let weight = -b.volume * kernel.dw_dr(x.length(), h) / x.length();
        let dyad = |u: DVec3, v: DVec3| DMat3::from_cols(u * v.x, u * v.y, u * v.z);
        moment += weight * dyad(x, x);
        stress += weight * dyad(x, b.v - a.v);
    }
    if plane {
        moment.z_axis.z = 1.0;
    }
    moment.inverse() * stress * viscosity
}

#[test]
fn forces_are_those_of_a_naive_sum_over_all_pairs_and_opposite_on_the_wall() {
    for dimension in [2, 3] {
        for (wall, no_slip) in [("", false), ("slip: No", true)] {
            let mut sim = simulation(&dam(dimension, wall));
            sim.start().expect("a start");
            let support = if dimension == 2 { 3.0 * 0.04 } else { 2.6 * 0.05 };
            let (kernel, h) =
                (Kernel::new(KernelName::WendlandC2, dimension).expect("a kernel"), 0.5 * support);
            let (fluid, walls) = particles(&sim, no_slip, &kernel, h);
            let mass = column::<Mass>(&sim, 0);
            let forces = column::<Force>(&sim, 0);
            let scale = forces.iter().map(|f| f.0.length()).fold(0.0, f64::max);
            let stress = |a: &Particle| transposed_stress(a, &fluid, 2.0, &kernel, h, dimension == 2);
            let stresses: Vec<DMat3> = fluid.iter().map(stress).collect();
            for (k, particle) in fluid.iter().enumerate() {
                let of_surface = fluid.iter().zip(&stresses).map(|(b, stress)| {
                    let x = b.x - particle.x;
                    let weight = -kernel.dw_dr(x.length(), h) / x.length().max(1e-300);
                    particle.volume * b.volume * weight * ((stresses[k] + *stress) * x)
                });
                let of_fluid = fluid.iter().map(|other| pair_force(particle, other, 2.0, &kernel, h));
                let friction = if no_slip { 2.0 } else { 0.0 };
                let of_wall = walls.iter().map(|other| pair_force(particle, other, friction, &kernel, h));
                let sum: DVec3 = of_fluid.chain(of_wall).chain(of_surface).sum();
                let wanted = sum + mass[k].0 * DVec3::new(0.0, -9.81, 0.0);
                let found = forces[k].0;
                assert!(found.distance(wanted) < 1e-11 * scale, "{dimension}: {found} {wanted}");
            }
            let weight: f64 = mass.iter().map(|m| m.0 * -9.81).sum();
            let all: DVec3 = forces.iter().chain(&column::<Force>(&sim, 1)).map(|f| f.0).sum::<DVec3>()
                - weight * DVec3::Y;
            let turnover: f64 = forces.iter().map(|f| f.0.length()).sum();
            assert!(all.length() < 1e-12 * turnover, "{dimension} {wall}: {all}");
        }
    }
}

#[test]
fn momentum_is_kept_in_a_periodic_box() {
    let text = r#"(dimension: Three, domain: (min: (0, 0, 0), max: (1, 1, 1), periodic: [X, Y, Z]),
        materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 5.0)},
        bodies: [(name: "water", material: "water", shape: Box(min: (0, 0, 0), max: (1, 1, 1)), spacing: 0.125,
                  formulation: Fluid(pressure: "1000*sin(6.283185307179586*x)"))],
        conditions: [InitialVelocity(on: Select(), value: ("sin(6.283185307179586*y)", "0.5", "cos(6.283185307179586*x)"))],
        time: (end: 1.0))"#;
    let mut sim = simulation(text);
    let momentum = |sim: &Simulation| -> DVec3 {
        let (m, v) = (column::<Mass>(sim, 0), column::<Velocity>(sim, 0));
        m.iter().zip(&v).map(|(m, v)| m.0 * v.0).sum()
    };
    sim.start().expect("a start");
    let before = momentum(&sim);
    run(&mut sim, 60);
    assert!((momentum(&sim) - before).length() < 1e-11 * 1000.0, "{before} {}", momentum(&sim));
    assert!(sim.ledger().relative_error().abs() < 1e-3, "{}", sim.ledger().relative_error());
    assert!(sim.ledger().total_named("viscosity") > 0.0);
}

#[test]
fn momentum_and_energy_of_a_fluid_with_a_solid_in_it_are_kept() {
    let text = r#"(dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
        materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 2.0),
                    "rubber": NeoHookean(density: 1200.0, young: 4.0e5, poisson: 0.3)},
        bodies: [
            (name: "water", material: "water", spacing: 0.04, formulation: Fluid,
             shape: Difference(Box(min: (0, 0), max: (1, 1)), Box(min: (0.4, 0.4), max: (0.64, 0.64)))),
            (name: "block", material: "rubber", spacing: 0.04, formulation: TotalLagrangian,
             shape: Box(min: (0.4, 0.4), max: (0.64, 0.64))),
        ],
        conditions: [InitialVelocity(on: Select(body: "water"), value: ("sin(2*pi*y)", "0.3")),
                     InitialVelocity(on: Select(body: "block"), value: ("-0.5", "0.5"))],
        time: (end: 1.0))"#;
    let mut sim = simulation(text);
    let momentum = |sim: &Simulation| -> DVec3 {
        let sum = |body| {
            let (m, v) = (column::<Mass>(sim, body), column::<Velocity>(sim, body));
            m.iter().zip(&v).map(|(m, v)| m.0 * v.0).sum::<DVec3>()
        };
        sum(0) + sum(1)
    };
    sim.start().expect("a start");
    let before = momentum(&sim);
    sim.run(|sim| sim.clock().time < 0.2).expect("a run");
    assert!((momentum(&sim) - before).length() < 1e-10 * 500.0, "{before} {}", momentum(&sim));
    assert!(sim.ledger().total_named("strain") > 0.0);
    assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
}

#[test]
fn a_dam_break_keeps_its_energy_in_the_books() {
    let mut sim = simulation(&dam(2, "slip: No"));
    sim.run(|sim| sim.clock().time < 0.4).expect("a run");
    let ledger = sim.ledger();
    assert!(ledger.total_named("gravity") > 50.0 && ledger.total_named("viscosity") > 0.0);
    assert!(ledger.relative_error().abs() < 2e-3, "{}", ledger.relative_error());
}

#[test]
fn sorted_particles_move_as_those_that_keep_their_rows() {
    let positions = |condition: &str| {
        let text = dam(2, "").replace("conditions: [", &format!("conditions: [{condition}"));
        let mut sim = simulation(&text);
        run(&mut sim, 300);
        let ids: Vec<u64> = column::<ParticleId>(&sim, 0).iter().map(|id| id.0).collect();
        let mut rows: Vec<usize> = (0..ids.len()).collect();
        rows.sort_by_key(|&row| ids[row]);
        let x = column::<Position>(&sim, 0);
        (ids.is_sorted(), rows.into_iter().map(|row| x[row].0).collect::<Vec<_>>())
    };
    let (as_made, sorted) = positions("");
    assert!(!as_made);
    let (as_made, held) =
        positions(r#"Force(on: Select(body: "water", nearest: (0, 0)), value: ("0", "0")),"#);
    assert!(as_made);
    let farthest = sorted.iter().zip(&held).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(farthest < 1e-6 * 0.04, "{farthest}");
}

#[test]
fn water_at_rest_stays_at_rest() {
    let text = dam(2, "").replace("lattice: Relaxed(seed: 3, iterations: 1)", "");
    let text = text.replace("0.3 + y - 2*x", "0").replace("0.1 + 3*x", "0");
    let text = text.replace("max: (0.4, 0.4)", "max: (0.8, 0.4)");
    let mut sim = simulation(&text);
    sim.run(|sim| sim.clock().time < 0.5).expect("a run");
    let fastest = column::<Velocity>(&sim, 0).iter().map(|v| v.0.length()).fold(0.0, f64::max);
    assert!(fastest < 0.05, "{fastest}");
    let bottom = column::<Position>(&sim, 0);
    let lowest = bottom.iter().map(|x| x.0.y).fold(f64::INFINITY, f64::min);
    assert!((lowest - 0.02).abs() < 0.004, "{lowest}");
}

#[test]
fn the_sound_speed_is_ten_times_that_of_a_fall_through_the_water() {
    let sim = simulation(&dam(2, ""));
    let cloud = sim.resources().get::<super::FlowCloud>();
    let found = cloud.groups[0].fluid().expect("a fluid").sound_speed;
    let positions = column::<Position>(&sim, 0);
    let heights = positions.iter().map(|x| x.0.y);
    let height = heights.clone().fold(0.0, f64::max) - heights.fold(1.0, f64::min);
    assert!((found - 10.0 * (2.0 * 9.81 * height).sqrt()).abs() < 1e-9, "{found}");
}
