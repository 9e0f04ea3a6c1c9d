//! The pressure in gaps, continued from where the fluid is.
//!
//! A particle with fluid in its support has the pressure of a wall. From there, and from where a dry gap is
//! open to the air, pressures are continued along the body in steps of a support: each particle takes the
//! mean of those near it that are known, with the weight of the fluid between the two. In a gap that is wet
//! on one side and dry on the other, the two meet halfway.
//!
//! A gap that opens has to be filled from where the fluid is: its pressure falls by the head of that flow.
//! Without this fall, an impact of the fluid beside a body would lift the body with a pressure that no inflow
//! supports.
//!
//! A particle that has its fluid on the other side than its gap, as one in the bottom of a container that
//! stands on a floor, has no fluid in that gap.

use glam::DVec3;

use super::moments::Surrounding;
use crate::formulations::fluid::cloud::FlowCloud;

/// Share of the fluid below which a particle sees none.
const MIN_SHARE: f64 = 1e-10;
/// Closed share below which a dry gap is at its end.
const OPEN: f64 = 0.5;
/// Cosine of the angle between the ways to the fluid and out of a gap above which the fluid is outside of it.
const BEHIND: f64 = 0.5;

/// The fluid at a particle: pressure, Pa, and its gradient at rest, Pa/m; its density, kg/m3, and the length
/// of the way to where it is, m, zero before the gap has been looked into.
#[derive(Clone, Copy, Debug, Default)]
pub struct GapRemainder {
    pub pressure: f64,
    pub slope: DVec3,
    density: f64,
    way: f64,
}

/// The way to the fluid in the support of a boundary particle, m; zero where there is none.
fn way_to_fluid(cloud: &FlowCloud, row: usize) -> DVec3 {
    let near = cloud.near_row(row).iter().filter_map(|&j| cloud.gap_pair(row, j));
    let (mut total, mut place) = (0.0, DVec3::ZERO);
    for pair in near {
        total += pair.value;
        place += pair.value * pair.x;
    }
    if total > MIN_SHARE { place / total } else { DVec3::ZERO }
}

/// Whether fluid that is that way is not in a gap out of which this direction leads.
fn is_outside(way: DVec3, out: DVec3) -> bool {
    way.dot(out) > BEHIND * way.length()
}

impl GapRemainder {
    /// The pressure at that offset, m, Pa.
    fn at(&self, x: DVec3) -> f64 {
        self.pressure + self.slope.dot(x)
    }

    /// Beside a boundary particle, if fluid is in its support.
    pub fn of_wet(cloud: &FlowCloud, gravity: DVec3, row: u32) -> Option<Self> {
        let (mut total, mut mass, mut slope) = (0.0, 0.0, DVec3::ZERO);
        let near = cloud.near_row(row as usize);
        for pair in near.iter().filter_map(|&j| cloud.gap_pair(row as usize, j)) {
            let density = cloud.groups.iter().find(|group| group.cloud.contains(&pair.row));
            let density = density.and_then(|group| group.fluid()).map_or(0.0, |state| state.density);
            total += pair.value;
            mass += pair.value * density;
            slope += pair.value * density * (gravity + cloud.load(pair.row));
        }
        let pressure = cloud.pressure(row as usize);
        let of_mean = || Self { pressure, slope: slope / total, density: mass / total, way: 0.0 };
        (total > MIN_SHARE).then(of_mean)
    }
}

/// A particle of a gap.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gap {
    /// Its rows in the cloud and in the lists of gaps.
    pub particle: [u32; 2],
    pub around: Surrounding,
    /// Share of the empty space around it that is a gap.
    pub closed: f64,
    /// The fluid there; none before it is known.
    pub fluid: Option<GapRemainder>,
    /// Fall of its pressure because the gap opens, Pa.
    pub fall: f64,
}

/// Motion of the boundaries.
pub struct BoundaryMotion<'a> {
    /// Velocity of every boundary particle, m/s.
    pub velocities: &'a [DVec3],
    /// Spacing of the fluid, m.
    pub spacing: f64,
}

impl Gap {
    /// Finds the way to the fluid, and leaves out fluid that is on the other side of its body than the gap,
    /// and where no gap is in the support.
    pub fn look_into(&mut self, cloud: &FlowCloud) {
        let Some(fluid) = &mut self.fluid else { return };
        let (toward, way) = (self.around.toward(), way_to_fluid(cloud, self.particle[0] as usize));
        fluid.way = way.length();
        if toward == DVec3::ZERO || is_outside(way, -toward) {
            self.fluid = None;
        }
    }

    /// The fluid there with the pressure that is left, and nothing where it is not known.
    pub fn filled(&self) -> Option<GapRemainder> {
        let left = |fluid: GapRemainder| (fluid.pressure - self.fall).max(0.0);
        self.fluid.map(|fluid| GapRemainder { pressure: left(fluid), ..fluid })
    }

    /// Bernoulli: what flows into a gap as wide as the spacing that opens comes along the way from where the
    /// fluid is, the faster the longer that is.
    fn open(&mut self, cloud: &FlowCloud, motion: &BoundaryMotion<'_>) {
        let velocity = |row: usize| motion.velocities[row - cloud.fluid];
        let Some(GapRemainder { density, way, .. }) = self.fluid else { return };
        let (mut total, mut mean) = (0.0, DVec3::ZERO);
        for pair in cloud.across_gap(self.particle) {
            total += pair.value;
            mean += pair.value * velocity(pair.row);
        }
        if total > MIN_SHARE {
            let apart = mean / total - velocity(self.particle[0] as usize);
            let inflow = apart.dot(self.around.toward()).max(0.0) * way / motion.spacing;
            self.fall = 0.5 * density * inflow * inflow;
        }
    }
}

/// Finds the fluid at the particles beside gaps that are joined to the fluid or to the air.
#[derive(Debug, Default)]
pub struct Fill {
    /// Number of every boundary particle among those beside gaps.
    numbers: Vec<u32>,
    found: Vec<(usize, GapRemainder)>,
    /// Sums of weights and of pressures with them at particles on the other side of gaps.
    beyond: Vec<[f64; 2]>,
    /// The ways to the fluid, m, from those of them that have it in their support.
    ways: Vec<DVec3>,
}

impl Fill {
    /// Continues the known pressures of the gaps to the others, and to their other sides.
    pub fn run(&mut self, cloud: &FlowCloud, gaps: &mut [Gap], motion: &BoundaryMotion<'_>) {
        self.numbers.clear();
        self.numbers.resize(cloud.records.len() - cloud.fluid, u32::MAX);
        for (k, gap) in (0..).zip(gaps.iter_mut()) {
            self.numbers[gap.particle[0] as usize - cloud.fluid] = k;
            if gap.fluid.is_none() && gap.closed < OPEN {
                gap.fluid = Some(GapRemainder::default());
            }
        }
        let mut found = std::mem::take(&mut self.found);
        loop {
            found.clear();
            let unknown = (0..gaps.len()).filter(|&k| gaps[k].fluid.is_none());
            found.extend(unknown.filter_map(|k| Some((k, self.continued(cloud, gaps, k)?))));
            found.iter().for_each(|&(k, fluid)| gaps[k].fluid = Some(fluid));
            if found.is_empty() {
                break;
            }
        }
        self.found = found;
        gaps.iter_mut().for_each(|gap| gap.open(cloud, motion));
        self.go_beyond(cloud, gaps);
    }

    /// The fluid at particle `k` by those near it.
    fn continued(&self, cloud: &FlowCloud, gaps: &[Gap], k: usize) -> Option<GapRemainder> {
        let [row, list] = gaps[k].particle;
        let (mut total, mut sum) = (0.0, GapRemainder::default());
        for &j in cloud.pairs.gaps.list.row(list as usize) {
            let number = self.numbers[j as usize - cloud.fluid] as usize;
            let Some(there) = gaps.get(number).and_then(|gap| gap.fluid) else { continue };
            let Some(pair) = cloud.gap_pair(row as usize, j) else { continue };
            total += pair.value;
            sum.pressure += pair.value * there.at(-pair.x);
            sum.slope += pair.value * there.slope;
            sum.density += pair.value * there.density;
            sum.way += pair.value * (there.way + pair.x.length());
        }
        // A floor of zero keeps a gap above the surface dry.
        let mean = || GapRemainder {
            pressure: (sum.pressure / total).max(0.0),
            slope: sum.slope / total,
            density: sum.density / total,
            way: sum.way / total,
        };
        (total > MIN_SHARE).then(mean)
    }

    /// Continues pressures to the other sides of gaps.
    fn go_beyond(&mut self, cloud: &FlowCloud, gaps: &[Gap]) {
        self.beyond.clear();
        self.beyond.resize(cloud.records.len() - cloud.fluid, [0.0; 2]);
        self.ways.clear();
        self.ways.resize(cloud.records.len() - cloud.fluid, DVec3::NAN);
        for gap in gaps {
            for pair in cloud.across_gap(gap.particle) {
                let way = &mut self.ways[pair.row - cloud.fluid];
                if way.is_nan() {
                    *way = way_to_fluid(cloud, pair.row);
                }
            }
            let Some(fluid) = gap.filled() else { continue };
            for pair in cloud.across_gap(gap.particle) {
                let sum = &mut self.beyond[pair.row - cloud.fluid];
                sum[0] += pair.value;
                sum[1] += pair.value * fluid.at(pair.x).max(0.0);
            }
        }
    }

    /// Pressure of a particle on the other side of a gap, Pa: that of a wall if fluid of the gap is in its
    /// support, less its fall.
    pub fn beyond(&self, cloud: &FlowCloud, row: usize, gap: &Gap) -> Option<f64> {
        let way = self.ways[row - cloud.fluid];
        if way != DVec3::ZERO && !is_outside(way, gap.around.toward()) {
            let pressure = cloud.pressure(row);
            return Some(if gap.fall > 0.0 { (pressure - gap.fall).max(0.0) } else { pressure });
        }
        let [total, pressure] = self.beyond[row - cloud.fluid];
        (total > MIN_SHARE).then(|| pressure / total)
    }
}
