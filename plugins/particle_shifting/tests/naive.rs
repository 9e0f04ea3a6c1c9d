//! Displacements, velocities and densities against a naive second implementation over all pairs.

use std::sync::{Arc, Mutex};

use meshless_engine::assembly::build;
use meshless_engine::formulations::fluid::{DensityShift, SHIFTING_ENERGY};
use meshless_engine::glam::{DMat2, DVec2, DVec3};
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::scene::{Source, parse};
use meshless_engine::schedule::{Ledger, Stage, Step, System};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{
    BodyId, Column, Density, Force, Mass, Position, ReferenceVolume, Velocity, World,
};
use particle_shifting::{ParticleShifting, PendingDilation};
use schemars::JsonSchema;
use serde::Deserialize;

const SPACING: f64 = 0.05;
const H: f64 = 0.075;
const SOUND_SPEED: f64 = 20.0;
const STRENGTHS: [f64; 2] = [5.0, 2.0];
const REST_DENSITIES: [f64; 2] = [1000.0, 800.0];

/// A tank with two fluids of different strengths, a free surface and walls, far from order.
const SCENE: &str = r#"(dimension: Two, gravity: (0, -9.81),
    materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 1.0), "oil": Fluid(density: 800.0, sound_speed: 20.0)},
    bodies: [
        (name: "water", material: "water", shape: Box(min: (0, 0), max: (1.0, 0.4)), spacing: 0.05,
         lattice: Relaxed(seed: 7, iterations: 1), formulation: Fluid, plugins: [particle_shifting(strength: 5.0)]),
        (name: "oil", material: "oil", shape: Box(min: (0, 0.4), max: (1.0, 0.8)), spacing: 0.05,
         lattice: Relaxed(seed: 3, iterations: 1), formulation: Fluid, plugins: [particle_shifting(strength: 2.0)]),
        (name: "tank", material: "wall", spacing: 0.05, formulation: Wall(slip: Free),
         shape: Difference(Box(min: (-0.2, -0.2), max: (1.2, 0.9)), Box(min: (0, 0), max: (1, 2)))),
    ],
    conditions: [InitialVelocity(on: Select(body: "water"), value: ("sin(9*y)*x", "0.5*sin(7*x)")),
                 InitialVelocity(on: Select(body: "oil"), value: ("sin(9*y)", "0.5*sin(7*x)"))],
    plugins: [witness()], time: (end: 1.0))"#;

/// The state of all particles, fluids first.
#[derive(Clone, Default)]
struct State {
    position: Vec<DVec3>,
    velocity: Vec<DVec3>,
    /// Velocity at the middle of the step.
    middle: Vec<DVec3>,
    volume: Vec<f64>,
    density: Vec<f64>,
    pending: Vec<f64>,
    mass: Vec<f64>,
    bodies: Vec<usize>,
    dt: f64,
    /// Energy that the shift has taken from each body, J.
    taken: [f64; 2],
}

impl State {
    fn of(world: &World, dt: f64, ledger: &Ledger) -> Self {
        let account = ledger.accounts().iter().find(|account| account.name == SHIFTING_ENERGY);
        let taken = [0, 1].map(|k| account.map_or(0.0, |account| account.of(BodyId(k))));
        let mut state = Self { dt, taken, ..Self::default() };
        for k in 0..3 {
            let (view, rows) = world.body_view(BodyId(k));
            let read = |row: usize| -> Option<()> {
                let (x, v) = (view.read::<Position>().ok()?[row].0, view.read::<Velocity>().ok()?[row].0);
                state.position.push(x);
                state.velocity.push(v);
                state.bodies.push(k);
                if k == 2 {
                    state.volume.push(view.read::<ReferenceVolume>().ok()?[row].0);
                    state.middle.push(v);
                    return Some(());
                }
                let (m, rho) = (view.read::<Mass>().ok()?[row].0, view.read::<Density>().ok()?[row].0);
                state.volume.push(m / rho);
                state.mass.push(m);
                state.density.push(rho);
                state.middle.push(v - 0.5 * dt * view.read::<Force>().ok()?[row].0 / m);
                state.pending.push(view.read::<PendingDilation>().ok()?[row].0);
                Some(())
            };
            assert!(rows.map(read).all(|done| done.is_some()));
        }
        state
    }
}

static SEEN: Mutex<Option<Arc<Mutex<State>>>> = Mutex::new(None);

/// Writes the state down that the shift finds.
#[derive(Deserialize, JsonSchema)]
struct Witness {}

impl Plugin for Witness {
    const NAME: &'static str = "witness";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let state = Arc::new(Mutex::new(State::default()));
        *SEEN.lock().expect("a lock") = Some(Arc::clone(&state));
        let look = move |step: &mut Step<'_>| {
            *state.lock().expect("a lock") = State::of(step.world, step.clock.dt, step.ledger);
            Ok(())
        };
        sim.add_system(
            System::new(Stage::PostStep, "witness", look).reads_all().before(ParticleShifting::NAME),
        );
        Ok(())
    }
}

fn column<C: Column + Copy>(sim: &Simulation) -> Vec<C> {
    let of = |k| {
        let (view, rows) = sim.world().body_view(BodyId(k));
        view.read::<C>().expect("a column")[rows].to_vec()
    };
    [of(0), of(1)].concat()
}

/// What the shift does to a state.
struct Shifted {
    displacement: Vec<DVec3>,
    velocity: Vec<DVec3>,
    pending: Vec<f64>,
    density: Vec<f64>,
    inside: Vec<bool>,
}

/// Sums over all pairs of a state, in the plane.
struct Pairs<'a> {
    state: &'a State,
    kernel: Kernel,
    fluid: usize,
}

/// What the particles of a neighbourhood are like.
struct Local {
    lambda: f64,
    excess: f64,
    rate: f64,
    shift: DVec2,
}

impl Pairs<'_> {
    fn between(&self, i: usize, j: usize) -> DVec2 {
        (self.state.position[j] - self.state.position[i]).truncate()
    }

    fn near(&self, i: usize, end: usize) -> impl Iterator<Item = usize> {
        (0..end).filter(move |&j| j != i && self.between(i, j).length() < 2.0 * H)
    }

    fn w(&self, x: DVec2) -> f64 {
        if x.length() < 2.0 * H { self.kernel.pair_weight(x.length(), H) } else { 0.0 }
    }

    fn value(&self, x: DVec2) -> f64 {
        self.kernel.w(x.length(), H)
    }

    fn local(&self, i: usize) -> Local {
        let state = self.state;
        let (mut moment, mut gradient) = (DMat2::ZERO, DMat2::ZERO);
        let (mut first, mut walls) = (DVec2::ZERO, DVec2::ZERO);
        let mut excess = state.volume[i] * self.value(DVec2::ZERO) - 1.0;
        for j in self.near(i, state.position.len()) {
            let (x, v) = (self.between(i, j), (state.middle[j] - state.middle[i]).truncate());
            let vw = state.volume[j] * self.w(x);
            moment += DMat2::from_cols(x * x.x, x * x.y) * vw;
            gradient += DMat2::from_cols(v * x.x, v * x.y) * vw;
            first += x * vw * (1.0 + 0.2 * (self.value(x) / self.kernel.w(SPACING, H)).powi(4));
            excess += state.volume[j] * self.value(x);
            if j >= self.fluid {
                walls += x * vw;
            }
        }
        let (trace, determinant) = (moment.x_axis.x + moment.y_axis.y, moment.determinant());
        let lambda = 0.5 * (trace - (trace * trace - 4.0 * determinant).max(0.0).sqrt());
        let strain = 0.5 * (gradient + gradient.transpose());
        let rate = (2.0 * (strain.x_axis.length_squared() + strain.y_axis.length_squared())).sqrt();
        let normal = walls.normalize_or_zero();
        let along = first - normal * normal.dot(first);
        let shift = -4.0 * STRENGTHS[state.bodies[i]] * H * H * state.dt * rate * along;
        Local { lambda, excess, rate, shift: shift.clamp_length_max(SOUND_SPEED * state.dt / 12.0) }
    }

    /// Change of velocity of the particles of a body that gives back what it owes, J.
    fn friction(&self, body: usize, owed: f64) -> Vec<DVec3> {
        let state = self.state;
        let own = |i: &usize| state.bodies[*i] == body;
        let (mut change, mut taken) = (vec![DVec3::ZERO; self.fluid], 0.0);
        for i in (0..self.fluid).filter(own) {
            for j in self.near(i, self.fluid).filter(own) {
                let along = self.between(i, j).normalize().extend(0.0);
                let parting = (state.middle[j] - state.middle[i]).dot(along);
                let share = state.volume[j] * self.value(self.between(i, j)) * parting;
                // Where densities differ, the masses of two particles with the same volumes do too.
                let lightness = REST_DENSITIES[body] * state.volume[i] / state.mass[i];
                change[i] += lightness * share * along;
                taken += 0.5 * REST_DENSITIES[body] * state.volume[i] * share * parting;
            }
        }
        change.iter().map(|change| (owed / taken).min(0.05) * change).collect()
    }
}

/// The law, particle by particle over all pairs.
fn naive(state: &State) -> Shifted {
    let (fluid, all, dt) = (state.density.len(), state.position.len(), state.dt);
    let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
    let pairs = Pairs { state, kernel, fluid };
    let locals: Vec<Local> = (0..fluid).map(|i| pairs.local(i)).collect();
    let is_inside =
        |i: usize| locals[i].lambda >= 0.75 && pairs.near(i, fluid).all(|j| locals[j].lambda >= 0.65);
    let inside: Vec<bool> = (0..fluid).map(is_inside).collect();
    let shift = |j: usize| if j < fluid && inside[j] { locals[j].shift } else { DVec2::ZERO };
    let mut out = Shifted {
        displacement: (0..fluid).map(|i| shift(i).extend(0.0)).collect(),
        velocity: vec![DVec3::ZERO; fluid],
        pending: vec![0.0; fluid],
        density: vec![0.0; fluid],
        inside: inside.clone(),
    };
    let share = 1.0 - (-dt * SOUND_SPEED / (4.0 * H)).exp();
    for i in 0..fluid {
        let (mut dilation, mut mean, mut shared) = (0.0, locals[i].excess, 0.0);
        for j in pairs.near(i, all) {
            let apart = shift(j) - shift(i);
            let middle = pairs.between(i, j) + 0.5 * apart;
            dilation += state.volume[j] * pairs.w(middle) * apart.dot(middle);
        }
        for j in pairs.near(i, fluid) {
            let (x, v) = (pairs.between(i, j), state.middle[j] - state.middle[i]);
            out.velocity[i] += v * state.volume[j] * pairs.w(x) * 0.5 * (shift(i) + shift(j)).dot(x);
            let vw = state.volume[j] * pairs.value(x);
            shared += vw * (state.pending[j] - state.pending[i]);
            mean += if inside[j] { vw * (locals[j].excess - locals[i].excess) } else { 0.0 };
        }
        let (dilation, mean) = if inside[i] { (dilation, mean) } else { (0.0, 0.0) };
        let due = state.pending[i] + (10.0 * share).min(1.0) * shared + dilation;
        out.pending[i] = (1.0 - share) * due;
        let beyond = mean.signum() * (mean.abs() - 0.01).max(0.0);
        let change = (dt * locals[i].rate).min(1.0) * beyond - share * due;
        out.density[i] = state.density[i] * change / (1.0 - 0.5 * change);
    }
    for body in 0..2 {
        let own: Vec<usize> = (0..fluid).filter(|&i| state.bodies[i] == body).collect();
        let momentum: DVec3 = own.iter().map(|&i| state.mass[i] * out.velocity[i]).sum();
        let magnitude: f64 = own.iter().map(|&i| state.mass[i] * out.velocity[i].length()).sum();
        for i in own {
            let share = out.velocity[i].length() / magnitude;
            out.velocity[i] -= momentum * share;
        }
    }
    out.velocity.iter_mut().zip(&state.velocity).for_each(|(v, before)| *v += *before);
    for body in (0..2).filter(|&body| state.taken[body] < 0.0) {
        let changes = pairs.friction(body, -state.taken[body]);
        out.velocity.iter_mut().zip(changes).for_each(|(v, change)| *v += change);
    }
    out
}

#[test]
fn a_step_is_that_of_a_naive_sum_over_all_pairs() {
    compare("Double", 1.0);
    // Single precision is 1e-7 of what is summed.
    compare("Mixed", 1e3);
}

/// Compares the sums in that precision, whose round-off is so much larger than in double precision.
fn compare(precision: &str, factor: f64) {
    let text = SCENE.replacen('(', &format!("(precision: {precision}, "), 1);
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(particle_shifting::register).with(|registry| {
        registry.plugin::<Witness>();
    });
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    let witness = SEEN.lock().expect("a lock").clone().expect("a witness");
    let gives = || witness.lock().expect("a lock").taken.iter().any(|&energy| energy < 0.0);
    sim.run(|sim| sim.clock().step < 3 || (!gives() && sim.clock().step < 200)).expect("a run");
    let state = witness.lock().expect("a lock").clone();
    let wanted = naive(&state);
    let largest = wanted.displacement.iter().map(|x| x.length()).fold(0.0, f64::max);
    assert!(largest > 1e-4 * SPACING, "nothing moves: {largest}");
    let inside = wanted.inside.iter().filter(|&&inside| inside).count();
    assert!(inside > 50 && inside + 20 < wanted.inside.len(), "{inside}");
    assert!(state.pending.iter().any(|b| b.abs() > 1e-6));
    assert!(state.taken.iter().any(|&energy| energy < 0.0), "{:?}", state.taken);
    let (x, v) = (column::<Position>(&sim), column::<Velocity>(&sim));
    let (pending, density) = (column::<PendingDilation>(&sim), column::<DensityShift>(&sim));
    for i in 0..x.len() {
        let moved = x[i].0 - state.position[i];
        assert!(
            (moved - wanted.displacement[i]).length() < factor * 1e-9 * SPACING,
            "{precision} {i}: {moved} {}",
            wanted.displacement[i]
        );
        assert!((v[i].0 - wanted.velocity[i]).length() < factor * 1e-9, "{precision} {i}: {}", v[i].0);
        assert!(
            (pending[i].0 - wanted.pending[i]).abs() < factor * 1e-9,
            "{precision} {i}: {}",
            pending[i].0
        );
        assert!(
            (density[i].0 - wanted.density[i]).abs() < factor * 1e-6,
            "{precision} {i}: {}",
            density[i].0
        );
    }
}
