//! Skins: exact for affine motions, and forces that return by the transpose.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::{Patch, QuadratureRule, Skin, SkinColumns, Wanted};
use crate::assembly::build;
use crate::plugin::{Distances, Registry};
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, DeformationGradient, Force, Position};

/// A soft body of that shape, with a spacing of 0.01 m.
pub(crate) fn simulation(dimension: &str, shape: &str) -> Simulation {
    let text = format!(
        r#"(dimension: {dimension},
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "body", material: "soft", shape: {shape}, spacing: 0.01, formulation: TotalLagrangian)],
            time: (end: 0.01))"#
    );
    let (scene, source) = parse(Source::new("skin.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"))
}

/// The skin of a body of a simulation, with a spacing of 0.01 m, whose particles stand where those of the
/// scene do.
pub(crate) fn skin(sim: &Simulation, id: BodyId, dimension: &str, shape: &str) -> Skin {
    skin_of(sim, id, (dimension, shape), Distances::Reference)
}

fn skin_of(sim: &Simulation, id: BodyId, (dimension, shape): (&str, &str), distances: Distances) -> Skin {
    use crate::plugin::BodyPlan;
    use crate::scene::Dimension;
    use crate::shapes::{Filling, Lattice, Shape, fill};
    let axes = if dimension == "Two" { Dimension::Two } else { Dimension::Three };
    let shape: Shape = ron::from_str(shape).unwrap();
    let folder = std::path::Path::new(".");
    let sites = fill(
        &shape,
        Filling {
            lattice: Lattice::default(),
            spacing: 0.01,
            dimension: axes,
            folder,
            limit: 1_000_000,
            is_wall: false,
        },
    )
    .unwrap();
    let body = sim.world().body(id);
    let plan = BodyPlan {
        id,
        name: body.name.clone(),
        phase: body.phase,
        formulation: "TotalLagrangian",
        rows: body.rows.clone(),
        spacing: 0.01,
        material_name: String::new(),
        material: crate::materials::Material::nothing(),
        sites,
        carried: Vec::new(),
        hidden: Vec::new(),
        sides: Vec::new(),
        bounds: shape.region(axes, folder, "shape").unwrap().bounds(),
        velocity: None,
        kind: crate::plugin::BodyKind::Solid,
        offers: &[],
        support: None,
        kernel: None,
        distances,
    };
    Skin::of(&plan, &shape, &[], axes, folder).unwrap_or_else(|| panic!("no skin"))
}

const SHAPES: [(&str, &str); 3] = [
    ("Two", "Box(min: (0, 0), max: (0.1, 0.05))"),
    ("Two", "Sphere(center: (0.02, 0.01), radius: 0.05)"),
    ("Three", "Cylinder(from: (0, 0, 0), to: (0, 0, 0.08), radius: 0.04)"),
];

#[test]
fn vertices_follow_an_affine_motion_exactly() {
    for (dimension, shape) in SHAPES {
        let sim = simulation(dimension, shape);
        let skin = skin(&sim, BodyId(0), dimension, shape);
        let mut f = DMat3::from_cols_array(&[1.3, 0.2, 0.0, -0.1, 0.8, 0.0, 0.0, 0.0, 1.0]);
        let shift = DVec3::new(0.3, -0.2, 0.0);
        if dimension == "Three" {
            f.z_axis = DVec3::new(0.2, 0.1, 1.1);
        }
        {
            let (view, rows) = sim.world().body_view(BodyId(0));
            let mut x = view.write::<Position>().unwrap();
            let mut gradient = view.write::<DeformationGradient>().unwrap();
            for row in rows {
                x[row].0 = f * x[row].0 + shift;
                gradient[row].0 = f;
            }
        }
        let columns = SkinColumns::new(&skin, sim.world()).unwrap();
        let view = columns.view();
        let vertices: Vec<u32> = (0..skin.vertices() as u32).collect();
        view.places(&vertices, &mut |k, place, _| {
            let reference = skin.facets.points[k];
            assert!(place.distance(f * reference + shift) < 1e-14, "{shape} {reference}");
        });
    }
}

#[test]
fn forces_on_a_skin_are_those_on_its_particles_in_sum_and_moment() {
    for (dimension, shape) in SHAPES {
        let sim = simulation(dimension, shape);
        let skin = Arc::new(skin(&sim, BodyId(0), dimension, shape));
        let mut patch = Patch::new(Arc::clone(&skin));
        patch.select(0..skin.facets.corners.len() as u32);
        let columns = SkinColumns::new(&skin, sim.world()).unwrap();
        patch.update(&columns.view(), 0.0, Wanted::default());
        let rule = QuadratureRule::exact(skin.facets.axes);
        let (mut force, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        for facet in 0..skin.facets.corners.len() as u32 {
            for point in 0..rule.len() {
                let shares = rule.shares(point);
                let corners = patch.corners(facet);
                let x: DVec3 = (0..3).map(|k| shares[k] * corners[k].place).sum();
                let f = DVec3::new(1.0, f64::from(facet % 7) - 3.0, 0.0);
                (force, moment) = (force + f, moment + x.cross(f));
                patch.push(facet, shares, f, None);
            }
        }
        patch.transfer_forces();
        let (view, rows) = sim.world().body_view(BodyId(0));
        let mut on_particles = vec![Force(DVec3::ZERO); rows.len()];
        patch.add_forces(&mut on_particles);
        let x = view.read::<Position>().unwrap();
        let sum: DVec3 = on_particles.iter().map(|force| force.0).sum();
        let mut turn: DVec3 = rows.clone().map(|row| x[row].0.cross(on_particles[row].0)).sum();
        // At F = I the moment of a couple f (x) A is A x f.
        for (_, _, couple) in patch.on_particles() {
            turn +=
                DVec3::X.cross(couple.x_axis) + DVec3::Y.cross(couple.y_axis) + DVec3::Z.cross(couple.z_axis);
        }
        assert!(sum.distance(force) < 1e-12 * force.length(), "{shape}: {sum} {force}");
        assert!(turn.distance(moment) < 1e-10 * force.length(), "{shape}: {turn} {moment}");
    }
}

/// Deforms a body unevenly, flatter and flatter towards y = 0.
fn press(sim: &Simulation) {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (mut x, mut f) = (view.write::<Position>().unwrap(), view.write::<DeformationGradient>().unwrap());
    for row in rows {
        let start = x[row].0;
        let flat = 0.25 + 8.0 * start.y.abs();
        x[row].0 = DVec3::new(1.4 * start.x + 0.3 * start.y, flat * start.y, 0.9 * start.z);
        f[row].0 =
            DMat3::from_cols_array(&[1.4, 0.0, 0.0, 0.3, flat + 8.0 * start.y.abs(), 0.0, 0.1, 0.0, 0.9]);
    }
}

#[test]
fn forces_return_by_the_transpose_where_shares_follow_the_deformation() {
    let kinds = [Distances::Present, Distances::PartWay];
    for ((dimension, shape), distances) in kinds.iter().flat_map(|kind| SHAPES.map(|shape| (shape, *kind))) {
        let sim = simulation(dimension, shape);
        let skin = Arc::new(skin_of(&sim, BodyId(0), (dimension, shape), distances));
        press(&sim);
        let load = |vertex: usize| DVec3::new((7 * vertex % 11) as f64 - 5.0, (3 * vertex % 5) as f64, 1.0);
        let vertices: Vec<u32> = (0..skin.vertices() as u32).collect();
        let potential = || {
            let columns = SkinColumns::new(&skin, sim.world()).unwrap();
            let mut sum = 0.0;
            columns.view().places(&vertices, &mut |k, place, _| sum += load(k).dot(place));
            sum
        };
        let mut patch = Patch::new(Arc::clone(&skin));
        patch.select(0..skin.facets.corners.len() as u32);
        patch.update(&SkinColumns::new(&skin, sim.world()).unwrap().view(), 0.0, Wanted::default());
        vertices.iter().for_each(|&k| patch.push_vertex(k as usize, load(k as usize)));
        patch.transfer_forces();
        let size = patch.on_particles().map(|(_, force, _)| force.length()).fold(0.0, f64::max);
        let (view, rows) = sim.world().body_view(BodyId(0));
        for (particle, force, couple) in patch.on_particles().step_by(17) {
            let (row, step) = (rows.start + particle, 1e-6);
            for axis in [DVec3::X, DVec3::Y] {
                let shift = |by: f64| view.write::<Position>().unwrap()[row].0 += by * axis;
                let slope = slope_of(&potential, &shift, 0.01 * step);
                assert!((slope - force.dot(axis)).abs() < 1e-5 * size, "{shape}: {slope} {force}");
                for side in [DVec3::X, DVec3::Y] {
                    let turn = DMat3::from_cols(axis * side.x, axis * side.y, axis * side.z);
                    let strain = |by: f64| view.write::<DeformationGradient>().unwrap()[row].0 += turn * by;
                    let (slope, couple) = (slope_of(&potential, &strain, step), axis.dot(couple * side));
                    assert!((slope - couple).abs() < 1e-6 * size, "{shape}: {slope} {couple}");
                }
            }
        }
    }
}

/// The slope of a value in what a change changes, by central differences.
fn slope_of(value: &dyn Fn() -> f64, change: &dyn Fn(f64), step: f64) -> f64 {
    change(step);
    let high = value();
    change(-2.0 * step);
    let low = value();
    change(step);
    (high - low) / (2.0 * step)
}

#[test]
fn rules_are_exact_for_what_they_are_made_for() {
    for rule in [
        QuadratureRule::exact(2),
        QuadratureRule::fine(2, 8),
        QuadratureRule::exact(3),
        QuadratureRule::fine(3, 2),
        QuadratureRule::fine(3, 4),
    ] {
        let count = rule.len() as f64;
        let mean: f64 = (0..rule.len()).map(|k| rule.shares(k)[1]).sum::<f64>() / count;
        let ends: f64 = (0..rule.len()).map(|k| rule.shares(k).iter().sum::<f64>()).sum();
        assert!((ends - count).abs() < 1e-12);
        let axes = if rule.shares(0)[2] == 0.0 { 2.0 } else { 3.0 };
        assert!((mean - 1.0 / axes).abs() < 1e-12, "{mean}");
    }
    for (axes, square) in [(2, 1.0 / 3.0), (3, 1.0 / 6.0)] {
        let rule = QuadratureRule::exact(axes);
        let mean = (0..rule.len()).map(|k| rule.shares(k)[1].powi(2)).sum::<f64>() / rule.len() as f64;
        assert!((mean - square).abs() < 1e-12, "{axes}: {mean}");
    }
}
