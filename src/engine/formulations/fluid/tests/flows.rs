//! Flows against naive second implementations, closed forms, and the energy balance.

use glam::{DMat3, DVec3};

use schemars::JsonSchema;
use serde::Deserialize;

use super::{column, double, pressure_factor, simulation, simulation_with};
use crate::formulations::fluid::FlowCloud;
use crate::kernels::{Kernel, KernelName};
use crate::plugin::{Plugin, Registry, SetupError, SimBuilder};
use crate::scene::Select;
use crate::simulation::Simulation;
use crate::world::{Density, Force, Mass, ParticleId, Position, Pressure, ReferenceVolume, Velocity};

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

/// The particles of both bodies; walls with pressure and velocity recomputed from the fluid.
fn particles(sim: &Simulation, no_slip: bool, kernel: &Kernel, h: f64) -> (Vec<Particle>, Vec<Particle>) {
    let (x, v) = (column::<Position>(sim, 0), column::<Velocity>(sim, 0));
    let (rho, m) = (column::<Density>(sim, 0), column::<Mass>(sim, 0));
    let fluid: Vec<Particle> = column::<Pressure>(sim, 0)
        .iter()
        .enumerate()
        .map(|(k, p)| Particle { x: x[k].0, v: v[k].0, seen: v[k].0, p: p.0, volume: m[k].0 / rho[k].0 })
        .collect();
    let state = sim.resources().get::<FlowCloud>().groups[0].fluid().copied().expect("a fluid");
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

/// `-W' / r` of a pair that is not one particle.
fn weight(x: DVec3, kernel: &Kernel, h: f64) -> f64 {
    -kernel.dw_dr(x.length(), h) / x.length()
}

/// The first moment of a particle among all others, 1/m, and the trace of the second.
fn moments<'a>(
    a: &Particle,
    all: impl Iterator<Item = &'a Particle>,
    kernel: &Kernel,
    h: f64,
) -> (DVec3, f64) {
    let others = all.filter(|b| b.x != a.x).map(|b| (b.x - a.x, b.volume));
    others.fold((DVec3::ZERO, 0.0), |(first, trace), (x, volume)| {
        let weight = volume * weight(x, kernel, h);
        (first + weight * x, trace + weight * x.length_squared())
    })
}

/// Force of b on a, by the formula of the module in ten plain lines; `spin` is that of the pair.
fn pair_force(a: &Particle, b: &Particle, viscosity: f64, spin: DVec3, (kernel, h): (&Kernel, f64)) -> DVec3 {
    let x = b.x - a.x;
    if x == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let pressure = -(a.p + b.p) * x;
    let friction = 4.0 * viscosity * (b.seen - a.seen - spin.cross(x));
    a.volume * b.volume * weight(x, kernel, h) * (pressure + friction)
}

/// `r^2 I - x (x) x`.
fn inertia(x: DVec3) -> DMat3 {
    DMat3::from_diagonal(DVec3::splat(x.dot(x))) - DMat3::from_cols(x * x.x, x * x.y, x * x.z)
}

/// The spin of a particle among all others: the matrix of inertia is inverted as it is, and returned beside
/// the spin.
fn spin<'a>(
    a: &Particle,
    all: impl Iterator<Item = &'a Particle>,
    kernel: &Kernel,
    h: f64,
    plane: bool,
) -> (DVec3, DMat3) {
    let (mut sum, mut momentum) = (DMat3::ZERO, DVec3::ZERO);
    for b in all.filter(|b| b.x != a.x) {
        let x = b.x - a.x;
        let mass = b.volume * weight(x, kernel, h);
        sum += mass * inertia(x);
        momentum += mass * x.cross(b.seen - a.seen);
    }
    if plane {
        // Rotations in the plane alone.
        sum = DMat3::from_diagonal(DVec3::new(1.0, 1.0, sum.z_axis.z));
        momentum *= DVec3::Z;
    }
    let inverse = sum.inverse();
    (inverse * momentum, inverse)
}

#[test]
fn forces_are_those_of_a_naive_sum_over_all_pairs_and_opposite_on_the_wall() {
    for dimension in [2, 3] {
        for (wall, no_slip) in [("", false), ("slip: No", true)] {
            let mut sim = double(&dam(dimension, wall));
            sim.start().expect("a start");
            let support = if dimension == 2 { 3.0 * 0.04 } else { 2.6 * 0.05 };
            let (kernel, h) =
                (Kernel::new(KernelName::WendlandC2, dimension).expect("a kernel"), 0.5 * support);
            let (mut fluid, mut walls) = particles(&sim, no_slip, &kernel, h);
            let of = |a: &Particle| moments(a, fluid.iter().chain(&walls), &kernel, h);
            let factor = pressure_factor(fluid.iter().map(of), h, dimension);
            fluid.iter_mut().chain(&mut walls).for_each(|particle| particle.p *= factor);
            let mass = column::<Mass>(&sim, 0);
            let forces = column::<Force>(&sim, 0);
            let scale = forces.iter().map(|f| f.0.length()).fold(0.0, f64::max);
            // Walls along which the fluid slides have no part in its spin.
            let sticky = if no_slip { &walls[..] } else { &[] };
            let of = |a: &Particle| spin(a, fluid.iter().chain(sticky), &kernel, h, dimension == 2);
            let fits: Vec<(DVec3, DMat3)> = fluid.iter().map(of).collect();
            let sharpened = |(a, (own, inverse)): (&Particle, &(DVec3, DMat3))| {
                let others = fluid.iter().zip(&fits).filter(|(b, _)| b.x != a.x);
                let of = others.map(|(b, (other, _))| {
                    let x = b.x - a.x;
                    0.5 * b.volume * weight(x, &kernel, h) * (inertia(x) * (*own - *other))
                });
                *own + *inverse * of.sum::<DVec3>()
            };
            let spins: Vec<DVec3> = fluid.iter().zip(&fits).map(sharpened).collect();
            for (k, particle) in fluid.iter().enumerate() {
                let of_fluid = fluid.iter().zip(&spins).map(|(other, other_spin)| {
                    pair_force(particle, other, 2.0, 0.5 * (spins[k] + *other_spin), (&kernel, h))
                });
                let friction = if no_slip { 2.0 } else { 0.0 };
                let of_wall =
                    walls.iter().map(|other| pair_force(particle, other, friction, spins[k], (&kernel, h)));
                let sum: DVec3 = of_fluid.chain(of_wall).sum();
                let wanted = sum + mass[k].0 * DVec3::new(0.0, -9.81, 0.0);
                let found = forces[k].0;
                assert!(found.distance(wanted) < 1e-11 * scale, "{dimension}: {found} {wanted}");
            }
            let on_walls = column::<Force>(&sim, 1);
            let (mut all, mut torque) = (DVec3::ZERO, DVec3::ZERO);
            for (particle, (force, mass)) in fluid.iter().zip(forces.iter().zip(&mass)) {
                let of_flow = force.0 + 9.81 * mass.0 * DVec3::Y;
                all += of_flow;
                torque += particle.x.cross(of_flow);
            }
            for (particle, force) in walls.iter().zip(&on_walls) {
                all += force.0;
                torque += particle.x.cross(force.0);
            }
            let turnover: f64 = forces.iter().map(|f| f.0.length()).sum();
            assert!(all.length() < 1e-12 * turnover, "{dimension} {wall}: {all}");
            assert!(torque.length() < 1e-12 * turnover, "{dimension} {wall}: {torque}");
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
    let mut sim = double(text);
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
    // In single precision the sums of each particle are rounded: three deviations of that over the steps.
    for (mut sim, most) in [(double(text), 1e-10), (simulation(text), 1e-7)] {
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
        assert!((momentum(&sim) - before).length() < most * 500.0, "{before} {}", momentum(&sim));
        assert!(sim.ledger().total_named("strain") > 0.0);
        assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
    }
}

#[test]
fn a_dam_break_keeps_its_energy_in_the_books() {
    let mut sim = simulation(&dam(2, "slip: No"));
    sim.run(|sim| sim.clock().time < 0.4).expect("a run");
    let ledger = sim.ledger();
    assert!(ledger.total_named("gravity") > 50.0 && ledger.total_named("viscosity") > 0.0);
    assert!(ledger.relative_error().abs() < 2e-3, "{}", ledger.relative_error());
}

/// Holds the water by its rows, and does nothing.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Hold {}

impl Plugin for Hold {
    const NAME: &'static str = "hold";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        sim.select(&Select { body: Some("water".to_owned()), ..Select::default() }, "").map(|_| ())
    }
}

/// Also under a load on some of them that varies in place and time.
#[test]
fn sorted_particles_move_as_those_that_keep_their_rows() {
    let part = r#"Select(body: "water", within: Box(min: (0.1, 0.1), max: (0.3, 0.3)))"#;
    let force = format!(r#"Force(on: {part}, value: ("400*x", "200*t"))"#);
    let positions = |plugins: &str| {
        let text = dam(2, "").replace("conditions: [", &format!("conditions: [{force}, "));
        let text = text.replacen("(dimension", &format!("(precision: Double, {plugins}dimension"), 1);
        let mut registry = Registry::standard();
        registry.plugin::<Hold>();
        let mut sim = simulation_with(&registry, &text);
        run(&mut sim, 300);
        let ids: Vec<u64> = column::<ParticleId>(&sim, 0).iter().map(|id| id.0).collect();
        let mut rows: Vec<usize> = (0..ids.len()).collect();
        rows.sort_by_key(|&row| ids[row]);
        let x = column::<Position>(&sim, 0);
        (ids.is_sorted(), rows.into_iter().map(|row| x[row].0).collect::<Vec<_>>())
    };
    let (as_made, sorted) = positions("");
    assert!(!as_made);
    let (as_made, held) = positions("plugins: [hold()], ");
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
    let cloud = sim.resources().get::<FlowCloud>();
    let found = cloud.groups[0].fluid().expect("a fluid").sound_speed;
    let positions = column::<Position>(&sim, 0);
    let heights = positions.iter().map(|x| x.0.y);
    let height = heights.clone().fold(0.0, f64::max) - heights.fold(1.0, f64::min);
    assert!((found - 10.0 * (2.0 * 9.81 * height).sqrt()).abs() < 1e-9, "{found}");
}

#[test]
fn drops_that_fly_together_have_the_sound_of_their_meeting() {
    let sound = |common: f64| {
        let (left, right) = (common + 2.0, common - 2.0);
        let sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0)}},
                bodies: [
                    (name: "one", material: "water", shape: Sphere(center: (0, 0), radius: 0.1), spacing: 0.02, formulation: Fluid, velocity: ({left}, 0)),
                    (name: "other", material: "water", shape: Sphere(center: (0.5, 0), radius: 0.1), spacing: 0.02, formulation: Fluid, velocity: ({right}, 0)),
                ], time: (end: 0.01))"#
        ));
        let cloud = sim.resources().get::<FlowCloud>();
        cloud.groups[0].fluid().expect("a fluid").sound_speed
    };
    assert!((sound(0.0) - 20.0).abs() < 1e-10);
    // Each meets the plane between them at 2 m/s, however fast both fly.
    assert!((sound(300.0) - 20.0).abs() < 1e-10);
}

#[test]
fn a_tank_that_moves_with_its_water_takes_the_steps_of_a_tank_at_rest() {
    let steps = |common: f64| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02, formulation: Fluid, velocity: ({common}, 0)),
                    (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(), velocity: ({common}, 0),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (0.46, 0.4)), Box(min: (0, 0), max: (0.4, 1)))),
                ], time: (end: 0.1))"#
        ));
        sim.run(|_| true).expect("a run");
        sim.clock().step
    };
    // At 3.8 m/s, 0.19 of the speed of sound, there was a sixth more.
    assert_eq!(steps(3.8), steps(0.0));
}
