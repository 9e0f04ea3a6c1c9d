//! A block of particles from the deformation gradient to the stress and its energies, while it is in cache.

use std::cell::RefCell;

use bytemuck::{Pod, Zeroable};
use glam::DMat3;

use super::corrected_stress::{CorrectedStress, CorrectedStressRows};
use super::damping::{DampedStrain, Damping, DampingRows, DampingStress};
use super::folded::{FoldedEnergy, FoldedMemory, FoldedRows, FoldedTerm};
use super::refit::{self, Refits};
use crate::materials::{SolidLaw, StateRows, StressRows};
use crate::parallel::{BLOCK, BlockSum, split_by_rows};
use crate::world::{
    DeformationGradient, HourglassGradient, HourglassModulus, HourglassResidual, MissingColumn, PhaseView,
    PiolaStress,
};

/// Message of an inverted particle, and advice.
pub(super) const CRUSHED: [&str; 2] = [
    "negative volume (det F <= 0)",
    ": its material cannot bear what presses or twists it there. Debris that a fluid or a tool crushes is taken out by \
    `remove_fragments()` in the plugins of the body; a body that is to stay needs a stiffer material, a smaller load, or a finer spacing",
];

/// Largest number of folded terms on one body.
pub(super) const MAX_TERMS: usize = 4;

/// Sums of the pass over a body.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct SolidSum {
    /// Strain energy, J.
    pub strain: f64,
    /// Plastic work of the step, J.
    pub plastic_work: f64,
    /// Energy dissipated by damping in the step, J.
    pub damped: f64,
    /// Energy of each folded term, J.
    pub terms: [FoldedEnergy; MAX_TERMS],
    /// Energy of the difference of Laplacians, J.
    pub hessian: FoldedEnergy,
    /// Energy of the control along pairs, J.
    pub control: FoldedEnergy,
    /// Row with det F <= 0 that comes first of those that resist, counted from one; zero if there is none.
    pub inverted: usize,
}

impl SolidSum {
    /// Sum of the energies of stress, folded terms, the difference of Laplacians and the control along pairs,
    /// J.
    pub fn stored(&self) -> f64 {
        let terms = self.terms.iter().chain([&self.hessian, &self.control]);
        self.strain + terms.map(|term| term.stored).sum::<f64>()
    }

    /// Adds the energies of a block, and checks for inverted particles.
    pub fn close(&mut self, rows: &SolidRows<'_>, block: &SolidBlock) {
        let n = rows.deformation.len();
        for k in 0..n {
            self.strain += block.energy[k] * block.volume[k];
            self.plastic_work += block.plastic_work[k] * block.volume[k];
        }
        // What resists nothing, because it has failed, may invert.
        let mut resisting = rows.deformation.iter().zip(&block.modulus[..n]);
        let inverted = resisting.position(|(f, modulus)| f.determinant() <= 0.0 && *modulus != 0.0);
        self.inverted = inverted.map_or(0, |k| block.first + k + 1);
    }
}

impl BlockSum for SolidSum {
    fn add(&mut self, next: &Self) {
        self.strain += next.strain;
        self.plastic_work += next.plastic_work;
        self.damped += next.damped;
        for (sum, next) in self.terms.iter_mut().zip(&next.terms) {
            sum.add(next);
        }
        self.hessian.add(&next.hessian);
        self.control.add(&next.control);
        if self.inverted == 0 {
            self.inverted = next.inverted;
        }
    }
}

/// The columns of a phase that the pass writes, borrowed.
pub struct SolidColumns<'a> {
    /// Deformation gradient F.
    pub deformation: hecs::ArchetypeColumnMut<'a, DeformationGradient>,
    /// First Piola-Kirchhoff stress P.
    pub stress: hecs::ArchetypeColumnMut<'a, PiolaStress>,
    modulus: Option<hecs::ArchetypeColumnMut<'a, HourglassModulus>>,
    residual: Option<hecs::ArchetypeColumnMut<'a, HourglassResidual>>,
    gradient: Option<hecs::ArchetypeColumnMut<'a, HourglassGradient>>,
    strain: Option<hecs::ArchetypeColumnMut<'a, DampedStrain>>,
    damping: Option<hecs::ArchetypeColumnMut<'a, DampingStress>>,
    /// Whether the pass is divided among ranks.
    pub(super) is_divided: bool,
}

impl<'a> SolidColumns<'a> {
    /// Those of a phase.
    ///
    /// # Errors
    /// The formulation has not declared deformation gradient and stress.
    pub fn of(view: &PhaseView<'a>) -> Result<Self, MissingColumn> {
        Ok(Self {
            deformation: view.write()?,
            stress: view.write()?,
            modulus: view.write().ok(),
            residual: view.write().ok(),
            gradient: view.write().ok(),
            strain: view.write().ok(),
            damping: view.write().ok(),
            is_divided: false,
        })
    }

    /// Those of a phase whose pass is divided among ranks: each computes its own rows, and the formulation
    /// exchanges the other results.
    ///
    /// # Errors
    /// The formulation has not declared deformation gradient and stress.
    pub fn own(view: &PhaseView<'a>) -> Result<Self, MissingColumn> {
        Ok(Self {
            deformation: view.write_own()?,
            stress: view.write_own()?,
            modulus: view.write_own().ok(),
            residual: view.write_own().ok(),
            gradient: view.write_own().ok(),
            strain: view.write_own().ok(),
            damping: view.write_own().ok(),
            is_divided: true,
        })
    }

    /// The rows of a body, with its state.
    pub(super) fn rows<'r>(
        &'r mut self,
        rows: &std::ops::Range<usize>,
        state: StateRows<'r>,
        is_damped: bool,
    ) -> SolidRows<'r> {
        SolidRows {
            deformation: bytemuck::cast_slice_mut(&mut self.deformation[rows.clone()]),
            stress: bytemuck::cast_slice_mut(&mut self.stress[rows.clone()]),
            state,
            memory: FoldedMemory {
                modulus: self.modulus.as_deref_mut().map_or(&mut [], |all| rows_of(all, rows)),
                residual: self.residual.as_deref_mut().map_or(&mut [], |all| rows_of(all, rows)),
                gradient: self.gradient.as_deref_mut().map_or(&mut [], |all| rows_of(all, rows)),
            },
            damping: match (&mut self.strain, &mut self.damping) {
                (Some(strain), Some(damping)) if is_damped => {
                    DampingRows { strain: rows_of(strain, rows), stress: rows_of(damping, rows) }
                }
                _ => DampingRows::default(),
            },
        }
    }
}

/// The rows of a body in a column.
fn rows_of<'a, C: crate::world::Column>(
    column: &'a mut [C],
    rows: &std::ops::Range<usize>,
) -> &'a mut [C::Value] {
    bytemuck::cast_slice_mut(&mut column[rows.clone()])
}

/// Rows of one body that the pass writes.
pub struct SolidRows<'a> {
    /// Deformation gradient F, to be written by the formulation.
    pub deformation: &'a mut [DMat3],
    /// First Piola-Kirchhoff stress P: that of the last step until the law has been called.
    pub stress: &'a mut [DMat3],
    state: StateRows<'a>,
    memory: FoldedMemory<'a>,
    damping: DampingRows<'a>,
}

split_by_rows!(SolidRows { deformation, stress, state, memory, damping });

/// Data of a block of particles in the course of the pass. The formulation fills gradient,
/// residual and volume.
pub struct SolidBlock {
    /// Row of its first particle in the phase.
    pub first: usize,
    /// Displacement gradient H = F - I, with all digits of a small strain.
    pub gradient: [DMat3; BLOCK],
    /// Hourglass residual, `sum_j V_j w_ij |F_i X_ij - x_ij|^2`, m2 times the unit of V w.
    pub residual: [f64; BLOCK],
    /// Reference volume V_0, m3.
    pub volume: [f64; BLOCK],
    /// Strain energy per reference volume, J/m3.
    energy: [f64; BLOCK],
    /// Current Young's modulus, Pa.
    modulus: [f64; BLOCK],
    strength: [f64; BLOCK],
    /// Share of its stress that a particle carries.
    share: [f64; BLOCK],
    /// Plastic work of the step per reference volume, J/m3.
    plastic_work: [f64; BLOCK],
    /// Stress at the end of the last step, Pa; after the law, the one that enters the force where there is
    /// damping.
    stress: [DMat3; BLOCK],
}

thread_local! {
    /// The block that this thread works on: it stays in the first-level cache, and no block is cleared or
    /// copied.
    static SCRATCH: RefCell<SolidBlock> = const {
        RefCell::new(SolidBlock {
            first: 0,
            gradient: [DMat3::ZERO; BLOCK],
            residual: [0.0; BLOCK],
            volume: [0.0; BLOCK],
            energy: [0.0; BLOCK],
            modulus: [0.0; BLOCK],
            strength: [0.0; BLOCK],
            share: [1.0; BLOCK],
            plastic_work: [0.0; BLOCK],
            stress: [DMat3::ZERO; BLOCK],
        })
    };
}

/// Share of the pressure in [`SolidBlock::brace`]. Behind a shock of 6 GPa in a relaxed lattice the stress is
/// 6.3 % too small without it, 3.0, 1.7, 1.0 and 0.4 % with 0.1, 0.2, 0.35 and 1; Taylor bars of copper,
/// where the pressure is some times the flow stress, are narrower at their foot by 0.0, 0.2, 0.7 and 2.4 %.
const BRACE: f64 = 0.2;

impl SolidBlock {
    /// Takes the share of its stress that each particle carries; returns whether all carry all of it. Beside
    /// the plane of a clamp the fit of what carries nothing may invert, where laws have no meaning.
    fn take_shares(&mut self, deformation: &mut [DMat3], carried: impl Fn(usize) -> f64) -> bool {
        let mut is_whole = true;
        for (k, (share, f)) in self.share.iter_mut().zip(deformation).enumerate() {
            *share = carried(k);
            is_whole &= *share == 1.0;
            if *share == 0.0 && f.determinant() <= 0.0 {
                *f = DMat3::IDENTITY;
            }
        }
        is_whole
    }

    /// Multiplies energy and modulus by the share that a particle carries; with the full values the rest
    /// would resist rotation.
    fn carry(&mut self, k: usize) {
        let share = self.share[k];
        self.energy[k] *= share;
        self.modulus[k] *= share;
        self.plastic_work[k] *= share;
        if self.strength[k].is_finite() {
            self.strength[k] *= share;
        }
    }

    /// Raises the resistance of particles that have yielded to a share of the pressure that they are under.
    /// On a lattice whose moments are not even, a uniform pressure leaves a force of some hundredths of it on
    /// each particle, and in metal that flows nothing but stabilizers holds that force: with the flow stress
    /// alone, particles move sideways behind strong shocks until the pressure is gone. With spherical
    /// supports in the present configuration a viscous control holds them.
    pub fn brace(&mut self, rows: &SolidRows<'_>) {
        let given = rows.deformation.iter().zip(&*rows.stress).zip(&self.share);
        for (strength, ((f, stress), share)) in self.strength.iter_mut().zip(given) {
            if strength.is_finite() {
                let kirchhoff =
                    stress.x_axis.dot(f.x_axis) + stress.y_axis.dot(f.y_axis) + stress.z_axis.dot(f.z_axis);
                let pressure = -kirchhoff / (3.0 * f.determinant());
                *strength = strength.max(BRACE * share * pressure);
            }
        }
    }

    /// Lends the block of this thread, with the contents of the last use, for the rows from `first` on.
    #[inline]
    pub(super) fn with<R>(first: usize, work: impl FnOnce(&mut Self) -> R) -> R {
        SCRATCH.with_borrow_mut(|block| {
            block.first = first;
            work(block)
        })
    }
}

/// The law of a body and what goes with it in this step.
pub struct Constitutive<'a> {
    pub(super) law: &'a dyn SolidLaw,
    /// Folded terms of plugins.
    pub terms: &'a [&'a dyn FoldedTerm],
    /// Corrections that keep F continuous when neighbours are lost.
    pub(super) refits: Option<&'a Refits>,
    /// Length of the step, s; zero before the first.
    pub dt: f64,
    /// Share of the damping of sub-steps; zero where the step is none.
    pub(super) damping: f64,
}

impl Constitutive<'_> {
    /// Computes the stress of a block whose deformation gradient is there, and calls `make` with the stress
    /// that enters the force: that of the law with that of damping. The share that a particle carries of its
    /// force, energy and heat is `carried`: usually 1; zero for a particle without a deformation gradient,
    /// for lack of neighbours; different beside supports.
    pub fn stress(
        &self,
        rows: &mut SolidRows<'_>,
        block: &mut SolidBlock,
        carried: impl Fn(usize) -> f64,
        sum: &mut SolidSum,
        make: impl FnOnce(&[DMat3]),
    ) {
        let (n, first) = (rows.deformation.len(), block.first);
        let refits = self.refits.map_or(&[][..], |refits| refits.of_block(first, n));
        refit::to_law(refits, first, rows.deformation, rows.stress);
        let before = if self.law.reads_last_stress() { n } else { 0 };
        block.stress[..before].copy_from_slice(&rows.stress[..before]);
        block.strength[..n].fill(f64::INFINITY);
        block.plastic_work[..n].fill(0.0);
        let is_whole = block.take_shares(rows.deformation, carried);
        self.law.stress(&mut StressRows {
            dt: self.dt,
            deformation: rows.deformation,
            share: &block.share[..n],
            stress_before: &block.stress[..before],
            stress: rows.stress,
            energy: &mut block.energy[..n],
            modulus: &mut block.modulus[..n],
            strength: &mut block.strength[..n],
            plastic_work: &mut block.plastic_work[..n],
            state: std::mem::take(&mut rows.state),
        });
        let gradient = &block.gradient;
        let fitted = |k: usize| DMat3::IDENTITY + gradient[k];
        refit::from_law(refits, first, fitted, rows.deformation, rows.stress);
        if !is_whole {
            (0..n).for_each(|k| block.carry(k));
        }
        if rows.damping.strain.is_empty() && is_whole {
            make(rows.stress);
        } else {
            for ((made, stress), share) in block.stress.iter_mut().zip(&*rows.stress).zip(&block.share) {
                *made = *stress * *share;
            }
            let damping = Damping {
                elastic: self.law.elastic(),
                dt: self.dt,
                share: self.damping,
                deformation: rows.deformation,
                gradient: &block.gradient[..n],
                modulus: &block.modulus[..n],
                volume: &block.volume[..n],
            };
            if !rows.damping.strain.is_empty() {
                sum.damped = damping.add(std::mem::take(&mut rows.damping), &mut block.stress[..n]);
            }
            make(&block.stress[..n]);
        }
        refit::to_column(refits, first, rows.stress);
    }

    /// The rows that folded terms add to; `stress` is the corrected stress of the formulation.
    pub fn folded<'b>(
        &self,
        rows: &'b mut SolidRows<'_>,
        block: &'b SolidBlock,
        stress: &'b mut [CorrectedStress],
    ) -> FoldedRows<'b> {
        let n = rows.deformation.len();
        FoldedRows {
            deformation: rows.deformation,
            displacement_gradient: &block.gradient[..n],
            modulus: &block.modulus[..n],
            strength: &block.strength[..n],
            memory: rows.memory.part(0..n),
            residual: &block.residual[..n],
            volume: &block.volume[..n],
            stress: CorrectedStressRows(stress),
        }
    }

    /// Adds all folded terms to rows, and their energies to the sum.
    pub fn fold(&self, rows: &mut FoldedRows<'_>, sum: &mut SolidSum) {
        for (sum, term) in sum.terms.iter_mut().zip(self.terms) {
            let energy = term.add(rows);
            sum.stored += energy.stored;
            sum.released += energy.released;
        }
    }
}
