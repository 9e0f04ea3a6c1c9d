//! F6: the flow in a lid-driven cavity.

use anyhow::{Context, Result};
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{Density, Position, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F6",
    title: "lid-driven cavity, Re 100 and 1000",
    resolutions: &[25, 50, 100],
    ci_resolution: 25,
    run: cavity,
};

const U_VERTICAL: &str = include_str!("../../../tests/validation/lid_driven_cavity/u_vertical.csv");
const V_HORIZONTAL: &str = include_str!("../../../tests/validation/lid_driven_cavity/v_horizontal.csv");
/// Time between two samples of the steady flow, s.
const EVERY: f64 = 0.25;

/// One flow: its Reynolds number with unit lid velocity and cavity width, and the time of evaluation.
struct Flow {
    reynolds: u32,
    first: f64,
    end: f64,
    tolerance: f64,
}

fn cavity(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let slow =
        Flow { reynolds: 100, first: 10.0, end: 14.0, tolerance: if across < 50 { 0.06 } else { 0.03 } };
    let mut checks = flow(registry, across, &slow)?;
    // The thin layers of the faster flow need a finer lattice.
    if across >= 100 {
        checks.extend(flow(
            registry,
            across,
            &Flow { reynolds: 1000, first: 40.0, end: 50.0, tolerance: 0.06 },
        )?);
    }
    Ok(checks)
}

fn flow(registry: &Registry, across: usize, flow: &Flow) -> Result<Vec<Check>> {
    let spacing = 1.0 / across as f64;
    let (low, high) = (-3.0 * spacing, 1.0 + 3.0 * spacing);
    let path = "tests/validation/lid_driven_cavity/scene.ron";
    let text = include_str!("../../../tests/validation/lid_driven_cavity/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("materials.fluid.viscosity", 1.0 / f64::from(flow.reynolds))?
        .set("time.end", flow.end)?
        .set("bodies.fluid.spacing", spacing)?
        .set("bodies.walls.spacing", spacing)?
        .set("bodies.lid.spacing", spacing)?
        .set("bodies.walls.shape[0].min", format!("({low}, {low})"))?
        .set("bodies.walls.shape[0].max", format!("({high}, 1.0)"))?
        .set("bodies.lid.shape.min", format!("({low}, 1.0)"))?
        .set("bodies.lid.shape.max", format!("({high}, {high})"))?
        .build(registry)?;
    let within =
        |record: Record| record.0.into_iter().filter(|&(s, _)| s > 0.0 && s < 1.0).collect::<Vec<_>>();
    let column = format!("Re{}", flow.reynolds);
    let u = within(Record::read(U_VERTICAL, "y", &column)?);
    let v = within(Record::read(V_HORIZONTAL, "x", &column)?);
    let mut sums = vec![0.0; u.len() + v.len()];
    let mut samples = 0.0;
    let balance = run(&mut simulation, |simulation| {
        if simulation.clock().time < flow.first + EVERY * samples {
            return Ok(());
        }
        samples += 1.0;
        let field = CavityField::new(simulation, 3.0 * spacing)?;
        let along = u.iter().map(|&(y, _)| Ok(field.at(DVec3::new(0.5, y, 0.0))?.x));
        let across = v.iter().map(|&(x, _)| Ok(field.at(DVec3::new(x, 0.5, 0.0))?.y));
        for (sum, value) in sums.iter_mut().zip(along.chain(across)) {
            let value: Result<f64> = value;
            *sum += value?;
        }
        Ok(())
    })?;
    let errors = sums.iter().zip(u.iter().chain(&v)).map(|(sum, (_, exact))| sum / samples - exact);
    let (mut largest, mut square) = (0.0f64, 0.0);
    for error in errors {
        largest = largest.max(error.abs());
        square += error * error;
    }
    let source = "Ghia, Ghia, Shin 1982, u_vertical.csv and v_horizontal.csv";
    let rms = (square / sums.len() as f64).sqrt();
    let of =
        |what: &str| format!("{what} on both centre lines, over the speed of the lid, Re {}", flow.reynolds);
    let density = mean_density(&simulation)?;
    let largest =
        Check::new(of("largest error"), largest, 0.0, Tolerance::Absolute(flow.tolerance), "1", source);
    let rms = Check::new(of("rms error"), rms, 0.0, Tolerance::Absolute(0.03), "1", source);
    Ok(vec![
        largest,
        if flow.reynolds == 100 { rms.converging() } else { rms },
        Check::new(
            format!("mean density at the end, Re {}", flow.reynolds),
            density,
            1.0,
            Tolerance::Relative(0.005),
            "kg/m3",
            "mass is conserved in the box",
        ),
        balance.check_of(&format!("Re {}", flow.reynolds), Kind::Smooth),
    ])
}

/// Mean density of the fluid, kg/m3.
fn mean_density(simulation: &Simulation) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(body(simulation, "fluid")?);
    let density = view.read::<Density>()?;
    Ok(density[rows.clone()].iter().map(|rho| rho.0).sum::<f64>() / rows.len() as f64)
}

/// Velocities of the fluid, fitted linearly around a place with the weights of a Wendland kernel.
struct CavityField {
    particles: Vec<(DVec3, DVec3)>,
    radius: f64,
}

impl CavityField {
    fn new(simulation: &Simulation, radius: f64) -> Result<Self> {
        let (view, rows) = simulation.world().body_view(body(simulation, "fluid")?);
        let (position, velocity) = (view.read::<Position>()?, view.read::<Velocity>()?);
        Ok(Self { particles: rows.map(|row| (position[row].0, velocity[row].0)).collect(), radius })
    }

    fn at(&self, place: DVec3) -> Result<DVec3> {
        let (mut moment, mut sums) = (DMat3::ZERO, [DVec3::ZERO; 2]);
        for &(x, v) in &self.particles {
            let apart = (x - place) / self.radius;
            let r = apart.length();
            if r < 1.0 {
                let weight = (1.0 - r).powi(4) * (1.0 + 4.0 * r);
                let basis = DVec3::new(1.0, apart.x, apart.y);
                moment += DMat3::from_cols(basis * basis.x, basis * basis.y, basis * basis.z) * weight;
                sums[0] += basis * (weight * v.x);
                sums[1] += basis * (weight * v.y);
            }
        }
        let inverse = moment.try_inverse().context("there is no fluid on the centre line")?;
        Ok(DVec3::new((inverse * sums[0]).x, (inverse * sums[1]).x, 0.0))
    }
}
