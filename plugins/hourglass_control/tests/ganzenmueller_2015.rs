//! The form of the paper against a naive sum over all pairs, at random displacements.

use glam::{DMat2, DVec2, DVec3};
use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Force, Position, ReferencePosition, ReferenceVolume};

const YOUNG: f64 = 2.0;
const ALPHA: f64 = 13.0;
const SUPPORT: f64 = 0.26;

fn started(plugins: &str, bend: impl Fn(DVec3) -> DVec3) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"m": StVenantKirchhoff(density: 1, young: {YOUNG:?}, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.0, 0.7)), spacing: 0.1,
                      lattice: Relaxed(seed: 2), formulation: TotalLagrangian(support: 2.6), plugins: [{plugins}])],
            time: (end: 1))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(hourglass_control::register);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    for x in sim.world().body_view(BodyId(0)).0.write::<Position>().expect("places").iter_mut() {
        x.0 += bend(x.0);
    }
    sim.start().expect("a start");
    sim
}

fn forces(sim: &Simulation) -> Vec<DVec2> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<Force>().expect("forces").iter().map(|f| f.0.truncate()).collect()
}

fn rough(x: DVec3) -> DVec3 {
    DVec3::new((31.0 * x.x + 7.0 * x.y).sin(), (13.0 * x.y - 29.0 * x.x).cos(), 0.0) * 0.02
}

/// Force of the control alone: the difference to the forces without it.
fn control_force(bend: impl Fn(DVec3) -> DVec3 + Copy) -> (Vec<DVec2>, Simulation) {
    let with = started(&format!("hourglass_control(form: Ganzenmueller2015, alpha: {ALPHA:?})"), bend);
    let without = forces(&started("", bend));
    (forces(&with).iter().zip(without).map(|(a, b)| *a - b).collect(), with)
}

#[test]
fn the_force_is_that_of_eqs_31_and_32() {
    let (force, sim) = control_force(rough);
    let (view, _) = sim.world().body_view(BodyId(0));
    let reference: Vec<DVec2> =
        view.read::<ReferencePosition>().expect("places").iter().map(|x| x.0.truncate()).collect();
    let x: Vec<DVec2> = view.read::<Position>().expect("places").iter().map(|x| x.0.truncate()).collect();
    let volume: Vec<f64> = view.read::<ReferenceVolume>().expect("volumes").iter().map(|v| v.0).collect();
    let n = x.len();
    let neighbors = |i: usize| {
        let reference = &reference;
        (0..n).filter(move |&j| j != i && reference[i].distance(reference[j]) < SUPPORT)
    };
    let dyad = |a: DVec2, b: DVec2| DMat2::from_cols(a * b.x, a * b.y);
    let gradient: Vec<DMat2> = (0..n)
        .map(|i| {
            let (mut moment, mut spread) = (DMat2::ZERO, DMat2::ZERO);
            for j in neighbors(i) {
                let d = reference[j] - reference[i];
                let w = volume[j] * (SUPPORT - d.length()).powi(2) / d.length();
                moment += dyad(d, d) * w;
                spread += dyad(x[j] - x[i], d) * w;
            }
            spread * moment.inverse()
        })
        .collect();
    let largest = force.iter().map(|f| f.length()).fold(0.0, f64::max);
    for i in 0..n {
        let mut naive = DVec2::ZERO;
        for j in neighbors(i) {
            let (long, short) = (reference[j] - reference[i], x[j] - x[i]);
            let kernel = 10.0 / (std::f64::consts::PI * SUPPORT.powi(5)) * (SUPPORT - long.length()).powi(3);
            let error = (gradient[i] * long - short).dot(short) + (gradient[j] * long - short).dot(short);
            let size = 0.5 * ALPHA * YOUNG * volume[i] * volume[j] * kernel / long.length_squared();
            naive -= short * (size * error / short.length_squared());
        }
        assert!((force[i] - naive).length() < 1e-6 * largest, "particle {i}: {} {naive}", force[i]);
    }
}

#[test]
fn it_keeps_momentum_and_leaves_affine_maps_alone() {
    let (force, _) = control_force(rough);
    let size: f64 = force.iter().map(|f| f.length()).sum();
    assert!(force.iter().sum::<DVec2>().length() < 1e-12 * size);
    let affine = |x: DVec3| DVec3::new(0.1 * x.x - 0.05 * x.y, 0.07 * x.x + 0.02 * x.y, 0.0);
    let (rest, _) = control_force(affine);
    assert!(rest.iter().all(|f| f.length() < 1e-12 * size));
}
