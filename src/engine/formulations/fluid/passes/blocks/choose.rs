//! Whether the passes over pairs run in blocks: where they can, unless the scene says otherwise.

use crate::formulations::fluid::lists::blocks::{Blocks, Units};
use crate::notation::number;
use crate::plugin::{SetupError, SimBuilder};
use crate::scene::{Precision, Problem};

/// Minimum and maximum spacing of blocks, m: weights of pairs in three dimensions go with its fifth power,
/// and single precision ends at 1e38.
const SPACINGS: [f64; 2] = [1e-6, 1e6];

/// The blocks of a flow of that many particles and that spacing, m, if it has some. `thin` says that the flow
/// does not see across some bodies.
///
/// # Errors
/// Single precision where it cannot be.
pub fn choose(
    particles: usize,
    spacing: f64,
    thin: bool,
    sim: &SimBuilder<'_>,
) -> Result<Option<Box<Blocks>>, SetupError> {
    let is_asked = match sim.scene().precision {
        Some(Precision::Double) => return Ok(None),
        Some(Precision::Mixed) => true,
        None => false,
    };
    let [least, most] = SPACINGS;
    if !(spacing >= least && spacing <= most) {
        if !is_asked {
            return Ok(None);
        }
        let found = number(spacing);
        let message = format!("`Mixed` is for spacings of {least} to {most} m, found {found} m");
        let problem = Problem::at_path("precision", message)
            .help("leave `precision` out: sums are then in double precision");
        return Err(SetupError::Problems(vec![problem]));
    }
    let units = Units::new(spacing, &sim.periodic());
    Ok(Some(Box::new(Blocks::new(particles, units, thin))))
}
