//! Shapes and prescribed motion of rigid bodies.

use crate::assembly::build;
use crate::plugin::Registry;
use crate::rigid::RigidBodies;
use crate::scene::{SceneError, Source, parse};
use crate::simulation::Simulation;

/// A tee of two boxes that touch, over a strip.
fn tee(contacts: &str) -> Result<Simulation, SceneError> {
    let text = format!(
        r#"(dimension: Two, gravity: (0.0, -10.0), materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
            bodies: [
                (name: "tee", material: "wood", shape: Union([Box(min: (-0.1, 0.1), max: (0.1, 0.14)), Box(min: (-0.02, 0.0), max: (0.02, 0.1))]), spacing: 0.01, formulation: Rigid()),
                (name: "strip", material: "wood", shape: Box(min: (-0.2, -0.3), max: (0.2, -0.25)), spacing: 0.01, formulation: TotalLagrangian),
            ],
            {contacts} time: (end: 0.1))"#
    );
    let (scene, source) = parse(Source::new("tee.ron", text))?;
    build(&scene, &source, &Registry::standard())
}

#[test]
fn a_rigid_body_that_touches_nothing_may_have_any_shape() {
    let mut sim = tee("").unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    let bodies = sim.resources().get::<RigidBodies>();
    let tee = bodies.iter().next().expect("a body");
    // 80 cm2 about 0.12 m and 40 cm2 about 0.05 m, after a fall of g t^2 / 2.
    let height = (80.0 * 0.12 + 40.0 * 0.05) / 120.0 - 0.05;
    assert!((tee.state.center.y - height).abs() < 1e-4, "{}", tee.state.center);
    assert!((tee.mass - 500.0 * 0.012).abs() < 1e-9, "{}", tee.mass);
}

#[test]
fn a_rigid_body_that_touches_needs_a_surface_such_as_a_polygon() {
    let error = tee(r#"contacts: [(between: ("tee", "strip"))],"#).err().expect("an error").to_string();
    assert!(
        error.contains("the parts of the union touch each other") && error.contains("`Polygon`"),
        "{error}"
    );
}

/// A plate, and a second one beside it, with these conditions.
fn plates(conditions: &str) -> Result<Simulation, SceneError> {
    let text = format!(
        r#"(dimension: Two, materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
            bodies: [
                (name: "left", material: "wood", shape: Box(min: (-0.3, 0.0), max: (-0.1, 0.1)), spacing: 0.01, formulation: Rigid()),
                (name: "right", material: "wood", shape: Box(min: (0.1, 0.0), max: (0.3, 0.1)), spacing: 0.01, formulation: Rigid()),
            ],
            conditions: [{conditions}], time: (end: 0.1))"#
    );
    let (scene, source) = parse(Source::new("plates.ron", text))?;
    build(&scene, &source, &Registry::standard())
}

#[test]
fn short_pulses_and_fast_swings_move_rigid_bodies() {
    // Of ten thousandths of the duration; on 20 cm x 10 cm of 500 kg/m3. Then a mean of 5 m/s.
    let jump = |value: &str| format!("{value}*step(t - 0.0503)*step(0.05031 - t)");
    let conditions = [
        format!(r#"Force(on: Select(body: "left"), value: ("{}", None))"#, jump("1e6")),
        format!(r#"BodyForce(on: Select(body: "left"), value: ("{}", None))"#, jump("1e5")),
        format!(r#"Traction(on: Select(body: "left", face: MinX), value: ("{}", None))"#, jump("1e7")),
        format!(r#"Velocity(on: Select(body: "left"), value: ("{}", 0.0))"#, jump("1e3")),
        r#"Velocity(on: Select(body: "left"), value: ("0.2*sin(2e3*pi*t)^2", 0.0))"#.to_owned(),
        r#"Displacement(on: Select(body: "left"), value: ("0.01*sin(2e3*pi*t - pi/2) + 0.01", 0.0))"#
            .to_owned(),
    ];
    for (k, condition) in conditions.iter().enumerate() {
        let mut sim = plates(condition).unwrap_or_else(|error| panic!("{error}"));
        let mut highest = f64::NEG_INFINITY;
        let center = |sim: &Simulation| {
            let bodies = sim.resources().get::<RigidBodies>();
            bodies.iter().next().map(|body| body.state).expect("a body")
        };
        sim.run(|sim| {
            highest = highest.max(center(sim).center.x + 0.2);
            true
        })
        .expect("a run");
        let end = center(&sim);
        let (found, expected) = match k {
            0..=2 => (end.velocity.x, 1.0),
            3 => (end.center.x + 0.2, 0.01),
            4 => (end.center.x + 0.2, 0.01),
            _ => (highest, 0.02),
        };
        assert!((found / expected - 1.0).abs() < 0.005, "{condition}: {found}, expected {expected}");
    }
}

#[test]
fn a_pulse_of_one_load_on_two_bodies_moves_the_one_where_it_is() {
    let pulse = "1e6*step(t - 0.0503)*step(0.05031 - t)";
    for (there, expected) in [("step(-x)", [0.5, 0.0]), ("step(x)", [0.0, 0.5])] {
        let condition = format!(r#"Force(on: Select(), value: ("{pulse}*{there}", None))"#);
        let mut sim = plates(&condition).unwrap_or_else(|error| panic!("{error}"));
        sim.run(|_| true).expect("a run");
        let bodies = sim.resources().get::<RigidBodies>();
        let found: Vec<f64> = bodies.iter().map(|body| body.state.velocity.x).collect();
        // Both of 10 kg share 10 N s by their particles.
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 0.005 * 0.5, "{there}: {found}, expected {expected}");
        }
    }
}

#[test]
fn a_motion_that_differs_within_a_rigid_body_is_an_error() {
    let turns = [
        r#"Displacement(on: Select(body: "left"), value: ("x*(cos(2*t)-1)-y*sin(2*t)", "x*sin(2*t)+y*(cos(2*t)-1)"))"#,
        r#"Velocity(on: Select(body: "left"), value: (None, "2*x*step(t - 0.05)"))"#,
    ];
    for turn in turns {
        let error = plates(turn).err().expect("an error").to_string();
        assert!(error.contains("`left` moves as a whole") && error.contains("`RotationRate`"), "{error}");
    }
}

#[test]
fn an_initial_displacement_of_a_rigid_body_is_an_error() {
    // The first step took its particles back to where its shape is.
    for moves in [r#"("0.1*step(-x)", 0)"#, r#"("-y*step(-x)", "x*step(-x)")"#] {
        let condition = format!("InitialDisplacement(on: Select(), value: {moves})");
        let error = plates(&condition).err().expect("an error").to_string();
        assert!(error.contains("move `left`") && error.contains("`Translate`"), "{error}");
    }
    assert!(plates(r#"InitialDisplacement(on: Select(body: "left"), value: ("1e-15*x", 0))"#).is_ok());
}

#[test]
fn a_motion_may_differ_from_rigid_body_to_rigid_body() {
    let mut sim = plates(r#"Velocity(on: Select(), value: ("-2*sign(x)", 0.0))"#)
        .unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    let bodies = sim.resources().get::<RigidBodies>();
    let places: Vec<f64> = bodies.iter().map(|body| body.state.center.x).collect();
    assert!((places[0] - 0.0).abs() < 1e-12 && (places[1] - 0.0).abs() < 1e-12, "{places:?}");
}

#[test]
fn in_the_plane_two_components_and_the_rotation_are_the_whole_motion() {
    let driven = |condition: &str| {
        let sim = plates(condition).unwrap_or_else(|error| panic!("{error}"));
        sim.resources().get::<RigidBodies>()[0].is_driven()
    };
    assert!(driven(r#"Fix(on: Select(body: "left"))"#));
    assert!(driven(r#"Velocity(on: Select(body: "left"), value: (1.0, 0.0))"#));
    assert!(driven(
        r#"Velocity(on: Select(body: "left"), value: (1.0, 0.0)), RotationRate(on: Select(body: "left"), rate: 2.0)"#
    ));
    assert!(!driven(r#"Velocity(on: Select(body: "left"), value: (1.0, None))"#));
    assert!(!driven(r#"RotationRate(on: Select(body: "left"), rate: 2.0)"#));
    assert!(!driven(r#"Fix(on: Select(body: "right"))"#));
}

#[test]
fn a_body_that_friction_cannot_make_roll_is_warned_of() {
    let warned = |rotation: &str, friction: f64, axes: &str| {
        let text = format!(
            r#"(dimension: Three, gravity: (2, -10, 0), materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "roller", material: "wood", shape: Cylinder(from: (0, 0.1, 0), to: (0, 0.1, 0.2), radius: 0.1), spacing: 0.05, formulation: Rigid({rotation})),
                    (name: "floor", material: "wood", shape: HalfSpace(point: (0, 0, 0), normal: (0, 1, 0)), spacing: 0.05, formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "floor")), Fix(on: Select(body: "roller"), axes: [{axes}])],
                contacts: [(between: ("roller", "floor"), friction: {friction:?})], time: (end: 0.1))"#
        );
        let (scene, source) =
            parse(Source::new("roller.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|error| panic!("{error}"));
        sim.warnings().iter().any(|text| text.contains("`roller` does not turn"))
    };
    assert!(warned("", 0.3, "Z"));
    assert!(!warned("rotation: Free", 0.3, "Z") && !warned("rotation: Held", 0.3, "Z"));
    assert!(!warned("", 0.0, "Z") && !warned("", 0.3, "X, Y, Z"));
}

/// A bar of 0.4 x 0.1 m, 20 kg a metre, that is filled coarsely, with this load; turned by how much after 0.2
/// s, and the balance error over the largest energy.
fn turned(condition: &str) -> (f64, f64) {
    let text = format!(
        r#"(dimension: Two, materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
            bodies: [(name: "bar", material: "wood", shape: Box(min: (0.0, 0.0), max: (0.4, 0.1)), spacing: 0.05, formulation: Rigid())],
            conditions: [{condition}], time: (end: 0.2, step: Fixed(1e-3)))"#
    );
    let (scene, source) = parse(Source::new("bar.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    let bodies = sim.resources().get::<RigidBodies>();
    let angle = 2.0 * bodies[0].state.rotation.z.asin();
    (angle, sim.ledger().relative_error())
}

/// A torque T turns the bar by T t^2 / 2 I, I = m (a^2 + b^2) / 12, as long as the angle is small.
#[test]
fn loads_act_on_the_surface_of_a_rigid_body_however_coarsely_it_is_filled() {
    let inertia = 20.0 * 0.17 / 12.0;
    let angle = |torque: f64| torque * 0.02 / inertia;
    for (condition, torque) in [
        (r#"Force(on: Select(nearest: (0.4, 0.1)), value: (0.0, 0.1))"#, 0.02),
        (r#"Force(on: Select(nearest: (0.4, 0.1)), value: (0.1, 0.0))"#, -0.005),
        (r#"Force(on: Select(nearest: (0.3, 0.05)), value: (0.0, 0.1))"#, 0.01),
        (r#"Force(on: Select(face: MaxX), value: (0.0, 0.1))"#, 0.02),
        (r#"Force(on: Select(), value: (0.0, 0.1))"#, 0.0),
        (r#"Traction(on: Select(face: MaxX), value: (0.0, "1.0 + 0*t"))"#, 0.02),
        (r#"Traction(on: Select(face: MinY), value: (0.25, 0.0))"#, 0.005),
    ] {
        let (found, error) = turned(condition);
        assert!((found - angle(torque)).abs() < 1e-6, "{condition}: {found} instead of {}", angle(torque));
        assert!(error.abs() < 1e-3, "{condition}: {error}");
    }
}

/// A force F that keeps its direction swings a bar about its held centre, as a weight at its end does, and
/// one on a free bar turns it; the kinetic energy is the work of the force, F times the way of its point.
#[test]
fn the_work_of_a_force_is_that_of_the_way_of_its_point_as_the_body_turns() {
    for (rotation, conditions) in [
        ("Free", r#"Fix(on: Select()), Force(on: Select(nearest: (0.4, 0.05)), value: (0.0, -10.0))"#),
        ("About((0, 0, 1))", r#"Fix(on: Select()), Force(on: Select(face: MaxX), value: (0.0, -10.0))"#),
        ("Free", r#"Traction(on: Select(face: MaxX), value: (0.0, -100.0))"#),
        ("Free", r#"BodyForce(on: Select(face: MaxX), value: (0.0, "-2 - 0*t"))"#),
    ] {
        let text = format!(
            r#"(dimension: Two, materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
                bodies: [(name: "bar", material: "wood", shape: Box(min: (0.0, 0.0), max: (0.4, 0.1)), spacing: 0.05, formulation: Rigid(rotation: {rotation}))],
                conditions: [{conditions}], time: (end: 0.9))"#
        );
        let (scene, source) = parse(Source::new("bar.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|error| panic!("{error}"));
        sim.run(|_| true).expect("a run");
        let turned = 2.0 * sim.resources().get::<RigidBodies>()[0].state.rotation.z.asin().abs();
        let error = sim.ledger().relative_error();
        assert!(turned > 0.5 && error.abs() < 5e-4, "{conditions}: turned by {turned}, error {error}");
    }
}

#[test]
fn a_top_without_torque_precesses_as_euler_says() {
    // A disc with a radius of 0.1 m, 0.04 m high: its axis goes round the angular momentum in 2 pi I / L,
    // with the moment of inertia I across the axis.
    let (along, across) = (0.01 / 2.0, (3.0 * 0.01 + 0.0016) / 12.0);
    let momentum = (across * 1.0f64).hypot(along * 10.0);
    let period = 2.0 * std::f64::consts::PI * across / momentum;
    let text = format!(
        r#"(dimension: Three, materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
            bodies: [(name: "top", material: "wood", shape: Cylinder(from: (0, 0, -0.02), to: (0, 0, 0.02), radius: 0.1), spacing: 0.02, formulation: Rigid(spin: (1, 0, 10)))],
            time: (end: {}))"#,
        10.0 * period
    );
    let (scene, source) = parse(Source::new("top.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    // After ten periods the axis is where it began, along z: it goes round a cone of 2 atan(I_across / (10
    // I_along)).
    let bodies = sim.resources().get::<RigidBodies>();
    let axis = bodies.iter().next().expect("a body").state.rotation * glam::DVec3::Z;
    let cone = (across / (10.0 * along)).atan().sin();
    let angle = axis.truncate().length() / cone;
    assert!(angle < 0.01, "{angle} of 62.8 rad");
}

/// The motion of a body after 0.1 s of free fall, m/s and rad/s.
fn fallen(shape: &str, conditions: &str) -> (f64, f64) {
    let text = format!(
        r#"(dimension: Two, gravity: (0.0, -10.0), materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
            bodies: [(name: "b", material: "wood", shape: {shape}, spacing: 0.02, formulation: Rigid)],
            conditions: [{conditions}], time: (end: 0.1))"#
    );
    let (scene, source) = parse(Source::new("fall.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).expect("a run");
    let bodies = sim.resources().get::<RigidBodies>();
    let body = bodies.iter().next().expect("a body");
    (body.state.velocity.y, body.state.angular_velocity.z)
}

#[test]
fn a_body_in_free_fall_does_not_begin_to_turn_however_coarsely_it_is_filled() {
    for shape in [
        "Polygon(points: [(0.0, 0.0), (0.2, 0.0), (0.0, 0.1)])",
        "Polygon(points: [(0.0, 0.0), (0.21, 0.0), (0.21, 0.03), (0.05, 0.03), (0.05, 0.17), (0.0, 0.17)])",
        "Intersection([Sphere(center: (0.0, 0.0), radius: 0.1), Box(min: (0.0, -1.0), max: (1.0, 1.0))])",
    ] {
        let (velocity, spin) = fallen(shape, "");
        assert!((velocity + 1.0).abs() < 1e-9 && spin.abs() < 1e-9, "{shape}: {velocity} {spin}");
    }
}

#[test]
fn initial_velocities_of_a_rotation_give_a_body_the_velocity_of_its_centre() {
    let shape =
        "Intersection([Sphere(center: (0.0, 0.0), radius: 0.1), Box(min: (0.0, -1.0), max: (1.0, 1.0))])";
    let turn = r#"InitialVelocity(on: Select(body: "b"), value: ("-10*y", "10*x"))"#;
    let (velocity, spin) = fallen(shape, turn);
    // The centre of half a disc is 4 r / (3 pi) from its side.
    let expected = 10.0 * 4.0 * 0.1 / (3.0 * std::f64::consts::PI) - 1.0;
    assert!((velocity - expected).abs() < 1e-3 && (spin - 10.0).abs() < 1e-9, "{velocity} {spin}");
}

/// Rotation, rad, and angular velocity, 1/s, of a body after a run.
fn swung(text: &str) -> (f64, f64) {
    let (scene, source) = parse(Source::new("needle.ron", text.to_owned())).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).expect("a run");
    let bodies = sim.resources().get::<RigidBodies>();
    let state = bodies.iter().next().map(|body| body.state).expect("a body");
    (2.0 * state.rotation.z.atan2(state.rotation.w), state.angular_velocity.z)
}

/// A needle, 1 m x 0.1 m, that is held at its middle and pulled at its last particle, at a small angle to the
/// force. Nothing but the load itself says how fast it swings.
#[test]
fn a_needle_swings_in_a_force_as_a_pendulum_does() {
    let (angle, period, mass, arm) = (0.01_f64, 0.01, 50.0, 0.49);
    let frequency = 2.0 * std::f64::consts::PI / period;
    let force = mass * 1.01 / 12.0 * frequency.powi(2) / arm;
    for periods in [0.25, 10.25, 100.25] {
        let (turned, spin) = swung(&format!(
            r#"(dimension: Two, materials: {{"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
                bodies: [(name: "needle", material: "wood", shape: Rotate(shape: Box(min: (-0.5, -0.05), max: (0.5, 0.05)), angle_degrees: {:?}),
                          spacing: 0.02, formulation: Rigid(rotation: Free))],
                conditions: [Fix(on: Select(body: "needle")), Force(on: Select(body: "needle", nearest: ({:?}, {:?})), value: ({force:?}, 0.0))],
                time: (end: {:?}))"#,
            angle.to_degrees(),
            arm * angle.cos(),
            arm * angle.sin(),
            periods * period,
        ));
        let (place, speed) = ((angle + turned) / angle, spin / (angle * frequency));
        assert!((place.hypot(speed) - 1.0).abs() < 0.005, "{periods}: {place}, {speed}");
        // After a quarter of a period it goes through the middle, backwards. With ten steps in a radian the
        // frequency of leapfrog is 1/2400 too high.
        let ahead = (-place).atan2(-speed);
        let expected = frequency * periods * period / 2400.0;
        assert!((ahead - expected).abs() < 0.002 + 0.3 * expected, "{periods}: {ahead}, {expected}");
    }
}

/// Two forces that are a couple accelerate no centre, and turn a body that is at rest.
#[test]
fn a_couple_turns_a_body_from_rest() {
    // 2e4 N at arms of 0.5 m, against 50 kg x 1.01 m2 / 12, with forces that keep their direction: energy
    // 2 F r sin(angle).
    let (angle, spin) = swung(
        r#"(dimension: Two, materials: {"wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)},
            bodies: [(name: "bar", material: "wood", shape: Box(min: (-0.5, -0.05), max: (0.5, 0.05)), spacing: 0.02, formulation: Rigid())],
            conditions: [Force(on: Select(body: "bar", nearest: (0.5, 0.0)), value: (0.0, 2e4)), Force(on: Select(body: "bar", nearest: (-0.5, 0.0)), value: (0.0, -2e4))],
            time: (end: 1.0))"#,
    );
    let inertia = 50.0 * 1.01 / 12.0;
    let energy = 2.0 * 2e4 * 0.5 * angle.sin();
    assert!((0.5 * inertia * spin * spin - energy).abs() < 0.002 * 2e4, "{angle}: {spin}");
}
