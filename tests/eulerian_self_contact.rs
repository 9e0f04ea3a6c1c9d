//! Eulerian bodies that touch themselves: two arms of one body that are thrown at each other, and a strip of
//! metal that folds onto what it stands on.

mod common;

use common::{momentum, simulation};
use meshless::glam::DVec3;
use meshless::scene::Source;
use meshless::simulation::Simulation;
use meshless::world::{BodyId, Position, ReferencePosition};

const CONTACT: &str = r#"contacts: [Contact(between: ("tongs", "tongs"), law: Penalty())],"#;

/// Tongs whose arms move towards each other.
fn tongs(formulation: &str, contact: &str) -> Simulation {
    simulation(&Source::new(
        "tongs.ron",
        format!(
            r#"(dimension: Two,
            materials: {{"rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "tongs", material: "rubber", spacing: 0.03, formulation: {formulation}, plugins: [hourglass_control()],
                      shape: Difference(Box(min: (0, 0), max: (0.6, 1)), Box(min: (0.15, 0.3), max: (0.45, 2))))],
            {contact}
            conditions: [
                InitialVelocity(on: Select(within: Box(min: (-1, 0.3), max: (0.3, 2))), value: ("6*(y-0.3)", "0")),
                InitialVelocity(on: Select(within: Box(min: (0.3, 0.3), max: (2, 2))), value: ("-6*(y-0.3)", "0")),
            ],
            time: (end: 0.2))"#
        ),
    ))
}

/// The particle of the body that began nearest to a place.
fn nearest(sim: &Simulation, place: DVec3) -> usize {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let start = view.read::<ReferencePosition>().expect("places");
    let distance = |row: &usize| (start[*row].0 - place).length();
    rows.min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a particle")
}

/// How far apart the tips of the arms are at each hundredth of a second, the largest error of the energy
/// balance, and the momentum at the end over that of an arm.
fn gaps(mut sim: Simulation) -> (Vec<f64>, f64, f64) {
    sim.start().expect("a start");
    let tips = [DVec3::new(0.135, 0.985, 0.0), DVec3::new(0.465, 0.985, 0.0)].map(|x| nearest(&sim, x));
    let (mut gaps, mut error) = (Vec::new(), 0.0f64);
    sim.run(|sim| {
        let (view, _) = sim.world().body_view(BodyId(0));
        let x = view.read::<Position>().expect("places");
        if sim.clock().time >= 0.01 * (gaps.len() + 1) as f64 {
            gaps.push((x[tips[1]].0 - x[tips[0]].0).x);
        }
        error = error.max(sim.ledger().relative_error().abs());
        true
    })
    .expect("a run");
    let (momentum, of_parts) = momentum(&sim);
    (gaps, error, momentum.length() / of_parts)
}

#[test]
fn arms_of_one_body_rebound_as_those_of_a_lagrangian_one() {
    let (gaps_of, error, momentum) = gaps(tongs("Eulerian()", CONTACT));
    let (lagrangian, ..) = gaps(tongs("TotalLagrangian", CONTACT));
    let (joined, ..) = gaps(tongs("Eulerian()", ""));
    let most = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // The arms are 0.3 m apart at first; of independent formulations, over two rebounds.
    let difference = most(&gaps_of, &lagrangian);
    assert!(difference < 0.03, "{difference}: {gaps_of:?} {lagrangian:?}");
    let least = gaps_of.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(least > 0.015, "the arms pass through each other: {least}");
    assert!(most(&joined, &lagrangian) > 0.08, "without contact they join: {joined:?}");
    assert!(error < 2e-3 && momentum < 1e-12, "{error}, {momentum}");
}

/// A strip of metal that stands on a block of the same body, six particles across, and is thrown over: it
/// bends plastically at its foot and strikes the block with its tip, as a chip the workpiece.
fn folding(formulation: &str, contact: &str) -> Simulation {
    simulation(&Source::new(
        "folding.ron",
        format!(
            r#"(dimension: Two,
            materials: {{"metal": J2(density: 1000, young: 1e7, poisson: 0.3, hardening: Linear(yield_stress: 1e5, modulus: 1e5))}},
            bodies: [(name: "part", material: "metal", spacing: 0.02, formulation: {formulation}, plugins: [hourglass_control()],
                      shape: Union([Box(min: (0, 0), max: (1, 0.2)), Box(min: (0.1, 0.2), max: (0.22, 0.8))]))],
            {contact}
            conditions: [
                Fix(on: Select(within: Box(min: (-1, -1), max: (2, 0.06)))),
                InitialVelocity(on: Select(within: Box(min: (-1, 0.2), max: (2, 2))), value: ("16*(y-0.2)", "-16*(x-0.16)")),
            ],
            time: (end: 0.2))"#
        ),
    ))
}

/// Where the tip of the strip is at each hundredth of a second, the minimum distance of the upper strip from
/// the block, and the largest error of the energy balance.
fn path(mut sim: Simulation) -> (Vec<DVec3>, f64, f64) {
    sim.start().expect("a start");
    let tip = nearest(&sim, DVec3::new(0.15, 0.79, 0.0));
    let (upper, block): (Vec<usize>, Vec<usize>) = {
        let (view, rows) = sim.world().body_view(BodyId(0));
        let start = view.read::<ReferencePosition>().expect("places");
        rows.filter(|&row| !(0.2..0.5).contains(&start[row].0.y)).partition(|&row| start[row].0.y > 0.5)
    };
    let (mut places, mut least, mut error) = (Vec::new(), f64::INFINITY, 0.0f64);
    sim.run(|sim| {
        let (view, _) = sim.world().body_view(BodyId(0));
        let x = view.read::<Position>().expect("places");
        if sim.clock().time >= 0.01 * (places.len() + 1) as f64 {
            places.push(x[tip].0);
            let to_block = |row: &usize| {
                block.iter().map(|&other| x[*row].0.distance(x[other].0)).fold(f64::INFINITY, f64::min)
            };
            least = upper.iter().map(to_block).fold(least, f64::min);
        }
        error = error.max(sim.ledger().relative_error().abs());
        true
    })
    .expect("a run");
    (places, least, error)
}

#[test]
fn a_strip_of_metal_that_folds_onto_its_workpiece_rebounds_as_a_lagrangian_one() {
    let contact = CONTACT.replace("tongs", "part");
    let (found, least, error) = path(folding("Eulerian()", &contact));
    let (lagrangian, ..) = path(folding("TotalLagrangian", &contact));
    let (joined, ..) = path(folding("Eulerian()", ""));
    let most = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // It has turned by a right angle, and its tip is on the block.
    let lowest = lagrangian.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    assert!(lowest < 0.28, "the strip stands: {lowest}");
    // The strip is 0.6 m long.
    let difference = most(&found, &lagrangian);
    assert!(difference < 0.04, "{difference}: {found:?} {lagrangian:?}");
    let without = most(&joined, &lagrangian);
    assert!(without > 1.5 * difference, "without contact it joins: {without} and {difference}, {joined:?}");
    assert!(least > 0.014, "the strip enters the block: {least}");
    assert!(error < 2e-3, "{error}");
}
