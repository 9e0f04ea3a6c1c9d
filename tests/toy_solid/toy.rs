//! A solid formulation in few lines, the pattern for a new one: a naive second implementation of the method
//! of `TotalLagrangian`.

use meshless::correction::MomentMatrix;
use meshless::glam::{DMat3, DVec3};
use meshless::kernels::{Kernel, KernelName};
use meshless::linalg::{Sym3, dyad};
use meshless::pair::{WeightAt, add_pair_systems};
use meshless::plugin::{BodyPlan, Setup};
use meshless::prelude::*;
use meshless::solids::{
    BodyPass, CORRECTED_STRESS, Constitutive as Law, CorrectedStress, LocalMotion, SolidBlock, SolidBodies,
    SolidColumns, SolidPairs, SolidPart, SolidPhase, SolidRows, SolidSum, StepEstimate,
};
use meshless::symmetry::{Ghosts, Repeat, repeats_of};
use meshless::world::{
    ColumnSet, MissingColumn, Mobility, PhaseId, PhaseView, ReferenceVolume, Removed, SupportRadius,
};

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Toy {}

/// Support radius over spacing.
const SUPPORT: f64 = 2.41;

#[derive(Clone, Copy, Default)]
struct Point {
    reference: DVec3,
    displacement: DVec3,
    velocity: DVec3,
    volume: f64,
}

/// The fit over the neighbours of a particle: M^-1, and sum_j V_j w_ij X_ij.
#[derive(Clone, Copy, Default)]
struct Fit {
    inverse: Sym3,
    first_moment: DVec3,
}

#[derive(Default)]
struct Rows {
    ghosts: Ghosts,
    lists: Vec<Vec<(usize, f64)>>, // neighbours with their weights
    points: Vec<Point>,
    fits: Vec<Fit>,
    stresses: Vec<CorrectedStress>,
    stable_step: Vec<f64>,
    dimension: usize,
}

impl Formulation for Toy {
    const NAME: &'static str = "Toy";
    const REFERENCE: &'static str = "";
    const KIND: BodyKind = BodyKind::Solid;
    const OFFERS: &'static [Offer] = Offer::OF_SOLIDS;

    fn support(&self, body: &BodyPlan) -> Option<f64> {
        Some(SUPPORT * body.spacing)
    }

    fn columns(columns: &mut ColumnSet) {
        columns.add::<SupportRadius>().add::<DeformationGradient>().add::<PiolaStress>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let ids: Vec<BodyId> = bodies.iter().map(|(id, _)| *id).collect();
        let (phase, gravity) = (sim.body(ids[0]).phase, sim.gravity());
        let solids = SolidBodies::new(&ids, sim)?;
        let mut parts = Vec::new();
        for own in solids.iter() {
            let (id, support) = (own.id, SUPPORT * sim.body(own.id).spacing);
            let repeats = repeats_of(sim.body(id), support, sim).map_err(|e| e.of_formulation(id))?;
            parts.push((id, support, repeats, own.estimate));
        }
        sim.add_setup(move |setup| set_up(&parts, phase, setup).map_err(|e| SetupError::internal(&e)));
        let state = solids.access();
        let work = Stress(phase, solids);
        sim.add_system(
            System::new(Stage::Constitutive, "toy_stress", work)
                .on_phases([phase])
                .reads_near::<Position>()
                .reads_near::<ReferencePosition>()
                .reads_near::<ReferenceVolume>()
                .reads_near::<Removed>()
                .reads::<Velocity>()
                .touches_all(state),
        );
        sim.add_system(
            System::new(Stage::Rates, "toy_force", move |step: &mut Step<'_>| force(step, phase, gravity))
                .on_phases([phase])
                .reads::<Mass>()
                .touches(CORRECTED_STRESS, Mode::ReadsNear)
                .writes::<Force>(),
        );
        add_pair_systems(sim, phase, SolidPairs { phase, weight_at: WeightAt::Reference })
    }
}

type Part = (BodyId, f64, Vec<Repeat>, StepEstimate);

fn set_up(parts: &[Part], phase: PhaseId, setup: &mut Setup<'_>) -> Result<(), MissingColumn> {
    let view = setup.world.phase(phase);
    let reference: Vec<DVec3> = view.read::<ReferencePosition>()?.iter().map(|x| x.0).collect();
    let volume = view.read::<ReferenceVolume>()?;
    let dimension = setup.world.dimension().count();
    let kernel = Kernel::new(KernelName::Spiky, dimension).expect("a kernel for every dimension");
    let mut rows = Rows {
        ghosts: Ghosts::new(view.len()),
        lists: vec![Vec::new(); view.len()],
        fits: vec![Fit::default(); view.len()],
        dimension,
        ..Rows::default()
    };
    for (id, support, repeats, estimate) in parts {
        let own = setup.world.body(*id).rows.clone();
        let images = rows.ghosts.add(own.clone(), &reference, *support, repeats);
        let mut stable_step = f64::INFINITY;
        for i in own.clone() {
            let (mut moment, mut weight_sum) = (MomentMatrix::new(dimension), 0.0);
            for j in own.clone().chain(images.clone()).filter(|&j| j != i) {
                let x_ij = rows.ghosts.pair(&reference, i, j);
                if x_ij.length() < *support {
                    // In single precision, as those of `TotalLagrangian`.
                    let weight =
                        kernel.pair_weight(x_ij.length(), kernel.smoothing_length(*support)) as f32 as f64;
                    rows.lists[i].push((j, weight));
                    let share = volume[rows.ghosts.source(j)].0 * weight;
                    moment.add(share, x_ij);
                    weight_sum += share;
                }
            }
            let mean = moment.inverse().unwrap_or_default().trace() / dimension as f64;
            stable_step = stable_step.min(estimate.stable_step(weight_sum, mean));
        }
        view.write::<SupportRadius>()?[own].fill(SupportRadius(*support));
        rows.stable_step.push(stable_step);
    }
    rows.points.resize(view.len() + rows.ghosts.len(), Point::default());
    rows.stresses.resize(rows.points.len(), CorrectedStress::default());
    rows.pack(&view)?;
    setup.resources.insert_solid(phase, rows);
    Ok(())
}

type Own<'a> = (&'a mut [Fit], &'a mut [CorrectedStress]);

impl Rows {
    /// Packs the particles as they are now; removed ones have no volume.
    fn pack(&mut self, view: &PhaseView<'_>) -> Result<(), MissingColumn> {
        let (x, reference) = (view.read_near::<Position>()?, view.read_near::<ReferencePosition>()?);
        let (velocity, removed) = (view.read::<Velocity>()?, view.read_near::<Removed>()?);
        let volume = view.read_near::<ReferenceVolume>()?;
        for i in 0..view.len() {
            self.points[i] = Point {
                reference: reference[i].0,
                displacement: x[i].0 - reference[i].0,
                velocity: velocity[i].0,
                volume: if removed[i] == Removed::NO { volume[i].0 } else { 0.0 },
            };
        }
        self.ghosts.fill(&mut self.points, |ghost, own: &Point| Point {
            reference: ghost.map.place(own.reference),
            displacement: ghost.map.vector(own.displacement),
            velocity: ghost.map.vector(own.velocity),
            volume: own.volume,
        });
        Ok(())
    }

    /// Neighbours of a particle with V_j w_ij, X_ij, u_ij.
    fn pairs(&self, i: usize) -> impl Iterator<Item = (usize, f64, DVec3, DVec3)> {
        let own = self.points[i];
        self.lists[i].iter().map(move |&(j, weight)| {
            let other = self.points[j];
            let (x, u) = (other.reference - own.reference, other.displacement - own.displacement);
            (j, other.volume * weight, x, u)
        })
    }

    /// From the displacements of the neighbours to the corrected stress of a block.
    fn block(
        &self,
        law: &Law<'_>,
        mut rows: SolidRows<'_>,
        own: Own<'_>,
        block: &mut SolidBlock,
    ) -> SolidSum {
        let ((fits, stresses), first, mut sum) = (own, block.first, SolidSum::default());
        for (k, fit) in fits.iter_mut().enumerate() {
            let (mut moment, mut spread) = (MomentMatrix::new(self.dimension), DMat3::ZERO);
            fit.first_moment = DVec3::ZERO;
            for (_, share, x, u) in self.pairs(first + k) {
                moment.add(share, x);
                fit.first_moment += share * x;
                spread += dyad(u * share, x);
            }
            block.volume[k] = self.points[first + k].volume;
            fit.inverse = moment.inverse().filter(|_| block.volume[k] > 0.0).unwrap_or_default();
            let h = spread * fit.inverse.to_matrix();
            let errors = self.pairs(first + k).map(|(_, share, x, u)| share * (h * x - u).length_squared());
            block.residual[k] = errors.sum();
            block.gradient[k] = h;
            rows.deformation[k] = DMat3::IDENTITY + h;
        }
        let carried = |k: usize| if fits[k].inverse == Sym3::ZERO { 0.0 } else { 1.0 };
        law.stress(&mut rows, block, carried, &mut sum, |stress| {
            for (k, out) in stresses.iter_mut().enumerate() {
                *out = CorrectedStress::new(&(stress[k] * fits[k].inverse.to_matrix()));
            }
        });
        law.fold(&mut law.folded(&mut rows, block, stresses), &mut sum);
        sum.close(&rows, block);
        sum
    }
}

struct Stress(PhaseId, SolidBodies);

impl Run for Stress {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let Self(phase, solids) = self;
        let (view, mut packed) = (step.world.phase(*phase), step.resources.solid_rows_mut::<Rows>(*phase));
        packed.pack(&view)?;
        let (mut fits, mut stresses) =
            (std::mem::take(&mut packed.fits), std::mem::take(&mut packed.stresses));
        let mut columns = SolidColumns::of(&view)?;
        let points = &*packed;
        solids.begin();
        for k in 0..solids.len() {
            let rows = step.world.body(solids.id(k)).rows.clone();
            let own = (&mut fits[rows.clone()], &mut stresses[rows.clone()]);
            let pass = BodyPass { body: k, view: &view, rows, part: SolidPart::of(step) };
            solids.run(pass, &mut columns, own, &|law, r, own: Own<'_>, b| points.block(law, r, own, b));
        }
        drop(columns);
        (packed.fits, packed.stresses) = (fits, stresses);
        packed.renew_ghosts();
        solids.book(step)?;
        solids.limit(step, &packed.stable_step, &[])
    }

    fn save(&self) -> Vec<u8> {
        self.1.save()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        self.1.restore(state)
    }
}

/// f_i = V_i sum_j V_j w_ij [(A_i + A_j) X_ij + (k_i + k_j) u_ij] + m_i g.
fn force(step: &Step<'_>, phase: PhaseId, gravity: DVec3) -> Result<(), StepError> {
    let (view, packed) = (step.world.phase(phase), step.resources.solid_rows::<Rows>(phase));
    let mass = view.read::<Mass>()?;
    for (i, force) in view.write::<Force>()?.iter_mut().enumerate() {
        let (own, volume) = (&packed.stresses[i], packed.points[i].volume);
        let traction = |j: usize, x, u| own.apply(x, u) + packed.stresses[j].apply(x, u);
        let sum: DVec3 = packed.pairs(i).map(|(j, share, x, u)| share * traction(j, x, u)).sum();
        force.0 = sum * volume + if volume > 0.0 { gravity * mass[i].0 } else { DVec3::ZERO };
    }
    Ok(())
}

impl SolidPhase for Rows {
    fn keeps_reference(&self) -> bool {
        true
    }

    fn ghosts(&self) -> &Ghosts {
        &self.ghosts
    }

    fn neighbors(&self, row: usize, f: &mut dyn FnMut(usize, f64)) {
        self.lists[row].iter().filter(|(j, _)| self.points[*j].volume > 0.0).for_each(|&(j, w)| f(j, w));
    }

    fn local_motion(&self, row: usize, velocity: &[Velocity], mobility: Mobility, _: bool) -> LocalMotion {
        let Fit { inverse, first_moment } = self.fits[row];
        let v_ij = |j: usize| self.points[j].velocity - self.points[row].velocity;
        let sum: DMat3 = self.pairs(row).map(|(j, share, x, _)| dyad(v_ij(j) * share, x)).sum();
        let (velocity, own) = (velocity[row].0, inverse * first_moment);
        LocalMotion { velocity, rate: sum * inverse.to_matrix(), mobility: mobility.0, own }
    }

    fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]) {
        for (node, couple) in nodes.iter().zip(couples) {
            let row = first + *node as usize;
            let stress = *couple * self.fits[row].inverse.to_matrix() * (-1.0 / self.points[row].volume);
            self.stresses[row].add(&stress, DVec3::ZERO);
        }
    }

    fn renew_ghosts(&mut self) {
        self.ghosts.fill(&mut self.stresses, |ghost, own: &CorrectedStress| own.image(ghost.map));
    }
}
