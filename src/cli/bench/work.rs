//! The standard works: scenes at any number of particles.

use anyhow::Result;

use super::super::template::Template;

/// A standard work.
pub struct Work {
    /// Name on the command line.
    pub name: &'static str,
    /// What it is, in one line.
    pub title: &'static str,
    scene: (&'static str, &'static str),
    /// Path of the spacing in the scene, and the spacing for a number of particles, m.
    spacing: (&'static str, fn(f64) -> f64),
    /// Values of the scene that make this work out of it.
    set: &'static [(&'static str, &'static str)],
}

impl Work {
    /// The scene with about that many particles.
    pub fn scene(&self, particles: usize) -> Result<Template> {
        let (path, text) = self.scene;
        let (place, spacing) = self.spacing;
        let mut template = Template::new(path, text).set(place, spacing(particles as f64))?;
        for (path, value) in self.set {
            template = template.set(path, value)?;
        }
        Ok(template)
    }
}

const BLOCK: (&str, &str) = ("benches/scenes/block.ron", include_str!("../../../benches/scenes/block.ron"));
const STRIP: (&str, &str) = ("benches/scenes/strip.ron", include_str!("../../../benches/scenes/strip.ron"));

/// Spacing of a lattice in the unit cube or square, m.
fn cube(particles: f64) -> f64 {
    1.0 / particles.cbrt().round()
}

fn square(particles: f64) -> f64 {
    1.0 / particles.sqrt().round()
}

/// A solid in three dimensions.
const fn block(
    name: &'static str,
    title: &'static str,
    set: &'static [(&'static str, &'static str)],
) -> Work {
    Work { name, title, scene: BLOCK, spacing: ("bodies.block.spacing", cube), set }
}

/// All works.
pub const WORKS: &[Work] = &[
    block(
        "solid-31",
        "solid in three dimensions, total-Lagrangian, 32 neighbours inside",
        &[("bodies.block.formulation", "TotalLagrangian(support: 2.2)")],
    ),
    block(
        "solid-31-free",
        "the same without hourglass control",
        &[("bodies.block.formulation", "TotalLagrangian(support: 2.2)"), ("bodies.block.plugins", "[]")],
    ),
    block(
        "solid-31-term",
        "the same with a pair term of a plugin, artificial viscosity",
        &[
            ("bodies.block.formulation", "TotalLagrangian(support: 2.2)"),
            ("bodies.block.plugins", "[hourglass_control(), artificial_viscosity()]"),
        ],
    ),
    block("solid-54", "solid in three dimensions, total-Lagrangian, 56 neighbours inside", &[]),
    Work {
        name: "solid-2d",
        title: "solid in plane strain, total-Lagrangian",
        scene: STRIP,
        spacing: ("bodies.strip.spacing", square),
        set: &[],
    },
];
