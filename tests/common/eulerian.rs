//! An Eulerian block, and what the sums over pairs need of its particles.

use meshless::formulations::eulerian::SupportMetric;
use meshless::glam::{DMat3, DVec3};
use meshless::linalg::Sym3;
use meshless::scene::Source;
use meshless::simulation::Simulation;
use meshless::world::{
    BodyId, DeformationGradient, Force, Mass, PiolaStress, Position, ReferenceVolume, Velocity,
};

use super::simulation;

/// The formulation with supports that become ellipsoids.
pub const FOLLOWING: &str = "Eulerian(support_follows: true)";
/// Velocities of a block that press it to some 0.6 of its length, in a plane and in space.
pub const UPSET: [&str; 2] = [
    r#"("0.3 - 1.2*(x - 0.5) + 0.8*y", "0.3*sin(5*x) + 0.8*(y - 0.2)")"#,
    r#"("0.3 - 1.2*(x - 0.5) + 0.8*y", "0.3*sin(5*x)", "0.5*x + 0.4*(z - 0.2)")"#,
];

/// A block of 1 x 0.4 m of irregular particles with a velocity, and in three dimensions 0.4 m deep.
pub fn block(dimension: usize, formulation: &str, velocity: &str, more: &str) -> Source {
    let (name, max) = if dimension == 2 { ("Two", "(1, 0.4)") } else { ("Three", "(1, 0.4, 0.4)") };
    let spacing = if dimension == 2 { 0.05 } else { 0.1 };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"rubber": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "block", material: "rubber", shape: Box(min: (0, 0, 0), max: {max}), spacing: {spacing},
                      lattice: Relaxed(seed: 5, iterations: 2), formulation: {formulation})],
            conditions: [InitialVelocity(on: Select(body: "block"), value: {velocity})],
            {more}
            time: (end: 100.0))"#
    );
    Source::new("block.ron", text.replace("(0, 0, 0)", if dimension == 2 { "(0, 0)" } else { "(0, 0, 0)" }))
}

pub fn after(source: &Source, steps: u64) -> Simulation {
    let mut sim = simulation(source);
    sim.run(|sim| sim.clock().step < steps).expect("a run");
    sim
}

/// A block whose density is smoothed while it swings.
pub fn diffusing() -> Source {
    let formulation = "Eulerian(), plugins: [hourglass_control(), density_diffusion(delta: 0.2)]";
    block(2, formulation, r#"("0.3*sin(5*x)", "0.2*x*y")"#, "")
}

/// What the sums over pairs need of a particle.
#[derive(Clone, Copy)]
pub struct Particle {
    pub x: DVec3,
    pub v: DVec3,
    pub f: DVec3,
    pub m: f64,
    /// V_0.
    pub volume: f64,
    pub deformation: DMat3,
    pub stress: DMat3,
    /// Metric of its support.
    pub metric: Sym3,
}

pub fn particles(sim: &Simulation) -> Vec<Particle> {
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (x, v) = (view.read::<Position>().expect("places"), view.read::<Velocity>().expect("velocities"));
    let (f, m) = (view.read::<Force>().expect("forces"), view.read::<Mass>().expect("masses"));
    let volume = view.read::<ReferenceVolume>().expect("volumes");
    let deformation = view.read::<DeformationGradient>().expect("gradients");
    let stress = view.read::<PiolaStress>().expect("stresses");
    let metric = view.read::<SupportMetric>().expect("supports");
    let of = |k: usize| Particle {
        x: x[k].0,
        v: v[k].0,
        f: f[k].0,
        m: m[k].0,
        volume: volume[k].0,
        deformation: deformation[k].0,
        stress: stress[k].0,
        metric: metric[k].0,
    };
    rows.map(of).collect()
}
