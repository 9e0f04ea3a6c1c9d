//! Losses: particles that have been removed or have failed, and whether the sums of a solid already leave
//! them out.
//!
//! A particle lost in a step is left out of the sums from the next step on. For a run that resumes from a
//! checkpoint between the two, a column stores per row which losses the sums already include.

use crate::column;

column! {
    /// Losses of a solid that the sums over neighbours already leave out: 1 for a particle that has been
    /// removed, 2 for one that has failed, 3 for both.
    pub struct AppliedLosses(u32) = "losses_taken_up", "-", "1";
}

/// How a particle is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// It has been removed from the run.
    Removed = 1,
    /// It has failed.
    Failed = 2,
}

impl AppliedLosses {
    /// The rows of that loss, ascending.
    pub fn rows(column: &[Self], loss: Loss) -> Vec<u32> {
        (0..column.len() as u32).filter(|&row| column[row as usize].0 & loss as u32 != 0).collect()
    }

    /// Writes down that these rows, and no others, are of that loss.
    pub fn write(column: &mut [Self], loss: Loss, rows: &[u32]) {
        column.iter_mut().for_each(|row| row.0 &= !(loss as u32));
        rows.iter().for_each(|&row| column[row as usize].0 |= loss as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_that_has_failed_and_is_removed_is_of_both() {
        let mut column = [AppliedLosses::default(); 4];
        AppliedLosses::write(&mut column, Loss::Failed, &[1, 2]);
        AppliedLosses::write(&mut column, Loss::Removed, &[2]);
        assert_eq!(column.map(|row| row.0), [0, 2, 3, 0]);
        AppliedLosses::write(&mut column, Loss::Failed, &[1]);
        assert_eq!(AppliedLosses::rows(&column, Loss::Failed), [1]);
        assert_eq!(AppliedLosses::rows(&column, Loss::Removed), [2]);
    }
}
