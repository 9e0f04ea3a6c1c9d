//! Viscosities between the bodies of a flow.

use super::group::{FluidState, Group, Role};

/// Kinematic viscosity, in units of c_0 h, above which a fluid is viscous and friction is corrected by the
/// spin: a flow at a tenth of the speed of sound has larger other losses below it.
const VISCOUS: f64 = 1e-4;
/// The same above which friction is corrected by the spin where a boundary to which the fluid sticks may
/// turn: sound is often far more than ten times as fast as that.
const VISCOUS_WHERE_TURNED: f64 = 1e-5;

/// Friction that goes into the sums of a loop: none, without spins, and corrected by these.
pub const NONE: u8 = 0;
pub const PLAIN: u8 = 1;
pub const WITH_SPIN: u8 = 2;

/// The viscosity between each two groups, Pa s.
#[derive(Debug)]
pub struct Viscosities {
    /// Group by group.
    values: Vec<f64>,
    /// First row of each group in the cloud.
    starts: Vec<usize>,
    /// Whether friction is corrected by the spin.
    pub spin: bool,
    /// Kinematic viscosity over c_0 above which it is, m.
    pub least: f64,
    /// Whether a fluid is viscous.
    pub is_viscous: bool,
}

/// Whether a fluid is viscous at a smoothing length `h`, m.
pub fn is_viscous(state: &FluidState, h: f64) -> bool {
    reaches(state, h * VISCOUS)
}

/// Whether the kinematic viscosity over c_0 is above `least`, m.
fn reaches(state: &FluidState, least: f64) -> bool {
    state.viscosity > least * state.density * state.sound_speed
}

impl Viscosities {
    /// Those of a flow of smoothing length `h`, m; `turns` says whether a boundary to which fluids stick may.
    pub fn new(groups: &[Group], h: f64, turns: bool) -> Self {
        let of = |a: &Group| groups.iter().map(|b| between(&a.role, &b.role)).collect::<Vec<f64>>();
        let reaches = |least: f64| groups.iter().filter_map(Group::fluid).any(|state| reaches(state, least));
        let least = h * if turns { VISCOUS_WHERE_TURNED } else { VISCOUS };
        Self {
            values: groups.iter().flat_map(of).collect(),
            starts: groups.iter().map(|group| group.cloud.start).collect(),
            spin: reaches(least),
            least,
            is_viscous: reaches(h * VISCOUS),
        }
    }

    /// Those of a group with every group.
    pub fn of(&self, group: &Group) -> &[f64] {
        let count = self.starts.len();
        let at = self.starts.iter().position(|&start| start == group.cloud.start).unwrap_or(0);
        &self.values[at * count..(at + 1) * count]
    }

    /// The friction of pairs with that viscosity, Pa s.
    #[inline(always)]
    pub fn friction(&self, viscosity: f64) -> u8 {
        match (viscosity > 0.0, self.spin) {
            (false, _) => NONE,
            (true, false) => PLAIN,
            (true, true) => WITH_SPIN,
        }
    }

    /// Factor of mu_ij w_ij in the friction of a pair.
    pub fn factor(&self) -> f64 {
        if self.spin { 4.0 } else { 2.0 }
    }
}

fn between(a: &Role, b: &Role) -> f64 {
    match (a, b) {
        (Role::Fluid(a), Role::Fluid(b)) => a.viscosity_with(b),
        (Role::Fluid(fluid), Role::Boundary(surface)) | (Role::Boundary(surface), Role::Fluid(fluid)) => {
            if surface.no_slip {
                fluid.viscosity
            } else {
                0.0
            }
        }
        (Role::Boundary(_), Role::Boundary(_)) => 0.0,
    }
}
