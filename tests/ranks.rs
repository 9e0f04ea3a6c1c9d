//! The same scene gives the same bits on any number of ranks.

mod common;
#[path = "ranks/threads.rs"]
mod threads;

use common::coupled::coupled;
use common::eulerian::{FOLLOWING, UPSET, block};
use common::thin::{thin, torn};
use common::touching::{large_rigid_bodies, tool_of_triangles, touching};
use common::wearing::wearing;
use common::{
    all_plugins, crash, double, eulerian, failing, failing_metals, flow, metals, of_many_tasks, removal,
    simulation, with_formulation,
};
use meshless::formulations::fluid::FlowCloud;
use meshless::parallel::own_rows;
use meshless::ranks::{self, Cut};
use meshless::record::StateHash;
use meshless::scene::Source;
use meshless::solids::HessianResidual;
use meshless::world::BodyId;
use threads::on_ranks;

/// Hash of the state, and the balance error, whose bits follow from every energy.
type Found = (StateHash, u64);

/// Weights of ranks from a seed, some of them zero.
fn weights(seed: u64, size: usize) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % 4
    };
    (0..size).map(|_| next() as f64).collect()
}

/// The scene after some steps; loops are divided anew in the middle, where there is a seed.
fn after(source: &Source, steps: u64, cuts: Option<(u64, usize)>) -> Found {
    let mut sim = simulation(source);
    if let Some((seed, size)) = cuts {
        for part in 0..3 {
            sim.set_cut(Cut::by_weights(&weights(seed + part, size)));
            sim.run(|sim| 3 * sim.clock().step < (part + 1) * steps).expect("a run");
        }
    }
    sim.run(|sim| sim.clock().step < steps).expect("a run");
    assert_eq!(sim.clock().step, steps);
    (sim.state_hash(), sim.ledger().balance_error().to_bits())
}

fn assert_equal_bits(name: &str, source: &Source, steps: u64) {
    let alone = after(source, steps, None);
    for size in [2, 3, 4] {
        let found = on_ranks(size, 1, |_| after(source, steps, None));
        assert!(found.iter().all(|of_rank| *of_rank == alone), "{name} on {size} ranks");
    }
    let exchanged = on_ranks(2, 1, |_| {
        after(source, 1, None);
        ranks::traffic()
    });
    assert!(exchanged.iter().all(|traffic| traffic.bytes > 0), "{name}: nothing is divided");
    let found = on_ranks(3, 2, |_| after(source, steps, Some((source.text.len() as u64, 3))));
    assert!(found.iter().all(|of_rank| *of_rank == alone), "{name} with random cuts");
}

fn with_stabilization(form: &str) -> Source {
    let Source { name, text, .. } = all_plugins(2);
    let plugin = format!("plugins: [hessian_stabilization({form})]");
    Source::new(name, text.replace("plugins: [hourglass_control()]", &plugin))
}

#[test]
fn total_lagrangian_solids() {
    assert_equal_bits("two dimensions", &of_many_tasks(&all_plugins(2)), 12);
    assert_equal_bits("three dimensions", &all_plugins(3), 30);
    assert_equal_bits("metals", &metals(), 30);
    assert_equal_bits("second derivatives", &with_stabilization(""), 30);
    assert_equal_bits("the form of the paper", &with_stabilization("form: Vidal2007"), 30);
}

#[test]
fn updated_lagrangian_solids() {
    let often = "UpdatedLagrangian(update: Every(3))";
    assert_equal_bits("two dimensions", &with_formulation(often, &all_plugins(2)), 30);
    assert_equal_bits("failing", &with_formulation(often, &failing()), 100);
    assert_equal_bits("touching", &with_formulation(often, &touching()), 60);
    assert_equal_bits("second derivatives", &with_formulation(often, &with_stabilization("")), 30);
}

#[test]
fn eulerian_solids() {
    assert_equal_bits("three dimensions", &eulerian(&all_plugins(3)), 20);
    assert_equal_bits("metals", &eulerian(&metals()), 20);
    assert_equal_bits("failing", &eulerian(&failing()), 60);
    let upset = block(3, FOLLOWING, UPSET[1], "plugins: [hourglass_control()],");
    assert_equal_bits("supports that follow", &upset, 60);
}

#[test]
fn flows() {
    // Lists are built, and fluids sorted, several times.
    assert_equal_bits("two dimensions", &flow(2), 300);
    assert_equal_bits("three dimensions", &flow(3), 60);
    assert_equal_bits("double precision", &double(&flow(3)), 60);
    assert_equal_bits("thin bodies", &thin(), 150);
    assert_equal_bits("torn", &torn(), 150);
}

/// Water that falls from a step in a tank along which it slides: loops need what is near their own particles
/// and no more. The tank moves, or stands still.
fn sliding(is_solid: bool, moves: bool, plugins: &str) -> Source {
    let [water, outer, inner, at] = match is_solid {
        true => [
            "(0, 0, 0), max: (0.2, 0.5, 0.2)",
            "(-0.15, -0.15, -0.15), max: (0.85, 0.7, 0.35)",
            "(0, 0, 0), max: (0.7, 1, 0.2)",
            "(0.1, 0, 0.1)",
        ],
        false => {
            ["(0, 0), max: (0.2, 0.5)", "(-0.1, -0.1), max: (0.8, 0.7)", "(0, 0), max: (0.7, 1)", "(0.1, 0)"]
        }
    };
    let (dimension, spacing) = if is_solid { ("Three", 0.05) } else { ("Two", 0.02) };
    let motion =
        if moves { r#"Velocity(on: Select(body: "tank"), value: ("0.2*sin(20*t)", None))"# } else { "" };
    let text = format!(
        r#"(dimension: {dimension}, gravity: (0.0, -9.81), domain: (min: (-0.3, -0.3, -0.3), max: (1.0, 0.9, 0.6), outside: Remove),
            materials: {{"water": Fluid(density: 1000.0, eos: Tait(gamma: 7.0))}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: {water}), spacing: {spacing:?}, formulation: Fluid,
                 velocity: (0.5, 0.0), plugins: [{plugins}]),
                (name: "tank", material: "wall", shape: Difference(Box(min: {outer}), Box(min: {inner})),
                 spacing: {spacing:?}, formulation: Wall(slip: Free)),
            ],
            conditions: [{motion}],
            probes: [Probe(name: "level", at: {at}, quantity: WaterLevel())],
            plugins: [artificial_viscosity(alpha: 0.02, beta: 0.0)],
            time: (end: 10.0))"#
    );
    Source::new("sliding.ron", text)
}

#[test]
fn flows_that_slide_along_walls() {
    assert_equal_bits("a tank that stands still", &sliding(true, false, "density_diffusion()"), 300);
    assert_equal_bits("a tank that moves", &sliding(true, true, ""), 150);
    assert_equal_bits("in the plane", &of_many_tasks(&sliding(false, true, "density_diffusion()")), 30);
    assert_equal_bits("shifted", &sliding(false, false, "density_diffusion(), particle_shifting()"), 300);
}

/// Oil in a vessel with a piston that moves along its walls, all of these of that kind.
fn pushed(dimension: usize, wall: &str, viscosity: f64) -> Source {
    let [kind, z, spacing] = if dimension == 3 { ["Three", ", 0.3", "0.05"] } else { ["Two", "", "0.02"] };
    let [z0, out] = if dimension == 3 { [", 0", ", 0.5"] } else { ["", ""] };
    let below = if dimension == 3 { ", -0.2" } else { "" };
    let text = format!(
        r#"(dimension: {kind}, gravity: (0.0, -9.81),
            materials: {{"oil": Fluid(density: 1000.0, sound_speed: 30.0, viscosity: {viscosity:?})}},
            bodies: [
                (name: "oil", material: "oil", shape: Box(min: (0, 0{z0}), max: (0.6, 0.4{z})), spacing: {spacing}, formulation: Fluid,
                 plugins: [density_diffusion()]),
                (name: "piston", material: "wall", shape: Box(min: (-0.2, 0{z0}), max: (0, 0.6{z})), spacing: {spacing}, formulation: Wall({wall})),
                (name: "vessel", material: "wall", shape: Difference(Box(min: (-0.2, -0.2{below}), max: (0.8, 0.6{out})), Box(min: (-1, 0{z0}), max: (0.6, 1{z}))),
                 spacing: {spacing}, formulation: Wall({wall})),
            ],
            conditions: [Displacement(on: Select(body: "piston"), value: ("0.05*sin(8*t)", 0.0))],
            time: (end: 10.0))"#
    );
    Source::new("pushed.ron", text)
}

#[test]
fn flows_between_several_walls() {
    for dimension in [2, 3] {
        let steps = if dimension == 2 { 200 } else { 60 };
        let check = |wall, viscosity| {
            let name = format!("{dimension} dimensions, {wall}");
            assert_equal_bits(&name, &pushed(dimension, wall, viscosity), steps);
        };
        check("slip: Free", 0.0);
        check("slip: No", 1.0);
        check("slip: No, suction: true", 1.0);
        check("slip: Free, suction: true", 0.0);
    }
}

/// Who looks at particles of other ranks sees them as they are.
#[test]
fn probes_and_neighbours_of_a_flow_are_those_of_one_rank() {
    let look = || {
        let mut sim = simulation(&sliding(true, false, "density_diffusion()"));
        let mut seen = Vec::new();
        for steps in [20, 25, 60] {
            sim.run(|sim| sim.clock().step < steps).expect("a run");
            let level = sim.measure("level").expect("a level");
            seen.extend(level.into_iter().map(|(_, value)| value.to_bits()));
            let cloud = FlowCloud::whole(sim.resources()).expect("a flow");
            let counts = cloud.neighbor_counts(BodyId(0)).expect("counts");
            seen.extend(counts.into_iter().map(|count| count as u64));
            seen.extend(cloud.records().iter().map(|record| record.pressure().to_bits()));
        }
        seen
    };
    let alone = look();
    assert!(alone.iter().any(|&bits| bits != 0));
    for size in [2, 3] {
        // Here old rows are unusable.
        let seen = on_ranks(size, 1, |_| look());
        assert!(seen.iter().all(|of_rank| *of_rank == alone), "{size} ranks");
    }
}

/// Stress at the free side of a strip that a traction bends: its forces are those of particles of all ranks.
#[test]
fn stress_at_a_surface_is_that_of_one_rank() {
    let text = r#"(dimension: Two, materials: {"m": NeoHookean(density: 1000.0, young: 1e6, poisson: 0.3)},
        bodies: [(name: "strip", material: "m", shape: Box(min: (0, 0), max: (1.6, 0.1)), spacing: 0.0125, formulation: TotalLagrangian)],
        conditions: [Fix(on: Select(body: "strip", face: MinX)), Traction(on: Select(body: "strip", face: MaxX), value: (0, 1e3))],
        probes: [
            Probe(name: "sides", on: Select(body: "strip", surface: Facing((0, 1))), take: Maximum, quantity: Field("von_mises")),
            Probe(name: "depth", line: (from: (0.8, 0.1), to: (0.8, 0.05), points: 4), follows: "strip", quantity: Field("stress.xx")),
        ],
        time: (end: 1.0))"#;
    let look = || {
        let mut sim = simulation(&Source::new("bent.ron", text));
        sim.run(|sim| sim.clock().step < 60).expect("a run");
        let of = |probe: &str| sim.measure(probe).expect("a stress");
        of("sides").into_iter().chain(of("depth")).map(|(_, value)| value.to_bits()).collect::<Vec<_>>()
    };
    let alone = look();
    assert!(alone.iter().any(|&bits| f64::from_bits(bits).abs() > 1.0));
    for size in [2, 3] {
        let seen = on_ranks(size, 1, |_| look());
        assert!(seen.iter().all(|of_rank| *of_rank == alone), "{size} ranks");
    }
}

#[test]
fn flows_with_bodies() {
    assert_equal_bits("coupled", &coupled(), 150);
    assert_equal_bits("wearing", &wearing(), 60);
    assert_equal_bits("a gap", &gap(), 100);
    let [wall, elastic] = [
        r#"material: "wall", formulation: Wall(slip: Free, suction: true)"#,
        r#"material: "rubber", formulation: TotalLagrangian(), plugins: [hourglass_control()]"#,
    ];
    assert_equal_bits("a piston", &piston(wall, 0.0), 150);
    assert_equal_bits("a deformable piston", &piston(elastic, -0.04), 100);
}

/// A piston of that kind, driven up to that place, between the walls of a vessel, along which it moves, and a
/// probe of its force.
fn piston(kind: &str, driven: f64) -> Source {
    let text = r#"(dimension: Two,
        materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0), "rubber": NeoHookean(density: 1000.0, young: 2e6, poisson: 0.3)},
        bodies: [
            (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.6, 0.3)), spacing: 0.02, lattice: Relaxed(seed: 1, iterations: 10),
             formulation: Fluid, plugins: [density_diffusion()]),
            (name: "piston", KIND, shape: Box(min: (-0.1, 0), max: (0, 0.3)), spacing: 0.02),
            (name: "vessel", material: "wall", shape: Difference(Box(min: (-0.1, -0.1), max: (0.7, 0.4)), Box(min: (-1, 0), max: (0.6, 0.3))),
             spacing: 0.02, formulation: Wall(slip: Free, suction: true)),
        ],
        conditions: [Velocity(on: Select(body: "piston", within: Box(min: (-0.1, 0), max: (DRIVEN, 0.3))), value: ("0.05*sin(4*pi*t)", None))],
        probes: [Probe(name: "force", on: Select(body: "piston"), quantity: FluidForce)],
        time: (end: 10.0))"#;
    Source::new("piston.ron", text.replace("KIND", kind).replace("DRIVEN", &driven.to_string()))
}

/// A box on the floor of a tank, under water that has no room below it, and a probe of the force on the
/// walls.
fn gap() -> Source {
    let text = r#"(dimension: Two, gravity: (0.0, -9.81),
        materials: {"water": Fluid(density: 1000.0, viscosity: 0.1, sound_speed: 20.0), "wood": NeoHookean(density: 600, young: 1e9, poisson: 0.3)},
        bodies: [
            (name: "water", material: "water", shape: Difference(Box(min: (0, 0), max: (0.6, 0.3)), Box(min: (0.2, 0), max: (0.4, 0.1))), spacing: 0.02,
             formulation: Fluid, plugins: [density_diffusion()]),
            (name: "box", material: "wood", shape: Box(min: (0.2, 0), max: (0.4, 0.1)), spacing: 0.02, formulation: Rigid()),
            (name: "tank", material: "wall", shape: Difference(Box(min: (-0.1, -0.1), max: (0.7, 0.5)), Box(min: (0, 0), max: (0.6, 1))),
             spacing: 0.02, formulation: Wall(slip: No)),
        ],
        contacts: [Contact(between: ("tank", "box"), law: Penalty())],
        time: (end: 10.0))"#;
    Source::new("gap.ron", text)
}

#[test]
fn contact_and_rigid_bodies() {
    assert_equal_bits("touching", &touching(), 150);
    assert_equal_bits("a tool", &tool_of_triangles(), 100);
    assert_equal_bits("rigid bodies", &large_rigid_bodies(), 30);
}

#[test]
fn failure_and_removal() {
    assert_equal_bits("removal", &removal(), 300);
    assert_equal_bits("failing", &failing(), 300);
    assert_equal_bits("failing metals", &failing_metals(), 150);
    assert_equal_bits("crash", &crash(), 150);
}

#[test]
fn rows_of_other_ranks_are_unusable_once_they_are_old() {
    on_ranks(2, 1, |_| {
        let mut sim = simulation(&with_stabilization(""));
        sim.run(|sim| sim.clock().step < 3).expect("a run");
        let (view, body) = sim.world().body_view(BodyId(0));
        let residual = view.read_own::<HessianResidual>().expect("the column");
        let own = own_rows(&body);
        assert!(!own.is_empty() && own.len() < body.len());
        for row in body {
            assert_eq!(residual[row].0.is_finite(), own.contains(&row), "row {row}");
        }
    });
}
