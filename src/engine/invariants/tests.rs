//! The invariants of every formulation of solids, without stabilizers; a new formulation is added to the
//! list.

use std::error::Error;
use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::Specimen;
use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;

/// Formulations, and whether their internal force is the slope of an energy of the places.
const FORMULATIONS: [(&str, bool); 3] =
    [("TotalLagrangian", true), ("UpdatedLagrangian()", true), ("Eulerian()", false)];

/// An irregular block of 1 m x 0.5 m (x 0.5 m).
fn block(dimension: usize, formulation: &str, end: f64) -> Result<Simulation, Box<dyn Error>> {
    let (name, low, high) = if dimension == 2 {
        ("Two", "(0, 0)", "(1.0, 0.5)")
    } else {
        ("Three", "(0, 0, 0)", "(1.0, 0.5, 0.5)")
    };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: {low}, max: {high}), spacing: 0.1,
                      lattice: Relaxed(seed: 3, iterations: 2), formulation: {formulation})],
            time: (end: {end:?}))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text))?;
    Ok(build(&scene, &source, &Registry::standard())?)
}

fn each(mut check: impl FnMut(usize, &str, bool) -> Result<(), Box<dyn Error>>) {
    for (dimension, (formulation, has_energy)) in
        [2, 3].into_iter().flat_map(|d| FORMULATIONS.map(|f| (d, f)))
    {
        check(dimension, formulation, has_energy)
            .unwrap_or_else(|error| panic!("{formulation} in {dimension} dimensions: {error}"));
    }
}

#[test]
fn an_affine_map_is_exact_and_leaves_no_net_force_or_torque() {
    each(|dimension, formulation, _| {
        let z = if dimension == 2 { DVec3::Z } else { DVec3::new(0.1, -0.1, 1.1) };
        let map = DMat3::from_cols(DVec3::new(1.2, 0.3, 0.0), DVec3::new(-0.2, 0.8, 0.0), z);
        let make = || block(dimension, formulation, 1.0);
        let found = Specimen::new(&make).affine(map, DVec3::new(0.7, -0.4, 0.0))?;
        assert!(found.gradient < 1e-10 && found.net.size > 0.1, "{formulation}: {found:?}");
        assert!(found.net.force < 1e-10 && found.net.torque < 1e-10, "{formulation}: {found:?}");
        Ok(())
    });
}

#[test]
fn forces_are_the_slope_of_the_strain_energy() {
    each(|dimension, formulation, has_energy| {
        if has_energy {
            let make = || block(dimension, formulation, 1.0);
            let found = Specimen::new(&make).slope()?;
            assert!(found.error < 1e-6, "{formulation}: {found:?}");
            assert!(found.net.force < 1e-10 && found.net.torque < 1e-10, "{formulation}: {found:?}");
        }
        Ok(())
    });
}

#[test]
fn a_body_that_is_thrown_keeps_its_momenta() {
    each(|dimension, formulation, _| {
        let make = || block(dimension, formulation, 20.0);
        let found = Specimen::new(&make).thrown(|x| {
            let swing = 0.02 * (PI * x.x).cos();
            DVec3::new(0.01 + swing - 0.05 * (x.y - 0.25), 0.02 + 0.05 * (x.x - 0.5), 0.0)
        })?;
        assert!(found.momentum < 1e-12 && found.angular_momentum < 1e-10, "{formulation}: {found:?}");
        assert!(found.energy < 0.01, "{formulation}: {found:?}");
        Ok(())
    });
}
