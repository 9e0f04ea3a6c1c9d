//! Tests of bodies that are thinner than the support of the fluid.

use std::ops::Range;

use glam::DVec3;

use super::{column, double, simulation};
use crate::formulations::fluid::{FlowCloud, NearPairs, RowPass, RowSums};
use crate::parallel::{Arithmetic, Vector};
use crate::simulation::Simulation;
use crate::world::{BodyId, Force, Mass, Position, Removed, Velocity};

/// Two tanks side by side with a sheet between them, `layers` particles of the water thick and at least two
/// of its own; water at rest in the left one and, with its own pressure, in the right one.
fn tanks(precision: &str, layers: usize, right: f64, rest: &str) -> Simulation {
    let (edge, spacing) = (0.2 + 0.01 * layers as f64, 0.005 * layers.min(2) as f64);
    simulation(&format!(
        r#"(precision: {precision}, dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0),
                "rubber": NeoHookean(density: 1100.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "left", material: "water", spacing: 0.01, formulation: Fluid(pressure: "2000"),
                 shape: Box(min: (0, 0), max: (0.2, 0.3))),
                (name: "right", material: "water", spacing: 0.01, formulation: Fluid(pressure: "{right}"),
                 shape: Box(min: ({edge}, 0), max: ({}, 0.3))),
                (name: "sheet", material: "rubber", spacing: {spacing}, {rest}
                 shape: Box(min: (0.2, -0.1), max: ({edge}, 0.4))),
            ],
            conditions: [InitialVelocity(on: Select(body: "left"), value: ("0.2*sin(20*y)", "0.1")),
                         InitialVelocity(on: Select(body: "right"), value: ("-0.3*sin(15*y)", "0.1*cos(20*x)"))],
            time: (end: 1.0))"#,
        edge + 0.2
    ))
}

#[test]
fn water_does_not_see_water_through_a_sheet() {
    for (precision, formulation) in
        [("Double", "TotalLagrangian"), ("Double", "Rigid()"), ("Mixed", "TotalLagrangian")]
    {
        let mut sim = tanks(precision, 2, 500.0, &format!("formulation: {formulation},"));
        sim.start().expect("a start");
        let cloud = sim.resources().get::<FlowCloud>();
        let left = cloud.groups[0].cloud.clone();
        let right = cloud.groups[1].cloud.clone();
        let (x, y) = (column::<Position>(&sim, 0), column::<Position>(&sim, 1));
        let mut walls = [0, 0];
        for (side, group) in [left.clone(), right.clone()].into_iter().enumerate() {
            for i in group.clone() {
                for &j in cloud.near_row(i) {
                    let j = j as usize;
                    if j < cloud.fluid {
                        assert!(group.contains(&j), "{precision}, {formulation}: {i} sees {j}");
                    } else {
                        walls[side] += 1;
                    }
                }
            }
        }
        assert_eq!(walls[0], walls[1], "both sides see the same wall");
        assert!(walls[0] > 100 && x.len() == y.len());
        // Pressures of the copies are those of the water on their sides.
        let pressure = |group: usize| {
            let rows = cloud.groups[group].cloud.clone();
            let at = rows.start + rows.len() / 2;
            (at.saturating_sub(2)..at + 3).map(|row| cloud.records[row].pressure()).fold(0.0, f64::max)
        };
        let mut two = [pressure(2), pressure(3)];
        two.sort_by(f64::total_cmp);
        assert!((two[0] - 500.0).abs() < 20.0 && (two[1] - 2000.0).abs() < 20.0, "{two:?}");
    }
}

/// Where particles of a sheet have been removed, water sees water.
#[test]
fn water_sees_water_through_a_hole_in_a_sheet() {
    for precision in ["Double", "Mixed"] {
        let mut sim = tanks(precision, 1, 2000.0, "formulation: TotalLagrangian,");
        let through = |sim: &Simulation| {
            let cloud = sim.resources().get::<FlowCloud>();
            let (left, right) = (cloud.groups[0].cloud.clone(), cloud.groups[1].cloud.clone());
            let pairs = left.flat_map(|i| cloud.near_row(i).to_vec().into_iter().map(move |j| (i, j)));
            let pairs = pairs.filter(|(_, j)| right.contains(&(*j as usize)));
            pairs.map(|(i, _)| cloud.records[i].position().y).collect::<Vec<_>>()
        };
        sim.run(|sim| sim.clock().step < 1).expect("a start");
        assert!(through(&sim).is_empty(), "{precision}");
        {
            let (view, rows) = sim.world().body_view(BodyId(2));
            let x = view.read::<Position>().expect("places");
            let mut removed = view.write::<Removed>().expect("a column");
            rows.filter(|&row| (0.1..0.2).contains(&x[row].0.y)).for_each(|row| removed[row] = Removed::YES);
        }
        sim.run(|sim| sim.clock().step < 2).expect("a step");
        let seen = through(&sim);
        assert!(seen.len() >= 10 && seen.iter().all(|y| (0.09..0.21).contains(y)), "{precision}: {seen:?}");
    }
}

#[test]
fn momentum_is_kept_with_water_on_both_sides_of_a_sheet() {
    // Round-off of the sums, and of some hundred steps in single precision.
    for (precision, most) in [("Double", 1e-11), ("Mixed", 1e-6)] {
        let mut sim = tanks(precision, 2, 2500.0, "formulation: TotalLagrangian,");
        let momentum = |sim: &Simulation| -> DVec3 {
            let of = |body| {
                let (m, v) = (column::<Mass>(sim, body), column::<Velocity>(sim, body));
                m.iter().zip(&v).map(|(m, v)| m.0 * v.0).sum::<DVec3>()
            };
            of(0) + of(1) + of(2)
        };
        sim.start().expect("a start");
        let before = momentum(&sim);
        sim.run(|sim| sim.clock().time < 0.03).expect("a run");
        assert!(sim.resources().get::<FlowCloud>().builds() > 2);
        assert!(
            (momentum(&sim) - before).length() < most * 100.0,
            "{precision}: {before} {}",
            momentum(&sim)
        );
        assert!(sim.ledger().relative_error().abs() < 2e-2, "{precision}: {}", sim.ledger().relative_error());
    }
}

/// A sheet that ends in water: there, particles of both sides, and of none, share a list.
fn immersed(precision: &str) -> Simulation {
    simulation(&format!(
        r#"(precision: {precision}, dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0),
                    "rubber": NeoHookean(density: 1100.0, young: 1.0e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.01, formulation: Fluid(pressure: "2000"),
                     shape: Difference(Box(min: (0, 0), max: (0.3, 0.3)), Box(min: (0.15, 0.1), max: (0.16, 0.4)))),
                    (name: "sheet", material: "rubber", spacing: 0.005, formulation: TotalLagrangian,
                     shape: Box(min: (0.15, 0.1), max: (0.16, 0.4))),
                ],
                conditions: [InitialVelocity(on: Select(body: "water"), value: ("0.2*sin(20*y)", "0.1*cos(20*x)"))],
                time: (end: 1.0))"#
    ))
}

/// A sheet in water does the same in both precisions.
#[test]
fn forces_beside_a_sheet_are_those_of_double_precision() {
    let after = |precision| {
        let mut sim = immersed(precision);
        sim.run(|sim| sim.clock().step < 40).expect("a run");
        assert!(sim.resources().get::<FlowCloud>().builds() > 1);
        (0..2).flat_map(|body| column::<Force>(&sim, body)).map(|force| force.0).collect::<Vec<_>>()
    };
    let (double, mixed) = (after("Double"), after("Mixed"));
    let rms = (double.iter().map(|f| f.length_squared()).sum::<f64>() / double.len() as f64).sqrt();
    let worst = double.iter().zip(&mixed).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(rms > 0.0 && worst < 1e-4 * rms, "{worst:e} of {rms:e}");
}

/// How the velocity changes around a particle, and where its neighbours are: what plugins sum.
struct Around<'a>(&'a FlowCloud);

impl RowPass<1, 2> for Around<'_> {
    type Output = [DVec3; 2];

    fn among(&self) -> Range<usize> {
        self.0.everything()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [self.0.records()[row].velocity()]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [change, place]: &mut [Vector<A>; 2],
    ) {
        *change = (*other - *own).mul_add(near.volume * near.kernel, *change);
        *place = near.x_ij.mul_add(near.volume * near.weight, *place);
    }

    fn output(&self, _: usize, sums: &[DVec3; 2]) -> [DVec3; 2] {
        *sums
    }
}

/// Sums of plugins see as little through a sheet as forces do.
#[test]
fn sums_over_rows_beside_a_sheet_are_those_of_double_precision() {
    let after = |precision| {
        let mut sim = immersed(precision);
        sim.run(|sim| sim.clock().step < 40).expect("a run");
        let cloud = sim.resources().get::<FlowCloud>();
        let mut rows = vec![[DVec3::ZERO; 2]; cloud.fluid];
        cloud.for_each_row(0, &mut rows, &mut RowSums::default(), &Around(&cloud));
        // Both start from one lattice, and are sorted alike.
        assert!(cloud.builds() > 1);
        rows
    };
    let (double, mixed) = (after("Double"), after("Mixed"));
    for sum in 0..2 {
        let largest = double.iter().map(|row| row[sum].length()).fold(0.0, f64::max);
        let worst = double.iter().zip(&mixed).map(|(a, b)| a[sum].distance(b[sum])).fold(0.0, f64::max);
        assert!(largest > 0.0 && worst < 1e-4 * largest, "{sum}: {worst:e} of {largest:e}");
    }
}

/// A tank of 0.6 m with water to 0.3 m, and a body of rubber in or above it.
fn rubber((water, lattice): (&str, &str), body: &str, rest: &str) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, gravity: (0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, viscosity: 1e-3), "rubber": NeoHookean(density: 450.0, young: 5.0e6, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", spacing: 0.01, lattice: {lattice}, formulation: Fluid, shape: {water}),
                (name: "body", material: "rubber", spacing: 0.005, formulation: TotalLagrangian, shape: {body}),
                (name: "tank", material: "water", spacing: 0.01, formulation: Wall(slip: Free),
                 shape: Difference(Box(min: (-0.34, -0.04), max: (0.34, 0.5)), Box(min: (-0.3, 0), max: (0.3, 0.6)))),
            ],
            {rest} time: (end: 0.15))"#
    ))
}

#[test]
fn bodies_that_are_thick_and_thin_keep_their_energy_in_water() {
    // A boat whose keel, 4 particles thick, drops into the water; and a buoy that a strip holds.
    let boat =
        "Union([Box(min: (-0.12, 0.40), max: (0.12, 0.48)), Box(min: (-0.01, 0.31), max: (0.01, 0.40))])";
    let buoy = "Union([Box(min: (-0.01, 0.01), max: (0.01, 0.15)), Sphere(center: (0, 0.15), radius: 0.06)])";
    let around = format!("Difference(Box(min: (-0.3, 0), max: (0.3, 0.3)), {buoy})");
    let hold = r#"conditions: [Fix(on: Select(body: "body", within: Box(min: (-1, -1), max: (1, 0.03))))],"#;
    let still = ("Box(min: (-0.3, 0), max: (0.3, 0.3))", "Square");
    let around = (around.as_str(), "Relaxed(seed: 1, iterations: 30)");
    let scenes = [rubber(still, boat, ""), rubber(around, buoy, hold)];
    for (mut sim, name) in scenes.into_iter().zip(["boat", "buoy"]) {
        sim.run(|_| true).unwrap_or_else(|error| panic!("{name}: {error}"));
        let error = sim.ledger().relative_error();
        assert!(error.abs() < 1e-2, "{name}: balance {error}");
    }
}

#[test]
fn momenta_are_kept_with_water_around_a_fin_on_a_block() {
    // The fin turns as it meets the water. With sub-steps it would turn under a force that stands still.
    let mut sim = double(
        r#"(dimension: Two, materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0),
                "rubber": NeoHookean(density: 1100.0, young: 1.0e6, poisson: 0.3)},
            bodies: [
                (name: "left", material: "water", spacing: 0.01, formulation: Fluid(pressure: "2000"),
                 shape: Box(min: (-0.2, 0), max: (-0.015, 0.2))),
                (name: "right", material: "water", spacing: 0.01, formulation: Fluid(pressure: "500"),
                 shape: Box(min: (0.035, 0), max: (0.22, 0.2))),
                (name: "fin", material: "rubber", spacing: 0.01, formulation: TotalLagrangian,
                 shape: Union([Box(min: (-0.005, -0.05), max: (0.015, 0.3)), Box(min: (-0.055, 0.3), max: (0.065, 0.4))])),
            ],
            conditions: [InitialVelocity(on: Select(body: "left"), value: ("0.4", "0.3")),
                         InitialVelocity(on: Select(body: "fin"), value: ("-2*(y - 0.2)", "2*x"))],
            time: (end: 1.0, sub_steps: 1))"#,
    );
    let momenta = |sim: &Simulation| {
        let of = |body| {
            let (m, v) = (column::<Mass>(sim, body), column::<Velocity>(sim, body));
            let x = column::<Position>(sim, body);
            let of = |k: usize| (m[k].0 * v[k].0, x[k].0.cross(m[k].0 * v[k].0));
            (0..m.len()).map(of).fold((DVec3::ZERO, DVec3::ZERO), |a, b| (a.0 + b.0, a.1 + b.1))
        };
        (0..3).map(of).fold((DVec3::ZERO, DVec3::ZERO), |a, b| (a.0 + b.0, a.1 + b.1))
    };
    sim.start().expect("a start");
    let (linear, angular) = momenta(&sim);
    sim.run(|sim| sim.clock().time < 0.08).expect("a run");
    let (now, turned) = momenta(&sim);
    assert!((now - linear).length() < 1e-11 * linear.length(), "{linear} {now}");
    assert!((turned - angular).length() < 1e-9 * angular.length(), "{angular} {turned}");
    assert!(sim.ledger().relative_error().abs() < 2e-2, "{}", sim.ledger().relative_error());
}

/// A sheet, two particles thick, that ends in a liquid of one pressure, on one lattice with it: nothing
/// moves, also where particles of both sides meet in front of the end.
#[test]
fn a_liquid_around_the_end_of_a_sheet_stays_at_rest() {
    for (precision, formulation) in
        [("Double", "TotalLagrangian"), ("Double", "Rigid()"), ("Mixed", "TotalLagrangian")]
    {
        let mut sim = simulation(&format!(
            r#"(precision: {precision}, dimension: Two, domain: (min: (-0.2, -0.2), max: (0.2, 0.2), periodic: [X, Y]),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0),
                    "rubber": NeoHookean(density: 1000.0, young: 1.0e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.01, formulation: Fluid(pressure: "2000"),
                     shape: Difference(Box(min: (-0.2, -0.2), max: (0.2, 0.2)), Box(min: (-0.1, -0.01), max: (0.1, 0.01)))),
                    (name: "sheet", material: "rubber", spacing: 0.01, formulation: {formulation},
                     shape: Box(min: (-0.1, -0.01), max: (0.1, 0.01))),
                ],
                time: (end: 1.0))"#
        ));
        sim.start().expect("a start");
        let weight = 2000.0 * 0.01;
        let most = column::<Force>(&sim, 0).iter().map(|force| force.0.length()).fold(0.0, f64::max);
        assert!(most < 1e-5 * weight, "{precision}, {formulation}: {most} N of {weight} N");
    }
}

#[test]
fn an_acute_edge_does_not_stir_water_at_rest() {
    for formulation in ["Rigid()", "TotalLagrangian"] {
        let wedge = "Polygon(points: [(0.2, 0.2), (0.4, 0.25359), (0.4, 0.14641)])";
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0, -9.81),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0),
                    "wood": NeoHookean(density: 700.0, young: 1.0e7, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.02, formulation: Fluid,
                     shape: Difference(Box(min: (0, 0), max: (0.6, 0.4)), {wedge})),
                    (name: "wedge", material: "wood", spacing: 0.02, formulation: {formulation}, shape: {wedge}),
                    (name: "tank", material: "water", spacing: 0.02, formulation: Wall(slip: Free),
                     shape: Difference(Box(min: (-0.08, -0.08), max: (0.68, 0.5)), Box(min: (0, 0), max: (0.6, 1)))),
                ],
                conditions: [Fix(on: Select(body: "wedge"))], time: (end: 0.3))"#
        ));
        sim.run(|_| true).expect("a run");
        let (m, v) = (column::<Mass>(&sim, 0), column::<Velocity>(&sim, 0));
        let energy: f64 = m.iter().zip(&v).map(|(m, v)| 0.5 * m.0 * v.0.length_squared()).sum();
        // That of one spacing of fall of the water: 1000 x 0.6 x 0.4 kg times g dx is 47 J.
        assert!(energy < 1e-3 * 47.0, "{formulation}: {energy} J");
    }
}
