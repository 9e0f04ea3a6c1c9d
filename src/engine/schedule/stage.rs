//! The stages of a step, in the order in which they run.

/// A stage of the step; systems of one stage run one after another, in their stated order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// The time step is known: prescribed motion sets the velocities at mid-step.
    PreStep,
    /// First kick and drift: v(n+1/2) = v(n) + dt/2 a(n), x(n+1) = x(n) + dt v(n+1/2).
    InitialIntegrate,
    /// Cell grid, neighbour lists and sorting, where they are due.
    Neighbors,
    /// Gradients by a pass over pairs: deformation gradient, velocity gradient, density gradient.
    Gradients,
    /// Stress or pressure of every particle; plasticity, damage, temperature.
    Constitutive,
    /// Wall particles take pressure and velocity from the fluid beside them; forces of contact are computed.
    Boundary,
    /// Rates by a pass over pairs: force, density rate, heating, from every pair term at once.
    Rates,
    /// Forces from outside the pairs: tractions, point forces, contact, sums over rigid bodies.
    External,
    /// Second kick: v(n+1) = v(n+1/2) + dt/2 a(n+1); then boundary conditions on velocities.
    FinalIntegrate,
    /// Shifting, smoothing, damping, reference updates, removal of failed particles.
    PostStep,
    /// Probes, frames and checkpoints that are due now.
    Record,
}

impl Stage {
    /// All stages in the order in which they run.
    pub const ALL: [Stage; 11] = [
        Stage::PreStep,
        Stage::InitialIntegrate,
        Stage::Neighbors,
        Stage::Gradients,
        Stage::Constitutive,
        Stage::Boundary,
        Stage::Rates,
        Stage::External,
        Stage::FinalIntegrate,
        Stage::PostStep,
        Stage::Record,
    ];

    /// The stages that evaluate the right-hand side; they also run once before the first step.
    pub fn is_right_hand_side(self) -> bool {
        (Stage::Neighbors..=Stage::External).contains(&self)
    }
}
