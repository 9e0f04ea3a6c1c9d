//! A particle beside a gap, and the fluid there.

use glam::DVec3;

use super::moments::Surrounding;
use crate::formulations::fluid::cloud::FlowCloud;

/// Share of the fluid below which a particle sees none.
pub const MIN_SHARE: f64 = 1e-10;
/// Cosine of the angle between the ways to the fluid and out of a gap above which the fluid is outside of it.
const BEHIND: f64 = 0.5;

/// The fluid at a particle: pressure, Pa, and its gradient at rest, Pa/m; its density, kg/m3, and the length
/// of the way to where it is, m, zero before the gap has been looked into.
#[derive(Clone, Copy, Debug, Default)]
pub struct GapRemainder {
    pub pressure: f64,
    pub slope: DVec3,
    pub density: f64,
    pub way: f64,
}

/// The way to the fluid in the support of a boundary particle, m; zero where there is none.
pub fn way_to_fluid(cloud: &FlowCloud, row: usize) -> DVec3 {
    let near = cloud.near_row(row).iter().filter_map(|&j| cloud.gap_pair(row, j));
    let (mut total, mut place) = (0.0, DVec3::ZERO);
    for pair in near {
        total += pair.value;
        place += pair.value * pair.x;
    }
    if total > MIN_SHARE { place / total } else { DVec3::ZERO }
}

/// Whether fluid that is that way is not in a gap out of which this direction leads.
pub fn is_outside(way: DVec3, out: DVec3) -> bool {
    way.dot(out) > BEHIND * way.length()
}

impl GapRemainder {
    /// The pressure at that offset, m, Pa.
    pub fn at(&self, x: DVec3) -> f64 {
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
    pub fn open(&mut self, cloud: &FlowCloud, motion: &BoundaryMotion<'_>) {
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
