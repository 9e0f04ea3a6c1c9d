//! Whether the passes over pairs go in blocks: where the scene says so, and they can.

use super::rows::KeepRows;
use crate::formulations::fluid::cloud::Group;
use crate::formulations::fluid::lists::blocks::{Blocks, Units};
use crate::notation::number;
use crate::plugin::{SetupError, SimBuilder};
use crate::scene::{Precision, Problem};

/// The blocks of a flow of that spacing, m, if it has some. `thin` is a body that the flow does not see across, `spin` says that friction is corrected by the spin.
///
/// # Errors
/// Single precision where it cannot be.
pub fn choose(
    spacing: f64,
    thin: Option<&Group>,
    spin: bool,
    sim: &mut SimBuilder<'_>,
) -> Result<Option<Box<Blocks>>, SetupError> {
    let asked: Vec<KeepRows> = sim.take_extensions();
    if sim.scene().precision == Precision::Double {
        return Ok(None);
    }
    Ok(Some(Box::new(Blocks::new(units(spacing, thin, sim)?, spin || !asked.is_empty()))))
}

/// Least and largest spacing of blocks, m: weights of pairs in three dimensions go with its fifth power, and single precision ends at 1e38.
const SPACINGS: [f64; 2] = [1e-6, 1e6];

/// The unit of places.
fn units(spacing: f64, thin: Option<&Group>, sim: &SimBuilder<'_>) -> Result<Units, SetupError> {
    let refuse = |message: String| {
        let problem = Problem::at_path("precision", message)
            .help("leave `precision` out: sums are then in double precision");
        Err(SetupError::Problems(vec![problem]))
    };
    if let Some(group) = thin {
        let name = &sim.body(group.body).name;
        return refuse(format!(
            "`{name}` is thinner than the support of the fluid, whose neighbours across it `Mixed` cannot leave out"
        ));
    }
    let [least, most] = SPACINGS;
    if !(spacing >= least && spacing <= most) {
        let found = number(spacing);
        return refuse(format!("`Mixed` is for spacings of {least} to {most} m, found {found} m"));
    }
    Ok(Units::new(spacing, &sim.periodic()))
}
