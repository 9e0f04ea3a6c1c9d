//! Heat from particle to particle, as much to the one as from the other.
//!
//! `m_i c dT_i/dt = sum_j 2 k V_i V_j w_ij g_ij (T_j - T_i)`, with present volumes and pair vectors. g_ij is 1 inside of an undeformed body, where
//! `M = sum_j V_j w_ij x_ij (x) x_ij` is the identity. Else the neighbourhood is taken for the affine image of a round one, in d dimensions:
//!
//! `g_i = 1/2 [(d + 2) (x . M_i^-2 x) / (x . M_i^-1 x) - tr M_i^-1]`, `g_ij = max((g_i + g_j) / 2, 0)`,
//!
//! which is exact for quadratic temperatures where that is so, and about makes up for the half neighbourhoods along surfaces. Heat never flows from cold to hot.

use meshless_engine::bytemuck;
use meshless_engine::correction::MomentMatrix;
use meshless_engine::glam::DVec3;
use meshless_engine::linalg::Sym3;
use meshless_engine::parallel::for_each_block;
use meshless_engine::plugin::SimBuilder;
use meshless_engine::schedule::{AccountKind, Run, Stage, Step, StepError, System};
use meshless_engine::solids::SolidPhase;
use meshless_engine::world::{
    BodyId, BodySet, DeformationGradient, Mass, Position, ReferenceVolume, Removed, Temperature,
};

use crate::ConductedTemperature;

/// What a body conducts with.
#[derive(Clone, Copy)]
pub(crate) struct Conductor {
    pub body: BodyId,
    /// W/(m K).
    pub conductivity: f64,
    /// J/(kg K).
    pub specific_heat: f64,
    /// Whether the material sets the temperature at the start.
    pub has_temperature: bool,
}

/// Step over that at which the explicit update of temperatures becomes unstable.
const SAFETY: f64 = 0.9;
/// Least determinant of a moment matrix that shows a shape: below it the neighbourhood counts as round.
const SINGULAR: f64 = 0.02;

/// Adds the system that conducts at the end of each step of the bodies.
pub(crate) fn add_system(sim: &mut SimBuilder<'_>, conductors: Vec<Conductor>) {
    let phases = sim.phases_of(&BodySet::new(conductors.iter().map(|of| of.body)));
    let axes = sim.dimension().count();
    let conduction =
        Conduction { conductors, axes, volumes: Vec::new(), shapes: Vec::new(), gains: Vec::new() };
    sim.add_system(
        System::new(Stage::PostStep, "heat_conduction", conduction)
            .on_phases(phases)
            .by_body()
            .reads::<Position>()
            .reads::<ReferenceVolume>()
            .reads::<DeformationGradient>()
            .reads::<Mass>()
            .reads::<Removed>()
            .adds::<Temperature>()
            .adds::<ConductedTemperature>(),
    );
}

struct Conduction {
    conductors: Vec<Conductor>,
    axes: usize,
    /// Of all rows of the phase of a body: present volumes, m3; of the rows of the body: inverse moment matrices, and heat gained in a second, W, with the
    /// rate at which a particle would come to the temperature of its neighbours, W/K.
    volumes: Vec<f64>,
    shapes: Vec<Sym3>,
    gains: Vec<(f64, f64)>,
}

impl Run for Conduction {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for k in 0..self.conductors.len() {
            let conductor = self.conductors[k];
            if step.turn.is_due(step.world, conductor.body) {
                self.conduct(&conductor, step)?;
            }
        }
        Ok(())
    }
}

impl Conduction {
    fn conduct(&mut self, of: &Conductor, step: &mut Step<'_>) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(of.body);
        let Some(solid) = step.resources.solid(step.world.body(of.body).phase) else { return Ok(()) };
        let (position, mass) = (view.read::<Position>()?, view.read::<Mass>()?);
        let mut now = view.write::<Temperature>()?;
        let mut last = view.write::<ConductedTemperature>()?;
        let (volume, removed) = (view.read::<ReferenceVolume>()?, view.read::<Removed>()?);
        let deformation = view.read::<DeformationGradient>()?;
        self.volumes.resize(volume.len(), 0.0);
        for row in rows.clone() {
            let is_there = removed[row] == Removed::NO;
            self.volumes[row] =
                if is_there { volume[row].0 * deformation[row].0.determinant().max(0.0) } else { 0.0 };
        }
        self.shapes.resize(rows.len(), Sym3::ZERO);
        self.gains.resize(rows.len(), (0.0, 0.0));
        let pairs = Pairs {
            solid: &*solid,
            position: bytemuck::cast_slice(&position),
            volumes: &self.volumes,
            first: rows.start,
            axes: self.axes,
        };
        for_each_block(&mut self.shapes[..], &mut Vec::new(), &|first, shapes: &mut [Sym3]| {
            shapes.iter_mut().zip(rows.start + first..).for_each(|(shape, row)| *shape = pairs.shape(row));
        });
        let (shapes, temperature) = (&self.shapes[..], &now[..]);
        for_each_block(&mut self.gains[..], &mut Vec::new(), &|first, gains: &mut [(f64, f64)]| {
            for (gain, row) in gains.iter_mut().zip(rows.start + first..) {
                *gain = pairs.gain(row, shapes, temperature, of.conductivity);
            }
        });
        let capacity = |row: usize| mass[row].0 * of.specific_heat;
        let dt = step.clock.dt;
        // What has come from elsewhere since the last step, and what conduction changes in all: nothing but rounding.
        let (mut come, mut conducted, mut fastest) = (0.0, 0.0, 0.0f64);
        for (k, row) in rows.enumerate() {
            come += capacity(row) * (now[row].0 - last[row].0);
            let change = dt * self.gains[k].0;
            conducted += change;
            now[row].0 += change / capacity(row);
            last[row].0 = now[row].0;
            fastest = fastest.max(self.gains[k].1 / capacity(row));
        }
        drop((now, last, solid));
        let heat = step.ledger.account("heat", AccountKind::Stored);
        step.ledger.add(heat, of.body, come + conducted);
        let into_heat = step.ledger.account("into_heat", AccountKind::Dissipated);
        step.ledger.add(into_heat, of.body, -come);
        if fastest > 0.0 {
            let name = &step.world.body(of.body).name;
            step.limits.propose(SAFETY / fastest, format_args!("conduction of heat in `{name}`"));
        }
        Ok(())
    }
}

/// The pairs of a body.
struct Pairs<'a> {
    solid: &'a dyn SolidPhase,
    position: &'a [DVec3],
    volumes: &'a [f64],
    /// First row of the body.
    first: usize,
    axes: usize,
}

impl Pairs<'_> {
    /// Calls `f` with the row, the pair vector and V_j w_ij of every neighbour.
    fn of(&self, row: usize, mut f: impl FnMut(usize, DVec3, f64)) {
        let ghosts = self.solid.ghosts();
        self.solid.neighbors(row, &mut |j, weight| {
            let source = ghosts.source(j);
            f(source, ghosts.pair(self.position, row, j), self.volumes[source] * weight);
        });
    }

    /// The inverse of the moment matrix of the neighbourhood.
    fn shape(&self, row: usize) -> Sym3 {
        let mut moment = MomentMatrix::new(self.axes);
        self.of(row, |_, x, weight| moment.add(weight, x));
        let mean = moment.matrix().trace() / self.axes as f64;
        let round = || if mean > 0.0 { Sym3::IDENTITY * (1.0 / mean) } else { Sym3::ZERO };
        moment.inverse_above(SINGULAR).unwrap_or_else(round)
    }

    /// g_i along a pair vector.
    fn weight(&self, shape: &Sym3, x: DVec3) -> f64 {
        let y = *shape * x;
        let along = x.dot(y);
        if along <= 0.0 {
            return 0.0;
        }
        let axes = self.axes as f64;
        let trace = if self.axes == 2 { shape.xx + shape.yy } else { shape.trace() };
        0.5 * ((axes + 2.0) * y.length_squared() / along - trace)
    }

    /// Heat that a particle gains in a second, W, and its rate, W/K.
    fn gain(
        &self,
        row: usize,
        shapes: &[Sym3],
        temperature: &[Temperature],
        conductivity: f64,
    ) -> (f64, f64) {
        let (mut gain, mut rate) = (0.0, 0.0);
        let (own, volume) = (&shapes[row - self.first], self.volumes[row]);
        self.of(row, |j, x, weight| {
            let shape = 0.5 * (self.weight(own, x) + self.weight(&shapes[j - self.first], x));
            let share = 2.0 * conductivity * (volume * weight) * shape.max(0.0);
            gain += share * (temperature[j].0 - temperature[row].0);
            rate += share;
        });
        (gain, rate)
    }
}
