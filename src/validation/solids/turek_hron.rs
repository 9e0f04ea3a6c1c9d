//! S9: the elastic flag of Turek and Hron under gravity, static (CSM1, CSM2) and oscillating (CSM3).

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, relax, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S9",
    title: "Turek-Hron CSM1, CSM2, CSM3",
    resolutions: &[7, 9, 18],
    ci_resolution: 7,
    run: turek_hron,
};

const REFERENCE: &str = include_str!("../../../tests/validation/turek_hron/reference.csv");
const SOURCE: &str = "Turek and Hron 2006, level 4+2";
const HISTORY: &str = "Turek and Hron 2006, reference.csv";

fn turek_hron(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for (name, young, reference) in [("CSM1", 1.4e6, -66.10e-3), ("CSM2", 5.6e6, -16.974e-3)] {
        let mut simulation = scene(across)?
            .set("materials.flag.young", young)?
            .set("plugins", "[local_damping(mode: Relaxation(tolerance: 1e-5))]")?
            .set("time.end", 20.0)?
            .build(registry)?;
        relax(&mut simulation)?;
        let sag = tip(&simulation)?.displacement(&simulation)?.y;
        let name = format!("{name} tip displacement");
        checks.push(Check::new(name, sag, reference, Tolerance::Relative(0.03), "m", SOURCE).converging());
    }
    let mut simulation = scene(across)?.build(registry)?;
    let point = tip(&simulation)?;
    let mut sag = Record::default();
    let balance = run(&mut simulation, |simulation| {
        sag.push(simulation.clock().time, -point.displacement(simulation)?.y);
        Ok(())
    })?;
    let mut reference = Record::read(REFERENCE, "time", "Uy")?.until(simulation.end());
    reference.0.iter_mut().for_each(|sample| sample.1 = -sample.1);
    let ((_, lowest), (_, lowest_reference)) = (sag.maximum()?, reference.maximum()?);
    // The flag starts from rest at its highest point, so that half a period passes until the middle of its
    // fall.
    let (period, period_reference) = (2.0 * sag.middle_of_peak(0.5)?, 2.0 * reference.middle_of_peak(0.5)?);
    checks.push(
        Check::new(
            "CSM3 amplitude",
            0.5 * lowest,
            0.5 * lowest_reference,
            Tolerance::Relative(0.03),
            "m",
            HISTORY,
        )
        .converging(),
    );
    checks.push(
        Check::new("CSM3 period", period, period_reference, Tolerance::Relative(0.02), "s", HISTORY)
            .converging(),
    );
    checks.push(balance.check_of("CSM3", Kind::Smooth));
    Ok(checks)
}

fn scene(across: usize) -> Result<Template> {
    let spacing = 0.02 / across as f64;
    Template::new(
        "tests/validation/turek_hron/scene.ron",
        include_str!("../../../tests/validation/turek_hron/scene.ron"),
    )
    .set("bodies.flag.spacing", spacing)?
    .set("bodies.flag.shape.min", format!("({}, -0.01)", -3.0 * spacing))
}

fn tip(simulation: &Simulation) -> Result<MaterialPoint> {
    MaterialPoint::new(simulation, body(simulation, "flag")?, DVec3::new(0.35, 0.0, 0.0))
}
