//! Scenes that fail, and the messages of the watchdog.

use crate::assembly::build;
use crate::plugin::{Plugin, Registry, SetupError, SimBuilder};
use crate::scene::{Source, parse};
use crate::schedule::{AccountKind, Stage, Step, StepError, System};
use crate::simulation::{Outcome, RunError, Simulation};
use crate::world::BodyId;

/// Two blocks of 6 particles side by side that fall; `more` goes into the scene.
fn blocks(more: &str) -> Simulation {
    blocks_under(10.0, more)
}

/// The same with the given gravity, m/s2.
fn blocks_under(gravity: f64, more: &str) -> Simulation {
    let text = format!(
        r#"Scene(
    dimension: Two,
    gravity: (0.0, -{gravity:?}),
    materials: {{"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)}},
    bodies: [
        Body(name: "left", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.03, 0.02)), spacing: 0.01,
             formulation: TotalLagrangian),
        Body(name: "right", material: "rubber", shape: Box(min: (1.0, 0.0), max: (1.03, 0.02)), spacing: 0.01,
             formulation: TotalLagrangian),
    ],
    {more}
)"#
    );
    simulation(text)
}

fn simulation(text: String) -> Simulation {
    let (scene, source) = parse(Source::new("blocks.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let registry = Registry::standard().with(|registry| {
        registry.condition::<Book>();
    });
    build(&scene, &source, &registry).unwrap_or_else(|e| panic!("{e}"))
}

/// Books an energy that is not there: `energy` times t in the account of the right body.
#[derive(Clone, serde::Deserialize, schemars::JsonSchema)]
struct Book {
    account: String,
    energy: f64,
    #[serde(default)]
    dissipated: bool,
    /// `energy` times t squared.
    #[serde(default)]
    squared: bool,
}

impl Plugin for Book {
    const NAME: &'static str = "Book";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        sim.add_system(System::new(Stage::PostStep, "book", move |step: &mut Step<'_>| {
            if self.dissipated {
                let account = step.ledger.account(&self.account, AccountKind::Dissipated);
                step.ledger.add(account, BodyId(1), self.energy * step.clock.dt);
                return Ok(());
            }
            let account = step.ledger.account(&self.account, AccountKind::Stored);
            let time = step.clock.end();
            step.ledger.set(account, BodyId(1), self.energy * if self.squared { time * time } else { time });
            Ok(())
        }));
        Ok(())
    }
}

fn failure(mut sim: Simulation) -> (StepError, Simulation) {
    match sim.run(|_| true) {
        Err(RunError::Step(error)) => (error, sim),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_particle_that_leaves_the_domain_stops_the_run() {
    let scene = "domain: (min: (-1.0, -0.05), max: (2.0, 1.0)), time: (end: 1.0, step: Fixed(1.0e-4)),";
    let (error, mut sim) = failure(blocks(scene));
    let StepError::Unstable { particle, ref body, step, time, .. } = error else { panic!("{error}") };
    // The lowest row, at 0.005 m, falls 0.055 m in sqrt(0.011) s; the look comes every tenth step.
    assert!((time - 0.011_f64.sqrt()).abs() < 1.1e-3, "{time}");
    assert!(step.is_multiple_of(10) && body == "left" && particle < 6, "{error}");
    assert!(error.to_string().contains("outside the domain, which holds nothing back"), "{error}");
    let Outcome::Failed(why) = sim.finish().unwrap().outcome else { panic!() };
    assert_eq!(why, error.to_string());
}

#[test]
fn periodic_sides_and_the_third_axis_of_a_plane_are_open() {
    let scene = "domain: (min: (-1.0, -0.05), max: (2.0, 1.0), periodic: [Y]), time: (end: 0.2),";
    assert!(blocks(scene).run(|_| true).is_ok());
}

#[test]
fn a_load_that_grows_from_nothing_is_no_instability() {
    // In its first steps it does less work than the round-off of the strain energy.
    let load = r#"Traction(on: Select(body: "right", face: MaxX), value: ("100*smoothstep(t/10.0)", 0.0))"#;
    let scene = format!("conditions: [{load}], time: (end: 0.01),");
    blocks_under(0.0, &scene).run(|_| true).unwrap();
}

#[test]
fn an_unstable_step_is_stopped_by_the_growth_of_energy() {
    // Twice the safe step is above the critical one: the shortest waves grow, from deformations so small that
    // no particle inverts before.
    let scene = "conditions: [Fix(on: Select(body: \"right\", face: MinX))],
                 time: (end: 1.0, step: Adaptive(factor: 2.0)),";
    let (error, sim) = failure(blocks_under(1.0e-3, scene));
    let StepError::EnergyGrowth { stored, available, ref body, ref account, .. } = error else {
        panic!("{error}")
    };
    assert!(stored > 10.0 * available && available > 0.0, "{error}");
    let held = |name: &str, k: usize| {
        sim.ledger().accounts().iter().find(|a| a.name == name).map(|a| a.of(BodyId(k))).unwrap()
    };
    let most = [("strain", 0), ("strain", 1), ("kinetic", 0), ("kinetic", 1)]
        .into_iter()
        .max_by(|a, b| held(a.0, a.1).total_cmp(&held(b.0, b.1)))
        .unwrap();
    assert_eq!((account.as_str(), body.as_str()), (most.0, ["left", "right"][most.1]));
    assert!(error.to_string().contains(&format!("energy of body `{body}`: the run is unstable")), "{error}");
}

#[test]
fn the_largest_account_and_its_body_are_named() {
    let (error, _) =
        failure(blocks("conditions: [Book(account: \"made_up\", energy: 1.0e6)], time: (end: 1.0),"));
    let StepError::EnergyGrowth { account, body, .. } = error else { panic!("{error}") };
    assert_eq!((account.as_str(), body.as_str()), ("made_up", "right"));
}

#[test]
fn a_body_without_any_energy_is_left_alone() {
    let mut sim = blocks("time: (end: 0.01),");
    let still = sim.run(|_| true);
    assert!(still.is_ok() && sim.finish().unwrap().warnings.is_empty(), "{:?}", sim.warnings());
}

#[test]
fn hourglass_energy_is_warned_of_once_for_each_body() {
    let scene = "conditions: [Fix(on: Select(face: MinX)), Book(account: \"hourglass\", energy: 10.0, squared: true)],
                 record: (every: 0.001), time: (end: 0.01),";
    let mut sim = blocks(scene);
    sim.run(|_| true).unwrap();
    let hourglass: Vec<&String> = sim.warnings().iter().filter(|w| w.contains("hourglass energy")).collect();
    assert_eq!(hourglass.len(), 1, "{:?}", sim.warnings());
    assert!(hourglass[0].contains("of body `right`") && hourglass[0].contains(", at 10 ms"), "{hourglass:?}");
}

#[test]
fn hourglass_energy_that_is_small_beside_plastic_work_is_not_warned_of() {
    let scene = "conditions: [Fix(on: Select(face: MinX)), Book(account: \"hourglass\", energy: 1.0e-2),
                              Book(account: \"plastic_work\", energy: 1.0e-1)],
                 record: (every: 0.001), time: (end: 0.01),";
    let mut sim = blocks(scene);
    sim.run(|_| true).unwrap();
    assert!(!sim.warnings().iter().any(|w| w.contains("hourglass energy")), "{:?}", sim.warnings());
}

#[test]
fn hourglass_energy_is_judged_beside_all_that_the_run_has_brought() {
    // It grows with t and the strain energy with its square: its share is large at first, where it was warned
    // of, and 5 % at the end.
    let scene = "conditions: [Fix(on: Select(face: MinX)), Book(account: \"hourglass\", energy: 1.0e-2)],
                 record: (every: 0.001), time: (end: 0.01),";
    let mut sim = blocks(scene);
    let mut largest = 0.0_f64;
    sim.run(|sim| {
        let of = |name: &str| sim.ledger().total_named(name);
        if sim.clock().time > 0.001 {
            largest = largest.max(of("hourglass") / of("strain"));
        }
        true
    })
    .unwrap();
    assert!(largest > 0.2, "{largest}");
    assert!(!sim.warnings().iter().any(|w| w.contains("hourglass energy")), "{:?}", sim.warnings());
}

#[test]
fn a_balance_that_does_not_close_is_warned_of_at_the_end() {
    let scene = "conditions: [Book(account: \"made_up\", energy: 1.0e-1)], time: (end: 0.01),";
    let mut sim = blocks(scene);
    sim.run(|_| true).unwrap();
    let warnings = sim.finish().unwrap().warnings;
    assert!(warnings.iter().any(|w| w.contains("energy balance error")), "{warnings:?}");
    assert_eq!(sim.finish().unwrap().warnings, warnings);
}

#[test]
fn what_can_only_take_energy_and_gives_it_is_warned_of_with_the_largest_share() {
    let scene = |energy: f64| {
        format!(
            "conditions: [Book(account: \"made_up\", energy: {energy:?}, dissipated: true)], record: (every: 0.01), time: (end: 0.1),"
        )
    };
    let given = |energy: f64| {
        let mut sim = blocks(&scene(energy));
        sim.run(|_| true).unwrap();
        sim.warnings()
            .iter()
            .filter(|text| text.contains("`made_up` has produced energy"))
            .cloned()
            .collect::<Vec<_>>()
    };
    assert!(given(1.0).is_empty());
    assert_eq!(given(-1.0).len(), 1);
    // The blocks of 0.6 kg each fall with 0.6 J at the end, of which these are 3 and 0.3 %.
    assert_eq!(given(-0.2).len(), 1);
    assert!(given(-0.02).is_empty());
}

#[test]
fn hourglass_energy_of_the_first_load_is_not_judged() {
    let scene = "conditions: [Fix(on: Select(face: MinX)), Book(account: \"hourglass\", energy: 1.0e-2)],
                 record: (every: 0.001), time: (end: 1.0),";
    let mut sim = blocks(scene);
    sim.run(|sim| sim.clock().time < 0.01).unwrap();
    assert!(!sim.warnings().iter().any(|w| w.contains("hourglass energy")), "{:?}", sim.warnings());
}

#[test]
fn what_walls_give_is_measured_by_the_weight_that_a_load_is() {
    let tank = |energy: f64| {
        let mut sim = simulation(format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02,
                     formulation: Fluid(pressure: "9810*(0.2 - y)")),
                    (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (0.46, 0.4)), Box(min: (0, 0), max: (0.4, 1)))),
                ],
                conditions: [
                    BodyForce(on: Select(body: "water"), value: (0.0, -9.81)),
                    Book(account: "given", energy: {energy:?}, dissipated: true),
                ],
                time: (end: 0.1))"#
        ));
        sim.run(|_| true).unwrap();
        sim.warnings().iter().any(|warning| warning.contains("`given` has produced energy"))
    };
    // The weight of 80 kg along their height of 0.2 m is 157 J, the energy of compression 0.13 J.
    assert!(!tank(-0.5));
    assert!(tank(-20.0));
}

#[test]
fn solids_that_pass_through_each_other_without_a_contact_are_named() {
    let told = |contacts: &str, speed: f64| {
        // The gap of 0.01 m closes after 5 ms at 2 m/s.
        let mut sim = simulation(format!(
            r#"(dimension: Two, materials: {{"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)}},
                bodies: [
                    (name: "a", material: "rubber", shape: Box(min: (0, 0), max: (0.04, 0.04)), spacing: 0.01, velocity: ({speed:?}, 0.0), formulation: TotalLagrangian),
                    (name: "b", material: "rubber", shape: Box(min: (0.05, 0.004), max: (0.09, 0.044)), spacing: 0.01, formulation: TotalLagrangian),
                ],
                {contacts} time: (end: 0.02))"#
        ));
        sim.run(|_| true).unwrap();
        sim.warnings().iter().filter(|text| text.contains("`a` and `b` pass through each other")).count()
    };
    assert_eq!(told("", 2.0), 1);
    assert_eq!(told("", 0.4), 0);
    assert_eq!(told(r#"contacts: [(between: ("a", "b"))],"#, 2.0), 0);
}

#[test]
fn bodies_that_go_through_a_symmetry_plane_are_named() {
    let told = |ball: &str, more: &str| {
        let mut sim = simulation(format!(
            r#"(dimension: Two, materials: {{"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)}},
                bodies: [
                    (name: "half", material: "rubber", shape: Box(min: (0, 0), max: (0.04, 0.04)), spacing: 0.01, formulation: TotalLagrangian),
                    (name: "ball", material: "rubber", spacing: 0.01, shape: {ball}),
                ],
                {more} time: (end: 0.02), record: (every: 0.002))"#
        ));
        sim.run(|_| true).unwrap();
        sim.warnings()
            .iter()
            .filter(|text| text.contains("`ball` goes through the symmetry plane X = 0 m"))
            .count()
    };
    let plane = "conditions: [Symmetry(plane: X, at: 0)],";
    let near = "Sphere(center: (0.04, 0.1), radius: 0.02), velocity: (-3.0, 0.0)";
    for formulation in ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()", "Rigid()"] {
        assert_eq!(told(&format!("{near}, formulation: {formulation}"), plane), 1, "{formulation}");
    }
    // It comes near the plane only; what stands for its image holds it; it is on a side where no body ends; a
    // tool is driven along the axis.
    let free = "formulation: Eulerian()";
    assert_eq!(
        told(&format!("Sphere(center: (0.09, 0.1), radius: 0.02), velocity: (-3.0, 0.0), {free}"), plane),
        0
    );
    let held = r#"Sphere(center: (0.04, 0.1), radius: 0.02), velocity: (-3.0, 0.0), formulation: Eulerian()),
        (name: "mirror", material: "rubber", shape: HalfSpace(point: (0, 0), normal: (1, 0)), spacing: 0.01, formulation: Rigid()"#;
    let holds = r#"conditions: [Symmetry(plane: X, at: 0), Fix(on: Select(body: "mirror"))], contacts: [(between: ("ball", "mirror"))],"#;
    assert_eq!(told(held, holds), 0);
    assert_eq!(
        told(&format!("Sphere(center: (-0.04, 0.1), radius: 0.02), velocity: (3.0, 0.0), {free}"), plane),
        0
    );
    let driven = r#"conditions: [Symmetry(plane: X, at: 0), Velocity(on: Select(body: "ball"), value: (-3.0, None))],"#;
    assert_eq!(told("Sphere(center: (0.04, 0.1), radius: 0.02), formulation: Rigid()", driven), 0);
}

#[test]
fn hourglass_energy_of_a_body_that_no_wave_has_reached_is_not_judged() {
    let scene = |hourglass: f64, strain: f64| {
        let book = |account: &str, energy: f64| format!("Book(account: {account:?}, energy: {energy:?})");
        format!(
            "conditions: [InitialDisplacement(on: Select(body: \"left\"), value: (\"0.01*x\", 0.0)), {}, {}], record: (every: 0.001), time: (end: 0.01),",
            book("hourglass", hourglass),
            book("plastic_work", strain)
        )
    };
    let is_warned = |hourglass: f64, strain: f64| {
        let mut sim = blocks_under(0.0, &scene(hourglass, strain));
        sim.run(|_| true).unwrap();
        sim.warnings().iter().any(|text| text.contains("hourglass energy of body `right`"))
    };
    // The left block holds some E e^2 / 2 of its 6 cm2, 3e-3 J, the right one at the end a hundredth of what
    // is booked.
    assert!(!is_warned(1.0e-6, 1.0e-6));
    assert!(is_warned(1.0e-3, 1.0e-3));
}

#[test]
fn viscous_hourglass_control_that_takes_a_fifth_of_the_internal_energy_is_told() {
    let is_warned = |share: f64| {
        let book = |account: &str, energy: f64| format!("Book(account: {account:?}, energy: {energy:?})");
        let mut sim = blocks_under(
            0.0,
            &format!(
                "conditions: [{}, {}], time: (end: 0.01),",
                book("plastic_work", 1.0e-3),
                book("hourglass_viscosity", share * 1.0e-3)
            ),
        );
        sim.run(|_| true).unwrap();
        let mut told = sim.warnings().iter();
        told.any(|text| text.contains("viscous part of the hourglass control of body `right`"))
    };
    assert!(!is_warned(0.15));
    assert!(is_warned(0.25));
}

#[test]
fn a_flow_under_tension_is_told_what_it_lacks() {
    let advice = |plugins: &str, pressure: f64| {
        let mut sim = simulation(format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.2, 0.2)), spacing: 0.02,
                     formulation: Fluid(pressure: {pressure:?}) {plugins}),
                    (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(suction: true),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (0.26, 0.26)), Box(min: (0, 0), max: (0.2, 0.2)))),
                ],
                conditions: [Book(account: "wall_pressure", energy: -100.0, dissipated: true)],
                time: (end: 0.01))"#
        ));
        sim.run(|_| true).unwrap();
        sim.warnings().iter().find(|text| text.contains("has produced energy")).expect("a warning").clone()
    };
    let tension = advice("", -100.0);
    assert!(
        tension.contains("`tensile_control()`") && tension.contains("`Fluid(pressure: ...)`"),
        "{tension}"
    );
    let pressed = advice("", 100.0);
    assert!(
        !pressed.contains("tensile") && pressed.contains("`density_diffusion()` for its noise"),
        "{pressed}"
    );
}
