//! Rows shared by the passes of the stabilization.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::super::bonds::Bonds;
use super::super::rows::PackedParticle;
use super::vidal_2007::{VidalDifference, VidalRows};
use crate::parallel::{run_hot, share_rows, split_by_rows};
use crate::solids::{CorrectedStress, FoldedRows, HessianDifference, HessianForm};
use crate::symmetry::Ghosts;

/// A body with the stabilization.
#[derive(Clone, Debug)]
pub(in crate::formulations) struct HessianBody {
    /// Number of the body in its formulation.
    pub body: usize,
    pub rows: Range<usize>,
    pub term: HessianDifference,
}

/// The packed rows of the stabilization; empty where no body of the phase has it.
#[derive(Default)]
pub(in crate::formulations) struct HessianRows {
    pub bodies: Vec<HessianBody>,
    /// Gradient of the displacements since the reference, Q - I, of all rows.
    pub gradient: Vec<DMat3>,
    /// Stiffness of the frame-indifferent form, J.
    pub stiffness: Vec<f64>,
    /// Records of the gradients for neighbours, of all rows.
    pub slopes: Vec<CorrectedStress>,
    /// Places of all rows, with the force per volume squared and weight that acts along their bonds.
    pub bond_forces: Vec<PackedParticle>,
    /// Of all rows, whether their motion says nothing; empty where that of all does.
    pub loose: Vec<bool>,
    /// Additional rows for the form of the paper.
    pub vidal: VidalRows,
    /// Theta_i of the form of the paper, of all rows, Pa.
    pub stress: Vec<DMat3>,
    /// Whether the reference is a new one.
    pub is_stale: bool,
}

impl HessianRows {
    /// Rows for these bodies: the rows of each and its stabilization, if it has one.
    pub fn new(bodies: impl Iterator<Item = (Range<usize>, Option<HessianDifference>)>) -> Self {
        let own = bodies
            .enumerate()
            .filter_map(|(body, (rows, term))| Some(HessianBody { body, rows, term: term? }));
        Self { bodies: own.collect(), ..Self::default() }
    }

    /// The bodies with that form.
    pub fn with_form(&self, form: HessianForm) -> impl Iterator<Item = &HessianBody> {
        self.bodies.iter().filter(move |body| body.term.form == form)
    }

    /// Whether a body has the stabilization in that form.
    pub fn has(&self, form: HessianForm) -> bool {
        self.with_form(form).next().is_some()
    }

    /// Allocates memory for real rows and ghosts.
    pub fn resize(&mut self, rows: usize, ghosts: usize) {
        if self.bodies.is_empty() {
            return;
        }
        self.is_stale = true;
        self.gradient.resize(rows + ghosts, DMat3::ZERO);
        self.stiffness.resize(rows, 0.0);
        if self.has(HessianForm::FrameIndifferent) {
            self.slopes.resize(rows + ghosts, CorrectedStress::default());
            self.bond_forces.resize(rows + ghosts, PackedParticle::default());
            self.loose.reserve(rows + ghosts);
        }
        if self.has(HessianForm::Vidal2007) {
            self.stress.resize(rows + ghosts, DMat3::ZERO);
        }
    }

    /// The rows of a body that the first pass writes, empty where they have no use.
    pub fn block(&mut self, body: usize, rows: &Range<usize>) -> HessianBlock<'_> {
        let Some(own) = self.bodies.iter().find(|own| own.body == body) else { return Default::default() };
        let HessianDifference { eta, form } = own.term;
        match form {
            HessianForm::FrameIndifferent => HessianBlock {
                eta,
                gradient: &mut self.gradient[rows.clone()],
                stiffness: &mut self.stiffness[rows.clone()],
                ..HessianBlock::default()
            },
            HessianForm::Vidal2007 => HessianBlock {
                eta,
                stress: &mut self.stress[rows.clone()],
                fitted: &self.gradient,
                vidal: Some(&self.vidal),
                ..HessianBlock::default()
            },
        }
    }

    /// Exchanges the rows of the first pass that neighbours read among ranks.
    pub fn share(&mut self) {
        for HessianBody { rows, term, .. } in &self.bodies {
            match term.form {
                HessianForm::FrameIndifferent => share_rows(&mut self.gradient[rows.clone()]),
                HessianForm::Vidal2007 => share_rows(&mut self.stress[rows.clone()]),
            }
        }
    }

    /// Copies gradients to the ghosts.
    pub fn fill_ghost_gradients(&mut self, ghosts: &Ghosts) {
        ghosts.fill(&mut self.gradient, |ghost, h| ghost.map.tensor(*h));
    }

    /// The force along its bonds of a row, over volume squared and weight; zero where there is none.
    #[inline]
    pub fn bond_force_of(&self, row: usize) -> DVec3 {
        self.bond_forces.get(row).map_or(DVec3::ZERO, |site| site.displacement.xyz())
    }
}

/// Bonds, and what lies at their ends.
#[derive(Clone, Copy)]
pub(in crate::formulations) struct BondedSites<'a> {
    pub bonds: &'a Bonds,
    pub ghosts: &'a Ghosts,
    pub sites: &'a [PackedParticle],
}

/// Rows that the first pass reads and writes of a block.
#[derive(Default)]
pub(in crate::formulations) struct HessianBlock<'a> {
    eta: f64,
    gradient: &'a mut [DMat3],
    stiffness: &'a mut [f64],
    stress: &'a mut [DMat3],
    fitted: &'a [DMat3],
    vidal: Option<&'a VidalRows>,
}

split_by_rows!(HessianBlock { gradient, stiffness, stress } and { eta, fitted, vidal });

impl HessianBlock<'_> {
    /// Takes the gradients of the displacements since the reference, Q - I, of the block that begins at row
    /// `first`; the form of the paper adds its difference to them.
    pub fn after_fit(
        &mut self,
        bonds: &Bonds,
        sites: &[PackedParticle],
        first: usize,
        gradient: &mut [DMat3],
    ) {
        self.take_gradient(gradient);
        if let Some(vidal) = self.vidal {
            let (rows, eta) = (vidal, self.eta);
            run_hot(VidalDifference {
                rows,
                bonds,
                sites,
                gradient: self.fitted,
                eta,
                first,
                block: gradient,
            });
        }
    }

    /// Takes the gradients that the frame-indifferent form compares.
    pub fn take_gradient(&mut self, gradient: &[DMat3]) {
        let own = &mut *self.gradient;
        own.copy_from_slice(&gradient[..own.len()]);
    }

    /// Takes the stress seen from the reference.
    pub fn take_stress(&mut self, stress: &[DMat3]) {
        let own = &mut *self.stress;
        own.copy_from_slice(&stress[..own.len()]);
    }

    /// Takes the stiffness after the law, eta^2 E V: after yield, E is the flow stress.
    pub fn take_stiffness(&mut self, rows: &FoldedRows<'_>) {
        for (k, stiffness) in self.stiffness.iter_mut().enumerate() {
            *stiffness = self.eta * self.eta * rows.modulus[k].min(rows.strength[k]) * rows.volume[k];
        }
    }
}
