//! Height of the surface of fluids above a point, and the wet share of the line up from there.
//!
//! A place is wet where fluids fill at least half of the space that walls leave: `sum_f V_f W >= (1 - sum_w
//! V_w W) / 2`. An oblique line goes on in the images of a periodic domain.

use glam::DVec3;

use super::carrier::GaugeCarrier;
use super::images::shifts_to_line;
use super::watch::WallWatch;
use crate::formulations::fluid::{FlowCloud, FlowParticle};
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::world::{BodyId, MissingColumn, World};

/// Steps along the line in a support radius.
const STEPS: f64 = 12.0;
/// Minimum part of a place that fluids fill where it is wet: inside walls none is.
const MIN_FILLING: f64 = 0.1;

/// A line up from a point.
pub struct LevelGauge {
    at: DVec3,
    /// Unit vector along the line.
    up: DVec3,
    /// What carries it along; without it the line stays where it is.
    carrier: Option<GaugeCarrier>,
    /// Whether the line turns with what carries it: its direction is a stated one, and not up.
    turns: bool,
    watch: WallWatch,
}

impl LevelGauge {
    /// A line that stays where it is.
    pub(super) fn new(at: DVec3, up: DVec3, turns: bool) -> Self {
        Self { at, up, carrier: None, turns, watch: WallWatch::default() }
    }

    /// The same, carried along.
    pub(super) fn following(self, carrier: Option<GaugeCarrier>) -> Self {
        Self { carrier, ..self }
    }
}

/// A particle near the line.
struct NearLine {
    height: f64,
    /// Squared distance from the line, m2.
    aside: f64,
    volume: f64,
    fluid: bool,
}

impl Measure for LevelGauge {
    fn columns(&self) -> Vec<(String, &'static str)> {
        vec![("level".to_owned(), "m"), ("wet".to_owned(), "m")]
    }

    fn of_nothing(&self) -> Option<f64> {
        Some(0.0)
    }

    fn left_by(&self) -> Option<BodyId> {
        self.watch.left()
    }

    fn needs(&self) -> Vec<&'static str> {
        GaugeCarrier::NEEDS.to_vec()
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let Some(cloud) = FlowCloud::whole(resources) else { return Ok(vec![f64::NAN; 2]) };
        let Some(carrier) = &self.carrier else {
            let heights = water_levels(&cloud, self.at, self.up);
            self.watch.look_at_foot(&cloud, self.at, heights[1] > 0.0);
            return Ok(heights.to_vec());
        };
        let Some(carried) = carrier.carried(world)? else { return Ok(vec![f64::NAN; 2]) };
        let up = if self.turns { carried.along(self.up) } else { self.up };
        Ok(water_levels(&cloud, carried.place, up).to_vec())
    }
}

/// Height of the surface of fluids above a point, m; `up` is a unit vector.
pub fn water_level(cloud: &FlowCloud, at: DVec3, up: DVec3) -> f64 {
    water_levels(cloud, at, up)[0]
}

/// The same, and the length of the line that is wet, m.
fn water_levels(cloud: &FlowCloud, at: DVec3, up: DVec3) -> [f64; 2] {
    let near = near_line(cloud, at, up);
    let top = near.iter().filter(|near| near.fluid).map(|near| near.height).fold(0.0, f64::max);
    let step = cloud.kernel.support / STEPS;
    let last = ((top + cloud.kernel.support) / step).ceil() as usize;
    let excess: Vec<f64> = (0..=last).map(|k| excess(cloud, &near, k as f64 * step)).collect();
    let (mut level, mut wet) = (0.0, 0.0);
    for (k, pair) in excess.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        wet += step * share_above_zero(a, b);
        if a > 0.0 && b <= 0.0 {
            level = step * (k as f64 + a / (a - b));
        }
    }
    [level, wet]
}

fn near_line(cloud: &FlowCloud, at: DVec3, up: DVec3) -> Vec<NearLine> {
    let support = cloud.kernel.support;
    let offset = |record: &FlowParticle| cloud.offset(at, record.position());
    let rows = || (0..cloud.fluid).chain(cloud.boundaries_once()).map(|row| (row, &cloud.records()[row]));
    let there = || rows().filter(|(_, record)| record.volume() > 0.0);
    let shifts = shifts_to_line(up, there().map(|(_, record)| offset(record)), support, cloud.periodic());
    let of = |(row, record): (usize, &FlowParticle), shift: DVec3| {
        let offset = offset(record) + shift;
        let height = offset.dot(up);
        let aside = (offset - up * height).length_squared();
        let within = aside < support * support && height > -support;
        within.then_some(NearLine { height, aside, volume: record.volume(), fluid: row < cloud.fluid })
    };
    there().flat_map(|particle| shifts.iter().filter_map(move |&shift| of(particle, shift))).collect()
}

/// Above zero where the line is wet at that height.
fn excess(cloud: &FlowCloud, near: &[NearLine], height: f64) -> f64 {
    let (mut fluid, mut wall) = (0.0, 0.0);
    for other in near {
        let distance = (other.aside + (other.height - height).powi(2)).sqrt();
        let share = other.volume * cloud.kernel.value(distance);
        *(if other.fluid { &mut fluid } else { &mut wall }) += share;
    }
    (fluid - 0.5 * (1.0 - wall)).min(fluid - MIN_FILLING)
}

/// Part of an interval in which a linear function of these values at its ends is above zero.
fn share_above_zero(a: f64, b: f64) -> f64 {
    match (a > 0.0, b > 0.0) {
        (true, true) => 1.0,
        (false, false) => 0.0,
        (true, false) => a / (a - b),
        (false, true) => b / (b - a),
    }
}
