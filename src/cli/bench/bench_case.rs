//! The benchmark cases: scenes with a selectable number of particles.

use anyhow::Result;
use meshless_validation::Template;

/// A benchmark case.
pub struct BenchCase {
    /// Name on the command line.
    pub name: &'static str,
    /// Title, in one line.
    pub title: &'static str,
    scene: (&'static str, &'static str),
    /// The spacing for a number of particles, m.
    spacing: fn(f64) -> f64,
    /// Overrides of the scene that define this case.
    set: &'static [(&'static str, BenchValue)],
    /// Steps after which the work repeats.
    pub cycle: u64,
}

/// A value of an override.
enum BenchValue {
    /// The given text.
    Text(&'static str),
    /// The spacing.
    Spacing,
    /// The size of a tank whose walls have four layers of particles, in this number of dimensions.
    Tank(usize),
}

impl BenchValue {
    fn text(&self, spacing: f64) -> String {
        let wall = 4.0 * spacing;
        let across = ((1.0 / spacing).round() + 4.0) * spacing;
        match self {
            Self::Text(text) => (*text).to_owned(),
            Self::Spacing => format!("{spacing:?}"),
            Self::Tank(2) => format!(
                "Difference(Box(min: (-{wall:?}, -{wall:?}), max: ({:?}, 1.2)), Box(min: (0, 0), max: ({:?}, 2)))",
                across + 1.0,
                across + 1.0 - wall,
            ),
            Self::Tank(_) => format!(
                "Difference(Box(min: (-{wall:?}, -{wall:?}, -{wall:?}), max: ({:?}, 1.2, {across:?})), \
                 Box(min: (0, 0, 0), max: ({:?}, 2, {:?})))",
                across + 1.0,
                across + 1.0 - wall,
                across - wall,
            ),
        }
    }
}

impl BenchCase {
    /// The scene with approximately this number of moving particles.
    pub fn scene(&self, particles: usize) -> Result<Template> {
        let (path, text) = self.scene;
        let spacing = (self.spacing)(particles as f64);
        self.set.iter().try_fold(Template::new(path, text), |template, (path, value)| {
            template.set(path, value.text(spacing))
        })
    }
}

use BenchValue::{Spacing, Tank, Text};

const BLOCK: (&str, &str) = ("benches/scenes/block.ron", include_str!("../../../benches/scenes/block.ron"));
const STRIP: (&str, &str) = ("benches/scenes/strip.ron", include_str!("../../../benches/scenes/strip.ron"));

const DAM: (&str, &str) = ("benches/scenes/dam.ron", include_str!("../../../benches/scenes/dam.ron"));
const DAM_PLANE: (&str, &str) =
    ("benches/scenes/dam_plane.ron", include_str!("../../../benches/scenes/dam_plane.ron"));
const DAM_PLATE: (&str, &str) =
    ("benches/scenes/dam_plate.ron", include_str!("../../../benches/scenes/dam_plate.ron"));

const SLABS: (&str, &str) = ("benches/scenes/slabs.ron", include_str!("../../../benches/scenes/slabs.ron"));
const SHEETS: (&str, &str) =
    ("benches/scenes/sheets.ron", include_str!("../../../benches/scenes/sheets.ron"));
const SHEETS_PLANE: (&str, &str) =
    ("benches/scenes/sheets_plane.ron", include_str!("../../../benches/scenes/sheets_plane.ron"));

const ABRASIVE: (&str, &str) =
    ("assets/scenes/abrasive_flow.ron", include_str!("../../../assets/scenes/abrasive_flow.ron"));

const CHANNEL_FLUID: (&str, &str) =
    ("benches/scenes/channel_fluid.ron", include_str!("../../../benches/scenes/channel_fluid.ron"));
const CHANNEL_FLOOR: (&str, &str) =
    ("benches/scenes/channel_floor.ron", include_str!("../../../benches/scenes/channel_floor.ron"));
const CHANNEL_GRAINS: (&str, &str) =
    ("benches/scenes/channel_grains.ron", include_str!("../../../benches/scenes/channel_grains.ron"));

/// Spacing of a lattice in the unit cube or square, m.
fn cube(particles: f64) -> f64 {
    1.0 / particles.cbrt().round()
}

fn square(particles: f64) -> f64 {
    1.0 / particles.sqrt().round()
}

/// Spacing of 200 layers that are 1 m long.
fn slabs(particles: f64) -> f64 {
    1.0 / (particles / 200.0).round().max(1.0)
}

/// Spacing of eight layers that are 1 m long, and of ten that are 1 m long and wide.
fn sheets_plane(particles: f64) -> f64 {
    1.0 / (particles / 8.0).round().max(1.0)
}

fn sheets(particles: f64) -> f64 {
    1.0 / (particles / 10.0).sqrt().round().max(1.0)
}

/// Spacing in the channel of abrasive flow, m: an integer fraction of that of the scene, so that the gaps
/// between the bodies remain.
fn channel(particles: f64) -> f64 {
    let (usual, area) = (2.0e-6, 2.8e-8);
    usual / (usual / (area / particles).sqrt()).round().max(1.0)
}

/// All cases.
pub const BENCH_CASES: &[BenchCase] = &[
    BenchCase {
        name: "solid-31",
        title: "solid in three dimensions, total-Lagrangian, 32 neighbours inside",
        scene: BLOCK,
        spacing: cube,
        set: &[
            ("bodies.block.spacing", Spacing),
            ("bodies.block.formulation", Text("TotalLagrangian(support: 2.2)")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "solid-31-free",
        title: "solid-31 without hourglass control",
        scene: BLOCK,
        spacing: cube,
        set: &[
            ("bodies.block.spacing", Spacing),
            ("bodies.block.formulation", Text("TotalLagrangian(support: 2.2)")),
            ("bodies.block.plugins", Text("[]")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "solid-31-term",
        title: "solid-31 with a pair term of a plugin, artificial viscosity",
        scene: BLOCK,
        spacing: cube,
        set: &[
            ("bodies.block.spacing", Spacing),
            ("bodies.block.formulation", Text("TotalLagrangian(support: 2.2)")),
            ("bodies.block.plugins", Text("[hourglass_control(), artificial_viscosity()]")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "solid-updated",
        title: "solid-31 with updated-Lagrangian bodies, cubic spline",
        scene: BLOCK,
        spacing: cube,
        set: &[
            ("bodies.block.spacing", Spacing),
            ("bodies.block.formulation", Text("UpdatedLagrangian(support: 2.2)")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "solid-updated-3",
        title: "solid-updated, its reference updated every three steps",
        scene: BLOCK,
        spacing: cube,
        set: &[
            ("bodies.block.spacing", Spacing),
            ("bodies.block.formulation", Text("UpdatedLagrangian(support: 2.2, update: Every(3))")),
        ],
        cycle: 3,
    },
    BenchCase {
        name: "solid-updated-hessian",
        title: "solid-updated with differences of second derivatives in the place of hourglass control",
        scene: BLOCK,
        spacing: cube,
        set: &[
            ("bodies.block.spacing", Spacing),
            ("bodies.block.formulation", Text("UpdatedLagrangian(support: 2.2)")),
            ("bodies.block.plugins", Text("[hessian_stabilization()]")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "solid-54",
        title: "solid in three dimensions, total-Lagrangian, 56 neighbours inside",
        scene: BLOCK,
        spacing: cube,
        set: &[("bodies.block.spacing", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "solid-2d",
        title: "solid in plane strain, total-Lagrangian",
        scene: STRIP,
        spacing: square,
        set: &[("bodies.strip.spacing", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "eulerian",
        title: "solid in three dimensions, Eulerian",
        scene: BLOCK,
        spacing: cube,
        set: &[("bodies.block.spacing", Spacing), ("bodies.block.formulation", Text("Eulerian()"))],
        cycle: 1,
    },
    BenchCase {
        name: "eulerian-2d",
        title: "solid in plane strain, Eulerian",
        scene: STRIP,
        spacing: square,
        set: &[("bodies.strip.spacing", Spacing), ("bodies.strip.formulation", Text("Eulerian()"))],
        cycle: 1,
    },
    BenchCase {
        name: "dam-80",
        title: "dam break in three dimensions, 80 neighbours inside",
        scene: DAM,
        spacing: cube,
        set: &[
            ("bodies.water.spacing", Spacing),
            ("bodies.tank.spacing", Spacing),
            ("bodies.tank.shape", Tank(3)),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "dam-80-double",
        title: "dam-80 with sums in double precision",
        scene: DAM,
        spacing: cube,
        set: &[
            ("precision", Text("Double")),
            ("bodies.water.spacing", Spacing),
            ("bodies.tank.spacing", Spacing),
            ("bodies.tank.shape", Tank(3)),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "dam-170",
        title: "dam-80 with 170 neighbours inside",
        scene: DAM,
        spacing: cube,
        set: &[
            ("bodies.water.spacing", Spacing),
            ("bodies.tank.spacing", Spacing),
            ("bodies.tank.shape", Tank(3)),
            ("bodies.water.formulation", Text("Fluid(support: 3.4)")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "dam-2d",
        title: "dam break in a plane, 20 neighbours inside",
        scene: DAM_PLANE,
        spacing: square,
        set: &[
            ("bodies.water.spacing", Spacing),
            ("bodies.tank.spacing", Spacing),
            ("bodies.tank.shape", Tank(2)),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "dam-2d-delta",
        title: "dam-2d as scenes have it without settings: 28 neighbours, renormalised density diffusion",
        scene: DAM_PLANE,
        spacing: square,
        set: &[
            ("bodies.water.spacing", Spacing),
            ("bodies.tank.spacing", Spacing),
            ("bodies.tank.shape", Tank(2)),
            ("bodies.water.formulation", Text("Fluid")),
            ("bodies.water.plugins", Text("[density_diffusion()]")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "dam-plate",
        title: "dam break in a plane with a plate of rubber in its way",
        scene: DAM_PLATE,
        spacing: square,
        set: &[
            ("bodies.water.spacing", Spacing),
            ("bodies.plate.spacing", Spacing),
            ("bodies.tank.spacing", Spacing),
            ("bodies.tank.shape", Tank(2)),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "abrasive",
        title: "abrasive flow in a plane: fluid, grains, a wearing Eulerian solid, as the shipped scene has them",
        scene: ABRASIVE,
        spacing: channel,
        set: &[("parameters.dx", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "abrasive-fluid",
        title: "the fluid of abrasive alone, its floor a wall: a part, at the spacing of the whole",
        scene: CHANNEL_FLUID,
        spacing: channel,
        set: &[("parameters.dx", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "abrasive-floor",
        title: "the floor of abrasive alone, an Eulerian solid that can fail",
        scene: CHANNEL_FLOOR,
        spacing: channel,
        set: &[("parameters.dx", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "abrasive-grains",
        title: "the grains of abrasive alone over a rigid floor, with their contacts",
        scene: CHANNEL_GRAINS,
        spacing: channel,
        set: &[("parameters.dx", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "contact-1",
        title: "two slabs in a plane pressed together face to face: one in a hundred particles touches",
        scene: SLABS,
        spacing: slabs,
        set: &[("parameters.dx", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "contact-all-2d",
        title: "a stack of sheets in a plane, each of two layers: every particle touches",
        scene: SHEETS_PLANE,
        spacing: sheets_plane,
        set: &[("parameters.dx", Spacing)],
        cycle: 1,
    },
    BenchCase {
        name: "contact-rubbed",
        title: "contact-all-2d with friction, every other sheet sliding",
        scene: SHEETS_PLANE,
        spacing: sheets_plane,
        set: &[
            ("parameters.dx", Spacing),
            ("parameters.friction", Text("0.3")),
            ("parameters.slide", Text("1.0")),
        ],
        cycle: 1,
    },
    BenchCase {
        name: "contact-all",
        title: "a stack of sheets in three dimensions, each of two layers: every particle touches",
        scene: SHEETS,
        spacing: sheets,
        set: &[("parameters.dx", Spacing)],
        cycle: 1,
    },
];
