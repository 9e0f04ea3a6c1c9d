//! Updated-Lagrangian solids beside total-Lagrangian ones in the same scenes.

mod common;

use common::touching::touching;
use common::{all_plugins, failing, failing_metals, removal, simulation, with_formulation};
use meshless::formulations::updated_lagrangian::UpdatedReference;
use meshless::glam::DVec3;
use meshless::scene::Source;
use meshless::simulation::{Checkpoint, Simulation};
use meshless::world::{
    BodyId, DeformationGradient, Mass, Position, ReferencePosition, Removed, SupportRadius, Velocity,
};

/// Updates often, so that short runs have many of them.
const OFTEN: &str = "UpdatedLagrangian(update: Adaptive(change: 0.01))";

fn after(source: &Source, steps: u64) -> Simulation {
    let mut sim = simulation(source);
    sim.run(|sim| sim.clock().step < steps).expect("a run");
    sim
}

fn positions(sim: &Simulation, body: usize) -> Vec<DVec3> {
    let body = sim.world().body(BodyId(body));
    let view = sim.world().phase(body.phase);
    view.read::<Position>().expect("positions")[body.rows.clone()].iter().map(|x| x.0).collect()
}

#[test]
fn without_updates_it_is_the_total_lagrangian_formulation() {
    for (dimension, steps) in [(2, 300), (3, 100)] {
        let scene = all_plugins(dimension);
        let total =
            after(&with_formulation("TotalLagrangian(kernel: cubic_spline, support: 2.4)", &scene), steps);
        let updated = after(&with_formulation("UpdatedLagrangian(update: Never)", &scene), steps);
        assert!((total.clock().time - updated.clock().time).abs() < 1e-12 * total.clock().time);
        for body in 0..2 {
            for (a, b) in positions(&total, body).iter().zip(positions(&updated, body)) {
                assert!((*a - b).length() < 1e-12, "body {body} in {dimension} dimensions: {a} and {b}");
            }
        }
    }
}

#[test]
fn without_updates_differences_of_laplacians_are_those_of_the_total_lagrangian_formulation() {
    let of = |formulation: &str| {
        let Source { name, text, .. } = thrown(formulation);
        let plugin = "hourglass_control(), hessian_stabilization()";
        after(&Source::new(name, text.replace("hourglass_control()", plugin)), 200)
    };
    let total = of("TotalLagrangian(kernel: cubic_spline, support: 2.4)");
    let updated = of("UpdatedLagrangian(update: Never)");
    for (a, b) in positions(&total, 0).iter().zip(positions(&updated, 0)) {
        assert!((*a - b).length() < 1e-12, "{a} and {b}");
    }
}

#[test]
fn bits_do_not_depend_on_threads_or_on_a_restart() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("state.mlc");
    let steps = 150;
    let differences = |form: &str| {
        let Source { name, text, .. } = thrown("TotalLagrangian");
        Source::new(name, text.replace("hourglass_control()", &format!("hessian_stabilization({form})")))
    };
    let differences = [differences(""), differences("form: Vidal2007")];
    let others = [all_plugins(2), all_plugins(3), removal(), failing(), failing_metals(), touching()];
    for source in others.into_iter().chain(differences) {
        let source = with_formulation(OFTEN, &source);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
            pool.install(|| after(&source, steps).state_hash())
        };
        let one = on(1);
        assert_eq!(one, on(3), "{}: threads", source.name);
        after(&source, 71).save(&path, &source).expect("a checkpoint");
        let checkpoint = Checkpoint::read(&path).expect("a checkpoint");
        let mut second = simulation(&checkpoint.source());
        second.restore(&checkpoint).expect("a restart");
        second.run(|sim| sim.clock().step < steps).expect("a run");
        assert_eq!(one, second.state_hash(), "{}: restart", source.name);
    }
}

#[test]
fn a_body_that_loses_particles_updates_no_other_one() {
    let body = |name: &str, at: f64| {
        format!(
            r#"(name: "{name}", material: "soft", shape: Box(min: (0, {at:?}), max: (1.0, {:?})), spacing: 0.04,
                formulation: UpdatedLagrangian(update: Never), plugins: [hourglass_control()])"#,
            at + 0.4
        )
    };
    let text = format!(
        r#"(dimension: Two, domain: (min: (-1, -1), max: (1.05, 1), outside: Remove),
            materials: {{"soft": NeoHookean(density: 1, young: 1, poisson: 0.3)}}, bodies: [{}, {}],
            conditions: [InitialVelocity(on: Select(body: "a"), value: ("0.5", "0")),
                         InitialVelocity(on: Select(body: "b"), value: ("0.05*x", "0"))], time: (end: 10.0))"#,
        body("a", 0.0),
        body("b", -0.8)
    );
    let sim = after(&Source::new("two.ron", text), 40);
    let world = sim.world();
    let moved = |body: usize| {
        let body = world.body(BodyId(body));
        let view = world.phase(body.phase);
        let original = view.read::<ReferencePosition>().expect("places of the start");
        let reference = view.read::<UpdatedReference>().expect("the reference");
        body.rows.clone().any(|row| reference[row].0 != original[row].0)
    };
    assert!(moved(0), "particles of `a` have left");
    assert!(!moved(1), "`b` has lost nothing");
}

/// A ball that leaves its domain has lost its neighbours as it should.
#[test]
fn a_body_that_leaves_its_domain_is_not_said_to_be_torn() {
    let text = r#"(dimension: Two, domain: (min: (-0.5, -0.5), max: (0.85, 1.5), outside: Remove),
            materials: {"rubber": StVenantKirchhoff(density: 1000, young: 1e6, poisson: 0.3)},
            bodies: [(name: "ball", material: "rubber", shape: Sphere(center: (0.5, 0.5), radius: 0.3), spacing: 0.05,
                      formulation: UpdatedLagrangian, plugins: [hourglass_control()])],
            conditions: [InitialVelocity(on: Select(), value: ("8", "0"))], time: (end: 0.2))"#;
    let sim = after(&Source::new("left.ron", text.to_owned()), 100);
    assert!(
        !sim.warnings().iter().any(|text| text.contains("lost their neighbours")),
        "{:?}",
        sim.warnings()
    );
    let (view, rows) = sim.world().body_view(BodyId(0));
    let removed = view.read::<Removed>().expect("removed particles");
    assert!(removed[rows].iter().all(|removed| *removed != Removed::NO), "all have left");
}

/// A particle that has been removed stays where it was; what is left of its body may move on at any speed.
#[test]
fn a_body_that_leaves_removed_particles_behind_is_updated_as_one_at_rest() {
    let flown = |speed: f64| {
        let text = format!(
            r#"(dimension: Two, materials: {{"brittle": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
                bodies: [(name: "strip", material: "brittle", shape: Box(min: (0, 0), max: (1.0, 0.4)), spacing: 0.04,
                          formulation: UpdatedLagrangian,
                          plugins: [hourglass_control(),
                                    failure(criterion: MaximumPrincipalStrain(limit: 0.05), then: Removed)])],
                conditions: [InitialVelocity(on: Select(), value: ("0.3*(x - 0.5)*(1 + x)", "{speed:?}"))],
                time: (end: 10.0, step: Fixed(0.005)))"#
        );
        let sim = after(&Source::new("flown.ron", text), 120);
        let place = DVec3::Y * (speed * sim.clock().time);
        let (view, rows) = sim.world().body_view(BodyId(0));
        let removed = view.read::<Removed>().expect("removed particles");
        let own = positions(&sim, 0).into_iter().zip(&removed[rows]);
        own.map(|(x, removed)| (x - place, *removed != Removed::NO)).collect::<Vec<_>>()
    };
    let (rest, flight) = (flown(0.0), flown(5.0));
    assert!(rest.iter().any(|(_, removed)| *removed), "some have failed");
    for (a, b) in rest.iter().zip(&flight) {
        assert!(a.1 == b.1 && (a.1 || (a.0 - b.0).length() < 1e-9), "{a:?} {b:?}");
    }
}

/// A beam that is thrown, spins and swings: 24 x 6 particles of rubber, irregular.
fn thrown(formulation: &str) -> Source {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"rubber": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "beam", material: "rubber", shape: Box(min: (0, 0), max: (1.2, 0.3)), spacing: 0.05,
                      lattice: Relaxed(seed: 5, iterations: 2), formulation: {formulation}, plugins: [hourglass_control()])],
            conditions: [InitialVelocity(on: Select(body: "beam"), value: ("0.3 - 0.4*(y - 0.15)", "0.4*(x - 0.6) + 0.2*cos(5.2*x)"))],
            time: (end: 100.0))"#
    );
    Source::new("thrown.ron", text)
}

/// Momentum, angular momentum about the origin, and the sums of their parts.
fn momenta(sim: &Simulation) -> (DVec3, DVec3) {
    let view = sim.world().phase(sim.world().body(BodyId(0)).phase);
    let (x, v) = (view.read::<Position>().expect("places"), view.read::<Velocity>().expect("velocities"));
    let m = view.read::<Mass>().expect("masses");
    let rows = 0..view.len();
    let linear = rows.clone().map(|k| v[k].0 * m[k].0).sum();
    (linear, rows.map(|k| x[k].0.cross(v[k].0) * m[k].0).sum())
}

#[test]
fn a_thrown_body_keeps_its_momenta_and_its_energy_through_updates() {
    let mut sim = simulation(&thrown("UpdatedLagrangian(update: Adaptive(change: 0.25))"));
    sim.run(|sim| sim.clock().step < 1).expect("a step");
    let (linear, angular) = momenta(&sim);
    sim.run(|sim| sim.clock().time < 20.0).expect("a run");
    let (now, turned) = momenta(&sim);
    // Turned by more than two radians: the reference has been updated, and what it has changed is booked.
    assert!(sim.ledger().total_named("reference_update") != 0.0, "no update");
    assert!((now - linear).length() < 1e-12 * linear.length(), "momentum {linear} -> {now}");
    assert!((turned - angular).length() < 1e-10 * angular.length(), "angular momentum {angular} -> {turned}");
    let kinetic = sim.ledger().total_named("kinetic");
    let error = sim.ledger().balance_error();
    assert!(error.abs() < 0.03 * kinetic, "balance {error} J of {kinetic} J");
}

#[test]
fn what_frequent_updates_change_is_booked() {
    for plugin in ["", "hourglass_control()", "hessian_stabilization()"] {
        let Source { name, text, .. } = thrown("UpdatedLagrangian(update: Every(3))");
        let source = Source::new(name, text.replace("hourglass_control()", plugin));
        let mut sim = simulation(&source);
        sim.run(|sim| sim.clock().time < 4.0).expect("a run");
        assert!(sim.ledger().total_named("reference_update") != 0.0, "no update");
        let share = sim.ledger().balance_error() / sim.ledger().total_named("kinetic");
        assert!(share.abs() < 2e-3, "`{plugin}`: balance {share} of the kinetic energy");
    }
}

/// A rubber ring, five particles across, that hits a wall at an eleventh of its wave speed.
fn ring(formulation: &str, plugin: &str) -> Source {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"rubber": DecoupledNeoHookean(density: 1000, bulk: 1.67e6, shear: 0.3571e6),
                         "steel": NeoHookean(density: 7850, young: 2.1e11, poisson: 0.3)}},
            bodies: [(name: "ring", material: "rubber", shape: Ring(center: (0, 0), inner: 0.03, outer: 0.04), spacing: 2e-3,
                      lattice: Concentric, formulation: {formulation}, velocity: (-4, 0), plugins: [{plugin}]),
                     (name: "wall", material: "steel", shape: Box(min: (-0.05, -0.05), max: (-0.04, 0.05)), spacing: 5e-3, formulation: Rigid)],
            conditions: [Fix(on: Select(body: "wall"))],
            contacts: [Contact(between: ("ring", "wall"), law: Penalty())],
            time: (end: 15e-3))"#
    );
    Source::new("ring.ron", text)
}

/// Energies that ways of updating may differ by, over that at the start.
const DRIFT: f64 = 0.02;

#[test]
fn frequent_updates_take_no_energy_out_of_the_motion() {
    for plugin in ["hourglass_control()", "hessian_stabilization()"] {
        let run = |update: &str| {
            let mut sim = simulation(&ring(&format!("UpdatedLagrangian(update: {update})"), plugin));
            sim.start().expect("a start");
            let start = sim.ledger().stored();
            sim.run(|_| true).expect("a run");
            let share = |name| sim.ledger().total_named(name) / start;
            ["kinetic", "strain", "reference_update"].map(share)
        };
        let never = run("Never");
        for update in ["Every(3)", "Adaptive(change: 0.25)"] {
            for (found, expected) in run(update).into_iter().zip(never) {
                let error = (found - expected).abs();
                assert!(
                    error < DRIFT,
                    "`{plugin}`, {update}: {found} of the energy, {expected} without updates"
                );
            }
        }
    }
}

/// Irregular particles are updated by few of them at the edge, whose strain is largest.
#[test]
fn a_body_of_random_particles_that_breathes_by_a_fifth_keeps_its_energy() {
    let scene = include_str!("validation/patch/scene.ron")
        .replace("StVenantKirchhoff", "NeoHookean")
        .replace("TotalLagrangian(neighbors: 12)", "UpdatedLagrangian(update: Adaptive(change: 1.0))")
        .replace("0.1*", "0.2*")
        .replace("end: 308.0", "end: 15.5");
    let mut sim = simulation(&Source::new("patch.ron", scene));
    sim.start().expect("a start");
    let start = sim.ledger().stored();
    sim.run(|_| true).expect("a run");
    let drift = sim.ledger().stored() / start - 1.0;
    assert!(drift.abs() < 0.06, "{drift}");
    assert!(sim.ledger().total_named("reference_update") != 0.0, "it is updated");
}

/// The stiffness of the control does not follow the dilatation, and updates do no work.
#[test]
fn a_body_that_breathes_gains_no_energy_by_many_updates() {
    let scene = include_str!("validation/patch/scene.ron")
        .replace("TotalLagrangian(neighbors: 12)", "UpdatedLagrangian(update: Every(10))")
        .replace("end: 308.0", "end: 15.5");
    let mut sim = simulation(&Source::new("patch.ron", scene));
    sim.start().expect("a start");
    let start = sim.ledger().stored();
    sim.run(|_| true).expect("a run");
    let booked = sim.ledger().total_named("reference_update") / start;
    assert!(booked != 0.0 && booked.abs() < 0.01, "updates have taken {booked} of the energy");
}

#[test]
fn a_gate_beside_water_moves_alike_in_every_formulation() {
    let scene = include_str!("validation/elastic_gate/scene.ron");
    let swing = |formulation: &str| {
        let text = scene.replace("formulation: TotalLagrangian", &format!("formulation: {formulation}"));
        let mut sim = simulation(&Source::new("gate.ron", text.replace("end: 0.16", "end: 0.04")));
        let start = positions(&sim, 1);
        sim.run(|_| true).expect("a run");
        let moved = positions(&sim, 1).into_iter().zip(start).map(|(now, start)| now - start);
        moved.max_by(|a, b| a.length().total_cmp(&b.length())).expect("particles")
    };
    let total = swing("TotalLagrangian");
    assert!(total.x > 0.01, "the water pushes the gate to the side: {total}");
    for formulation in ["UpdatedLagrangian", "UpdatedLagrangian(update: Every(3))", "Eulerian"] {
        let found = swing(formulation);
        assert!((found - total).length() < 0.03 * total.length(), "{formulation}: {found}, {total}");
    }
}

/// A quarter of a metal bar, 5 x 12 particles, that is squeezed to a tenth of its height.
fn squeezed(formulation: &str) -> Source {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"metal": J2(density: 2700, young: 78.2e9, poisson: 0.3, hardening: Perfect(yield_stress: 0.29e9))}},
            bodies: [(name: "bar", material: "metal", shape: Box(min: (0, 0), max: (4e-3, 9.6e-3)), spacing: 0.8e-3,
                      formulation: {formulation}, plugins: [hourglass_control()])],
            conditions: [Symmetry(plane: X, at: 0.0, side: Above), Symmetry(plane: Y, at: 0.0, side: Above),
                         InitialVelocity(on: Select(), value: ("1e4*x", "-1e4*y")),
                         Velocity(on: Select(body: "bar", face: MaxY), value: (None, "-96*exp(-1e4*t)"))],
            time: (end: 230e-6))"#
    );
    Source::new("squeezed.ron", text)
}

#[test]
fn a_bar_that_is_squeezed_to_a_tenth_becomes_ten_times_as_wide() {
    // The volume of metal that flows stays: x = X exp(1e4 t).
    let error = |formulation: &str| {
        let mut sim = simulation(&squeezed(formulation));
        let widest = |sim: &Simulation| positions(sim, 0).iter().map(|x| x.x).fold(0.0, f64::max);
        let start = widest(&sim);
        sim.run(|_| true).expect("a run");
        assert!(sim.ledger().relative_error().abs() < 0.01, "energy balance");
        let body = sim.world().body(BodyId(0));
        let view = sim.world().phase(body.phase);
        let gradient = view.read::<DeformationGradient>().expect("deformation gradients");
        let volume = gradient.iter().map(|f| f.0.determinant()).sum::<f64>() / gradient.len() as f64;
        assert!((volume - 1.0).abs() < 0.01, "{formulation}: volume {volume}");
        (widest(&sim) / (start * 2.3f64.exp()) - 1.0).abs()
    };
    let often = error("UpdatedLagrangian(update: Adaptive(change: 0.25))");
    let (updated, total) = (error("UpdatedLagrangian"), error("TotalLagrangian"));
    assert!(often < 0.025, "the width is off by {often}");
    assert!(often < updated && updated < total, "{often}, {updated}, {total} of a total-Lagrangian bar");
}

/// A metal bar of 5 x 15 particles that hits a wall and flows.
fn taylor(formulation: &str) -> Source {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"metal": J2(density: 2700, young: 78.2e9, poisson: 0.3, hardening: Perfect(yield_stress: 0.29e9))}},
            bodies: [(name: "bar", material: "metal", shape: Box(min: (-3.81e-3, 0), max: (3.81e-3, 22.86e-3)), spacing: 1.524e-3,
                      formulation: {formulation}, velocity: (0, -373), plugins: [hourglass_control()])],
            conditions: [Symmetry(plane: Y, at: 0.0, side: Above)],
            time: (end: 40e-6))"#
    );
    Source::new("taylor.ron", text)
}

#[test]
fn steps_of_a_body_that_is_squeezed_are_those_of_its_present_reference() {
    let run = |formulation: &str| {
        let mut sim = simulation(&taylor(formulation));
        sim.run(|_| true).expect("a run");
        (sim.clock().step, sim.ledger().relative_error().abs())
    };
    let (total, _) = run("TotalLagrangian(kernel: cubic_spline, support: 2.4)");
    let (updated, balance) = run("UpdatedLagrangian()");
    // Seen from the undeformed configuration the wave speed grows as one over the smallest stretch; over
    // present lengths it stays.
    assert!(updated < total, "{updated} steps, {total} of a total-Lagrangian bar");
    assert!(balance < 0.01, "energy balance error {balance}");
}

/// Strain energy of the square of S5, eight across, at three times its length, and what the run has warned
/// of.
fn drawn(formulation: &str) -> (f64, Vec<String>) {
    let scene = include_str!("validation/rubber_pull/scene.ron")
        .replace("formulation: TotalLagrangian", &format!("formulation: {formulation}"))
        .replace("spacing: 0.0666666667e-3", "spacing: 0.25e-3")
        .replace("end: 1.45e-3", "end: 0.6e-3");
    let mut sim = simulation(&Source::new("pull.ron", scene));
    sim.run(|_| true).expect("a run");
    (sim.ledger().total_named("strain"), sim.warnings().to_vec())
}

#[test]
fn rubber_that_is_drawn_from_a_clamp_is_not_torn_by_updates() {
    let (total, _) = drawn("TotalLagrangian(kernel: cubic_spline, support: 2.0)");
    for (update, warns) in
        [("Automatic", false), ("Adaptive(change: 1.0)", true), ("Every(20)", true), ("Never", false)]
    {
        let (strain, warnings) = drawn(&format!("UpdatedLagrangian(support: 2.0, update: {update})"));
        assert!((strain / total - 1.0).abs() < 0.1, "{update}: {strain} J and {total} J");
        let has_warned = warnings.iter().any(|text| text.contains("body `sheet` keeps its reference from"));
        assert_eq!(has_warned, warns, "{update}: {warnings:?}");
    }
}

/// Metal that its sides draw to so many times its length, and what the run has warned of.
fn warnings_of_drawn_metal(update: &str, stretch: f64) -> Vec<String> {
    let text = format!(
        r#"(dimension: Two, materials: {{"metal": J2(density: 2700, young: 7e10, poisson: 0.3, hardening: Linear(yield_stress: 4e8, modulus: 4e9))}},
        bodies: [(name: "bar", material: "metal", shape: Box(min: (0, 0), max: (0.02, 0.01)), spacing: 0.00125,
            formulation: UpdatedLagrangian(update: {update}), plugins: [hourglass_control()])],
        conditions: [Symmetry(plane: X, at: 0.0), Symmetry(plane: Y, at: 0.0), InitialVelocity(on: Select(), value: ("2000*x", None)),
            Velocity(on: Select(face: MaxX), value: ("40", None))],
        time: (end: {:?}))"#,
        (stretch - 1.0) / 2000.0
    );
    let mut sim = simulation(&Source::new("drawn.ron", text));
    sim.run(|_| true).expect("a run");
    sim.warnings().to_vec()
}

/// The shares of stress beside such sides are those of the initial lattice.
#[test]
fn a_side_that_draws_metal_unevenly_after_an_update_is_said() {
    for (update, stretch, warns) in
        [("Automatic", 1.2, false), ("Automatic", 1.8, true), ("Never", 1.8, false)]
    {
        let warnings = warnings_of_drawn_metal(update, stretch);
        let count = warnings.iter().filter(|text| text.contains("from the first update of the reference on"));
        assert_eq!(count.count(), usize::from(warns), "{update} to {stretch}: {warnings:?}");
    }
}

/// Nobody sees the inside of a clamp: no larger support would find it neighbours, but would make the lists of
/// all others longer, and the first update take four searches.
#[test]
fn particles_deep_in_a_clamp_keep_their_support() {
    let text = r#"(dimension: Two, materials: {"rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)},
        bodies: [(name: "bar", material: "rubber", shape: Box(min: (0, 0), max: (0.04, 0.01)), spacing: 0.001,
            formulation: UpdatedLagrangian(update: Every(1)), plugins: [hourglass_control()])],
        conditions: [Fix(on: Select(within: Box(min: (0, 0), max: (0.01, 0.01)))), InitialVelocity(on: Select(), value: ("x", 0))],
        time: (end: 1.0))"#;
    let sim = after(&Source::new("clamped.ron", text.to_owned()), 5);
    let support = sim.world().phase(sim.world().body(BodyId(0)).phase);
    let support = support.read::<SupportRadius>().expect("support radii");
    assert!(
        support.iter().all(|own| own.0 == support[399].0),
        "{:?}",
        support.iter().map(|own| own.0).fold(0.0, f64::max)
    );
}
