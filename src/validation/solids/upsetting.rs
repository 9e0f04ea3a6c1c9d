//! S21: a cylinder of aluminium upset to half its height with friction.

use std::f64::consts::LN_2;

use anyhow::{Result, ensure};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{
    BodyId, DeformationGradient, PlasticStrain, Position, ReferencePosition, ReferenceVolume,
};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Balance, Kind, body, state};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S21",
    title: "upsetting of an aluminium cylinder",
    resolutions: &[8, 12, 16],
    ci_resolution: 8,
    run: upsetting,
};

const SOURCE: &str = "slab method, reference.csv";
/// Height of the billet at the start, and at the end, m; the force is the mean from the third on.
const HEIGHT: f64 = 5.0e-3;
const END: f64 = 2.5e-3;
const WINDOW: f64 = 2.7e-3;

/// `across` is the number of particles over the height.
fn upsetting(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut simulation = Template::new(
        "tests/validation/upsetting/scene.ron",
        include_str!("../../../tests/validation/upsetting/scene.ron"),
    )
    .set("bodies.billet.spacing", HEIGHT / across as f64)?
    .build(registry)?;
    let billet = body(&simulation, "billet")?;
    simulation.start()?;
    let (mut forces, mut height, mut balance) = (Vec::new(), HEIGHT, Balance::default());
    while height > END {
        ensure!(!simulation.is_finished(), "the billet is still {height} m high");
        simulation.step()?;
        balance.see(&simulation);
        height = height_of(&simulation, billet)?;
        if height < WINDOW {
            let (upper, lower) = (state(&simulation, "upper")?, state(&simulation, "lower")?);
            forces.push(0.5 * (upper.force.z - lower.force.z));
        }
    }
    let force = forces.iter().sum::<f64>() / forces.len() as f64;
    let shape = measure(&simulation, billet)?;
    let plates = state(&simulation, "upper")?.center.z - state(&simulation, "lower")?.center.z - 2.0e-3;
    let volume = Tolerance::Relative(0.01);
    Ok(vec![
        Check::new("force", force, 59.906e3, Tolerance::Relative(0.05), "N", SOURCE),
        Check::new("volume over that at the start", shape.volume, 1.0, volume, "", "plastic flow"),
        Check::new("mean radius", shape.radius, 7.0711e-3, Tolerance::Relative(0.03), "m", "volume"),
        Check::above("bulge: middle over ends", shape.bulge, 1.0, "friction"),
        Check::new("mean plastic strain", shape.strain, LN_2, Tolerance::Between(-0.03, 0.1), "", SOURCE),
        Check::new(
            "gap of the plates over the height",
            plates / END,
            1.0,
            Tolerance::Relative(0.02),
            "",
            "none",
        ),
        balance.check(Kind::Inelastic),
    ])
}

/// Distance of the end faces of the billet, m: half a spacing outside of its outermost particles, moved by
/// their deformation gradients.
fn height_of(simulation: &Simulation, billet: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(billet);
    let (position, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
    let gradient = view.read::<DeformationGradient>()?;
    let half = 0.5 * simulation.world().body(billet).spacing;
    let face = |sign: f64| {
        let own = rows
            .clone()
            .filter(|&row| sign * (reference[row].0.z - 0.5 * HEIGHT) > 0.5 * HEIGHT - 1.5 * half);
        let (count, sum) = own.fold((0.0, 0.0), |(count, sum), row| {
            (count + 1.0, sum + position[row].0.z + sign * half * gradient[row].0.z_axis.z)
        });
        sum / count
    };
    Ok(face(1.0) - face(-1.0))
}

struct BilletShape {
    volume: f64,
    radius: f64,
    bulge: f64,
    strain: f64,
}

/// Radii are those of the second moment, r^2 = 2 <x^2 + y^2> weighted by volume: that of a disc.
fn measure(simulation: &Simulation, billet: BodyId) -> Result<BilletShape> {
    let (view, rows) = simulation.world().body_view(billet);
    let (position, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
    let (gradient, strain) = (view.read::<DeformationGradient>()?, view.read::<PlasticStrain>()?);
    let volume = view.read::<ReferenceVolume>()?;
    let mean = |value: &dyn Fn(usize) -> f64, of: &dyn Fn(usize) -> bool| {
        let of = || rows.clone().filter(|&row| of(row));
        of().map(|row| volume[row].0 * value(row)).sum::<f64>() / of().map(|row| volume[row].0).sum::<f64>()
    };
    let square = |row: usize| 2.0 * position[row].0.truncate().length_squared();
    let from_middle = |row: usize| (reference[row].0.z / HEIGHT - 0.5).abs();
    let (middle, ends) =
        (mean(&square, &|row| from_middle(row) < 0.15), mean(&square, &|row| from_middle(row) > 0.35));
    Ok(BilletShape {
        volume: mean(&|row| gradient[row].0.determinant(), &|_| true),
        radius: mean(&square, &|_| true).sqrt(),
        bulge: (middle / ends).sqrt(),
        strain: mean(&|row| strain[row].0, &|_| true),
    })
}
