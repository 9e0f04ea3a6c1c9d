//! What holds exactly, with and without the control: affine maps, force as the gradient of the energy, conservation.

use glam::{DMat3, DVec3};
use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, DeformationGradient, Force, Mass, Position, Velocity};

const CONTROLS: [&str; 3] = ["", "hourglass_control()", "hourglass_control(form: Ganzenmueller2015)"];

/// An irregular body, in two or three dimensions, that is moved to `place` and has velocity `velocity` at the start.
fn body(
    dimension: usize,
    plugins: &str,
    end: f64,
    place: impl Fn(DVec3) -> DVec3,
    velocity: impl Fn(DVec3) -> DVec3,
) -> Simulation {
    let (name, low, high) = if dimension == 2 {
        ("Two", "(0, 0)", "(1.0, 0.5)")
    } else {
        ("Three", "(0, 0, 0)", "(1.0, 0.5, 0.5)")
    };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: {low}, max: {high}), spacing: 0.1,
                      lattice: Relaxed(seed: 3), formulation: TotalLagrangian, plugins: [{plugins}])],
            time: (end: {end:?}))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(hourglass_control::register);
    let sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    let (view, _) = sim.world().body_view(BodyId(0));
    let mut x = view.write::<Position>().expect("places");
    for (x, v) in x.iter_mut().zip(view.write::<Velocity>().expect("velocities").iter_mut()) {
        v.0 = velocity(x.0);
        x.0 = place(x.0);
    }
    drop(x);
    sim
}

fn forces(sim: &Simulation) -> Vec<DVec3> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<Force>().expect("forces").iter().map(|f| f.0).collect()
}

fn places(sim: &Simulation) -> Vec<DVec3> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<Position>().expect("places").iter().map(|x| x.0).collect()
}

/// A rough displacement of the size of 0.4 % of the body, in the plane or in space.
fn rough(dimension: usize) -> impl Fn(DVec3) -> DVec3 + Copy {
    move |x: DVec3| {
        let phase = DVec3::new(31.0, 17.0, 23.0).dot(x);
        let bend = DVec3::new(phase.sin(), (1.7 * phase + 0.3).cos(), (2.3 * phase).sin()) * 0.004;
        x + if dimension == 2 { DVec3::new(bend.x, bend.y, 0.0) } else { bend }
    }
}

#[test]
fn an_affine_map_is_exact_and_leaves_no_net_force_or_torque() {
    for (dimension, control) in [2, 3].into_iter().flat_map(|d| CONTROLS.map(|control| (d, control))) {
        let (a, b, c) = if dimension == 2 {
            (DVec3::new(1.2, 0.3, 0.0), DVec3::new(-0.2, 0.8, 0.0), DVec3::Z)
        } else {
            (DVec3::new(1.2, 0.3, 0.1), DVec3::new(-0.2, 0.8, 0.2), DVec3::new(0.1, -0.1, 1.1))
        };
        let map = DMat3::from_cols(a, b, c);
        let shift = DVec3::new(0.7, -0.4, 0.0);
        let mut sim = body(dimension, control, 1.0, |x| map * x + shift, |_| DVec3::ZERO);
        sim.start().expect("a start");
        let (view, _) = sim.world().body_view(BodyId(0));
        for gradient in view.read::<DeformationGradient>().expect("gradients").iter() {
            assert!(gradient.0.abs_diff_eq(map, 1e-10), "{control}: {} instead of {map}", gradient.0);
        }
        let (force, x) = (forces(&sim), places(&sim));
        let size: f64 = force.iter().map(|f| f.length()).sum();
        let net: DVec3 = force.iter().sum();
        let torque: DVec3 = force.iter().zip(&x).map(|(f, x)| x.cross(*f)).sum();
        assert!(size > 0.1, "{size}");
        assert!(net.length() < 1e-10 * size, "{control}: net force {net} of {size}");
        // The paper's form acts along the bonds, the variational one is the gradient of an energy that turns with the body.
        assert!(torque.length() < 1e-10 * size, "{control}: torque {torque} of {size}");
        let (strain, stored) = (sim.ledger().total_named("strain"), sim.ledger().total_named("hourglass"));
        assert!(stored.abs() < 1e-13 * strain, "{control}: hourglass energy {stored} of {strain}");
    }
}

#[test]
fn a_rough_displacement_leaves_no_net_force_or_torque() {
    for (dimension, control) in [2, 3].into_iter().flat_map(|d| CONTROLS.map(|control| (d, control))) {
        let mut sim = body(dimension, control, 1.0, rough(dimension), |_| DVec3::ZERO);
        sim.start().expect("a start");
        let (force, x) = (forces(&sim), places(&sim));
        let size: f64 = force.iter().map(|f| f.length()).sum();
        let net: DVec3 = force.iter().sum();
        let torque: DVec3 = force.iter().zip(&x).map(|(f, x)| x.cross(*f)).sum();
        assert!(net.length() < 1e-10 * size, "{control}: net force {net} of {size}");
        assert!(torque.length() < 1e-10 * size, "{control}: torque {torque} of {size}");
    }
}

#[test]
fn the_force_is_the_gradient_of_strain_and_hourglass_energy() {
    for (dimension, control) in [2, 3].into_iter().flat_map(|d| ["", "hourglass_control()"].map(|c| (d, c))) {
        let moved = rough(dimension);
        let mut sim = body(dimension, control, 1.0, moved, |_| DVec3::ZERO);
        sim.start().expect("a start");
        let force = forces(&sim);
        let scale = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        let start = places(&body(dimension, control, 1.0, |x| x, |_| DVec3::ZERO));
        for row in [0, force.len() / 3, force.len() / 2, force.len() - 1] {
            for axis in 0..dimension {
                let energy = |by: f64| {
                    let place = |x: DVec3| {
                        let mut place = moved(x);
                        if x == start[row] {
                            place[axis] += by;
                        }
                        place
                    };
                    let mut sim = body(dimension, control, 1.0, place, |_| DVec3::ZERO);
                    sim.start().expect("a start");
                    sim.ledger().total_named("strain") + sim.ledger().total_named("hourglass")
                };
                let h = 1e-4;
                let slope =
                    (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
                let found = force[row][axis];
                assert!((found + slope).abs() < 1e-6 * scale, "{control}: {found} and slope {slope}");
            }
        }
    }
}

/// Momentum, angular momentum about the origin, and the sums of their sizes.
fn momenta(sim: &Simulation) -> (DVec3, DVec3, f64, f64) {
    let (view, _) = sim.world().body_view(BodyId(0));
    let mass = view.read::<Mass>().expect("masses");
    let x = view.read::<Position>().expect("places");
    let v = view.read::<Velocity>().expect("velocities");
    let (mut momentum, mut spin, mut size, mut spin_size) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0.0);
    for k in 0..view.len() {
        let p = mass[k].0 * v[k].0;
        momentum += p;
        spin += x[k].0.cross(p);
        size += p.length();
        spin_size += x[k].0.cross(p).length();
    }
    (momentum, spin, size, spin_size)
}

/// A body that is thrown, spins and swings along its length, over 100 periods 2 L / c of that swing.
fn thrown(dimension: usize, control: &str) -> (Simulation, f64) {
    let (center, spin) = (DVec3::new(0.5, 0.25, 0.0), DVec3::new(0.0, 0.0, 0.05));
    let velocity = |x: DVec3| {
        let swing = 0.02 * (std::f64::consts::PI * x.x).cos();
        DVec3::new(0.01 + swing, 0.02, 0.0) + spin.cross(x - center)
    };
    let mut sim = body(dimension, control, 200.0, |x| x, velocity);
    sim.start().expect("a start");
    let (p0, l0, size, spin_size) = momenta(&sim);
    let energy = sim.ledger().stored();
    let mut drift = 0.0f64;
    while !sim.is_finished() {
        sim.step().expect("a step");
        drift = drift.max((sim.ledger().stored() / energy - 1.0).abs());
        if sim.clock().step % 100 == 0 {
            let (p, l, ..) = momenta(&sim);
            assert!(p.distance(p0) < 1e-12 * size, "{control}: momentum {p} instead of {p0}");
            assert!(l.distance(l0) < 1e-10 * spin_size, "{control}: angular momentum {l} instead of {l0}");
        }
    }
    (sim, drift)
}

#[test]
fn a_thrown_and_spinning_body_keeps_momentum_and_energy() {
    for dimension in [2, 3] {
        for control in ["", "hourglass_control()"] {
            let (_, drift) = thrown(dimension, control);
            assert!(drift < 5e-3, "{dimension} dimensions, {control}: energy drift {drift}");
        }
    }
}
