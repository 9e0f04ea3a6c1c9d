//! Mach number of a flow: whether the fluid is still nearly incompressible.
//!
//! A tank that moves as a whole with its fluid compresses nothing. Speeds count relative to one of several
//! frames: at rest, that of one of the boundary bodies, or, without boundaries, that of the mean velocity of
//! the fluids. The frame is the one in which the largest speed of fluids and boundaries is smallest.
//!
//! What has fallen past all boundaries that stay meets nothing that could compress it, and does not count.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::floor::Floor;
use crate::formulations::fluid::cloud::{FluidState, Group, Role};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::parallel::{BlockSum, sum_over_own_blocks};
use crate::schedule::{Step, StepError, replace_warning};

/// Speed of the flow over that of sound that is worth a warning: twice the one that a speed of sound is
/// chosen for. The density then changes by 4 %.
const FAST: f64 = 0.2;
/// Growth of the largest Mach number for which the warning is renewed.
const GROWTH: f64 = 1.05;

/// Largest speed in a frame, over that in the first one, for which the frame is taken.
const SLOWER: f64 = 0.9;

/// The frame that speeds are measured in at first: the mean velocity of the largest wall, m/s, or rest.
pub fn wall_frame(groups: &[Group], records: &[FlowParticle]) -> DVec3 {
    let is_wall = |group: &&Group| matches!(&group.role, Role::Boundary(surface) if !surface.moved);
    let largest = groups.iter().filter(is_wall).max_by_key(|group| group.rows.len());
    largest.map_or(DVec3::ZERO, |group| mean_velocity(std::slice::from_ref(group), records))
}

/// Largest square of a speed, m2/s2.
#[derive(Clone, Copy, Default, Pod, Zeroable)]
#[repr(transparent)]
struct LargestSpeed(f64);

impl BlockSum for LargestSpeed {
    fn add(&mut self, next: &Self) {
        self.0 = self.0.max(next.0);
    }
}

/// Largest speed in a frame, m/s, of the particles of a body that have not fallen.
fn fastest(group: &Group, records: &[FlowParticle], frame: DVec3, floor: Floor) -> f64 {
    let square = sum_over_own_blocks(&records[group.cloud.clone()], &|_, records: &[FlowParticle]| {
        let here = records.iter().filter(|record| record.volume() > 0.0 && !floor.is_above(record));
        LargestSpeed(here.map(|record| record.velocity().distance_squared(frame)).fold(0.0, f64::max))
    });
    square.0.sqrt()
}

/// Sum of the velocities of some particles, m/s, and their number.
#[derive(Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
struct VelocitySum {
    velocity: DVec3,
    count: f64,
}

impl BlockSum for VelocitySum {
    fn add(&mut self, next: &Self) {
        self.velocity += next.velocity;
        self.count += next.count;
    }
}

fn mean_velocity(groups: &[Group], records: &[FlowParticle]) -> DVec3 {
    let mut all = VelocitySum::default();
    for group in groups {
        all.add(&sum_over_own_blocks(&records[group.cloud.clone()], &|_, records: &[FlowParticle]| {
            let here = records.iter().filter(|record| record.volume() > 0.0);
            here.fold(VelocitySum::default(), |mut sum, record| {
                sum.add(&VelocitySum { velocity: record.velocity(), count: 1.0 });
                sum
            })
        }));
    }
    all.velocity / all.count.max(1.0)
}

/// Largest speed of a fluid against the frame of its flow, m/s; `at_first` is the one against `base`, the
/// [`wall_frame`], under this gravity, m/s2. At the speeds of fluids that are no warning nothing is looked
/// for.
pub fn relative_speed(
    at_first: f64,
    [base, gravity]: [DVec3; 2],
    group: &Group,
    groups: &[Group],
    records: &[FlowParticle],
) -> f64 {
    if group.fluid().is_none_or(|state| at_first <= FAST * state.sound_speed) {
        return at_first;
    }
    let bounds = || groups.iter().filter(|group| group.fluid().is_none());
    let of_bounds = bounds().map(|group| mean_velocity(std::slice::from_ref(group), records));
    let of_all = bounds().next().is_none().then(|| mean_velocity(groups, records));
    let floor = Floor::of(gravity, groups, records);
    let in_frame =
        |frame| groups.iter().map(|group| fastest(group, records, frame, floor)).fold(0.0, f64::max);
    let mut least = in_frame(base);
    let mut speed = fastest(group, records, base, floor).min(at_first);
    // A frame that is slow beside the flow is as good as the first one.
    for frame in of_bounds.chain(of_all).filter(|frame| frame.distance(base) > (1.0 - SLOWER) * at_first) {
        let largest = in_frame(frame);
        if largest < SLOWER * least {
            (least, speed) = (largest, fastest(group, records, frame, floor).min(at_first));
        }
    }
    speed
}

/// The largest Mach number of a body reported to the user.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mach {
    pub told: f64,
}

impl Mach {
    /// Checks the largest [`relative_speed`] in a step, m/s; the warning has the largest one of the run.
    ///
    /// # Errors
    /// The flow is faster than its sound.
    pub fn look(
        &mut self,
        speed: f64,
        state: &FluidState,
        name: &str,
        step: &mut Step<'_>,
    ) -> Result<(), StepError> {
        let mach = speed / state.sound_speed;
        if mach <= FAST.max(GROWTH * self.told) {
            return Ok(());
        }
        let (found, sound) = (quantity(speed, "m/s"), quantity(state.sound_speed, "m/s"));
        if mach >= 1.0 {
            let message = format!(
                "the flow of `{name}` has reached {found} at {}, faster than its sound of {sound}: it no longer behaves as a liquid; \
                 give ten times the largest speed of the flow as `sound_speed` of its material",
                quantity(step.clock.time, "s")
            );
            return Err(StepError::System { system: "fluid_pressure".to_owned(), message });
        }
        let begin = format!("the flow of `{name}` has reached ");
        let text = format!(
            "{begin}a Mach number of {mach:.2}, {found} with a speed of sound of {sound}: its density changes by {:.0} %, where it \
             should by 1 %; a `sound_speed` of some {} would be right, at smaller steps",
            100.0 * mach * mach,
            quantity(10.0 * speed, "m/s")
        );
        replace_warning(step.warnings, &begin, text);
        self.told = mach;
        Ok(())
    }
}
