//! Symmetry planes and periodic axes against the whole problem, and against closed forms.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::assembly::build;
use crate::pair::{Pair, PairTerm, Rates};
use crate::parallel::{Arithmetic, Matrix, Vector};
use crate::plugin::{Plugin, Registry, SetupError, SimBuilder};
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::solids::{FoldedEnergy, FoldedRows, FoldedTerm};
use crate::world::{BodyId, DeformationGradient, Mass, Position, ReferencePosition, Velocity};

/// A bond term that uses the bond stiffness and the corrected stress: images must carry both.
#[derive(Deserialize, JsonSchema)]
pub(super) struct Stiffener {}

struct Stiff;

impl FoldedTerm for Stiff {
    fn add(&self, rows: &mut FoldedRows<'_>) -> FoldedEnergy {
        let mut stored = 0.0;
        for k in 0..rows.deformation.len() {
            let stiffness = 0.5 * rows.modulus[k];
            rows.stress.add_scaled(k, -stiffness, &rows.displacement_gradient[k]);
            rows.stress.add_stiffness(k, stiffness);
            stored += 0.5 * stiffness * rows.volume[k] * rows.residual[k];
        }
        FoldedEnergy { stored, released: 0.0 }
    }

    fn stiffness_factor(&self) -> f64 {
        0.5
    }
}

/// A pair term that reads a vector and a tensor of the neighbour.
struct Friction;

impl PairTerm for Friction {
    type ReadI = (Velocity, DeformationGradient);
    type ReadJ = (Velocity, DeformationGradient);

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (v_i, f_i): (Vector<A>, Matrix<A>),
        (v_j, f_j): (Vector<A>, Matrix<A>),
        rates: &mut Rates<A>,
    ) {
        // Half of it by the columns, half by what the row says.
        let slip = (f_i + f_j) * (v_j - v_i + pair.v_ij) * 0.5;
        rates.force += slip * (100.0 * pair.volume_i * pair.volume_j * pair.weight);
    }
}

impl Plugin for Stiffener {
    const NAME: &'static str = "stiffener";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        sim.add_folded_term(sim.scope().clone(), "stiffener", Stiff);
        sim.add_pair_term(sim.scope().clone(), "friction", Friction);
        Ok(())
    }
}

struct Case<'a> {
    dimension: &'a str,
    min: &'a str,
    max: &'a str,
    spacing: f64,
    velocity: &'a str,
    /// Further conditions, and fields of the scene.
    conditions: &'a str,
    fields: &'a str,
}

fn run(case: &Case<'_>, steps: usize) -> Simulation {
    let Case { dimension, min, max, spacing, velocity, conditions, fields } = case;
    let text = format!(
        "Scene(dimension: {dimension},
        materials: {{\"rubber\": NeoHookean(density: 1000.0, young: 1.0e6, poisson: 0.3)}},
        bodies: [Body(name: \"block\", material: \"rubber\", shape: Box(min: {min}, max: {max}),
            spacing: {spacing:?}, formulation: TotalLagrangian)],
        conditions: [InitialVelocity(on: Select(), value: {velocity}), {conditions}],
        plugins: [stiffener()], {fields} time: (end: 1.0, step: Fixed(2.0e-4)))"
    );
    let mut registry = Registry::standard();
    registry.plugin::<Stiffener>();
    let built =
        parse(Source::new("test.ron", text)).and_then(|(scene, source)| build(&scene, &source, &registry));
    let mut sim = built.unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..steps {
        sim.step().expect("a step");
    }
    sim
}

/// Reference place, displacement and velocity of every particle.
fn states(sim: &Simulation) -> Vec<(DVec3, DVec3, DVec3)> {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let reference = view.read::<ReferencePosition>().expect("places");
    let position = view.read::<Position>().expect("places");
    let velocity = view.read::<Velocity>().expect("velocities");
    rows.map(|k| (reference[k].0, position[k].0 - reference[k].0, velocity[k].0)).collect()
}

fn stored(sim: &Simulation, name: &str) -> f64 {
    sim.ledger().accounts().iter().find(|account| account.name == name).map_or(0.0, |account| account.total())
}

/// Compares a part with the whole; `fold` maps a place of the part to the place in the whole that it must
/// equal.
fn assert_equal(part: &Simulation, whole: &Simulation, fold: impl Fn(DVec3) -> DVec3) {
    let all = states(whole);
    let scale = all.iter().map(|(_, u, _)| u.length()).fold(0.0, f64::max);
    assert!(scale > 0.001, "the block must deform: {scale}");
    for (place, u, v) in states(part) {
        let wanted = fold(place);
        let twin = all.iter().find(|(other, ..)| other.distance(wanted) < 1e-9).expect("a twin");
        assert!(u.distance(twin.1) < 1e-12 * scale, "displacement at {place}: {u} and {}", twin.1);
        assert!(v.distance(twin.2) < 1e-9 * scale, "velocity at {place}: {v} and {}", twin.2);
    }
}

#[test]
fn half_a_block_with_a_symmetry_plane_moves_like_the_whole_in_two_dimensions() {
    let half = Case {
        dimension: "Two",
        min: "(0.0, 0.0)",
        max: "(1.0, 0.5)",
        spacing: 0.0625,
        velocity: "(\"3*x*(1 + y)\", \"-4*y*cos(2*x)\")",
        conditions: "Symmetry(plane: X, at: 0.0), Fix(on: Select(face: MinX), axes: [X])",
        fields: "gravity: (0.0, -9.81),",
    };
    // The row beside the plane is held along x in the whole block, too, on both sides.
    let fix = "Fix(on: Select(within: Box(min: (-0.0625, 0.0), max: (0.0625, 0.5))), axes: [X])";
    let whole = Case { min: "(-1.0, 0.0)", conditions: fix, ..half };
    let free = Case { conditions: "Symmetry(plane: X, at: 0.0)", ..half };
    let whole_free = Case { conditions: "", ..whole };
    for (half, whole) in [(half, whole), (free, whole_free)] {
        let (half, whole) = (run(&half, 100), run(&whole, 100));
        assert_equal(&half, &whole, |place| place);
        for name in ["kinetic", "strain", "stiffener", "friction"] {
            let (part, all) = (stored(&half, name), stored(&whole, name));
            assert!((2.0 * part - all).abs() < 1e-11 * all && all > 0.0, "{name}: {part} and {all}");
        }
    }
}

#[test]
fn loads_on_the_sides_of_half_a_block_move_it_like_the_whole() {
    let half = Case {
        dimension: "Two",
        min: "(0.0, 0.0)",
        max: "(1.0, 0.5)",
        spacing: 0.0625,
        velocity: "(\"x*(1 + y)\", \"-y*cos(2*x)\")",
        conditions: "Traction(on: Select(face: MaxX), value: (\"2e5\", \"1e4*y\")), Pressure(on: Select(face: MaxY), value: \"1e5*(1 + x^2)\"),
            Symmetry(plane: X, at: 0.0)",
        fields: "",
    };
    let whole = Case {
        min: "(-1.0, 0.0)",
        conditions: "Traction(on: Select(face: MaxX), value: (\"2e5\", \"1e4*y\")), Traction(on: Select(face: MinX), value: (\"-2e5\", \"1e4*y\")),
            Pressure(on: Select(face: MaxY), value: \"1e5*(1 + x^2)\")",
        ..half
    };
    let (half, whole) = (run(&half, 100), run(&whole, 100));
    assert_equal(&half, &whole, |place| place);
    for name in ["kinetic", "strain", "traction", "pressure"] {
        let (part, all) = (stored(&half, name), stored(&whole, name));
        assert!((2.0 * part - all).abs() < 1e-9 * all.abs() && all != 0.0, "{name}: {part} and {all}");
    }
}

#[test]
fn an_eighth_of_a_block_with_three_symmetry_planes_moves_like_the_whole() {
    let eighth = Case {
        dimension: "Three",
        min: "(0.0, 0.0, 0.0)",
        max: "(0.5, 0.5, 0.5)",
        spacing: 0.125,
        velocity: "(\"3*x*(1 + y^2)\", \"-4*y*cos(2*z)\", \"2*z*x^2\")",
        conditions: "Symmetry(plane: X, at: 0.0), Symmetry(plane: Y, at: 0.0, side: Above),
            Symmetry(plane: Z, at: 0.0)",
        fields: "",
    };
    let whole = Case { min: "(-0.5, -0.5, -0.5)", conditions: "", ..eighth };
    let (eighth, whole) = (run(&eighth, 60), run(&whole, 60));
    assert_equal(&eighth, &whole, |place| place);
    for name in ["kinetic", "strain", "stiffener", "friction"] {
        let (part, all) = (stored(&eighth, name), stored(&whole, name));
        assert!((8.0 * part - all).abs() < 1e-11 * all && all > 0.0, "{name}: {part} and {all}");
    }
}

#[test]
fn a_strip_between_two_planes_is_the_same_as_a_periodic_one_of_twice_the_width() {
    let strip = Case {
        dimension: "Two",
        min: "(0.0, 0.0)",
        max: "(0.5, 0.5)",
        spacing: 0.0625,
        velocity: "(\"0.5*sin(2*pi*x)*(1 + y)\", \"0.5*cos(2*pi*x)*y\")",
        conditions: "Symmetry(plane: X, at: 0.0), Symmetry(plane: X, at: 0.5)",
        fields: "",
    };
    let periodic = Case {
        max: "(1.0, 0.5)",
        conditions: "",
        fields: "domain: (min: (0.0, -1.0), max: (1.0, 2.0), periodic: [X]),",
        ..strip
    };
    let (strip, periodic) = (run(&strip, 100), run(&periodic, 100));
    assert_equal(&strip, &periodic, |place| place);
}

#[test]
fn a_periodic_bar_moves_like_one_of_two_periods() {
    let one = Case {
        dimension: "Two",
        min: "(0.0, 0.0)",
        max: "(0.5, 0.25)",
        spacing: 0.03125,
        velocity: "(\"sin(4*pi*x)\", \"0.5*cos(4*pi*x)*y\")",
        conditions: "",
        fields: "domain: (min: (0.0, -1.0), max: (0.5, 1.0), periodic: [X]),",
    };
    let two = Case {
        max: "(1.0, 0.25)",
        fields: "domain: (min: (0.0, -1.0), max: (1.0, 1.0), periodic: [X]),",
        ..one
    };
    let (one, two) = (run(&one, 100), run(&two, 100));
    assert_equal(&one, &two, |place| place);
    assert_equal(&one, &two, |place| place + 0.5 * DVec3::X);
}

#[test]
fn momentum_along_periodic_axes_is_kept() {
    let block = Case {
        dimension: "Three",
        min: "(0.0, 0.0, 0.0)",
        max: "(0.7, 0.7, 0.7)",
        spacing: 0.1,
        velocity: "(\"2 + sin(17*x + 5*y)\", \"1 + cos(31*z*x)\", \"sin(23*y)\")",
        conditions: "",
        fields: "domain: (min: (0.0, 0.0, 0.0), max: (0.7, 0.7, 0.7), periodic: [X, Y, Z]),",
    };
    let momentum = |sim: &Simulation| {
        let (view, rows) = sim.world().body_view(BodyId(0));
        let (m, v) = (view.read::<Mass>().expect("masses"), view.read::<Velocity>().expect("velocities"));
        rows.map(|k| m[k].0 * v[k].0).sum::<DVec3>()
    };
    let (before, after) = (momentum(&run(&block, 0)), momentum(&run(&block, 200)));
    assert!(before.length() > 100.0);
    assert!((after - before).length() < 1e-12 * before.length(), "{before} {after}");
}

#[test]
fn a_wave_in_a_periodic_medium_has_the_longitudinal_speed_and_the_error_falls() {
    // Standing wave of one wavelength of 1 m: cos(2 pi c t), c^2 = (lambda + 2 mu) / rho. Measured at a
    // quarter period by the phase that is left, asin(v / v0).
    let speed = (1e6 * 0.7 / (1.3 * 0.4) / 1000.0_f64).sqrt();
    let error = |n: u32| {
        let spacing = 1.0 / f64::from(n);
        let wave = Case {
            dimension: "Two",
            min: "(0.0, 0.0)",
            max: "(1.0, 0.5)",
            spacing,
            velocity: "(\"1e-6*sin(2*pi*x)\", 0.0)",
            conditions: "",
            fields: "domain: (min: (0.0, 0.0), max: (1.0, 0.5), periodic: [X, Y]),",
        };
        let steps = 33;
        let sim = run(&wave, steps);
        let phase = 2.0 * std::f64::consts::PI * speed * 2.0e-4 * steps as f64;
        let mut worst: f64 = 0.0;
        for (place, _, v) in states(&sim) {
            let wanted = 1e-6 * (2.0 * std::f64::consts::PI * place.x).sin() * phase.cos();
            worst = worst.max((v - DVec3::X * wanted).length() / 1e-6);
        }
        worst
    };
    let (coarse, fine) = (error(16), error(32));
    assert!(coarse < 0.08 && fine < 0.3 * coarse, "{coarse} {fine}");
}
