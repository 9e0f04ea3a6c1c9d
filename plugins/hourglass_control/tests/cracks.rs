//! No hourglass force across a crack, whatever the form of the control: against an energy summed anew, and on
//! halves that have come apart.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use meshless_engine::assembly::build;
use meshless_engine::materials::{ElasticConstants, SolidLaw, StateRows, StressRows, Stretches};
use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{
    BodyId, Column, ColumnSet, Damage, Force, Position, ReferencePosition, ReferenceVolume, Velocity,
};
use schemars::JsonSchema;
use serde::Deserialize;

const FORMS: [&str; 4] = ["Variational", "Ganzenmueller2015", "Viscous", "Combined"];
const SPACING: f64 = 0.1;
const SUPPORT: f64 = 2.41 * SPACING;

/// What has failed carries nothing, or all that it did before: then a crack is one for the control alone.
#[derive(Deserialize, JsonSchema)]
struct Crumble {
    bears: bool,
}

impl Plugin for Crumble {
    const NAME: &'static str = "crumble";
    const REFERENCE: &'static str = "";
    const CHANGES_MATERIALS: bool = true;

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        sim.wrap_solid_law(BodyId(0), |law| Ok(Crumbling { law, bears: self.bears }))
    }
}

struct Crumbling {
    law: Arc<dyn SolidLaw>,
    bears: bool,
}

impl SolidLaw for Crumbling {
    fn elastic(&self) -> &ElasticConstants {
        self.law.elastic()
    }

    fn needs_positive_volume(&self) -> bool {
        self.law.needs_positive_volume()
    }

    fn stable_step_factor(&self, stretches: &Stretches) -> f64 {
        self.law.stable_step_factor(stretches)
    }

    fn state(&self, columns: &mut ColumnSet) {
        columns.add::<Damage>();
    }

    fn stress(&self, rows: &mut StressRows<'_>) {
        self.law.stress(&mut StressRows {
            dt: rows.dt,
            deformation: rows.deformation,
            share: rows.share,
            stress_before: rows.stress_before,
            stress: rows.stress,
            energy: rows.energy,
            modulus: rows.modulus,
            strength: rows.strength,
            plastic_work: rows.plastic_work,
            state: StateRows::default(),
        });
        for (k, damage) in rows.state.take::<Damage>().iter_mut().enumerate() {
            // Half of it is an order to fail in this step.
            damage.0 = (2.0 * damage.0).min(1.0);
            if damage.0 >= 1.0 {
                rows.modulus[k] = 0.0;
            }
            if damage.0 >= 1.0 && !self.bears {
                (rows.stress[k], rows.energy[k]) = (DMat3::ZERO, 0.0);
            }
        }
    }
}

/// An irregular block, 1 m long, at the start: particles with |X - 0.5| < `half` have failed; with `half`
/// below zero none has, and those that will bear what they did.
fn started(
    dimension: usize,
    control: &str,
    half: f64,
    place: impl Fn(DVec3) -> DVec3,
    velocity: impl Fn(DVec3) -> DVec3,
) -> Simulation {
    let bears = half < 0.0;
    let (low, high) =
        if dimension == 2 { ("(0, 0)", "(1.0, 0.5)") } else { ("(0, 0, 0)", "(1.0, 0.5, 0.5)") };
    let body = format!(
        "shape: Box(min: {low}, max: {high}), lattice: Relaxed(seed: 3), plugins: [{control} crumble(bears: {bears})]"
    );
    let mut sim = scene(dimension, &body, "");
    for_each(&sim, |x, v, damage| {
        damage.0 = if (x.0.x - 0.5).abs() < half { 1.0 } else { 0.0 };
        v.0 = velocity(x.0);
        x.0 = place(x.0);
    });
    sim.start().expect("a start");
    sim
}

/// A body of that description that has not been started.
fn scene(dimension: usize, body: &str, conditions: &str) -> Simulation {
    let name = if dimension == 2 { "Two" } else { "Three" };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", spacing: {SPACING}, formulation: TotalLagrangian, {body})],
            {conditions} time: (end: 20.0, step: Adaptive(factor: 0.25)))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut registry = Registry::standard().with(hourglass_control::register);
    registry.plugin::<Crumble>();
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

fn for_each(sim: &Simulation, change: impl Fn(&mut Position, &mut Velocity, &mut Damage)) {
    let (view, _) = sim.world().body_view(BodyId(0));
    let mut x = view.write::<Position>().expect("places");
    let mut v = view.write::<Velocity>().expect("velocities");
    let mut damage = view.write::<Damage>().expect("damage");
    for k in 0..view.len() {
        change(&mut x[k], &mut v[k], &mut damage[k]);
    }
}

fn column<C: Column>(sim: &Simulation) -> Vec<C> {
    sim.world().body_view(BodyId(0)).0.read::<C>().expect("a column").to_vec()
}

fn control(form: &str) -> String {
    format!("hourglass_control(form: {form}),")
}

/// A rough displacement, and the sides of the crack 0.02 m apart.
fn rough(dimension: usize) -> impl Fn(DVec3) -> DVec3 + Copy {
    move |x: DVec3| {
        let phase = DVec3::new(31.0, 17.0, 23.0).dot(x);
        let bend = DVec3::new(phase.sin(), (1.7 * phase + 0.3).cos(), (2.3 * phase).sin()) * 0.004;
        let apart = DVec3::X * (0.02 * (x.x - 0.5).signum());
        x + apart + if dimension == 2 { DVec3::new(bend.x, bend.y, 0.0) } else { bend }
    }
}

fn swirl(x: DVec3) -> DVec3 {
    DVec3::new((7.0 * x.y).sin(), (9.0 * x.x).cos(), 0.0)
}

/// The energy of the variational form, over particles and neighbours that hold.
fn energy(dimension: usize, reference: &[DVec3], volume: &[f64], holds: &[bool], x: &[DVec3]) -> f64 {
    // Spiky kernel: W' = -30 / (pi H^5) (H - r)^2 in two, -45 / (pi H^6) (H - r)^2 in three dimensions.
    let front = if dimension == 2 { 30.0 / SUPPORT.powi(5) } else { 45.0 / SUPPORT.powi(6) };
    let weight = |r: f64| front / std::f64::consts::PI * (SUPPORT - r).powi(2) / r;
    let mut sum = 0.0;
    for i in (0..x.len()).filter(|&i| holds[i]) {
        let near = |j: &usize| *j != i && holds[*j] && reference[i].distance(reference[*j]) < SUPPORT;
        let bonds: Vec<_> = (0..x.len())
            .filter(near)
            .map(|j| {
                let big = reference[j] - reference[i];
                (volume[j] * weight(big.length()), big, x[j] - x[i])
            })
            .collect();
        let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
        let mut moment = bonds.iter().fold(DMat3::ZERO, |sum, (w, big, _)| sum + outer(*big, *big) * *w);
        let spread = bonds.iter().fold(DMat3::ZERO, |sum, (w, big, now)| sum + outer(*now, *big) * *w);
        if dimension == 2 {
            moment.z_axis.z = 1.0;
        }
        let f = spread * moment.inverse();
        let residual: f64 = bonds.iter().map(|(w, big, now)| w * (f * *big - *now).length_squared()).sum();
        sum += 5.0 / 12.0 * volume[i] * residual;
    }
    sum
}

#[test]
fn the_force_is_the_gradient_of_an_energy_without_those_that_have_failed() {
    for dimension in [2, 3] {
        let place = rough(dimension);
        let with = started(dimension, &control("Variational"), 0.11, place, |_| DVec3::ZERO);
        let without = column::<Force>(&started(dimension, "", 0.11, place, |_| DVec3::ZERO));
        let force: Vec<DVec3> =
            column::<Force>(&with).iter().zip(&without).map(|(with, without)| with.0 - without.0).collect();
        let reference: Vec<DVec3> = column::<ReferencePosition>(&with).iter().map(|row| row.0).collect();
        let x: Vec<DVec3> = column::<Position>(&with).iter().map(|row| row.0).collect();
        let volume: Vec<f64> = column::<ReferenceVolume>(&with).iter().map(|row| row.0).collect();
        let holds: Vec<bool> = column::<Damage>(&with).iter().map(|row| row.0 < 1.0).collect();
        let energy_at = |x: &[DVec3]| energy(dimension, &reference, &volume, &holds, x);
        let (stored, wanted) = (with.ledger().total_named("hourglass"), energy_at(&x));
        assert!((stored / wanted - 1.0).abs() < 1e-6, "{stored} instead of {wanted}");
        let scale = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        let net: DVec3 = force.iter().sum();
        assert!(net.length() < 1e-12 * scale, "{net}");
        let torque: DVec3 = force.iter().zip(&x).map(|(f, x)| x.cross(*f)).sum();
        assert!(torque.length() < 1e-12 * scale, "{torque}");
        let mut seen = [0, 0];
        for row in (0..x.len()).filter(|&row| (reference[row].x - 0.5).abs() < 0.35) {
            for axis in 0..dimension {
                let moved = |by: f64| {
                    let mut x = x.clone();
                    x[row][axis] += by;
                    energy_at(&x)
                };
                let h = 1e-4;
                let slope = (moved(h) - moved(-h)) / (2.0 * h);
                assert!((force[row][axis] + slope).abs() < 1e-6 * scale, "{} {slope}", force[row]);
            }
            seen[usize::from(holds[row])] += 1;
            assert!(holds[row] || force[row].length() < 1e-12 * scale, "on a failed one: {}", force[row]);
        }
        assert!(seen[0] > 5 && seen[1] > 10, "{seen:?}");
    }
}

#[test]
fn halves_that_have_come_apart_feel_nothing_of_each_other() {
    // Half a metre apart, in motion, and each turned as a whole; the failed ones stay where they were.
    let place = |x: DVec3| {
        let side = if (x.x - 0.5).abs() < 0.11 { 0.0 } else { (x.x - 0.5).signum() };
        DMat3::from_rotation_z(0.4 * side) * x + DVec3::X * (0.5 * side)
    };
    let velocity = |x: DVec3| DVec3::X * (x.x - 0.5).signum();
    for (dimension, form) in [2, 3].into_iter().flat_map(|d| FORMS.map(|form| (d, form))) {
        let without = column::<Force>(&started(dimension, "", 0.11, place, velocity));
        let with = started(dimension, &control(form), 0.11, place, velocity);
        let scale = without.iter().map(|f| f.0.length()).fold(0.0, f64::max);
        assert!(scale > 1e-3, "there is stress at the edges: {scale}");
        for (row, (with, without)) in column::<Force>(&with).iter().zip(&without).enumerate() {
            let force = with.0 - without.0;
            assert!(force.length() < 1e-12 * scale, "{dimension} {form} {row}: {force} of {scale}");
        }
        let stored = with.ledger().total_named("hourglass");
        assert!(stored.abs() < 1e-12 * scale, "{form}: {stored}");
    }
}

#[test]
fn momentum_is_kept_beside_a_crack_and_nothing_acts_on_what_has_failed() {
    for (dimension, form) in [2, 3].into_iter().flat_map(|d| FORMS.map(|form| (d, form))) {
        let place = rough(dimension);
        let with = started(dimension, &control(form), 0.11, place, swirl);
        let without = column::<Force>(&started(dimension, "", 0.11, place, swirl));
        let forces = column::<Force>(&with);
        let force: Vec<DVec3> =
            forces.iter().zip(&without).map(|(with, without)| with.0 - without.0).collect();
        let scale: f64 = force.iter().map(|f| f.length()).sum();
        let net: DVec3 = force.iter().sum();
        assert!(scale > 1e-3 && net.length() < 1e-12 * scale, "{form}: {net} of {scale}");
        for (force, damage) in force.iter().zip(column::<Damage>(&with)) {
            assert!(damage.0 < 1.0 || force.length() < 1e-12 * scale, "{form}: {force}");
        }
    }
}

/// A block that swings and in which particles fail one by one, from the middle to either side.
fn crumbling(dimension: usize, form: &str, fail: bool) -> Simulation {
    let swing = |x: DVec3| DVec3::new(0.1 * (9.0 * x.x).sin(), 0.2 * (27.0 * x.x + 40.0 * x.y).sin(), 0.0);
    let mut sim = started(dimension, &control(form), -1.0, |x| x, swing);
    let x: Vec<f64> = column::<ReferencePosition>(&sim).iter().map(|row| (row.0.x - 0.5).abs()).collect();
    let mut order: Vec<usize> = (0..x.len()).filter(|&k| x[k] < 0.2).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    for row in order {
        (0..8).for_each(|_| sim.step().expect("a step"));
        sim.world().body_view(BodyId(0)).0.write::<Damage>().expect("damage")[row].0 =
            if fail { 0.5 } else { 0.0 };
    }
    (0..20).for_each(|_| sim.step().expect("a step"));
    sim
}

#[test]
fn what_a_crack_releases_is_booked() {
    for (dimension, form, least) in
        [(2, "Variational", 5e-4), (2, "Combined", 3e-4), (3, "Variational", 4e-4)]
    {
        let ledger = |sim: &Simulation| {
            (sim.ledger().total_named("hourglass_released"), sim.ledger().balance_error().abs())
        };
        let (released, error) = ledger(&crumbling(dimension, form, true));
        assert!(released > least && error < 0.05 * released, "{dimension} {form}: {released} {error}");
        let (nothing, _) = ledger(&crumbling(dimension, form, false));
        assert_eq!(nothing, 0.0, "{dimension} {form}");
    }
}

#[test]
fn a_crack_through_a_symmetry_plane_is_half_a_crack() {
    // Failed where |Y - 0.25| < 0.06, moved alike on both sides of X = 0.
    let place = |x: DVec3| {
        let bend = DVec3::new(x.x * (23.0 * x.y).cos(), (9.0 * x.x * x.x + 31.0 * x.y).sin(), 0.0) * 0.02;
        x + bend + DVec3::Y * (0.03 * (x.y - 0.25).signum())
    };
    let forces = |shape: &str, conditions: &str| {
        let body = format!(r#"shape: {shape}, plugins: [hourglass_control(), crumble(bears: false)]"#);
        let mut sim = scene(2, &body, conditions);
        for_each(&sim, |x, v, damage| {
            damage.0 = if (x.0.y - 0.25).abs() < 0.06 { 1.0 } else { 0.0 };
            v.0 = DVec3::ZERO;
            x.0 = place(x.0);
        });
        sim.start().expect("a start");
        let reference = column::<ReferencePosition>(&sim);
        let force = column::<Force>(&sim);
        let (stored, rows) = (sim.ledger().total_named("hourglass"), reference.iter().zip(force));
        let right = rows.filter(|(x, _)| x.0.x > 0.0).map(|(x, f)| (x.0, f.0));
        (stored, right.collect::<Vec<(DVec3, DVec3)>>())
    };
    let (whole, of_whole) = forces("Box(min: (-0.5, 0), max: (0.5, 0.5))", "");
    let symmetry = "conditions: [Symmetry(plane: X, at: 0.0, side: Above)],";
    let (half, of_half) = forces("Box(min: (0, 0), max: (0.5, 0.5))", symmetry);
    assert!(half > 1e-6 && (2.0 * half / whole - 1.0).abs() < 1e-10, "{half} and {whole}");
    let scale = of_half.iter().map(|(_, f)| f.length()).fold(0.0, f64::max);
    assert_eq!(of_half.len(), of_whole.len());
    for (x, force) in of_half {
        let (_, other) =
            of_whole.iter().find(|(other, _)| other.distance(x) < 1e-9).expect("the same particle");
        assert!(force.distance(*other) < 1e-10 * scale, "{x}: {force} instead of {other}");
    }
}
