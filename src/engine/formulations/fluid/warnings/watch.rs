//! Checks of a flow during the run: particles inside of its boundaries, compression, gaps
//! and swelling, rows that break up or are drawn apart.

use super::closed::ClosedWatch;
use super::compression::CompressionWatch;
use super::driven;
use super::fallen::FallenWatch;
use super::filling::FillingWatch;
use super::fit;
use super::friction::FrictionOfParticle;
use super::half_space;
use super::held_down::HeldDown;
use super::intrusion::Intrusion;
use super::lost_volume::LostVolume;
use super::no_gap_pressure;
use super::passing::PassingWalls;
use super::spreading::Spreading;
use super::stabilized;
use super::stairs::StairsWatch;
use super::stretched;
use super::tension::TensionWatch;
use super::torques;
use super::unevenness::Unevenness;
use crate::formulations::fluid::cloud::{FLOW_RECORDS, FlowCloud, Group};
use crate::plugin::SimBuilder;
use crate::rigid::RIGID_BODIES;
use crate::schedule::Trigger;
use crate::schedule::{Mode, Run, Stage, Step, StepError, System};
use crate::world::{Mobility, ParticleId, PhaseId, Position, ReferencePosition, ReferenceVolume, Removed};

/// Steps between two checks for particles inside boundaries: they stay there for some time.
const INTERVAL: u64 = 50;

struct FlowWatch {
    intrusion: Intrusion,
    passing: PassingWalls,
    fallen: FallenWatch,
    /// Whether the user has been told of a half-space that a fluid falls into.
    is_through: bool,
    /// The same of a body beside a gap without pressure.
    lies: bool,
    /// The same of motion that stabilizers have taken.
    is_stabilized: bool,
    /// Account of the diffusion of density, if there is one, and whether its share in the work of walls has
    /// been reported.
    diffusion: Option<String>,
    is_driven: bool,
    /// Whether torques by friction without spin have been reported.
    has_torques: bool,
    closed: ClosedWatch,
    held_down: HeldDown,
    lost_volume: LostVolume,
    /// Spacing of the fluid, m.
    spacing: f64,
    compression: CompressionWatch,
    filling: FillingWatch,
    /// Whether the user has been told of each group whose rows have been drawn apart.
    stretched: Vec<bool>,
    unevenness: Unevenness,
    tension: TensionWatch,
    spreading: Spreading,
    stairs: StairsWatch,
    /// Compression, filling and unevenness are looked at with the frames.
    frames: Trigger,
    end: f64,
    /// Whether the lattices have been looked at.
    is_started: bool,
    /// Results of the checks for each particle.
    scratch: Vec<Option<f64>>,
    friction: Vec<Option<FrictionOfParticle>>,
}

/// Adds the system of the checks.
pub fn add(phases: Vec<PhaseId>, groups: &[Group], diffusion: Option<String>, sim: &mut SimBuilder<'_>) {
    let spacing = sim.body(groups[0].body).spacing;
    let watch = FlowWatch {
        intrusion: Intrusion::new(sim, spacing),
        passing: PassingWalls::new(sim),
        fallen: FallenWatch::new(sim),
        is_through: false,
        lies: false,
        is_stabilized: false,
        diffusion,
        is_driven: false,
        has_torques: false,
        closed: ClosedWatch::default(),
        held_down: HeldDown::new(sim.gravity(), spacing),
        lost_volume: LostVolume::default(),
        spacing,
        compression: CompressionWatch::default(),
        filling: FillingWatch::default(),
        stretched: Vec::new(),
        unevenness: Unevenness::new(sim.work_of_weight()),
        tension: TensionWatch::new(groups, sim),
        spreading: Spreading::new(sim),
        stairs: StairsWatch::default(),
        frames: Trigger::after_interval(sim.scene().record_interval()),
        end: sim.scene().time.end,
        is_started: false,
        scratch: Vec::new(),
        friction: Vec::new(),
    };
    sim.add_system(
        System::new(Stage::Record, "fluid_watch", watch)
            .on_phases(phases)
            .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
            .reads_own_packed()
            .touches_packed(RIGID_BODIES, Mode::Reads)
            .reads::<Position>()
            .reads_near::<ReferencePosition>()
            .reads::<ReferenceVolume>()
            .reads::<ParticleId>()
            .reads::<Mobility>()
            .reads::<Removed>(),
    );
}

impl Run for FlowWatch {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let begins = !std::mem::replace(&mut self.is_started, true) && step.clock.step <= 1;
        let at_end = step.clock.time >= self.end || step.stop.is_some();
        let is_frame = self.frames.is_due(step.clock.time) || at_end;
        let is_due = is_frame || step.clock.step.is_multiple_of(INTERVAL);
        let looks = begins || is_due;
        let Some(cloud) = looks.then(|| FlowCloud::whole(step.resources)).flatten() else { return Ok(()) };
        if begins {
            fit::look(&cloud, &mut self.scratch, step);
        }
        if is_due {
            self.intrusion.look(&cloud, step)?;
            self.passing.look(step)?;
            half_space::look(&mut self.is_through, &cloud, self.spacing, step);
            self.spreading.look(at_end, &cloud, step);
        }
        if is_frame {
            self.held_down.look(&cloud, step)?;
            no_gap_pressure::look(&mut self.lies, &cloud, self.spacing, step)?;
            self.lost_volume.look(&cloud, step)?;
            self.fallen.look(&cloud, step);
            self.compression.look(&cloud, &mut self.friction, step);
            self.filling.look(&cloud, &mut self.scratch, step);
            stretched::look(&mut self.stretched, &cloud, &mut self.scratch, step);
            self.closed.look(at_end, &cloud, &mut self.scratch, step);
            self.unevenness.look(&cloud, &mut self.friction, step);
            self.tension.look(&cloud, &mut self.scratch, step);
            self.stairs.look(at_end, &cloud, &self.intrusion, step)?;
        }
        if at_end {
            stabilized::look(&mut self.is_stabilized, &cloud, &mut self.scratch, step);
            driven::look(&mut self.is_driven, self.diffusion.as_deref(), &cloud, step);
            torques::look(&mut self.has_torques, &cloud, step);
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let told = (&self.intrusion.told, &self.passing.told, &self.unevenness.told);
        let at_end = (self.is_stabilized, self.is_driven, self.has_torques);
        let bodies = (self.is_through, self.lies, at_end, self.closed, &self.held_down.seen);
        postcard::to_stdvec(&(
            told,
            bodies,
            (&self.compression, &self.tension, &self.spreading.seen, &self.stairs),
            (&self.filling, &self.lost_volume, &self.stretched, self.fallen.told),
            self.frames,
        ))
        .unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok((
            told,
            bodies,
            (compression, tension, spreading, stairs),
            (filling, lost, stretched, fallen),
            frames,
        )) = postcard::from_bytes(state)
        else {
            return false;
        };
        (self.lost_volume, self.stretched, self.fallen.told) = (lost, stretched, fallen);
        let at_end;
        (self.is_through, self.lies, at_end, self.closed, self.held_down.seen) = bodies;
        (self.is_stabilized, self.is_driven, self.has_torques) = at_end;
        (self.intrusion.told, self.passing.told, self.unevenness.told) = told;
        (self.compression, self.filling, self.tension) = (compression, filling, tension);
        (self.spreading.seen, self.stairs) = (spreading, stairs);
        self.frames.resume(frames);
        true
    }
}
