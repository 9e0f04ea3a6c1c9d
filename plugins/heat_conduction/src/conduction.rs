//! Heat flux between pairs of particles, antisymmetric, so that heat is conserved.
//!
//! `m_i c dT_i/dt = sum_j 2 k V_i V_j w_ij g_ij (T_j - T_i)`, `g_ij = max((g_i + g_j) / 2, 0)`, with present
//! volumes and pair vectors, and g_i from the [neighborhood](crate::neighborhood) of a particle. Heat never
//! flows from cold to hot. Beside supports m_i and V_i count with the share that a particle has of the heat,
//! which is that of its energy; one without a share, in the plane of a clamp, follows its neighbours.

use meshless_engine::bytemuck;
use meshless_engine::parallel::{BlockSum, for_each_block};
use meshless_engine::plugin::SimBuilder;
use meshless_engine::schedule::{AccountKind, INTO_HEAT, Mode, Run, Stage, Step, StepError, System};
use meshless_engine::solids::{PACKED_SOLID, PresentPair, PresentPairs, PresentVolumes, fill_rows};
use meshless_engine::world::{
    BodyId, BodySet, DeformationGradient, Mass, Position, ReferenceVolume, Removed, Temperature,
};

use crate::ConductedTemperature;
use crate::neighborhood::ConductingNeighborhood;

/// Conduction data of a body.
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

/// Adds the system that conducts at the end of each step of the bodies.
pub(crate) fn add_system(sim: &mut SimBuilder<'_>, conductors: Vec<Conductor>) {
    let bodies = BodySet::new(conductors.iter().map(|of| of.body));
    let phases = sim.phases_of(&bodies);
    let axes = sim.dimension().count();
    let conduction = Conduction {
        conductors,
        axes,
        volumes: PresentVolumes::default(),
        weighted: Vec::new(),
        shapes: Vec::new(),
        gains: Vec::new(),
        sums: Vec::new(),
    };
    sim.add_system(
        System::new(Stage::PostStep, "heat_conduction", conduction)
            .on_phases(phases)
            .on_bodies(bodies)
            .by_body()
            .reads_near::<Position>()
            .touches(PACKED_SOLID, Mode::ReadsNear)
            .reads_near::<ReferenceVolume>()
            .reads_near::<DeformationGradient>()
            .reads::<Mass>()
            .reads_near::<Removed>()
            .reads_near::<Temperature>()
            .adds::<Temperature>()
            .adds::<ConductedTemperature>(),
    );
}

struct Conduction {
    conductors: Vec<Conductor>,
    axes: usize,
    volumes: PresentVolumes,
    /// The same, times the shares of the particles.
    weighted: Vec<f64>,
    /// Neighbourhoods of the rows of a body.
    shapes: Vec<ConductingNeighborhood>,
    gains: Vec<Gain>,
    sums: Vec<Heat>,
}

/// Heat gain of a whole particle, of which a share counts.
#[derive(Clone, Copy, Default)]
struct Gain {
    /// Weight of its place in the heat of the body: not 1 beside supports.
    share: f64,
    /// Heat in a second, W.
    power: f64,
    /// Rate at which it would come to the temperature of its neighbours, W/K.
    rate: f64,
}

/// Energies below this share of the heat that goes from particle to particle in a step are round-off: a
/// hundred times what the sums of a long run are off by, as a hundredth of them is worth a warning.
const DIGITS: f64 = 1e-10;

/// The heat of some particles.
#[derive(Clone, Copy, Default)]
struct Heat {
    /// Heat from other sources since the last step, J.
    come: f64,
    /// Total change of heat by conduction, J: rounding errors only.
    conducted: f64,
    /// Heat exchanged between particles, J.
    exchanged: f64,
    /// Largest rate at which a particle comes to the temperature of its neighbours, 1/s.
    fastest: f64,
}

impl BlockSum for Heat {
    fn add(&mut self, next: &Self) {
        self.come += next.come;
        self.conducted += next.conducted;
        self.exchanged += next.exchanged;
        self.fastest = self.fastest.max(next.fastest);
    }
}

impl Run for Conduction {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for k in 0..self.conductors.len() {
            let conductor = self.conductors[k];
            if step.part.is_due(step.world, conductor.body) {
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
        let volumes = self.volumes.of_body(&view, &rows)?;
        let solid = &*solid;
        self.weighted.resize(volumes.len(), 0.0);
        fill_rows(&mut self.weighted[rows.clone()], rows.start, |row| solid.share(row) * volumes[row]);
        self.shapes.resize(rows.len(), ConductingNeighborhood::NONE);
        self.gains.resize(rows.len(), Gain::default());
        let (position, weighted) = (bytemuck::cast_slice(&position), &self.weighted[..]);
        let pairs = PresentPairs { solid, position, volumes: weighted };
        let field = HeatField { pairs, volumes, first: rows.start, axes: self.axes };
        fill_rows(&mut self.shapes, rows.start, |row| field.shape(row));
        let (shapes, temperature) = (&self.shapes[..], &now[..]);
        fill_rows(&mut self.gains, rows.start, |row| field.gain(row, shapes, temperature, of.conductivity));
        let dt = step.clock.dt;
        let own = (&mut now[rows.clone()], &mut last[rows.clone()], &self.gains[..], &mass[rows]);
        type Rows<'a> = (&'a mut [Temperature], &'a mut [ConductedTemperature], &'a [Gain], &'a [Mass]);
        let found = for_each_block(own, &mut self.sums, &|_, (now, last, gains, mass): Rows<'_>| {
            let mut sum = Heat::default();
            for (((now, last), gain), mass) in now.iter_mut().zip(last).zip(gains).zip(mass) {
                let capacity = mass.0 * of.specific_heat;
                sum.come += gain.share * capacity * (now.0 - last.0);
                let change = dt * gain.power;
                sum.conducted += gain.share * change;
                sum.exchanged += gain.share * change.abs();
                now.0 += change / capacity;
                last.0 = now.0;
                sum.fastest = sum.fastest.max(gain.rate / capacity);
            }
            sum
        });
        drop((now, last));
        let heat = step.ledger.account("heat", AccountKind::Stored);
        step.ledger.add(heat, of.body, found.come + found.conducted);
        step.ledger.set_resolution(DIGITS * found.exchanged);
        let into_heat = step.ledger.account(INTO_HEAT, AccountKind::Dissipated);
        step.ledger.add(into_heat, of.body, -found.come);
        if found.fastest > 0.0 {
            let name = &step.world.body(of.body).name;
            step.limits.propose(SAFETY / found.fastest, format_args!("conduction of heat in `{name}`"));
        }
        Ok(())
    }
}

/// The neighbourhoods of a body.
struct HeatField<'a> {
    /// The pairs, with the share of its volume that each particle has beside supports.
    pairs: PresentPairs<'a>,
    /// Present volumes of the rows of the phase, m3.
    volumes: &'a [f64],
    /// First row of the body.
    first: usize,
    axes: usize,
}

impl HeatField<'_> {
    fn shape(&self, row: usize) -> ConductingNeighborhood {
        ConductingNeighborhood::new(self.axes, |take| self.pairs.of(row, |pair| take(pair.weight, pair.x_ij)))
    }

    /// Heat gain of a particle.
    fn gain(
        &self,
        row: usize,
        shapes: &[ConductingNeighborhood],
        temperature: &[Temperature],
        conductivity: f64,
    ) -> Gain {
        let mut gain = Gain { share: self.pairs.solid.share(row), ..Gain::default() };
        let (own, volume) = (&shapes[row - self.first], self.volumes[row]);
        self.pairs.of(row, |PresentPair { row: j, signs, x_ij, weight }| {
            // An image sees the pair mirrored.
            let other = shapes[j - self.first].weight(self.axes, signs * x_ij);
            let shape = 0.5 * (own.weight(self.axes, x_ij) + other);
            let share = 2.0 * conductivity * (volume * weight) * shape.max(0.0);
            gain.power += share * (temperature[j].0 - temperature[row].0);
            gain.rate += share;
        });
        gain
    }
}
