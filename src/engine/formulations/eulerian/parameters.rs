//! The formulation as scenes name it: its parameters, their check, its columns and systems.

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::artificial_stress::{ArtificialStress, TensileStress};
use super::control::HourglassEnergy;
use super::control_rows::{BodyControl, EulerianControlRows};
use super::dilatation::{Dilatation, DilatationRate};
use super::divergence::Divergence;
use super::force::EulerianForce;
use super::lists::{EulerianBody, EulerianLists};
use super::near::{ComputePairs, EulerianNeighbors, NearbyMotion};
use super::pairs::EulerianPairs;
use super::rates::{RATES, VelocityGradients};
use super::rows::{EulerianKernel, EulerianRows, PointColumns};
use super::separation;
use super::stress::Stress;
use super::supports::{SupportMetric, Supports};
use crate::formulations::bonded::{HeldBody, all_shares, balanced_shares};
use crate::kernels::{Kernel, KernelName};
use crate::linalg::Sym3;
use crate::pair::add_pair_systems;
use crate::plugin::{BodyKind, BodyPlan, Distances, Formulation, Offer, Setup, SetupError, SimBuilder};
use crate::removal::LeavingParticles;
use crate::scene::Dimension;
use crate::schedule::{Mode, Stage, System};
use crate::solids::{AppliedLosses, CORRECTED_STRESS, PACKED_SOLID, SolidBodies, require_support};
use crate::symmetry::repeats_of;
use crate::world::{
    BodyId, BodySet, Column, ColumnSet, Damage, DeformationGradient, Force, Mass, PhaseId, PiolaStress,
    Position, ReferencePosition, ReferenceVolume, Removed, SupportRadius, Velocity,
};

/// Solid whose neighbours and kernels are those of the current configuration, for flow, mixing and separation
/// without limit.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Eulerian {
    /// Kernel.
    pub kernel: KernelName,
    /// Support radius over spacing.
    pub support: f64,
    /// Whether supports become ellipsoids that follow large deformations. Default: true where the material
    /// flows plastically, but for `divergence: Shepard`.
    pub support_follows: Option<bool>,
    /// Divergence operator: force from stress.
    pub divergence: Divergence,
    /// Artificial stress against the tensile instability, for comparison; hourglass control does better.
    pub artificial_stress: Option<ArtificialStress>,
}

/// Support radius over spacing, where the scene gives none: a smoothing length of 1.3 spacings, as in the
/// paper.
const USUAL_SUPPORT: f64 = 2.6;

impl Default for Eulerian {
    fn default() -> Self {
        Self {
            kernel: KernelName::CubicSpline,
            support: USUAL_SUPPORT,
            support_follows: None,
            divergence: Divergence::Adjoint,
            artificial_stress: None,
        }
    }
}

/// Label of the system that makes stress and corrected stress.
const STRESS: &str = "eulerian_stress";
/// Label of the system that makes the internal force.
const FORCE: &str = "eulerian_force";

impl Formulation for Eulerian {
    const NAME: &'static str = "Eulerian";
    const REFERENCE: &'static str =
        "Eulerian-kernel SPH of solids: N. Mohseni-Mofidi, C. Bierwisch, Comput. Part. Mech. (2020)";
    const KIND: BodyKind = BodyKind::Solid;
    const BYTES_PER_PARTICLE: usize = 6200;
    const OFFERS: &'static [Offer] = &[
        Offer::PairTerms,
        Offer::PairControl,
        Offer::MirrorImages,
        Offer::Contact,
        Offer::DeformedContact,
        Offer::SelfContact,
        Offer::Dilatation,
        Offer::Sides,
    ];

    fn support(&self, body: &BodyPlan) -> Option<f64> {
        Some(self.support * body.spacing)
    }

    fn kernel(&self) -> Option<KernelName> {
        Some(self.kernel)
    }

    fn distances(&self, body: &BodyPlan) -> Distances {
        if self.follows(body) { Distances::PartWay } else { Distances::Present }
    }

    fn columns(columns: &mut ColumnSet) {
        columns
            .add::<SupportRadius>()
            .add::<DeformationGradient>()
            .add::<PiolaStress>()
            .add::<SupportMetric>()
            .add::<AppliedLosses>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let mut listed = Vec::with_capacity(bodies.len());
        let mut kernels = Vec::with_capacity(bodies.len());
        let touching = sim.touching_pairs();
        for (id, parameters) in &bodies {
            parameters.check(sim.body(*id).spacing).map_err(|error| error.of_formulation(*id))?;
            let support = parameters.support * sim.body(*id).spacing;
            let repeats =
                repeats_of(sim.body(*id), support, sim).map_err(|error| error.of_formulation(*id))?;
            let kernel = Kernel::new(parameters.kernel, sim.dimension().count());
            let Some(kernel) = kernel else {
                unreachable!("every kernel has a two- and a three-dimensional form");
            };
            if let Some(artificial_stress) = parameters.artificial_stress {
                artificial_stress.add(*id, &kernel, support, sim);
            }
            kernels.push(EulerianKernel { kernel, divergence: parameters.divergence, control: None });
            let touches_itself = touching.has(*id, *id);
            let rows = sim.body(*id).rows.clone();
            let follows = parameters.follows(sim.body(*id));
            listed.push(EulerianBody {
                id: *id,
                rows,
                support,
                follows,
                is_stretched: false,
                longest: 1.0,
                repeats,
                touches_itself,
            });
        }
        let ids: Vec<BodyId> = bodies.iter().map(|(id, _)| *id).collect();
        let phase = sim.body(ids[0]).phase;
        let solids = SolidBodies::new(&ids, sim)?;
        solids.require_terms_that_look(sim)?;
        for (own, of) in solids.iter().zip(&mut kernels) {
            let (density, young) = (sim.body(own.id).material.density, own.law.elastic().young);
            of.control = own.control.map(|control| BodyControl {
                xi: control.xi,
                across: control.across / control.xi / young,
                density,
            });
            if of.control.is_some() {
                sim.add_column_to::<HourglassEnergy>(&BodySet::new([own.id]));
            }
        }
        let shares = shares_of(&listed, &kernels, sim);
        sim.add_setup(move |setup| set_up(listed, kernels, phase, setup));
        add_systems(phase, Stress::new(phase, solids, shares), sim);
        add_pair_systems(sim, phase, EulerianPairs(phase))
    }
}

/// The share of its stress that every row carries such that a uniform stress is in balance beside held sides
/// at the start; empty where all carry all of it.
fn shares_of(listed: &[EulerianBody], kernels: &[EulerianKernel], sim: &SimBuilder<'_>) -> Vec<f64> {
    let bodies = listed.iter().zip(kernels).map(|(body, of)| {
        let (plan, repeats) = (sim.body(body.id), &body.repeats[..]);
        let held = HeldBody {
            plan,
            kernel: of.kernel,
            support: body.support,
            neighbors: None,
            repeats,
            stays: true,
        };
        let is_adjoint = of.divergence == Divergence::Adjoint;
        (body.id, if is_adjoint { balanced_shares(&held).shares } else { Vec::new() })
    });
    all_shares(bodies, sim)
}

fn add_systems(phase: PhaseId, stress: Stress, sim: &mut SimBuilder<'_>) {
    let rates = System::new(Stage::Gradients, RATES, VelocityGradients { phase })
        .on_phases([phase])
        .reads_near::<Position>()
        .reads_near::<ReferencePosition>()
        .reads_near::<ReferenceVolume>()
        .reads_near::<Removed>()
        .reads_near::<Velocity>()
        .reads_near::<DeformationGradient>()
        .reads_near::<SupportMetric>()
        .writes::<DeformationGradient>()
        .writes::<SupportMetric>()
        .touches(PACKED_SOLID, Mode::Writes);
    let can_fail = sim.columns(phase).get(Damage::NAME).is_some();
    let rates = if can_fail { rates.reads_near::<Damage>() } else { rates };
    let is_dilated = sim.columns(phase).get(DilatationRate::NAME).is_some();
    sim.add_system(if is_dilated { rates.reads::<DilatationRate>() } else { rates });
    let state = stress.access();
    let stress = System::new(Stage::Constitutive, STRESS, stress)
        .on_phases([phase])
        .reads_near::<Position>()
        .reads_near::<ReferenceVolume>()
        .reads_near::<Removed>()
        .reads_near::<Velocity>()
        .reads_near::<DeformationGradient>()
        .reads_near::<SupportMetric>()
        .reads::<Mass>()
        .touches_all(state);
    let has_control = sim.columns(phase).get(HourglassEnergy::NAME).is_some();
    let stress = if has_control { stress.writes::<HourglassEnergy>() } else { stress };
    let has_tensile_stress = sim.columns(phase).get(TensileStress::NAME).is_some();
    sim.add_system(if has_tensile_stress { stress.writes::<TensileStress>() } else { stress });
    let force = EulerianForce { phase, gravity: sim.gravity(), dilatation: Dilatation::default() };
    let force = System::new(Stage::Rates, FORCE, force).on_phases([phase]).reads::<Mass>();
    let force = if is_dilated { force.reads::<DilatationRate>() } else { force };
    sim.add_system(
        force.reads_near::<Position>().touches(CORRECTED_STRESS, Mode::ReadsNear).writes::<Force>(),
    );
}

impl Eulerian {
    /// Whether the supports of a body follow the deformation. Where it swings elastically, each change of the
    /// supports would cost energy.
    fn follows(&self, body: &BodyPlan) -> bool {
        let flows = || body.solid_law().is_ok_and(|law| law.initial_yield_stress().is_some());
        self.support_follows.unwrap_or_else(|| self.divergence == Divergence::Adjoint && flows())
    }

    fn check(&self, spacing: f64) -> Result<(), SetupError> {
        require_support(self.support, USUAL_SUPPORT, spacing)?;
        if self.support_follows == Some(true) && self.divergence == Divergence::Shepard {
            return Err(SetupError::parameter(
                "support_follows",
                "`support_follows: true` needs the corrected gradient of `divergence: Adjoint`, found `Shepard`",
                "leave one of them out",
            ));
        }
        self.artificial_stress.map_or(Ok(()), |own| own.check())?;
        Ok(())
    }
}

/// Fills the columns, and makes lists and sums of the reference configuration.
fn set_up(
    listed: Vec<EulerianBody>,
    kernels: Vec<EulerianKernel>,
    phase: PhaseId,
    setup: &mut Setup<'_>,
) -> Result<(), SetupError> {
    let view = setup.world.phase(phase);
    let missing = |error: crate::world::MissingColumn| SetupError::internal(&error);
    let reference = view.read::<ReferencePosition>().map_err(missing)?;
    {
        let mut support = view.write::<SupportRadius>().map_err(missing)?;
        for body in &listed {
            support[body.rows.clone()].fill(SupportRadius(body.support));
        }
        view.write::<DeformationGradient>().map_err(missing)?.fill(DeformationGradient(DMat3::IDENTITY));
        view.write::<SupportMetric>().map_err(missing)?.fill(SupportMetric(Sym3::IDENTITY));
    }
    let mut packed = EulerianRows {
        lists: EulerianLists::new(listed),
        kernels,
        points: Vec::new(),
        supports: Supports::default(),
        carried: Vec::new(),
        control: EulerianControlRows::default(),
        near: EulerianNeighbors {
            around: vec![NearbyMotion::default(); view.len()],
            ..EulerianNeighbors::default()
        },
        deformation: vec![DMat3::IDENTITY; view.len()],
        stresses: Vec::new(),
        stable_step: Vec::new(),
        inside: Vec::new(),
        plane: setup.world.dimension() == Dimension::Two,
    };
    let velocity = view.read::<Velocity>().map_err(missing)?;
    let (place, still): (&[DVec3], _) =
        (bytemuck::cast_slice(&reference), (bytemuck::cast_slice(&velocity), 0.0));
    packed.update_lists(place, place, still).map_err(|(body, error)| {
        let help = "use a larger `support`, or more particles across the body";
        SetupError::parameter(format!("bodies[{}].formulation", body.0), error.to_string(), help)
    })?;
    let columns = PointColumns {
        position: bytemuck::cast_slice(&reference),
        velocity: &velocity,
        volume: &view.read::<ReferenceVolume>().map_err(missing)?,
        deformation: &view.read::<DeformationGradient>().map_err(missing)?,
    };
    packed.pack(&columns, 0.0, std::iter::empty());
    look_at_reference(&mut packed, setup)?;
    packed.inside = separation::inside(&packed);
    setup.resources.insert_solid(phase, packed);
    setup.resources.insert_of(phase, LeavingParticles::default());
    Ok(())
}

/// Checks the neighbours of the reference configuration: a body without any has no stiffness.
fn look_at_reference(packed: &mut EulerianRows, setup: &mut Setup<'_>) -> Result<(), SetupError> {
    let EulerianRows { lists, kernels, points, supports, near, plane, .. } = packed;
    for (body, of) in lists.bodies.iter().zip(kernels) {
        let mut rows = near.of_rows(&lists.pairs, body.rows.clone());
        let (kernel, support, first) = (of.kernel, body.support, body.rows.start);
        let (lists, ellipsoids, plane) = (lists.pairs.indices(), supports.of(body), *plane);
        kernel.dispatch(ComputePairs {
            kernel,
            support,
            lists,
            points,
            ellipsoids,
            first,
            plane,
            rows: &mut rows,
        });
        let free = rows.around.iter().filter(|around| around.inverse_moment == Sym3::ZERO).count();
        let name = &setup.world.body(body.id).name;
        if free == rows.around.len() {
            let most = rows.around.iter().map(|around| around.count).max().unwrap_or_default();
            return Err(SetupError::parameter(
                format!("bodies[{}].formulation", body.id.0),
                format!(
                    "no particle of body `{name}` has enough neighbours for a velocity gradient (at most {most})"
                ),
                "use a larger `support`, or more particles across the body",
            ));
        }
        if free > 0 {
            let text =
                format!("{free} particles of body `{name}` have too few neighbours and carry no stress");
            setup.warnings.push(text);
        }
    }
    Ok(())
}
