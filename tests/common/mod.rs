//! What several tests share.
#![allow(dead_code, reason = "every test uses a part")]

pub mod coupled;
pub mod eulerian;
pub mod thin;
pub mod touching;
pub mod wearing;

use meshless::glam::DVec3;
use meshless::scene::{Source, parse};
use meshless::simulation::Simulation;
use meshless::world::{BodyId, Mass, Velocity};
use meshless::{assembly, standard_plugins};

/// Two bodies in two or three dimensions, one irregular, loaded and damped, with every stabilizer of
/// solids, and a rigid ball that is thrown onto one of them.
pub fn all_plugins(dimension: usize) -> Source {
    let (name, shapes, load, ball) = if dimension == 2 {
        (
            "Two",
            ["Box(min: (0, 0), max: (1.0, 0.4))", "Box(min: (2, 0), max: (3.0, 0.4))"],
            r#"("0.2*t", "-0.01*x")"#,
            "(center: (0.5, 0.52), radius: 0.11)",
        )
    } else {
        (
            "Three",
            ["Box(min: (0, 0, 0), max: (1.0, 0.4, 0.4))", "Box(min: (2, 0, 0), max: (3.0, 0.4, 0.4))"],
            r#"("0.2*t", "-0.01*x", "0.02")"#,
            "(center: (0.5, 0.52, 0.2), radius: 0.11)",
        )
    };
    let spacing = if dimension == 2 { 0.02 } else { 0.05 };
    let [first, second] = shapes;
    let text = format!(
        r#"(dimension: {name}, gravity: (0.01, -0.02),
            materials: {{"soft": NeoHookean(density: 1, young: 1, poisson: 0.3),
                         "hard": StVenantKirchhoff(density: 2, young: 3, poisson: 0.2)}},
            bodies: [
                (name: "a", material: "soft", shape: {first}, spacing: {spacing:?}, lattice: Relaxed(seed: 5, iterations: 2),
                 formulation: TotalLagrangian, plugins: [hourglass_control()]),
                (name: "b", material: "hard", shape: {second}, spacing: {spacing:?}, formulation: TotalLagrangian,
                 plugins: [hourglass_control(form: Ganzenmueller2015)]),
                (name: "c", material: "hard", shape: Sphere{ball}, spacing: {spacing:?}, velocity: (0.3, -0.5),
                 formulation: Rigid(spin: (0, 0, 1))),
            ],
            contacts: [
                Contact(between: ("a", "c"), law: Penalty(), friction: 0.4, restitution: 0.5),
                Contact(between: ("b", "a"), law: Hertz()),
                Contact(between: ("b", "b"), law: Penalty()),
            ],
            conditions: [
                Fix(on: Select(body: "a", face: MinX)),
                Traction(on: Select(body: "a", face: MaxX), value: {load}),
                InitialVelocity(on: Select(body: "b"), value: ("0.1*sin(9*y)", "0.1*x")),
            ],
            plugins: [artificial_viscosity(), local_damping(rate: 0.1)],
            time: (end: 10.0))"#
    );
    Source::new("determinism.ron", text)
}

/// A body that swings and leaves its domain bit by bit.
pub fn removal() -> Source {
    let text = r#"(dimension: Two, gravity: (0.1, -0.2), domain: (min: (-1, -1), max: (1.05, 1), outside: Remove),
        materials: {"soft": NeoHookean(density: 1, young: 1, poisson: 0.3)},
        bodies: [(name: "a", material: "soft", shape: Box(min: (0, 0), max: (1.0, 0.4)), spacing: 0.04,
                  formulation: TotalLagrangian, plugins: [hourglass_control()])],
        conditions: [InitialVelocity(on: Select(body: "a"), value: ("0.5 + 0.3*x - 0.2*y", "0.2*x"))],
        plugins: [artificial_viscosity(), local_damping(rate: 0.1)],
        time: (end: 10.0))"#;
    Source::new("removal.ron", text)
}

/// A breaking dam between walls that move, with drops that leave the domain; in two dimensions with a rubber
/// plate in its way.
pub fn flow(dimension: usize) -> Source {
    let (name, water, outer, inner, spacing) = if dimension == 2 {
        ("Two", "(0, 0), max: (0.4, 0.4)", "(-0.1, -0.1), max: (0.7, 0.5)", "(0, 0), max: (0.6, 1)", 0.02)
    } else {
        (
            "Three",
            "(0, 0, 0), max: (0.4, 0.5, 0.3)",
            "(-0.15, -0.15, -0.15), max: (0.65, 0.4, 0.45)",
            "(0, 0, 0), max: (0.5, 1, 0.3)",
            0.05,
        )
    };
    let (plate, clamp) = if dimension == 2 {
        (
            r#"(name: "plate", material: "rubber", shape: Box(min: (0.5, 0.0), max: (0.56, 0.2)), spacing: 0.02,
                formulation: TotalLagrangian, plugins: [hourglass_control()]),"#,
            r#"Fix(on: Select(body: "plate", face: MinY)),"#,
        )
    } else {
        ("", "")
    };
    let text = format!(
        r#"(dimension: {name}, gravity: (0.0, -9.81), domain: (min: (-0.2, -0.2, -0.2), max: (0.72, 0.55, 0.6), outside: Remove),
            materials: {{"water": Fluid(density: 1000.0, viscosity: 0.5, eos: Tait(gamma: 7.0)),
                         "rubber": NeoHookean(density: 1100, young: 1e5, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: {water}), spacing: {spacing:?}, formulation: Fluid,
                 velocity: (1.0, 1.0), plugins: [density_diffusion(), particle_shifting()]),
                {plate}
                (name: "tank", material: "wall", shape: Difference(Box(min: {outer}), Box(min: {inner})),
                 spacing: {spacing:?}, formulation: Wall(slip: No)),
            ],
            conditions: [{clamp} Velocity(on: Select(body: "tank"), value: ("0.2*sin(20*t)", None)),
                RelaxationZone(min: (-0.1, 0, 0), max: (0.2, 0.3, 0.3), along: (-1, 0, 0), value: ("0.2*sin(20*t)", None), rate: 5)],
            plugins: [artificial_viscosity(alpha: 0.02, beta: 0.0)],
            time: (end: 10.0))"#
    );
    Source::new("flow.ron", text)
}

/// A flow whose sums over neighbours are in double precision.
pub fn double(source: &Source) -> Source {
    Source::new("double.ron", source.text.replacen("(dimension", "(precision: Double, dimension", 1))
}

/// Metals that hit a wall: every law with state, every form of the hourglass control, an equation of state
/// with energy.
pub fn metals() -> Source {
    let body = |name: &str, at: f64, control: &str| {
        format!(
            r#"(name: "{name}", material: "{name}", shape: Box(min: (0, {at}, 0), max: (6e-3, {}, 3e-3)), spacing: 5e-4,
                formulation: TotalLagrangian, velocity: (-300, 20, 0), plugins: [hourglass_control({control})])"#,
            at + 3e-3
        )
    };
    let bodies = [
        body("hot", 0.0, ""),
        body("soft", 1e-2, "form: Combined"),
        body("turned", 2e-2, "form: Ganzenmueller2015"),
        body("rubber", 3e-2, ""),
    ];
    let text = format!(
        r#"(dimension: Three,
            materials: {{
                "hot": Al6061T6(eos: MieGrueneisen(slope: 1.34, gamma: 2.0)),
                "soft": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Voce(yield_stress: 1e8, saturation: 1e8, rate: 9),
                           eos: Polynomial(c2: 1e11, c3: 1e11)),
                "turned": Hypoelastic(density: 2700, young: 70e9, poisson: 0.3, heating: (specific_heat: 885),
                                      hardening: Power(yield_stress: 1e8, coefficient: 2e8, exponent: 0.4)),
                "rubber": Rubber,
            }},
            bodies: [{}],
            conditions: [Symmetry(plane: X, at: 0, side: Above)],
            plugins: [artificial_viscosity()],
            time: (end: 1e-3))"#,
        bodies.join(",\n")
    );
    Source::new("metals.ron", text)
}

/// Strips that break, each in another way, and go on.
pub fn failing() -> Source {
    let strip = |name: &str, at: f64, plugins: &str| {
        format!(
            r#"(name: "{name}", material: "brittle", shape: Box(min: (0, {at:?}), max: (1.0, {:?})), spacing: 0.04,
                formulation: TotalLagrangian, plugins: [hourglass_control(), {plugins}])"#,
            at + 0.4
        )
    };
    let strips = [
        strip(
            "rubble",
            0.0,
            "failure(criterion: MaximumPrincipalStrain(limit: 0.05), growth: CrackSpeed(factor: 0.1))",
        ),
        strip("liquid", 1.0, "failure(criterion: MaximumPrincipalStress(limit: 0.05), then: NoDeviator)"),
        strip(
            "gone",
            2.0,
            "failure(criterion: MaximumPrincipalStrain(limit: 0.05), growth: CrackSpeed(), then: Removed),
             remove_fragments(particles: 12, minimum_volume_ratio: 0.8)",
        ),
    ];
    let text = format!(
        r#"(dimension: Two, materials: {{"brittle": NeoHookean(density: 1, young: 1, poisson: 0.3)}}, bodies: [{}],
            conditions: [InitialVelocity(on: Select(), value: ("0.3*(x - 0.5)*(1 + x)", "0.05*sin(9*x)"))], time: (end: 10.0))"#,
        strips.join(", ")
    );
    Source::new("failing.ron", text)
}

/// Half of two blocks, of metal and of rubber, that crash into each other and rub.
pub fn crash() -> Source {
    let text = r#"(dimension: Two,
        materials: {"metal": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Linear(yield_stress: 2e8, modulus: 5e8)),
                    "rubber": NeoHookean(density: 2000, young: 20e9, poisson: 0.3)},
        bodies: [
            (name: "metal", material: "metal", shape: Box(min: (0, 0), max: (0.02, 0.01)), spacing: 1e-3, formulation: TotalLagrangian,
             plugins: [hourglass_control()]),
            (name: "rubber", material: "rubber", shape: Box(min: (0, 0.0102), max: (0.0153, 0.0202)), spacing: 1e-3,
             formulation: TotalLagrangian, velocity: (0, -400), plugins: [hourglass_control()]),
        ],
        contacts: [Contact(between: ("metal", "rubber"), law: Penalty(), friction: 0.3, restitution: 0.6)],
        conditions: [
            InitialVelocity(on: Select(body: "rubber"), value: ("5000*x", "-400")),
            Symmetry(plane: X, at: 0.0, side: Above),
        ],
        time: (end: 10.0))"#;
    Source::new("crash.ron", text.to_owned())
}

/// Strips of metal that flow and break, each by another law and in another way, and touch each other.
pub fn failing_metals() -> Source {
    let strip = |name: &str, at: f64, control: &str, failure: &str| {
        format!(
            r#"(name: "{name}", material: "{name}", spacing: 1e-3, formulation: TotalLagrangian(support: 2.6),
                plugins: [hourglass_control({control}), failure({failure})],
                shape: Difference(Box(min: (0, {at:?}), max: (0.03, {:?})), Box(min: (0.014, {:?}), max: (0.016, {:?}))))"#,
            at + 0.008,
            at + 0.006,
            at + 0.009
        )
    };
    let fracture = "criterion: JohnsonCook(d1: 0.01, d2: 0.05, d3: -1.5)";
    let strips = [
        strip("flowing", 0.0, "", &format!("{fracture}, growth: CrackSpeed(), then: Removed")),
        strip("hot", 0.0081, "form: Combined", &format!("{fracture}, then: NoDeviator")),
        strip(
            "turned",
            0.0162,
            "form: Ganzenmueller2015",
            &format!("{fracture}, growth: CrackSpeed(factor: 0.2), then: NoTension"),
        ),
        strip(
            "gone",
            0.0243,
            "after_yield: Young",
            "criterion: MaximumPrincipalStress(limit: 3e8), then: Removed",
        ),
    ];
    let contacts = ["flowing\", \"hot", "hot\", \"turned", "turned\", \"gone"].map(|pair| {
        format!("Contact(between: (\"{pair}\"), law: Penalty(), friction: 0.2, restitution: 0.6)")
    });
    let text = format!(
        r#"(dimension: Two,
            materials: {{
                "flowing": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Linear(yield_stress: 2e8, modulus: 5e8)),
                "hot": Al6061T6(eos: MieGrueneisen(slope: 1.34, gamma: 2.0)),
                "turned": Hypoelastic(density: 2700, young: 70e9, poisson: 0.3, heating: (specific_heat: 885),
                                      hardening: Power(yield_stress: 1e8, coefficient: 2e8, exponent: 0.4)),
                "gone": J2(density: 2700, young: 70e9, poisson: 0.3, hardening: Perfect(yield_stress: 2e8)),
            }},
            bodies: [{}], contacts: [{}],
            conditions: [InitialVelocity(on: Select(), value: ("6000*(x - 0.015)", "0.2*sin(300*x)"))],
            time: (end: 10.0))"#,
        strips.join(", "),
        contacts.join(", ")
    );
    Source::new("failing_metals.ron", text)
}

/// The simulation of a scene with the standard plugins.
pub fn simulation(source: &Source) -> Simulation {
    let (scene, source) = parse(source.clone()).unwrap_or_else(|error| panic!("{error}"));
    assembly::build(&scene, &source, &standard_plugins()).unwrap_or_else(|error| panic!("{error}"))
}

/// Momentum of all particles, and the sum of its sizes, kg m/s.
pub fn momentum(sim: &Simulation) -> (DVec3, f64) {
    let mut sums = (DVec3::ZERO, 0.0);
    for body in 0..sim.world().bodies().len() {
        let (view, rows) = sim.world().body_view(BodyId(body));
        let (mass, velocity) =
            (view.read::<Mass>().expect("masses"), view.read::<Velocity>().expect("velocities"));
        for p in rows.map(|row| mass[row].0 * velocity[row].0) {
            sums = (sums.0 + p, sums.1 + p.length());
        }
    }
    sums
}

/// The scene with another formulation in the place of the total-Lagrangian one.
pub fn with_formulation(formulation: &str, source: &Source) -> Source {
    assert!(source.text.contains("formulation: TotalLagrangian"), "{}", source.name);
    let usual = source.text.replace("TotalLagrangian(support: 2.6)", "TotalLagrangian");
    let text = usual.replace("formulation: TotalLagrangian", &format!("formulation: {formulation}"));
    Source::new(source.name.clone(), text)
}

/// The scene with Eulerian bodies in the place of the total-Lagrangian ones.
pub fn eulerian(source: &Source) -> Source {
    let Source { name, text, .. } = with_formulation("Eulerian()", source);
    Source::new(name, text.replace("form: Ganzenmueller2015", "form: Stiffness"))
}

/// The scene with every spacing divided by the smallest whole number that gives it more than 4096 particles:
/// several tasks of 1 024 rows, so that loops over rows are really divided between threads.
pub fn of_many_tasks(source: &Source) -> Source {
    let finer = (1..).map(|factor| refined(source, f64::from(factor)));
    let large = |source: &Source| simulation(source).world().len() > 4096;
    finer.into_iter().find(large).expect("a body of many tasks")
}

/// The scene with every spacing divided by `factor`.
fn refined(source: &Source, factor: f64) -> Source {
    let mut parts = source.text.split("spacing: ");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end =
            part.find(|c: char| !matches!(c, '0'..='9' | '.' | 'e' | '-')).expect("something after a number");
        let spacing: f64 = part[..end].parse().expect("a number");
        text += &format!("spacing: {:?}{}", spacing / factor, &part[end..]);
    }
    Source::new("refined.ron", text)
}
