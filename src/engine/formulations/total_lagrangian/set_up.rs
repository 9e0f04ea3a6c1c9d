//! Set-up before the first step: support radii, bonds, ghosts, and the packed rows.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::phase::PackedRows;
use crate::formulations::bonded::{
    BodyBonds, BodySetUp, Bonds, Cracks, HeldParticles, HessianRows, PackedParticle, choose_support, held_of,
};
use crate::neighbors::NeighborSearch;
use crate::plugin::{Setup, SetupError, SimBuilder};
use crate::ranks::Halo;
use crate::removal::LeavingParticles;
use crate::solids::CorrectedStress;
use crate::symmetry::Ghosts;
use crate::world::{
    BodyId, DeformationGradient, MissingColumn, PhaseId, ReferencePosition, ReferenceVolume, SupportRadius,
    World,
};

/// The bodies of a phase before the first step.
pub(super) struct SetUp {
    phase: PhaseId,
    bodies: Vec<BodySetUp>,
    held: HeldParticles,
}

/// Columns of the reference configuration, of the whole phase.
#[derive(Clone, Copy)]
struct ReferenceColumns<'a> {
    /// Positions, m.
    position: &'a [DVec3],
    /// Volumes, m3.
    volume: &'a [f64],
    /// Support radii, m.
    support: &'a [f64],
}

fn missing(error: MissingColumn) -> SetupError {
    SetupError::internal(&error)
}

impl SetUp {
    /// That of the bodies of a phase.
    pub fn of(phase: PhaseId, bodies: Vec<BodySetUp>, sim: &SimBuilder<'_>) -> Self {
        let held = held_of(&bodies, sim);
        Self { phase, bodies, held }
    }

    /// Makes the packed rows of the phase.
    pub fn run(self, setup: &mut Setup<'_>) -> Result<(), SetupError> {
        setup.warnings.extend(self.held.warnings.iter().cloned());
        self.fill_columns(setup.world)?;
        let phase = self.phase;
        let view = setup.world.phase(self.phase);
        let position = view.read::<ReferencePosition>().map_err(missing)?;
        let volume = view.read::<ReferenceVolume>().map_err(missing)?;
        let support = view.read::<SupportRadius>().map_err(missing)?;
        let reference = ReferenceColumns {
            position: bytemuck::cast_slice(&position),
            volume: bytemuck::cast_slice(&volume),
            support: bytemuck::cast_slice(&support),
        };
        let packed = self.pack(reference, setup)?;
        setup.resources.insert_solid(phase, packed);
        setup.resources.insert_of(phase, LeavingParticles::default());
        Ok(())
    }

    /// Fills deformation gradients and support radii.
    fn fill_columns(&self, world: &World) -> Result<(), SetupError> {
        let view = world.phase(self.phase);
        let reference = view.read::<ReferencePosition>().map_err(missing)?;
        let mut support = view.write::<SupportRadius>().map_err(missing)?;
        let mut gradient = view.write::<DeformationGradient>().map_err(missing)?;
        gradient.fill(DeformationGradient(DMat3::IDENTITY));
        for body in &self.bodies {
            let rows = world.body(body.id).rows.clone();
            let support = &mut support[rows.clone()];
            match body.neighbors {
                None => support.fill(SupportRadius(body.support)),
                Some(neighbors) => {
                    let position = bytemuck::cast_slice(&reference[rows]);
                    let support = bytemuck::cast_slice_mut(support);
                    choose_support(position, body.support, neighbors as usize, support)
                        .map_err(|error| SetupError::internal(&error))?;
                }
            }
        }
        Ok(())
    }

    fn pack(self, reference: ReferenceColumns<'_>, setup: &mut Setup<'_>) -> Result<PackedRows, SetupError> {
        let dimension = setup.world.dimension().count();
        let count = reference.position.len();
        let mut bonds = Bonds::default();
        let mut ghosts = Ghosts::new(count);
        let mut search = NeighborSearch::default();
        let mut stable_step = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let rows = setup.world.body(body.id).rows.clone();
            let ghost_rows = ghosts.add(rows.clone(), reference.position, body.support, &body.repeats);
            let own = BodyBonds {
                rows: rows.clone(),
                position: reference.position,
                volume: reference.volume,
                support: reference.support,
                kernel: body.kernel(dimension).kernel,
                ghosts: &ghosts,
                ghost_rows,
                hidden: self.held.hidden_of(body.id),
            };
            bonds.append(&own, &mut search).map_err(|error| {
                let help = "use a larger `support`, or more particles across the body";
                SetupError::parameter(format!("bodies[{}].formulation", body.id.0), error.to_string(), help)
            })?;
            self.warn_of_free(body.id, &rows, &bonds, setup);
            stable_step.push(bonds.stable_step(rows, dimension, &body.estimate, reference.support, None));
        }
        bonds.carried = self.held.carried;
        let origin = middle(reference.position);
        let mut sites = vec![PackedParticle::default(); count + ghosts.len()];
        for (site, (x, v)) in sites.iter_mut().zip(reference.position.iter().zip(reference.volume)) {
            *site = PackedParticle::new(*x - origin, DVec3::ZERO, *v);
        }
        let terms = self.bodies.iter().map(|body| (setup.world.body(body.id).rows.clone(), body.hessian));
        let mut hessian = HessianRows::new(terms);
        hessian.resize(count, ghosts.len());
        let mut packed = PackedRows {
            stresses: vec![CorrectedStress::default(); sites.len()],
            bonds,
            ghosts,
            origin,
            sites,
            self_force: vec![DVec3::ZERO; count],
            frames: Vec::with_capacity(self.bodies.len()),
            cracks: Cracks::default(),
            halo: Halo::default(),
            has_places: false,
            hessian,
            kernels: self.bodies.iter().map(|body| body.kernel(dimension)).collect(),
            stable_step,
        };
        packed.fill_ghost_sites();
        Ok(packed)
    }

    /// Tells of particles that carry no stress, other than those that no one sees.
    fn warn_of_free(&self, id: BodyId, rows: &Range<usize>, bonds: &Bonds, setup: &mut Setup<'_>) {
        let hidden = self.held.hidden_of(id).len();
        let free = bonds.free.iter().filter(|&&row| rows.contains(&(row as usize))).count() - hidden;
        if free > 0 {
            let name = &setup.world.body(id).name;
            let text =
                format!("{free} particles of body `{name}` have too few neighbours and carry no stress");
            setup.warnings.push(text);
        }
    }
}

/// The middle of the box around some points.
fn middle(points: &[DVec3]) -> DVec3 {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.iter().fold(start, |(low, high), &x| (low.min(x), high.max(x)));
    0.5 * (low + high)
}
