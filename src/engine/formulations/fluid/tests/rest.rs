//! Fluids that start at rest, below surfaces of every kind.

use super::{column, simulation};
use crate::simulation::Simulation;
use crate::world::{Position, Pressure, Velocity};

const SPACING: f64 = 0.02;

fn water(shape: &str, more: &str) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 30.0), "oil": Fluid(density: 800.0, sound_speed: 30.0)}},
            bodies: [
                (name: "water", material: "water", shape: {shape}, spacing: {SPACING}, formulation: Fluid),
                (name: "tank", material: "wall", spacing: {SPACING}, formulation: Wall(),
                 shape: Difference(Box(min: (-0.06, -0.06), max: (0.86, 0.6)), Box(min: (0, 0), max: (0.8, 1)))),
                {more}
            ],
            time: (end: 1.0))"#
    ))
}

/// Largest difference from the pressure below a surface of that height, Pa.
fn error(sim: &Simulation, body: usize, wanted: impl Fn(f64, f64) -> f64) -> f64 {
    let (x, p) = (column::<Position>(sim, body), column::<Pressure>(sim, body));
    let differ = |(x, p): (&Position, &Pressure)| (p.0 - wanted(x.0.x, x.0.y)).abs();
    x.iter().zip(&p).map(differ).fold(0.0, f64::max)
}

#[test]
fn a_tilted_surface_has_its_own_pressure_below() {
    let sim = water("Polygon(points: [(0, 0), (0.8, 0), (0.8, 0.2), (0.4, 0.34), (0, 0.3)])", "");
    let surface = |x: f64| if x < 0.4 { 0.3 + 0.1 * x } else { 0.34 - 0.35 * (x - 0.4) };
    let error = error(&sim, 0, |x, y| 9810.0 * (surface(x) - y));
    assert!(error < 1e-3 * 9810.0 * SPACING, "{error}");
}

#[test]
fn water_below_a_roof_has_the_pressure_of_the_water_beside_it() {
    let channel = "Union([Box(min: (0, 0), max: (0.8, 0.1)), Box(min: (0, 0.1), max: (0.2, 0.4))])";
    let roof = format!(
        r#"(name: "roof", material: "wall", shape: Box(min: (0.2, 0.1), max: (0.8, 0.4)), spacing: {SPACING}, formulation: Wall()),"#
    );
    let sim = water(channel, &roof);
    let error = error(&sim, 0, |_, y| 9810.0 * (0.4 - y));
    assert!(error < 1e-3 * 9810.0 * SPACING, "{error}");
}

/// A tube full of water that leads over a wall, its top 0.2 m above the levels on both sides, hangs in it
/// where boundaries have suction, and starts without pressure where they have none.
#[test]
fn water_in_a_siphon_is_in_tension() {
    let siphon = |suction: bool| {
        let sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0.0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 30.0)}},
                bodies: [
                    (name: "water", material: "water", spacing: {SPACING}, formulation: Fluid,
                     shape: Union([Box(min: (0, 0), max: (0.4, 0.2)), Box(min: (0.2, 0.2), max: (0.4, 0.4)), Box(min: (0.4, 0.3), max: (0.6, 0.4)),
                                   Box(min: (0.6, 0.2), max: (0.8, 0.4)), Box(min: (0.6, 0), max: (1, 0.2))])),
                    (name: "tanks", material: "wall", spacing: {SPACING}, formulation: Wall(suction: {suction}),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (1.06, 0.46)),
                         Union([Box(min: (0, 0), max: (0.4, 0.2)), Box(min: (0.2, 0.2), max: (0.4, 0.4)), Box(min: (0.4, 0.3), max: (0.6, 0.4)),
                                Box(min: (0.6, 0.2), max: (0.8, 0.4)), Box(min: (0.6, 0), max: (1, 0.2)),
                                Box(min: (0, 0.2), max: (0.14, 1)), Box(min: (0.86, 0.2), max: (1, 1))]))),
                ],
                time: (end: 1.0))"#
        ));
        let least = if suction { f64::NEG_INFINITY } else { 0.0 };
        error(&sim, 0, |_, y| (9810.0 * (0.2 - y)).max(least))
    };
    for suction in [true, false] {
        let error = siphon(suction);
        assert!(error < 1e-3 * 9810.0 * SPACING, "{suction}: {error}");
    }
}

#[test]
fn oil_on_part_of_the_water_presses_on_that_part() {
    let oil = format!(
        r#"(name: "oil", material: "oil", shape: Box(min: (0.4, 0.2), max: (0.8, 0.3)), spacing: {SPACING}, formulation: Fluid),"#
    );
    let sim = water("Box(min: (0, 0), max: (0.8, 0.2))", &oil);
    let of_oil = |x: f64| if x < 0.4 { 0.0 } else { 800.0 * 9.81 * 0.1 };
    let in_water = error(&sim, 0, |x, y| 9810.0 * (0.2 - y) + of_oil(x));
    let in_oil = error(&sim, 2, |_, y| 800.0 * 9.81 * (0.3 - y));
    assert!(in_water.max(in_oil) < 1e-3 * 9810.0 * SPACING, "{in_water} {in_oil}");
}

#[test]
fn water_below_air_stays_at_rest() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (0, -1), max: (0.16, 1), periodic: [X]),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 30.0), "air": Fluid(density: 1.2, sound_speed: 30.0)},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.16, 0.2)), spacing: 0.02, formulation: Fluid),
                (name: "air", material: "air", shape: Box(min: (0, 0.2), max: (0.16, 0.4)), spacing: 0.02, formulation: Fluid),
                (name: "floor", material: "wall", shape: Box(min: (0, -0.08), max: (0.16, 0)), spacing: 0.02, formulation: Wall()),
                (name: "roof", material: "wall", shape: Box(min: (0, 0.4), max: (0.16, 0.48)), spacing: 0.02, formulation: Wall()),
            ],
            time: (end: 0.01))"#,
    );
    sim.run(|_| true).expect("a run");
    for body in 0..2 {
        let fastest = column::<Velocity>(&sim, body).iter().map(|v| v.0.length()).fold(0.0, f64::max);
        // A hundredth of the speed of sound: what the light fluid exceeded within 0.6 ms, at the step of each
        // fluid for itself.
        assert!(fastest < 0.3, "{body}: {fastest}");
    }
}

#[test]
fn what_falls_freely_has_no_pressure() {
    let drop = |bottom: f64| {
        format!(
            r#"(name: "drop", material: "oil", shape: Sphere(center: (0.4, {}), radius: 0.1), spacing: {SPACING}, formulation: Fluid),"#,
            bottom + 0.1
        )
    };
    let pool = "Box(min: (0, 0), max: (0.8, 0.1))";
    let mut sim = water(pool, &drop(0.3));
    let falls = |sim: &Simulation| column::<Pressure>(sim, 2).iter().map(|p| p.0.abs()).fold(0.0, f64::max);
    assert_eq!(falls(&sim), 0.0);
    assert!(error(&sim, 0, |_, y| 9810.0 * (0.1 - y)) < 1e-3 * 9810.0 * SPACING);
    for _ in 0..20 {
        sim.step().expect("a step");
    }
    assert!(falls(&sim) < 1e-6 * 9810.0, "{}", falls(&sim));
    // Oil that rests on the water has the pressure of its weight.
    assert!(falls(&water(pool, &drop(0.1))) > 0.5 * 800.0 * 9.81 * 0.2);
}

#[test]
fn gravity_along_an_endless_fluid_causes_no_pressure() {
    let film = |gravity: &str, floor: &str| {
        simulation(&format!(
            r#"(dimension: Two, gravity: {gravity}, domain: (min: (0, -0.1), max: (0.4, 0.3), periodic: [X]),
                materials: {{"oil": Fluid(density: 900.0, viscosity: 1.0, sound_speed: 30.0)}},
                bodies: [
                    (name: "oil", material: "oil", spacing: {SPACING}, formulation: Fluid,
                     shape: Difference(Box(min: (0, 0), max: (0.4, 0.2)), Box(min: (0.14, -1), max: (0.2, {floor})))),
                    (name: "bed", material: "wall", spacing: {SPACING}, formulation: Wall(slip: No),
                     shape: Union([Box(min: (0, -0.06), max: (0.4, 0)), Box(min: (0.14, -0.06), max: (0.2, {floor}))])),
                ],
                time: (end: 1.0))"#
        ))
    };
    let close = 1e-3 * 8829.0 * SPACING;
    // A film on a slope of 30 degrees, also above a step on it, has the pressure of the part of its weight
    // across the slope.
    let across = 900.0 * 8.496;
    let slope = error(&film("(4.905, -8.496)", "0.1"), 0, |_, y| across * (0.2 - y));
    assert!(slope < close, "{slope}");
    // A liquid that falls between two walls has none.
    let falling = error(&film("(9.81, 0.0)", "0.1"), 0, |_, _| 0.0);
    assert!(falling == 0.0, "{falling}");
    // A wall across the period carries it: a column of 0.34 m above it, whose top is at the other side of it.
    let column = error(&film("(-9.81, 0.0)", "0.2"), 0, |x, _| {
        let above = if x > 0.17 { x - 0.2 } else { x + 0.2 };
        8829.0 * (0.34 - above)
    });
    assert!(column < close, "{column}");
}

#[test]
fn liquids_that_fill_a_closed_tank_have_one_pressure_at_their_interface() {
    let both = simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 30.0), "oil": Fluid(density: 800.0, sound_speed: 30.0)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.3, 0.2)), spacing: {SPACING}, formulation: Fluid),
                (name: "oil", material: "oil", shape: Box(min: (0, 0.2), max: (0.3, 0.4)), spacing: {SPACING}, formulation: Fluid),
                (name: "tank", material: "wall", spacing: {SPACING}, formulation: Wall(suction: true),
                 shape: Difference(Box(min: (-0.06, -0.06), max: (0.36, 0.46)), Box(min: (0, 0), max: (0.3, 0.4)))),
            ],
            time: (end: 1.0))"#
    ));
    let of_oil = |y: f64| 800.0 * 9.81 * (0.4 - y);
    let in_oil = error(&both, 1, |_, y| of_oil(y));
    let in_water = error(&both, 0, |_, y| of_oil(0.2) + 9810.0 * (0.2 - y));
    assert!(in_water.max(in_oil) < 1e-3 * 9810.0 * SPACING, "{in_water} {in_oil}");
}

/// A box that floats and one that stands on the floor, across the side of a periodic channel: the pressure
/// below and beside them is that of water that covers the floor without them.
#[test]
fn bodies_across_a_side_of_the_domain_cover_the_water_below() {
    for center in [0.0, 0.4, 0.8] {
        let images = |x: f64, low: f64, high: f64| {
            let at = |x: f64| format!("Box(min: ({}, {low}), max: ({}, {high}))", x - 0.1, x + 0.1);
            format!("{}, {}, {}", at(x), at(x - 0.8), at(x + 0.8))
        };
        let body = |name: &str, low: f64, high: f64| {
            format!(
                r#"(name: "{name}", material: "wood", spacing: {SPACING}, formulation: Rigid(),
                    shape: Box(min: ({}, {low}), max: ({}, {high})))"#,
                center - 0.1,
                center + 0.1
            )
        };
        let sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (0, -1), max: (0.8, 1), periodic: [X]),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 30.0), "wood": NeoHookean(density: 500.0, young: 1.0e7, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: {SPACING}, formulation: Fluid,
                     shape: Difference(Box(min: (0, 0), max: (0.8, 0.4)), Union([{}, {}]))),
                    (name: "floor", material: "wall", spacing: {SPACING}, formulation: Wall(), shape: Box(min: (0, -0.06), max: (0.8, 0))),
                    {}, {}
                ], time: (end: 1.0))"#,
            images(center, 0.3, 0.5),
            images(center, 0.0, 0.1),
            body("float", 0.3, 0.5),
            body("block", 0.0, 0.1)
        ));
        let error = error(&sim, 0, |_, y| 9810.0 * (0.4 - y));
        assert!(error < 1e-3 * 9810.0 * SPACING, "{center}: {error}");
    }
}

/// Oil, 24 deep, that hums in an open tank: its friction exceeds its kinetic energy, but nothing flows.
#[test]
fn friction_of_a_liquid_at_rest_is_not_warned_of() {
    let spacing = 0.4 / 24.0;
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -9.81), materials: {{"oil": Fluid(density: 1000.0, sound_speed: 30.0, viscosity: 0.5)}},
            bodies: [
                (name: "oil", material: "oil", shape: Box(min: (0, 0), max: (0.4, 0.4)), spacing: {spacing}, formulation: Fluid),
                (name: "tank", material: "wall", spacing: {spacing}, formulation: Wall(slip: No),
                 shape: Difference(Box(min: ("-4*{spacing}", "-4*{spacing}"), max: ("0.4 + 4*{spacing}", 0.6)), Box(min: (0, 0), max: (0.4, 9)))),
            ],
            time: (end: 0.5))"#
    ));
    sim.run(|_| true).expect("a run");
    let friction = sim.ledger().total_named("viscosity");
    assert!(friction > sim.ledger().motion(), "{friction}");
    let told: Vec<_> =
        sim.warnings().iter().filter(|warning| warning.contains("particles of `oil`")).collect();
    assert!(told.is_empty(), "{told:?}");
}

/// A container that nothing carries falls with its water; one that stands on something, also by way of a
/// block, and one that a condition holds or loads along gravity, does not.
#[test]
fn water_in_a_container_that_falls_has_no_pressure() {
    let start = |more: &str, conditions: &str| {
        let sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0.0, -9.81),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 30.0), "wood": NeoHookean(density: 500.0, young: 1e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: {SPACING}, formulation: Fluid),
                    (name: "flask", material: "wood", spacing: {SPACING}, formulation: Rigid(),
                     shape: Difference(Box(min: (-0.08, -0.08), max: (0.48, 0.3)), Box(min: (0, 0), max: (0.4, 1)))),
                    {more}
                ],
                conditions: [{conditions}],
                time: (end: 1.0))"#
        ));
        let is_told = sim.warnings().iter().any(|text| text.contains("nothing carries `flask`"));
        (column::<Pressure>(&sim, 0).iter().map(|p| p.0).fold(0.0, f64::max), is_told)
    };
    let floor = |y: f64| {
        format!(
            r#"(name: "floor", material: "wall", shape: Box(min: (-1, {}), max: (1, {y})), spacing: {SPACING}, formulation: Wall()),"#,
            y - 0.06
        )
    };
    let block = r#"(name: "block", material: "wood", shape: Box(min: (0, -0.2), max: (0.2, -0.08)), spacing: 0.02, formulation: TotalLagrangian()),"#;
    let on = r#"on: Select(body: "flask")"#;
    let falls = [
        start("", ""),
        start(&floor(-0.2), ""),
        start(block, ""),
        start("", &format!("Fix({on}, axes: [X])")),
        start("", &format!("RotationRate({on}, rate: 1.0)")),
    ];
    assert_eq!(falls, [true, false, true, true, true].map(|is_told| (0.0, is_told)));
    let rests = [
        start(&floor(-0.08), ""),
        start(&format!("{}{block}", floor(-0.2)), ""),
        start("", &format!("Fix({on}, axes: [Y])")),
        start("", &format!("Force({on}, value: (0.0, 1.1e3))")),
    ];
    let at_rest = |p: f64| (p - 9810.0 * 0.19).abs() < 1e-3 * 1962.0;
    assert!(rests.iter().all(|(p, is_told)| at_rest(*p) && !is_told), "{rests:?}");
}
