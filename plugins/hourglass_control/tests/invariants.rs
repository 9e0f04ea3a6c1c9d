//! Exact properties with the control, in both Lagrangian formulations: affine maps, force as the gradient of
//! the energy, conservation.

use std::error::Error;
use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use meshless_engine::assembly::build;
use meshless_engine::invariants::Specimen;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;

const VARIATIONAL: &str = "hourglass_control()";
const CONTROLS: [&str; 2] = [VARIATIONAL, "hourglass_control(form: Ganzenmueller2015)"];
const FORMULATIONS: [&str; 2] = ["TotalLagrangian", "UpdatedLagrangian()"];

/// An irregular body, in two or three dimensions.
fn block(dimension: usize, formulation: &str, plugins: &str, end: f64) -> Result<Simulation, Box<dyn Error>> {
    let (name, low, high) = if dimension == 2 {
        ("Two", "(0, 0)", "(1.0, 0.5)")
    } else {
        ("Three", "(0, 0, 0)", "(1.0, 0.5, 0.5)")
    };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: {low}, max: {high}), spacing: 0.1,
                      lattice: Relaxed(seed: 3, iterations: 2), formulation: {formulation}, plugins: [{plugins}])],
            time: (end: {end:?}))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text))?;
    Ok(build(&scene, &source, &Registry::standard().with(hourglass_control::register))?)
}

/// Calls `check` for every dimension, formulation and control.
fn each(controls: &[&str], mut check: impl FnMut(usize, &str, &str) -> Result<(), Box<dyn Error>>) {
    for (dimension, formulation) in [2, 3].into_iter().flat_map(|d| FORMULATIONS.map(|f| (d, f))) {
        for control in controls {
            check(dimension, formulation, control)
                .unwrap_or_else(|error| panic!("{control}, {formulation}, {dimension} dimensions: {error}"));
        }
    }
}

#[test]
fn an_affine_map_is_exact_and_holds_nothing() {
    each(&CONTROLS, |dimension, formulation, control| {
        let map = if dimension == 2 {
            DMat3::from_cols(DVec3::new(1.2, 0.3, 0.0), DVec3::new(-0.2, 0.8, 0.0), DVec3::Z)
        } else {
            let z = DVec3::new(0.1, -0.1, 1.1);
            DMat3::from_cols(DVec3::new(1.2, 0.3, 0.1), DVec3::new(-0.2, 0.8, 0.2), z)
        };
        let make = || block(dimension, formulation, control, 1.0);
        let found = Specimen::new(&make).affine(map, DVec3::new(0.7, -0.4, 0.0))?;
        assert!(found.gradient < 1e-10 && found.net.size > 0.1, "{control}, {formulation}: {found:?}");
        // The paper's form acts along the bonds, the variational one is the gradient of an energy that turns
        // with the body.
        assert!(found.net.force < 1e-10 && found.net.torque < 1e-10, "{control}, {formulation}: {found:?}");
        assert!(found.held < 1e-13, "{control}, {formulation}: {found:?}");
        Ok(())
    });
}

#[test]
fn a_rough_displacement_leaves_no_net_force_or_torque_and_forces_are_the_slope_of_an_energy() {
    each(&CONTROLS, |dimension, formulation, control| {
        let make = || block(dimension, formulation, control, 1.0);
        let net = Specimen::new(&make).rough()?;
        assert!(net.force < 1e-10 && net.torque < 1e-10, "{control}, {formulation}: {net:?}");
        // The paper's form has no energy.
        if control == VARIATIONAL {
            let found = Specimen::new(&make).slope()?;
            assert!(found.error < 1e-6, "{formulation}: {found:?}");
        }
        Ok(())
    });
}

#[test]
fn a_thrown_and_spinning_body_keeps_momentum_and_energy() {
    each(&[VARIATIONAL], |dimension, formulation, control| {
        // 100 periods 2 L / c of its swing in the total-Lagrangian formulation.
        let end = if formulation == "TotalLagrangian" { 200.0 } else { 20.0 };
        let make = || block(dimension, formulation, control, end);
        let (center, spin) = (DVec3::new(0.5, 0.25, 0.0), DVec3::new(0.0, 0.0, 0.05));
        let found = Specimen::new(&make).thrown(|x| {
            let swing = 0.02 * (PI * x.x).cos();
            DVec3::new(0.01 + swing, 0.02, 0.0) + spin.cross(x - center)
        })?;
        assert!(found.momentum < 1e-12 && found.angular_momentum < 1e-10, "{formulation}: {found:?}");
        assert!(found.energy < 5e-3, "{formulation}: {found:?}");
        Ok(())
    });
}

#[test]
fn round_off_of_a_body_at_rest_is_no_reason_to_warn() -> Result<(), Box<dyn Error>> {
    for formulation in ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()"] {
        let text = format!(
            r#"(dimension: Two,
                materials: {{"steel": NeoHookean(density: 7800, young: 2e11, poisson: 0.3)}},
                bodies: [(name: "b", material: "steel", shape: Box(min: (0, 0), max: (1.0, 0.5)), spacing: 0.05,
                          formulation: {formulation}, plugins: [{VARIATIONAL}])],
                conditions: [InitialDisplacement(on: Select(body: "b"), value:
                    ("cos(0.7)*x - sin(0.7)*y - x + 3", "sin(0.7)*x + cos(0.7)*y - y"))],
                time: (end: 2e-3))"#
        );
        let (scene, source) = parse(Source::new("test.ron", text))?;
        let mut sim = build(&scene, &source, &Registry::standard().with(hourglass_control::register))?;
        sim.run(|_| true)?;
        let warnings = sim.finish()?.warnings;
        assert!(warnings.is_empty(), "{formulation}: {warnings:?}");
    }
    Ok(())
}
