//! The total-Lagrangian formulation: its parameters, its columns, and its two systems.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::bond_terms::BondTerm;
use super::bonds::{BodyBonds, Bonds};
use super::deformation::{DeformationPass, DeformationRows, DeformationSum, MAX_TERMS};
use super::images::{Images, MirrorPlane, Repeat};
use super::internal_force::InternalForce;
use super::pairs::BondPairs;
use super::repeats::repeats_of;
use super::rows::{PairStress, Site};
use super::stable_step::StepEstimate;
use crate::kernels::{Kernel, KernelName};
use crate::linalg::smallest_and_largest_stretch;
use crate::materials::Material;
use crate::neighbors::NeighborSearch;
use crate::pair::add_pair_systems;
use crate::parallel::for_each_block;
use crate::plugin::{Formulation, Setup, SetupError, SimBuilder};
use crate::scene::Dimension;
use crate::schedule::{AccountKind, Mode, Run, Stage, Step, StepError, System};
use crate::world::{
    BodyId, BodySet, ColumnSet, DeformationGradient, Force, Mass, PhaseId, PiolaStress, Position,
    ReferencePosition, ReferenceVolume, SupportRadius,
};

/// Total-Lagrangian solid: neighbours, weights and corrections stay those of the reference configuration.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TotalLagrangian {
    /// Kernel.
    pub kernel: KernelName,
    /// Support radius over spacing.
    pub support: f64,
}

impl Default for TotalLagrangian {
    fn default() -> Self {
        Self { kernel: KernelName::Spiky, support: 2.41 }
    }
}

/// A bond term with the bodies it acts on; plugins add it with [`SimBuilder::extend`].
pub struct BodyBondTerm {
    /// Bodies.
    pub bodies: BodySet,
    /// Account of the energy ledger that holds what the term stores.
    pub account: String,
    /// The term.
    pub term: Box<dyn BondTerm>,
}

impl SimBuilder<'_> {
    /// Adds a force term that is linear in the pair vectors to total-Lagrangian bodies. The energy that it stores goes
    /// to the account of that name.
    pub fn add_bond_term(&mut self, bodies: BodySet, account: &str, term: impl BondTerm) {
        self.extend(BodyBondTerm { bodies, account: account.to_owned(), term: Box::new(term) });
    }
}

/// Label of the system that makes deformation gradient, stress and pair stress.
pub const DEFORMATION: &str = "total_lagrangian_deformation";
/// Label of the system that makes the internal force.
pub const INTERNAL_FORCE: &str = "total_lagrangian_force";

/// What the two systems share.
pub(super) struct PackedRows {
    pub(super) bonds: Bonds,
    pub(super) images: Images,
    pub(super) sites: Vec<Site>,
    pair_stress: Vec<PairStress>,
    /// Kernel of each body.
    pub(super) kernels: Vec<(BodyId, Kernel)>,
    /// Stable step of each body in its reference configuration, s.
    stable_step: Vec<f64>,
}

/// A body as the deformation system sees it.
struct BodyLaw {
    id: BodyId,
    material: Material,
    estimate: StepEstimate,
    /// Accounts and indices into the list of terms.
    terms: Vec<usize>,
    /// Factor of the stable step by the stretches of the body.
    stretch_factor: f64,
}

impl Formulation for TotalLagrangian {
    const NAME: &'static str = "TotalLagrangian";
    const REFERENCE: &'static str =
        "total-Lagrangian SPH: G. C. Ganzenmueller, Comput. Methods Appl. Mech. Engrg. 286 (2015) 87-106";

    fn columns(columns: &mut ColumnSet) {
        columns.add::<SupportRadius>().add::<DeformationGradient>().add::<PiolaStress>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        for (id, parameters) in &bodies {
            parameters.check(sim.body(*id).spacing)?;
        }
        let phase = sim.body(bodies[0].0).phase;
        super::fields::add(sim);
        let planes: Vec<MirrorPlane> = sim.take_extensions();
        let repeats_of = |(id, parameters): &(BodyId, Self)| {
            let body = sim.body(*id);
            repeats_of(body, parameters.support * body.spacing, &planes, sim)
        };
        let repeats = bodies.iter().map(repeats_of).collect::<Result<Vec<_>, _>>()?;
        let terms: Vec<BodyBondTerm> = sim.take_extensions();
        let laws = bodies.iter().map(|(id, _)| body_law(*id, sim, &terms)).collect::<Result<Vec<_>, _>>()?;
        let estimates: Vec<StepEstimate> = laws.iter().map(|law| law.estimate).collect();
        let plane = sim.dimension() == Dimension::Two;
        sim.add_setup(move |setup| set_up(&bodies, &estimates, &repeats, phase, setup));
        sim.add_system(
            System::new(
                Stage::Constitutive,
                DEFORMATION,
                Deformation { phase, plane, laws, terms, sums: Vec::new() },
            )
            .on_phases([phase])
            .reads::<Position>()
            .reads::<ReferencePosition>()
            .reads::<ReferenceVolume>()
            .writes::<DeformationGradient>()
            .writes::<PiolaStress>(),
        );
        let gravity = sim.gravity();
        sim.add_system(
            System::new(Stage::Rates, INTERNAL_FORCE, move |step: &mut Step<'_>| {
                internal_force(step, phase, gravity, plane)
            })
            .on_phases([phase])
            .reads::<Mass>()
            .touches("pair_stress", Mode::Reads)
            .writes::<Force>(),
        );
        add_pair_systems(sim, phase, INTERNAL_FORCE, BondPairs { phase })
    }
}

impl TotalLagrangian {
    fn check(&self, spacing: f64) -> Result<(), SetupError> {
        let fewest = 1.5;
        if self.support.is_finite() && self.support >= fewest && self.support <= 10.0 {
            return Ok(());
        }
        Err(SetupError::parameter(
            "support",
            format!(
                "a support radius of {} spacings ({} m) does not work",
                self.support,
                self.support * spacing
            ),
            format!("give a support of {fewest} to 10 spacings; 2.41 is usual"),
        ))
    }
}

fn body_law(id: BodyId, sim: &SimBuilder<'_>, all: &[BodyBondTerm]) -> Result<BodyLaw, SetupError> {
    let body = sim.body(id);
    let terms: Vec<usize> = (0..all.len()).filter(|&k| all[k].bodies.contains(id)).collect();
    if terms.len() > MAX_TERMS {
        let message = format!("body `{}` has {} bond terms, more than {MAX_TERMS}", body.name, terms.len());
        return Err(SetupError::parameter("", message, "remove plugins that add bond terms"));
    }
    let material = body.material.clone();
    let elastic = material.law.elastic();
    let factor: f64 = terms.iter().map(|&k| all[k].term.stiffness_factor()).sum();
    let estimate = StepEstimate {
        wave: elastic.longitudinal_modulus() / material.density,
        bond: factor * elastic.young / material.density,
    };
    Ok(BodyLaw { id, material, estimate, terms, stretch_factor: 1.0 })
}

fn set_up(
    bodies: &[(BodyId, TotalLagrangian)],
    estimates: &[StepEstimate],
    repeats: &[Vec<Repeat>],
    phase: PhaseId,
    setup: &mut Setup<'_>,
) -> Result<(), SetupError> {
    let view = setup.world.phase(phase);
    let missing = |error: crate::world::MissingColumn| SetupError::internal(&error);
    let reference = view.read::<ReferencePosition>().map_err(missing)?;
    let volume = view.read::<ReferenceVolume>().map_err(missing)?;
    let mut support = view.write::<SupportRadius>().map_err(missing)?;
    let mut gradient = view.write::<DeformationGradient>().map_err(missing)?;
    gradient.fill(DeformationGradient(glam::DMat3::IDENTITY));
    for (id, parameters) in bodies {
        let body = setup.world.body(*id);
        support[body.rows.clone()].fill(SupportRadius(parameters.support * body.spacing));
    }
    let position: &[DVec3] = bytemuck::cast_slice(&reference);
    let volume: &[f64] = bytemuck::cast_slice(&volume);
    let support: &[f64] = bytemuck::cast_slice(&support);
    let dimension = setup.world.dimension().count();
    let mut bonds = Bonds::default();
    let mut images = Images::new(view.len());
    let mut search = NeighborSearch::default();
    let mut stable_step = Vec::new();
    let mut kernels = Vec::new();
    for (((id, parameters), estimate), repeats) in bodies.iter().zip(estimates).zip(repeats) {
        let body = setup.world.body(*id);
        let Some(kernel) = Kernel::new(parameters.kernel, dimension) else {
            unreachable!("every kernel has a two- and a three-dimensional form");
        };
        kernels.push((*id, kernel));
        let rows = body.rows.clone();
        let image_rows = images.add(rows.clone(), position, parameters.support * body.spacing, repeats);
        let body_bonds =
            BodyBonds { rows: rows.clone(), position, volume, support, kernel, images: &images, image_rows };
        bonds.append(&body_bonds, &mut search).map_err(|error| {
            let help = "use a larger `support`, or more particles across the body";
            SetupError::parameter(format!("bodies[{}].formulation", id.0), error.to_string(), help)
        })?;
        let free = bonds.free.iter().filter(|&&row| rows.contains(&(row as usize))).count();
        if free > 0 {
            let text = format!(
                "{free} particles of body `{}` have too few neighbours and carry no stress",
                body.name
            );
            setup.warnings.push(text);
        }
        stable_step.push(bonds.stable_step(rows, dimension, estimate));
    }
    let sites = vec![Site::default(); view.len() + images.len()];
    let pair_stress = vec![PairStress::default(); view.len() + images.len()];
    setup.resources.insert(PackedRows { bonds, images, sites, pair_stress, kernels, stable_step });
    Ok(())
}

/// Steps between two looks at the stretches: they change slowly against the stable step.
const STRETCH_INTERVAL: u64 = 10;

struct Deformation {
    phase: PhaseId,
    plane: bool,
    laws: Vec<BodyLaw>,
    terms: Vec<BodyBondTerm>,
    sums: Vec<DeformationSum>,
}

impl Run for Deformation {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let mut packed = step.resources.get_mut::<PackedRows>();
        let PackedRows { bonds, images, sites, pair_stress, stable_step, .. } = &mut *packed;
        pack(&view, &mut sites[..view.len()])?;
        images.fill_sites(sites);
        let mut gradient = view.write::<DeformationGradient>()?;
        let mut stress = view.write::<PiolaStress>()?;
        let strain = step.ledger.account("strain", AccountKind::Stored);
        for (law, stable_step) in self.laws.iter_mut().zip(stable_step) {
            let body = step.world.body(law.id);
            let rows = body.rows.clone();
            let mut terms: [&dyn BondTerm; MAX_TERMS] = [&NoTerm; MAX_TERMS];
            for (slot, &k) in terms.iter_mut().zip(&law.terms) {
                *slot = &*self.terms[k].term;
            }
            let pass = DeformationPass {
                bonds,
                sites,
                law: &*law.material.law,
                terms: &terms[..law.terms.len()],
                first_row: rows.start,
                plane: self.plane,
            };
            let written = DeformationRows {
                deformation: bytemuck::cast_slice_mut(&mut gradient[rows.clone()]),
                stress: bytemuck::cast_slice_mut(&mut stress[rows.clone()]),
                pair_stress: &mut pair_stress[rows.clone()],
            };
            let sum = pass.run(written, &mut self.sums);
            step.ledger.set(strain, law.id, sum.strain);
            for (&k, energy) in law.terms.iter().zip(sum.terms) {
                let account = step.ledger.account(&self.terms[k].account, AccountKind::Stored);
                step.ledger.set(account, law.id, energy);
            }
            if sum.inverted > 0 && law.material.law.needs_positive_volume() {
                let particle = sum.inverted - 1 - rows.start;
                return Err(step.unstable("negative volume (det F <= 0)", law.id, particle));
            }
            if step.clock.step.is_multiple_of(STRETCH_INTERVAL) {
                law.refresh(&gradient[rows]);
            }
            let by = || law.limited_by(&body.name);
            step.limits.propose(*stable_step * law.stretch_factor, by);
        }
        images.fill_pair_stress(pair_stress);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        self.laws.iter().flat_map(|law| law.stretch_factor.to_le_bytes()).collect()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let factors = state.as_chunks::<8>();
        if factors.0.len() != self.laws.len() || !factors.1.is_empty() {
            return false;
        }
        for (law, bytes) in self.laws.iter_mut().zip(factors.0) {
            law.stretch_factor = f64::from_le_bytes(*bytes);
        }
        true
    }
}

/// Fills an unused slot of the list of terms.
struct NoTerm;

impl BondTerm for NoTerm {
    fn add(&self, _: &mut super::BondRows<'_>) -> f64 {
        0.0
    }

    fn stiffness_factor(&self) -> f64 {
        0.0
    }
}

impl BodyLaw {
    fn refresh(&mut self, gradient: &[DeformationGradient]) {
        let stretches = for_each_block(gradient, &mut Vec::new(), &|_, rows: &[DeformationGradient]| {
            rows.iter().fold(Stretches::default(), |all, row| all.with(smallest_and_largest_stretch(row.0)))
        });
        self.stretch_factor = self.material.law.stable_step_factor(stretches.smallest, stretches.largest);
    }

    fn limited_by(&self, body: &str) -> String {
        let cause = if self.estimate.bond_limited() { "bond stiffness" } else { "wave speed" };
        if self.stretch_factor < 0.99 {
            format!("{cause} of `{body}` at a stretch factor of {:.2}", self.stretch_factor)
        } else {
            format!("{cause} of `{body}`")
        }
    }
}

/// Smallest and largest principal stretch; one where nothing is stretched.
#[derive(Clone, Copy)]
struct Stretches {
    smallest: f64,
    largest: f64,
}

impl Default for Stretches {
    fn default() -> Self {
        Self { smallest: 1.0, largest: 1.0 }
    }
}

impl Stretches {
    fn with(self, (smallest, largest): (f64, f64)) -> Self {
        Self { smallest: self.smallest.min(smallest), largest: self.largest.max(largest) }
    }
}

impl crate::parallel::BlockSum for Stretches {
    fn add(&mut self, next: &Self) {
        *self = self.with((next.smallest, next.largest));
    }
}

fn pack(view: &crate::world::PhaseView<'_>, sites: &mut [Site]) -> Result<(), StepError> {
    let position = view.read::<Position>()?;
    let reference = view.read::<ReferencePosition>()?;
    let volume = view.read::<ReferenceVolume>()?;
    let rows = (&mut sites[..], &position[..], &reference[..], &volume[..]);
    type Rows<'a> = (&'a mut [Site], &'a [Position], &'a [ReferencePosition], &'a [ReferenceVolume]);
    for_each_block(rows, &mut Vec::new(), &|_, (sites, x, reference, volume): Rows<'_>| {
        for (k, site) in sites.iter_mut().enumerate() {
            *site = Site::new(reference[k].0, x[k].0, volume[k].0);
        }
    });
    Ok(())
}

fn internal_force(step: &mut Step<'_>, phase: PhaseId, gravity: DVec3, plane: bool) -> Result<(), StepError> {
    let view = step.world.phase(phase);
    let packed = step.resources.get::<PackedRows>();
    let mass = view.read::<Mass>()?;
    let mut force = view.write::<Force>()?;
    let pass = InternalForce {
        bonds: &packed.bonds,
        sites: &packed.sites,
        pair_stress: &packed.pair_stress,
        mass: bytemuck::cast_slice(&mass),
        gravity,
        plane,
    };
    pass.run(&mut force);
    Ok(())
}
