//! Stress at surfaces against that of exact displacement fields, and shifts against a naive fit.

use glam::DVec3;

use super::shifts::shift;
use super::traction::{LoadedParticle, SurfaceTraction};
use crate::kernels::{Kernel, KernelName};
use crate::record::probe::tests::first_of;

/// The stress along x that a probe finds in a strip of 0.3 x 0.1 m, `across` particles thick, with these
/// displacements and conditions.
fn strip(body: &str, poisson: f64, across: u32, fields: [&str; 2], conditions: &str, probe: &str) -> f64 {
    strip_field("stress.xx", body, poisson, across, fields, conditions, probe)
}

/// The same of such a field.
fn strip_field(
    field: &str,
    body: &str,
    poisson: f64,
    across: u32,
    fields: [&str; 2],
    conditions: &str,
    probe: &str,
) -> f64 {
    let ([ux, uy], spacing) = (fields, 0.1 / f64::from(across));
    let found = first_of(format!(
        r#"(dimension: Two, materials: {{"m": StVenantKirchhoff(density: 1000, young: 1e6, poisson: {poisson})}},
            bodies: [(name: "b", material: "m", shape: Box(min: (-0.15, -0.05), max: (0.15, 0.05)), spacing: {spacing}, {body})],
            conditions: [InitialDisplacement(on: Select(body: "b"), value: ("{ux}", "{uy}")), {conditions}],
            probes: [Probe(name: "p", quantity: Field("{field}"), {probe})], time: (end: 1e-9, step: Fixed(1e-9)))"#
    ));
    found[0].1
}

/// Pure bending in plane strain, `u = kappa (x y, -(x^2 + nu/(1 - nu) y^2)/2)`: the stress along x is
/// `E/(1 - nu^2) kappa y`, to the first order in kappa.
#[test]
fn the_stress_of_a_bent_strip_is_right_at_its_surface() {
    let kappa = 1e-3;
    for body in [
        "formulation: TotalLagrangian",
        "formulation: TotalLagrangian, lattice: Hexagonal",
        "formulation: UpdatedLagrangian",
        "formulation: Eulerian",
    ] {
        for (poisson, across) in [(0.0, 8), (0.3, 8), (0.3, 16), (0.45, 8)] {
            let ratio = poisson / (1.0 - poisson);
            let fields = [&format!("{kappa}*x*y"), &*format!("-0.5*{kappa}*(x*x + {ratio}*y*y)")];
            let most = 1e6 / (1.0 - poisson * poisson) * kappa * 0.05;
            let at = strip(body, poisson, across, fields, "", r#"at: (0.01, 0.05), follows: "b""#);
            assert!((at / most - 1.0).abs() < 3e-3, "{body} {poisson} {across}: {}", at / most);
            let below = r#"on: Select(body: "b", surface: Facing((0, -1)), within: Box(min: (-0.05, -1), max: (0.05, 1)))"#;
            let mean = strip(body, poisson, across, fields, "", below);
            assert!((mean / most + 1.0).abs() < 3e-3, "{body} {poisson} {across}: {}", mean / most);
        }
    }
}

/// The same with a pressure on the upper side that the whole strip carries, `sigma_yy = -p`.
#[test]
fn the_stress_of_a_bent_strip_is_right_under_a_pressure() {
    let (kappa, poisson, load) = (1e-3, 0.3, 40.0);
    let ratio = poisson / (1.0 - poisson);
    let (across, along) = (load * (1.0 - poisson * poisson) / 1e6, load * poisson * (1.0 + poisson) / 1e6);
    let fields =
        [&format!("{kappa}*x*y + {along}*x"), &*format!("-0.5*{kappa}*(x*x + {ratio}*y*y) - {across}*y")];
    let most = 1e6 / (1.0 - poisson * poisson) * kappa * 0.05;
    let pressure = format!(r#"Pressure(on: Select(body: "b", face: MaxY), value: {load})"#);
    for body in ["formulation: TotalLagrangian", "formulation: UpdatedLagrangian", "formulation: Eulerian"] {
        let at = |quantity: &str, y: f64, load: &str| {
            let probe = format!(r#"at: (0.01, {y}), follows: "b""#);
            strip_field(quantity, body, poisson, 8, fields, load, &probe)
        };
        let xx = at("stress.xx", 0.05, &pressure);
        assert!((xx / most - 1.0).abs() < 3e-3, "{body}: {}", xx / most);
        let yy = at("stress.yy", 0.05, &pressure);
        assert!((yy / load + 1.0).abs() < 1e-3, "{body}: {yy}");
        // What no load balances is no traction.
        assert!(at("stress.yy", -0.05, &pressure).abs() < 1e-3 * load);
    }
}

/// A uniform pressure on one side of a block, and one on a side of a thin strip: near edges, and where
/// particles carry both sides, the stress is that of the block as well.
#[test]
fn a_pressure_is_that_of_one_side() {
    let (load, poisson) = (40.0, 0.3);
    let (across, along) = (load * (1.0 - poisson * poisson) / 1e6, load * poisson * (1.0 + poisson) / 1e6);
    let fields = [&format!("{along}*x"), &*format!("-{across}*y")];
    let pressure = format!(r#"Pressure(on: Select(body: "b", face: MaxY), value: {load})"#);
    let body = "formulation: TotalLagrangian";
    for spacings in [0.25, 0.5, 1.0, 1.5, 2.0, 3.0] {
        let x = 0.15 - spacings * 0.0125;
        let probe = format!(r#"at: ({x}, 0.05), follows: "b""#);
        for (component, exact) in [("xx", 0.0), ("yy", -load), ("xy", 0.0)] {
            let field = format!("stress.{component}");
            let found = strip_field(&field, body, poisson, 8, fields, &pressure, &probe);
            assert!((found - exact).abs() < 1e-3 * load, "{component} at {x}: {found}");
        }
    }
    for across in [2, 3] {
        let probe = r#"at: (0.003, 0.05), follows: "b""#;
        let found = strip_field("stress.yy", body, poisson, across, fields, &pressure, probe);
        assert!((found / load + 1.0).abs() < 1e-3, "{across}: {found}");
    }
}

/// A pressure and a traction on a round surface are found again, and a force on one particle is not taken
/// for one.
#[test]
fn a_traction_is_what_acts_on_all_particles_alike() {
    let surface = |k: i32| 0.2 * DVec3::new((0.1 * f64::from(k)).sin(), (0.1 * f64::from(k)).cos(), 0.0);
    let of = |force: &dyn Fn(i32, DVec3) -> DVec3| -> Vec<LoadedParticle> {
        (-3..=3).map(|k| LoadedParticle { surface: surface(k), force: force(k, surface(k)) }).collect()
    };
    let left = |particles: &[LoadedParticle]| -> f64 {
        let traction = SurfaceTraction::of(particles);
        particles.iter().map(|of| traction.left(of).length()).sum()
    };
    let pressure = of(&|_, surface| -7.0 * surface);
    assert!((SurfaceTraction::of(&pressure).on(DVec3::Y) + 7.0 * DVec3::Y).length() < 1e-12);
    assert!(left(&pressure) < 1e-12);
    // Symmetric about the normal y, so that the pressure has no part of it.
    let along = of(&|_, surface| 3.0 * surface.length() * DVec3::X);
    assert!((SurfaceTraction::of(&along).on(DVec3::Y) - 3.0 * DVec3::X).length() < 1e-12);
    assert!(left(&along) < 1e-12);
    assert!(left(&of(&|k, _| if k == 1 { DVec3::NEG_Y } else { DVec3::ZERO })) > 1.0);
}

/// Uniaxial stress in plane strain, balanced by a traction on one side: there it is what the traction says,
/// and not that of a free surface.
#[test]
fn a_loaded_side_is_not_free() {
    let (strain, poisson) = (1e-3, 0.3);
    let ratio = poisson / (1.0 - poisson);
    let fields = [&format!("{strain}*x"), &*format!("-{strain}*{ratio}*y")];
    let stress = 1e6 / (1.0 - poisson * poisson) * strain;
    let load = format!(r#"Traction(on: Select(body: "b", face: MaxX), value: ("{stress}", "0"))"#);
    let body = "formulation: TotalLagrangian";
    let on_side = |load: &str, x: f64| {
        strip(body, poisson, 8, fields, load, &format!(r#"at: ({x}, 0.0), follows: "b""#)) / stress
    };
    assert!((on_side(&load, 0.15) - 1.0).abs() < 3e-3, "{}", on_side(&load, 0.15));
    // Without a load the side on the other end counts as free.
    assert!(on_side(&load, -0.15).abs() < 1e-3, "{}", on_side(&load, -0.15));
    // A held side is not free.
    let held = r#"Fix(on: Select(body: "b", face: MinX))"#;
    assert!((on_side(held, -0.15) - 1.0).abs() < 0.1, "{}", on_side(held, -0.15));
}

/// A block under the pressure p of a liquid is compressed in one direction, `sigma_yy = -p` up to its
/// surface, with particles as wide as those of the liquid and half as wide. It showed the stress of a free
/// surface.
#[test]
fn a_wet_side_is_not_free() {
    let (load, poisson): (f64, f64) = (1000.0, 0.3);
    let strain = load * (1.0 + poisson) * (1.0 - 2.0 * poisson) / (1e6 * (1.0 - poisson));
    let across = -load * poisson / (1.0 - poisson);
    for formulation in ["TotalLagrangian", "UpdatedLagrangian", "Eulerian"] {
        for spacing in [0.025, 0.0125] {
            let found = |component: &str| {
                first_of(format!(
                    r#"(dimension: Two, domain: (min: (0, -1), max: (0.2, 1), periodic: [X]),
                    materials: {{"m": StVenantKirchhoff(density: 1000, young: 1e6, poisson: {poisson}), "w": Fluid(density: 1000, sound_speed: 20)}},
                    bodies: [
                        (name: "w", material: "w", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.025, formulation: Fluid(pressure: "{load}")),
                        (name: "b", material: "m", shape: Box(min: (0, -0.1), max: (0.2, 0)), spacing: {spacing}, formulation: {formulation}),
                        (name: "lid", material: "wall", shape: Box(min: (0, 0.1), max: (0.2, 0.2)), spacing: 0.025, formulation: Wall(suction: true)),
                    ],
                    conditions: [InitialDisplacement(on: Select(body: "b"), value: (None, "-{strain}*y"))],
                    probes: [Probe(name: "p", quantity: Field("stress.{component}"), at: (0.1, 0), follows: "b")], time: (end: 1e-9, step: Fixed(1e-9)))"#
                ))[0]
                    .1
            };
            for (component, exact) in [("yy", -load), ("xx", across), ("xy", 0.0)] {
                let found = found(component);
                assert!((found - exact).abs() < 0.02 * load, "{formulation} {spacing} {component}: {found}");
            }
        }
    }
}

/// The slope along the surface that a least-squares fit finds in u = X_n X_t is that at the shifted place.
#[test]
fn shifts_are_those_of_a_fit() {
    let kernel = Kernel::new(KernelName::CubicSpline, 2).expect("a kernel");
    let support = 2.6;
    let h = kernel.smoothing_length(support);
    // A surface along the direction t, with the normal n into the body.
    let (sin, cos) = 0.7_f64.sin_cos();
    let (n, t) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
    for depth in 0..4 {
        let mut near = Vec::new();
        let (mut up, mut down) = (0.0, 0.0);
        for (k, l) in (-3..=3).flat_map(|k| (-3..=3).map(move |l| (k, l))) {
            let arm = f64::from(k) * n + f64::from(l) * t;
            if (k, l) == (0, 0) || k < -depth || arm.length() >= support {
                continue;
            }
            let weight = kernel.pair_weight(arm.length(), h);
            near.push((weight, arm));
            up += weight * arm.dot(n) * arm.dot(t) * arm.dot(t);
            down += weight * arm.dot(t) * arm.dot(t);
        }
        let found = shift(&near, 2);
        assert!((found - n * (up / down)).length() < 1e-12, "{depth}: {found}");
        assert!(if depth == 0 { (0.2..0.4).contains(&(up / down)) } else { up / down < 0.05 });
    }
}
