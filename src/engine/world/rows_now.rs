//! Current rows of particles, from their rows at the start: fluids are sorted from time to time.

use std::borrow::Cow;

use super::state::{MissingColumn, World};
use super::{BodyId, ParticleId};

impl World {
    /// The rows of the particles of a body that stood in these rows at the start, ascending.
    ///
    /// # Errors
    /// The phase has no particle ids.
    pub fn rows_now<'r>(&self, body: BodyId, at_start: &'r [u32]) -> Result<Cow<'r, [u32]>, MissingColumn> {
        if at_start.len() == self.body(body).rows.len()
            || self.are_in(body, at_start.iter().map(|&row| (row, row)))?
        {
            return Ok(Cow::Borrowed(at_start));
        }
        let places = self.places_now(body, at_start)?;
        Ok(Cow::Owned(places.into_iter().map(|(row, _)| row).collect()))
    }

    /// The rows of the particles of a body that stood in these rows at the start, ascending, and which of
    /// them each is.
    ///
    /// # Errors
    /// The phase has no particle ids.
    pub fn places_now(&self, body: BodyId, at_start: &[u32]) -> Result<Vec<(u32, u32)>, MissingColumn> {
        let (first, rows) = (self.first_id(body), self.body(body).rows.clone());
        let ids = self.body_view(body).0.read::<ParticleId>()?;
        let mut now = vec![0; rows.len()];
        for row in rows.clone() {
            now[(ids[row].0 - first) as usize - rows.start] = row as u32;
        }
        let place = |(k, &row): (usize, &u32)| (now[row as usize - rows.start], k as u32);
        let mut places: Vec<(u32, u32)> = at_start.iter().enumerate().map(place).collect();
        places.sort_unstable();
        Ok(places)
    }

    /// Whether particles of a body are in these rows that stood in those at the start.
    ///
    /// # Errors
    /// The phase has no particle ids.
    pub fn are_in(
        &self,
        body: BodyId,
        mut rows: impl Iterator<Item = (u32, u32)>,
    ) -> Result<bool, MissingColumn> {
        let first = self.first_id(body);
        let ids = self.body_view(body).0.read::<ParticleId>()?;
        Ok(rows.all(|(now, at_start)| ids[now as usize].0 == first + u64::from(at_start)))
    }

    /// Id of the particle that stood in the first row of the phase of a body: ids are counted through phases
    /// and rows.
    fn first_id(&self, body: BodyId) -> u64 {
        let phase = self.body(body).phase.0;
        self.phases().take(phase).map(|phase| self.phase(phase).len() as u64).sum()
    }
}
