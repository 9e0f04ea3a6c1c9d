//! The pairs of a body as they are now, for plugins that let particles of a solid exchange something: heat,
//! density.

use std::ops::Range;

use glam::DVec3;

use super::phase::SolidPhase;
use super::row_loops::fill_rows;
use crate::world::{DeformationGradient, MissingColumn, PhaseView, ReferenceVolume, Removed};

/// Present volumes of the rows of a phase, m3, kept between steps so that none allocates.
#[derive(Debug, Default)]
pub struct PresentVolumes(Vec<f64>);

impl PresentVolumes {
    /// Finds V_0 det F of the rows of a body, zero for particles that are removed or inverted, and
    /// gives those of the whole phase.
    ///
    /// # Errors
    /// The phase has no deformation gradient.
    pub fn of_body(&mut self, view: &PhaseView<'_>, rows: &Range<usize>) -> Result<&[f64], MissingColumn> {
        let (volume, removed) = (view.read::<ReferenceVolume>()?, view.read::<Removed>()?);
        let deformation = view.read::<DeformationGradient>()?;
        let (volume, removed, deformation) = (&volume[..], &removed[..], &deformation[..]);
        self.0.resize(volume.len(), 0.0);
        fill_rows(&mut self.0[rows.clone()], rows.start, |row| {
            let stretch = deformation[row].0.determinant().max(0.0);
            if removed[row] == Removed::NO { volume[row].0 * stretch } else { 0.0 }
        });
        Ok(&self.0)
    }
}

/// The pairs of a body in the present configuration.
#[derive(Clone, Copy)]
pub struct PresentPairs<'a> {
    /// The phase of the body.
    pub solid: &'a dyn SolidPhase,
    /// Positions of the rows of the phase, m.
    pub position: &'a [DVec3],
    /// Present volumes of the rows of the phase, m3.
    pub volumes: &'a [f64],
}

/// A neighbour of a particle.
#[derive(Clone, Copy, Debug)]
pub struct PresentPair {
    /// Row of the neighbour, or of the particle that a ghost is the image of.
    pub row: usize,
    /// Signs that vectors of the row have in the ghost, axis by axis.
    pub signs: DVec3,
    /// x_ij, m.
    pub x_ij: DVec3,
    /// V_j w_ij, m^-2.
    pub weight: f64,
}

impl PresentPairs<'_> {
    /// Calls `f` with every neighbour of a row, in the order of the list.
    pub fn of(&self, row: usize, mut f: impl FnMut(PresentPair)) {
        let ghosts = self.solid.ghosts();
        self.solid.neighbors(row, &mut |j, weight| {
            let source = ghosts.source(j);
            f(PresentPair {
                row: source,
                signs: ghosts.mirror(j).unwrap_or(DVec3::ONE),
                x_ij: ghosts.pair(self.position, row, j),
                weight: self.volumes[source] * weight,
            });
        });
    }
}
