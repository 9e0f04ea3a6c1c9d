//! The packed rows, filled from the columns in every step.

use glam::DVec3;

use super::columns::UpdatedReference;
use super::phase::UpdatedRows;
use crate::formulations::bonded::PackedParticle;
use crate::parallel::for_each_block;
use crate::symmetry::Ghost;
use crate::world::{MissingColumn, PhaseId, Position, ReferencePosition, World};

impl UpdatedRows {
    /// Fills the sites of the reference.
    pub fn pack_reference(&mut self, world: &World, phase: PhaseId) -> Result<(), MissingColumn> {
        let view = world.phase(phase);
        let position = view.read_near::<Position>()?;
        let reference = view.read_near::<UpdatedReference>()?;
        let Self { sites, volume, origin, ghosts, .. } = self;
        let (count, origin) = (view.len(), *origin);
        let (position, reference, volume) = (&position[..], &reference[..], &volume[..]);
        for_each_block(&mut sites[..count], &mut Vec::new(), &|first, sites: &mut [PackedParticle]| {
            for (k, site) in sites.iter_mut().enumerate() {
                let row = first + k;
                let (x, r) = (position[row].0, reference[row].0);
                *site = PackedParticle::new(r - origin, x - r, volume[row]);
            }
        });
        ghosts.fill(sites, image(origin));
        Ok(())
    }

    /// Fills the sites of the start, where they are others.
    pub fn pack_original(&mut self, world: &World, phase: PhaseId) -> Result<(), MissingColumn> {
        if !self.has_followed() {
            return Ok(());
        }
        let view = world.phase(phase);
        let position = view.read_near::<Position>()?;
        let original = view.read_near::<ReferencePosition>()?;
        let needs_pair_sites = self.needs_pair_sites();
        let Self { pair_sites, control, volume, ghosts, .. } = self;
        let (position, original) = (&position[..], &original[..]);
        let fill = |sites: &mut [PackedParticle], origin, volume: &[f64]| {
            for_each_block(
                &mut sites[..volume.len()],
                &mut Vec::new(),
                &|first, sites: &mut [PackedParticle]| {
                    for (k, site) in sites.iter_mut().enumerate() {
                        let row = first + k;
                        let (x, start) = (position[row].0, original[row].0);
                        *site = PackedParticle::new(start - origin, x - start, volume[row]);
                    }
                },
            );
            ghosts.fill(sites, image(origin));
        };
        if needs_pair_sites {
            fill(pair_sites, DVec3::ZERO, volume);
        }
        if control.has_sums() {
            fill(&mut control.sites, control.origin, &control.volume);
        }
        Ok(())
    }
}

/// The image of the site of a source, measured from `origin`, m.
fn image(origin: DVec3) -> impl Fn(Ghost<'_>, &PackedParticle) -> PackedParticle + Sync {
    move |ghost, site| {
        let reference = ghost.map.place(site.reference.xyz() + origin) - origin;
        PackedParticle::new(reference, ghost.map.vector(site.displacement.xyz()), site.reference.0[3])
    }
}
