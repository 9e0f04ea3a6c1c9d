//! The packed rows of the phase.

use glam::{DMat3, DVec3};

use super::control_rows::{BodyControl, Carried, EulerianControlRows};
use super::divergence::Divergence;
use super::lists::EulerianLists;
use super::near::EulerianNeighbors;
use super::particle::EulerianParticle;
use super::supports::{SupportMetric, Supports};
use crate::kernels::Kernel;
use crate::parallel::{Lanes4, for_each_block};
use crate::solids::CorrectedStress;
use crate::symmetry::Ghost;
use crate::world::{Damage, DeformationGradient, Position, ReferenceVolume, Velocity};

/// Kernel and options of the sums of a body.
#[derive(Clone, Copy)]
pub(super) struct EulerianKernel {
    pub kernel: Kernel,
    pub divergence: Divergence,
    /// Hourglass control along pairs.
    pub control: Option<BodyControl>,
}

/// Shared data of the systems of the formulation.
pub(super) struct EulerianRows {
    pub lists: EulerianLists,
    /// Of every body, as in the lists.
    pub kernels: Vec<EulerianKernel>,
    pub points: Vec<EulerianParticle>,
    pub supports: Supports,
    /// X, for comparisons with the initial configuration, and data for the control along pairs.
    pub carried: Vec<Carried>,
    pub near: EulerianNeighbors,
    /// F of the real rows.
    pub deformation: Vec<DMat3>,
    /// Corrected stress tau M^-1, and in the last lane of its traction its weight, the volume V_0.
    pub stresses: Vec<CorrectedStress>,
    /// Results of the control along pairs.
    pub control: EulerianControlRows,
    /// Current stable step of each body, s.
    pub stable_step: Vec<f64>,
    /// Of every row: whether it is inside of its body in the reference configuration.
    pub inside: Vec<bool>,
    /// Plane strain.
    pub plane: bool,
}

/// Columns that points are packed from.
pub(super) struct PointColumns<'a> {
    pub position: &'a [Position],
    pub velocity: &'a [Velocity],
    pub volume: &'a [ReferenceVolume],
    pub deformation: &'a [DeformationGradient],
}

impl EulerianRows {
    /// Brings the lists up to date, with capacity for all that depends on them. Positions and reference
    /// positions, m, and the velocities, m/s, that have moved the particles for `dt`, s.
    pub fn update_lists(
        &mut self,
        position: &[DVec3],
        reference: &[DVec3],
        (velocity, dt): (&[DVec3], f64),
    ) -> Result<(), (crate::world::BodyId, crate::neighbors::NeighborError)> {
        if self.lists.update(position, velocity, dt)? {
            let pairs = self.lists.pairs.pairs();
            self.near.neighbors.resize(pairs, 0);
            self.near.weights.resize(pairs, 0.0);
            self.near.curvatures.resize(pairs, 0.0);
            let all = position.len() + self.lists.ghosts.len();
            self.points.resize(all, EulerianParticle::default());
            self.stresses.resize(all, CorrectedStress::default());
            self.carried.resize(all, Carried::default());
            self.control.resize(position.len());
            for (carried, x) in self.carried.iter_mut().zip(reference) {
                carried.original = Lanes4::new(*x, 0.0);
            }
            self.fill_ghost_carried();
            self.supports.fill(&self.lists.ghosts);
        }
        Ok(())
    }

    /// Takes over the supports of the column.
    pub fn load_supports(&mut self, metric: &[SupportMetric]) {
        self.supports.load(metric, &mut self.lists.bodies, &self.lists.ghosts);
    }

    /// Puts other supports into the column where they are due, and says whether they are: they act from the
    /// stress on, and the lists have to be made anew before.
    pub fn renew_supports(
        &mut self,
        metric: &mut [SupportMetric],
        deformation: &[DeformationGradient],
        damage: Option<&[Damage]>,
    ) -> bool {
        let is_renewed = self.supports.renew(&mut self.lists.bodies, metric, deformation, damage);
        if is_renewed {
            self.lists.forget();
        }
        is_renewed
    }

    /// Packs the particles where they were `back` seconds ago, ghosts too; the rows that are `gone` have no
    /// volume.
    pub fn pack(&mut self, columns: &PointColumns<'_>, back: f64, gone: impl Iterator<Item = usize>) {
        let n = columns.position.len();
        let PointColumns { position, velocity, volume, deformation } = *columns;
        let rows = (&mut self.points[..n], position, velocity, volume, deformation);
        type Rows<'a> = (
            &'a mut [EulerianParticle],
            &'a [Position],
            &'a [Velocity],
            &'a [ReferenceVolume],
            &'a [DeformationGradient],
        );
        for_each_block(rows, &mut Vec::new(), &|_, (points, x, v, volume, f): Rows<'_>| {
            for (k, point) in points.iter_mut().enumerate() {
                *point = EulerianParticle {
                    place: Lanes4::new(x[k].0 - back * v[k].0, volume[k].0),
                    velocity: Lanes4::new(v[k].0, volume[k].0 * f[k].0.determinant()),
                };
            }
        });
        gone.for_each(|row| self.points[row].place.0[3] = 0.0);
        self.lists.ghosts.fill(&mut self.points, |ghost, point: &EulerianParticle| point.image(ghost.map));
    }

    /// Copies the initial data to the ghosts.
    pub fn fill_ghost_carried(&mut self) {
        self.lists.ghosts.fill(&mut self.carried, |ghost: Ghost<'_>, own: &Carried| own.image(ghost.map));
    }

    /// Copies the corrected stresses to the ghosts.
    pub fn fill_ghost_stresses(&mut self) {
        self.lists.ghosts.fill(&mut self.stresses, |ghost, own: &CorrectedStress| {
            let mut stress = own.image(ghost.map);
            stress.traction = own.traction;
            stress
        });
    }
}
