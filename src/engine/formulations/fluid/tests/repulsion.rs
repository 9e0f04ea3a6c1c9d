//! Lone particles and boundaries: nothing passes, energy and momentum are kept, and nothing is pushed at
//! rest.

use glam::DVec3;

use super::{column, simulation};
use crate::kernels::{Kernel, KernelName};
use crate::simulation::Simulation;
use crate::world::{BodyId, Density, Force, Mass, Position, Pressure, ReferenceVolume, Velocity};

pub const SPACING: f64 = 0.02;
const SOUND: f64 = 10.0;
const DENSITY: f64 = 1000.0;

/// Lone particles above a body whose surface is at y = 0, at a height in spacings, from right above a
/// particle of it to right above a gap; their density is over that at rest.
pub fn rain(dimension: usize, height: f64, velocity: DVec3, density: f64, below: &str) -> Simulation {
    rain_in("Mixed", (dimension, height, velocity, density), below)
}

/// The same in that precision.
fn rain_in(
    precision: &str,
    (dimension, height, velocity, density): (usize, f64, DVec3, f64),
    below: &str,
) -> Simulation {
    let (name, size, floor) = if dimension == 3 {
        ("Three", "(0.04, 1.04, 0.04)", "Box(min: (-0.2, -0.08, -0.2), max: (0.8, 0.0, 0.2))")
    } else {
        ("Two", "(0.04, 1.04)", "Box(min: (-0.2, -0.08), max: (0.8, 0.0))")
    };
    let shape = if below.contains("shape:") { String::new() } else { format!("shape: {floor}") };
    let low = if dimension == 3 { "(0, 1, 0)" } else { "(0, 1)" };
    let sim = simulation(&format!(
        r#"(precision: {precision}, dimension: {name}, materials: {{"water": Fluid(density: {DENSITY}, sound_speed: {SOUND}), "rubber": NeoHookean(density: 1200.0, young: 1.0e5, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", spacing: {SPACING}, formulation: Fluid(pressure: 0.0), shape: Box(min: {low}, max: {size})),
                (name: "below", {below}, spacing: {SPACING}, {shape}),
            ], time: (end: 1.0))"#
    ));
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (mut x, mut v) =
        (view.write::<Position>().expect("places"), view.write::<Velocity>().expect("velocities"));
    let count = rows.len();
    for (k, row) in rows.clone().enumerate() {
        let aside = 0.5 * SPACING * k as f64 / (count - 1) as f64;
        x[row].0 = DVec3::new(
            0.08 * k as f64 + 0.01 + aside,
            height * SPACING,
            if dimension == 3 { 0.01 + aside } else { 0.0 },
        );
        v[row].0 = velocity;
    }
    view.write::<Density>().expect("densities")[rows].fill(Density(density * DENSITY));
    drop((x, v));
    sim
}

pub const WALL: &str = r#"material: "wall", formulation: Wall()"#;

/// Lone particles fall onto `below` at these speeds over that of sound; particles that were torn out of a
/// fluid have lost density, and are drawn to the wall.
fn assert_that_nothing_passes(dimension: usize, falls: [(f64, f64); 4], below: &str) {
    for (speed, density) in falls {
        let velocity = DVec3::new(0.3, -1.0, 0.0).normalize() * speed * SOUND;
        let mut sim = rain(dimension, 2.6, velocity, density, below);
        let mut lowest = f64::INFINITY;
        sim.run(|sim| {
            let heights = column::<Position>(sim, 0).into_iter().map(|x| x.0.y);
            lowest = heights.fold(lowest, f64::min);
            sim.clock().time < 0.1 / (speed * SOUND)
        })
        .expect("a run");
        assert!(lowest > -0.5 * SPACING && lowest < 2.0 * SPACING, "{dimension} {speed} {density}: {lowest}");
        let balance = sim.ledger().relative_error().abs();
        assert!(balance < 0.02, "{dimension} {speed} {density}: {balance}");
    }
}

#[test]
fn lone_particles_do_not_pass_a_wall_and_keep_their_energy() {
    for dimension in [2, 3] {
        assert_that_nothing_passes(dimension, [(0.02, 1.0), (0.2, 1.0), (0.02, 0.5), (0.2, 0.4)], WALL);
    }
}

/// The particles of such a wall repel as spheres, between which a particle that is drawn to it with half of
/// its density passes.
#[test]
fn lone_particles_do_not_pass_a_wall_from_a_particle_file() {
    for dimension in [2, 3] {
        let rows = |low: f64, high: f64| {
            let count = ((high - low) / SPACING).round() as i32;
            (0..count).map(move |k| low + (f64::from(k) + 0.5) * SPACING)
        };
        let across: Vec<f64> = if dimension == 3 { rows(-0.2, 0.2).collect() } else { vec![0.0] };
        let mut text = "x,y,z,volume\n".to_owned();
        for x in rows(-0.2, 0.8) {
            for y in rows(-0.08, 0.0) {
                for z in &across {
                    text += &format!("{x},{y},{z},{}\n", SPACING.powi(dimension as i32));
                }
            }
        }
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("floor.csv");
        std::fs::write(&file, text).expect("a file");
        let falls = [(0.02, 1.0), (0.2, 1.0), (0.02, 0.9), (0.2, 0.9)];
        assert_that_nothing_passes(dimension, falls, &format!("{WALL}, shape: Points(file: {file:?})"));
    }
}

#[test]
fn the_force_is_that_of_the_distance_and_its_opposite_is_on_the_wall() {
    for dimension in [2, 3] {
        let mut sim = rain_in("Double", (dimension, 2.6, DVec3::new(0.3, -2.0, 0.0), 0.5), WALL);
        let kernel = Kernel::new(KernelName::WendlandC2, dimension).expect("a kernel");
        let h = 0.5 * SPACING * if dimension == 3 { 2.6 } else { 3.0 };
        let stiffness = DENSITY * SPACING.powi(dimension as i32) * (3.0 * SOUND / h).powi(2);
        let (floor, volume) = (column::<Position>(&sim, 1), column::<ReferenceVolume>(&sim, 1));
        let mut repelled = 0;
        sim.run(|sim| {
            let (x, p) = (column::<Position>(sim, 0), column::<Pressure>(sim, 0));
            let (m, rho) = (column::<Mass>(sim, 0), column::<Density>(sim, 0));
            let found = column::<Force>(sim, 0);
            let (mut sum, mut torque) = (DVec3::ZERO, DVec3::ZERO);
            for k in 0..x.len() {
                let gap = 0.15 * SPACING - x[k].0.y;
                repelled += i32::from(gap > 0.0);
                let mut force = stiffness * gap.max(0.0) * DVec3::Y;
                for (w, volume) in floor.iter().zip(&volume) {
                    let (x, p) = (w.0 - x[k].0, p[k].0);
                    let weight = -kernel.dw_dr(x.length(), h) / x.length();
                    force -= m[k].0 / rho[k].0 * volume.0 * (p + p.max(0.0)) * weight * x;
                }
                let error = (found[k].0 - force).length();
                assert!(
                    sim.clock().step == 0 || error <= 1e-6 * (1.0 + force.length()),
                    "{} {force}",
                    found[k].0
                );
                sum += found[k].0;
                torque += x[k].0.cross(found[k].0);
            }
            let on_wall = column::<Force>(sim, 1);
            let wall: DVec3 = on_wall.iter().map(|force| force.0).sum();
            assert!((sum + wall).length() <= 1e-9 * (1.0 + sum.length()), "{sum} {wall}");
            let turned: DVec3 = on_wall.iter().zip(&floor).map(|(force, x)| x.0.cross(force.0)).sum();
            assert!((torque + turned).length() <= 1e-9 * (1.0 + torque.length()), "{torque} {turned}");
            sim.clock().time < 0.035
        })
        .expect("a run");
        assert!(repelled > 0);
    }
}

/// The motion of a wall that rests is kept: it must not be when it has moved.
#[test]
fn a_wall_that_has_risen_repels_where_it_is() {
    let rise = 2.0 * SPACING;
    let mut sim = rain(2, 4.6, DVec3::new(0.0, -1.0, 0.0), 0.5, WALL);
    sim.run(|sim| sim.clock().time < 0.01).expect("a run");
    let (view, rows) = sim.world().body_view(BodyId(1));
    view.write::<Position>().expect("places")[rows].iter_mut().for_each(|x| x.0.y += rise);
    let mut lowest = f64::INFINITY;
    sim.run(|sim| {
        lowest = column::<Position>(sim, 0).into_iter().map(|x| x.0.y).fold(lowest, f64::min);
        sim.clock().time < 0.1
    })
    .expect("a run");
    assert!(lowest < rise + 0.15 * SPACING, "{lowest}");
    assert!(lowest > rise - 0.5 * SPACING, "{lowest}");
}

#[test]
fn a_body_that_is_hit_gets_the_momentum() {
    for body in
        [r#"material: "rubber", formulation: Rigid()"#, r#"material: "rubber", formulation: TotalLagrangian"#]
    {
        let mut sim = rain_in("Double", (2, 2.6, DVec3::new(0.3, -2.0, 0.0), 0.5), body);
        let momentum = |sim: &Simulation| -> DVec3 {
            let of = |body| {
                let (m, v) = (column::<Mass>(sim, body), column::<Velocity>(sim, body));
                m.iter().zip(&v).map(|(m, v)| m.0 * v.0).sum::<DVec3>()
            };
            of(0) + of(1)
        };
        sim.start().expect("a start");
        let before = momentum(&sim);
        let mut lowest = f64::INFINITY;
        sim.run(|sim| {
            lowest = column::<Position>(sim, 0).into_iter().map(|x| x.0.y).fold(lowest, f64::min);
            sim.clock().time < 0.05
        })
        .expect("a run");
        assert!(lowest < 0.15 * SPACING, "{lowest}");
        assert!((momentum(&sim) - before).length() < 1e-10, "{before} {}", momentum(&sim));
    }
}

#[test]
fn a_particle_that_starts_nearer_than_the_range_is_not_pushed() {
    for dimension in [2, 3] {
        let mut sim = rain(dimension, 0.05, DVec3::ZERO, 1.0, WALL);
        sim.run(|sim| sim.clock().step < 20).expect("a run");
        assert!(column::<Velocity>(&sim, 0).iter().all(|v| v.0 == DVec3::ZERO));
    }
}

#[test]
fn particles_between_a_turned_body_and_its_periodic_image_are_not_pushed() {
    let (spacing, thickness, period) = (SPACING, 4.0 * SPACING, 6.4 * SPACING);
    let mut sim = simulation(&format!(
        r#"(dimension: Three, domain: (min: (-1, -1, 0), max: (1, 1, {period}), periodic: [Z]), materials: {{"water": Fluid(density: {DENSITY}, sound_speed: {SOUND})}},
            bodies: [
                (name: "water", material: "water", spacing: {spacing}, formulation: Fluid(pressure: 0.0), shape: Box(min: (0.06, 0.06, {thickness}), max: (0.1, 0.1, {period}))),
                (name: "block", {WALL}, spacing: {spacing}, shape: Box(min: (0, 0, 0), max: (0.16, 0.16, {thickness}))),
            ], time: (end: 1.0))"#
    ));
    sim.start().expect("a start");
    for body in [BodyId(0), BodyId(1)] {
        let (view, rows) = sim.world().body_view(body);
        let mut x = view.write::<Position>().expect("places");
        rows.for_each(|row| x[row].0 = glam::DMat3::from_rotation_z(0.8) * x[row].0);
    }
    sim.run(|sim| sim.clock().step < 20).expect("a run");
    assert!(column::<Velocity>(&sim, 0).iter().all(|v| v.0 == DVec3::ZERO));
    assert!(!sim.warnings().iter().any(|text| text.contains(" is inside of ")), "{:?}", sim.warnings());
}

/// The walls of the channel are one shape whose hole ends where the domain repeats itself: water passes as if
/// there were no end.
#[test]
fn a_channel_that_is_cut_out_of_a_block_is_open_where_the_domain_repeats_itself() {
    let mut sim = simulation(
        r#"(dimension: Two, domain: (min: (0, -0.1), max: (0.2, 0.3), periodic: [X]), materials: {"water": Fluid(density: 1000.0, sound_speed: 10.0)},
            bodies: [
                (name: "water", material: "water", spacing: 0.02, velocity: (0.3, 0.0), formulation: Fluid, shape: Box(min: (0, 0), max: (0.2, 0.2))),
                (name: "wall", material: "wall", spacing: 0.02, formulation: Wall(suction: true),
                 shape: Difference(Box(min: (0, -0.06), max: (0.2, 0.26)), Box(min: (0, 0), max: (0.2, 0.2)))),
            ], time: (end: 0.3))"#,
    );
    sim.run(|_| true).expect("a run");
    for velocity in column::<Velocity>(&sim, 0) {
        assert!((velocity.0 - 0.3 * DVec3::X).length() < 1e-3, "{}", velocity.0);
    }
}

/// Water runs out of a slit in the floor of its tank as fast however the walls are written, and nothing at
/// the slit gives it energy.
#[test]
fn water_leaves_a_tank_through_a_slit() {
    let (outer, tank, slit) = (
        "Box(min: (-0.06, -0.06), max: (0.46, 0.3))",
        "Box(min: (0, 0), max: (0.4, 1))",
        "Box(min: (0.16, -0.1), max: (0.24, 0))",
    );
    let run = |walls: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.02, formulation: Fluid, shape: Box(min: (0, 0), max: (0.4, 0.2))),
                    (name: "walls", material: "wall", spacing: 0.02, formulation: Wall, shape: {walls}),
                ], time: (end: 0.1))"#
        ));
        sim.run(|_| true).expect("a run");
        column::<Velocity>(&sim, 0)
    };
    let nested = run(&format!("Difference(Difference({outer}, {tank}), {slit})"));
    let fastest = nested.iter().map(|v| v.0.length()).fold(0.0, f64::max);
    // The fall from the surface at the start to the lowest place that a particle falls to in this time.
    let limit = f64::sqrt(2.0 * 9.81 * (0.2 + 0.06 + 0.5 * 9.81 * 0.01));
    assert!(fastest > 0.3 && fastest < limit, "{fastest} and {limit}");
    let joined = run(&format!("Difference({outer}, Union([{tank}, {slit}]))"));
    assert!(nested.iter().zip(&joined).all(|(a, b)| a.0 == b.0), "the two walls differ");
}

/// A wall that starts across a side of a periodic domain repels there as it does in the middle.
#[test]
fn a_wall_across_a_side_of_the_domain_repels_what_falls_on_it() {
    let fallen = |center: f64| {
        let left = (center - 0.16f64).rem_euclid(1.0);
        let mut sim = simulation(&format!(
            r#"(precision: Double, dimension: Two, domain: (min: (0, -1), max: (1, 1), periodic: [X]),
                materials: {{"water": Fluid(density: {DENSITY}, sound_speed: {SOUND})}},
                bodies: [
                    (name: "water", material: "water", spacing: {SPACING}, velocity: (0.0, -0.5), formulation: Fluid(pressure: 0.0),
                     shape: Box(min: ({left}, 0.02), max: ({}, {}))),
                    (name: "wall", {WALL}, spacing: {SPACING}, shape: Box(min: ({}, -0.08), max: ({}, 0))),
                ], time: (end: 0.2))"#,
            left + 2.0 * SPACING,
            0.02 + 2.0 * SPACING,
            center - 0.3,
            center + 0.3
        ));
        sim.run(|_| true).expect("a run");
        (column::<Position>(&sim, 0)[0].0.y, column::<Velocity>(&sim, 0)[0].0.y)
    };
    let (middle, across) = (fallen(0.5), fallen(0.0));
    assert!(middle.0 > 0.0 && middle.1 > 0.0, "{middle:?}");
    assert!(
        (middle.0 - across.0).abs() < 1e-9 && (middle.1 - across.1).abs() < 1e-6,
        "{middle:?}, {across:?}"
    );
}
