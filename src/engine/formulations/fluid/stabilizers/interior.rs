//! Particles away from free surfaces, on which a stabilizer may act.

use crate::formulations::fluid::cloud::FlowCloud;

/// Smallest eigenvalue above which a particle can be inside the fluid (Marrone et al., J. Comput. Phys. 229
/// (2010) 3652-3663).
const INSIDE: f64 = 0.75;
/// Smallest eigenvalue below which a particle is at a free surface or beside a hole: its neighbours are not
/// inside.
const OUTERMOST: f64 = 0.65;

/// The particles inside of fluids: the smallest eigenvalue of `sum_j V_j w_ij x_ij (x) x_ij` is at least 0.75
/// and that of every neighbour 0.65.
#[derive(Debug, Default)]
pub struct Interior {
    inside: Vec<bool>,
}

impl Interior {
    /// Finds them by the smallest eigenvalue of each row of the fluids. Few particles are at a surface, so
    /// that it is cheaper to mark the neighbours of these than to test the neighbours of all.
    pub fn find(&mut self, cloud: &FlowCloud, lambda: impl Fn(usize) -> f64) {
        self.inside.clear();
        self.inside.extend((0..cloud.fluid).map(|i| lambda(i) >= INSIDE));
        let outermost = |i: &usize| lambda(*i) < OUTERMOST && cloud.volume(*i) > 0.0;
        for i in (0..cloud.fluid).filter(outermost) {
            cloud.for_each_neighbor(i, |near| {
                if let Some(inside) = self.inside.get_mut(near.row) {
                    *inside = false;
                }
            });
        }
    }

    /// Whether the particle in that row of the fluids is one of them.
    pub fn has(&self, row: usize) -> bool {
        self.inside[row]
    }
}
