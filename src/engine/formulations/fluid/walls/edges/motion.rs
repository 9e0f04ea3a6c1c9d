//! The motion of wall particles beside edges, and its contribution to the rates of compression.

use glam::{DMat3, DVec3};

use super::fronts::WallShapes;
use crate::formulations::fluid::cloud::{BoundaryEdges, EdgeParticle, FlowCloud, Group, MIN_SHARE, part};
use crate::linalg::dyad;
use crate::plugin::SimBuilder;
use crate::schedule::{Run, Step, StepError};

/// Weight of a particle itself, over the sum of the weights of faces around it.
const OWN: f64 = 1e-3;

/// Finds the particles beside edges and their motion.
pub struct EdgeMotion {
    shapes: WallShapes,
    /// For every boundary particle, the sum over the faces around it.
    sums: Vec<FaceSums>,
    /// Rows of those with faces.
    touched: Vec<usize>,
}

#[derive(Clone, Copy, Debug)]
struct FaceSums {
    moments: DMat3,
    motion: DVec3,
    /// Weight of the faces of other boundaries, and the part of it that the particle is behind.
    others: f64,
    behind: f64,
}

impl FaceSums {
    const NONE: Self = Self { moments: DMat3::ZERO, motion: DVec3::ZERO, others: 0.0, behind: 0.0 };
}

impl EdgeMotion {
    /// That of the walls of a flow; none where there is one at most.
    pub fn new(groups: &[Group], sim: &SimBuilder<'_>) -> Option<Self> {
        let shapes = WallShapes::new(groups, sim)?;
        Some(Self { shapes, sums: Vec::new(), touched: Vec::new() })
    }

    /// Adds up the faces around all particles of the walls.
    fn add_faces(&mut self, cloud: &FlowCloud, edges: &BoundaryEdges) {
        let Self { sums: all, touched, .. } = self;
        all.resize(cloud.records.len() - cloud.fluid, FaceSums::NONE);
        touched.clear();
        for front in &edges.fronts {
            let beside = |rows| part(cloud.near_row(front.i), rows).iter().map(|&w| w as usize);
            for w in edges.rows.iter().flat_map(beside) {
                let (share, depth) = front.share_and_depth(cloud, w);
                let sums = &mut all[w - cloud.fluid];
                if share == 0.0 || !cloud.pairs.gaps.have_edges(front.boundary, w) {
                    continue;
                }
                if sums.moments == DMat3::ZERO {
                    touched.push(w);
                }
                if cloud.group_of(w).cloud.start != front.boundary {
                    sums.others += share;
                    sums.behind += share * (depth / front.spacing + 0.5).clamp(0.0, 1.0);
                }
                sums.moments += share * dyad(front.normal, front.normal);
                sums.motion += share * front.normal.dot(front.velocity) * front.normal;
            }
        }
        touched.sort_unstable();
    }

    /// Computes the motion of the particles from the sums; `half` is half of the step, s.
    fn solve_motion(&mut self, cloud: &FlowCloud, half: f64, out: &mut Vec<EdgeParticle>) {
        out.clear();
        for &row in &self.touched {
            let FaceSums { moments, motion, others, behind } =
                std::mem::replace(&mut self.sums[row - cloud.fluid], FaceSums::NONE);
            if behind == 0.0 {
                continue;
            }
            let behind = behind / others;
            let own = OWN * (moments.x_axis.x + moments.y_axis.y + moments.z_axis.z);
            let inverse = behind * (moments + DMat3::from_diagonal(DVec3::splat(own))).inverse();
            let v = cloud.records[row].velocity();
            let excess = match cloud.group_of(row).has_suction() {
                true => inverse * (motion + own * v) - behind * v,
                false => DVec3::ZERO,
            };
            let [share, rate] = cloud.sums_beside(row, half, |part| part.dot(excess));
            let rate = if share > MIN_SHARE { -rate / share } else { 0.0 };
            out.push(EdgeParticle { row, behind, inverse, own, excess, rate, force: [DVec3::ZERO; 2] });
        }
    }
}

impl Run for EdgeMotion {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let half = 0.5 * step.clock.dt;
        let mut edges = std::mem::take(&mut cloud.edges);
        self.shapes.find(&cloud, step, &mut edges)?;
        self.add_faces(&cloud, &edges);
        self.solve_motion(&cloud, half, &mut edges.particles);
        let mut rates = std::mem::take(&mut cloud.compression);
        for edge in edges.particles.iter().filter(|edge| edge.excess != DVec3::ZERO) {
            cloud.for_each_beside(edge.row, half, |j, _, force| rates[j] -= force.dot(edge.excess));
        }
        (cloud.compression, cloud.edges) = (rates, edges);
        Ok(())
    }
}
