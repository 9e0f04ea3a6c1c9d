//! The range of support radii that a fit of the deformation gradient can use.

use crate::plugin::SetupError;

/// Checks the parameter `support` of a formulation, in spacings \[-\]; `usual` is the value that its message
/// recommends, `spacing` that of the body \[m\].
///
/// # Errors
/// The support reaches no second neighbour, or is wider than ten spacings.
pub fn require_support(support: f64, usual: f64, spacing: f64) -> Result<(), SetupError> {
    let fewest = 1.5;
    if (fewest..=10.0).contains(&support) {
        return Ok(());
    }
    let found = format!("found {support} ({} m)", support * spacing);
    Err(SetupError::parameter(
        "support",
        format!("`support` must be between {fewest} and 10 spacings, {found}"),
        format!("{usual} is usual"),
    ))
}
