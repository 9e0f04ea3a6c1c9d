//! The pressure in gaps, continued from where the fluid is.
//!
//! A particle with fluid in its support has the pressure of a wall. From there, and from where a dry gap is
//! open to the air, pressures are continued along the body in steps of a support: each particle takes the
//! mean of those near it that are known, with the weight of the fluid between the two. Between ends with
//! different heads the pressure then falls evenly ([`Seepage`]).
//!
//! A gap that opens has to be filled from where the fluid is: its pressure falls by the head of that flow.
//! Without this fall, an impact of the fluid beside a body would lift the body with a pressure that no inflow
//! supports.
//!
//! A particle that has its fluid on the other side than its gap, as one in the bottom of a container that
//! stands on a floor, has no fluid in that gap.

use glam::DVec3;

use super::gap::{BoundaryMotion, Gap, GapRemainder, MIN_SHARE, is_outside, way_to_fluid};
use super::seepage::Seepage;
use crate::formulations::fluid::cloud::FlowCloud;

/// Closed share below which a dry gap is at its end.
const OPEN: f64 = 0.5;

/// Finds the fluid at the particles beside gaps that are joined to the fluid or to the air.
#[derive(Debug, Default)]
pub struct Fill {
    /// Number of every boundary particle among those beside gaps.
    numbers: Vec<u32>,
    found: Vec<(usize, GapRemainder)>,
    /// Those of the gaps between their ends, ascending.
    between: Vec<u32>,
    seepage: Seepage,
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
        self.between.clear();
        self.between.extend((0..).zip(&*gaps).filter(|(_, gap)| gap.fluid.is_none()).map(|(k, _)| k));
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
        self.between.retain(|&k| gaps[k as usize].fluid.is_some());
        self.seepage.run(cloud, gaps, &self.numbers, &self.between);
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
