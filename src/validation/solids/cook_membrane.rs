//! S10: Cook's membrane in large strain.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{MaterialPoint, body, relax};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S10",
    title: "Cook's membrane",
    resolutions: &[8, 16, 32],
    ci_resolution: 32,
    run: cook_membrane,
};

const SOURCE: &str = "finite elements, reference.csv";

fn cook_membrane(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    // The last of the three columns of the clamp stands on the left edge; the right edge is half a spacing
    // outside of the last column.
    let columns = (48.0 * across as f64 / 44.0 - 0.5).round() + 0.5;
    let spacing = 48.0 / columns;
    let left = -2.5 * spacing;
    let corners =
        format!("[({left}, 0.0), (0.0, 0.0), (48.0, 44.0), (48.0, 60.0), (0.0, 44.0), ({left}, 44.0)]");
    let mut simulation = Template::new(
        "tests/validation/cook_membrane/scene.ron",
        include_str!("../../../tests/validation/cook_membrane/scene.ron"),
    )
    .set("bodies.membrane.spacing", spacing)?
    .set("bodies.membrane.shape.points", corners)?
    .build(registry)?;
    let membrane = body(&simulation, "membrane")?;
    relax(&mut simulation)?;
    let lift =
        |y| MaterialPoint::new(&simulation, membrane, DVec3::new(48.0, y, 0.0))?.displacement(&simulation);
    let (corner, middle) = (lift(60.0)?.y, lift(52.0)?.y);
    // Errors fall with the square of the spacing, as those of the elements of the reference.
    let coarser = (32.0 / across as f64).max(1.0);
    let tolerance = Tolerance::Relative(0.03 * coarser * coarser);
    let lift = |name, measured, reference| {
        Check::new(name, measured, reference, tolerance, "m", SOURCE).converging()
    };
    Ok(vec![
        lift("vertical displacement of the corner", corner, 7.7726),
        lift("vertical displacement of the middle", middle, 7.8863),
    ])
}
