//! Remedies that a message proposes for a flow that goes wrong: never a plugin that it has.

use crate::formulations::fluid::{FlowCloud, FlowParticle, Group};
use crate::notation::quantity;
use crate::plugin::{BodyPlan, SimBuilder};
use crate::scene::Item;
use crate::schedule::Step;
use crate::world::BodyId;

/// Minimum pressure below zero, over the largest magnitude of the pressure in the same flow, that counts as
/// tension.
const TENSION: f64 = 0.1;

/// Share of the energy that walls have given above which it is that of gaps.
const GAP_SHARE: f64 = 0.5;

/// The plugins of all bodies.
pub(super) struct Remedies {
    /// Names of the plugins of each body, those of the scene included.
    plugins: Vec<Vec<String>>,
}

impl Remedies {
    /// The plugins that the scene names.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let scene = sim.scene();
        let of = |body: &BodyPlan| {
            let all = scene.plugins.iter().chain(&scene.bodies[body.id.0].plugins);
            all.map(|item: &Item| item.name().to_owned()).collect()
        };
        Self { plugins: sim.bodies().iter().map(of).collect() }
    }

    fn has(&self, body: BodyId, plugin: &str) -> bool {
        self.plugins[body.0].iter().any(|name| name == plugin)
    }

    /// Advice for walls that have given so much energy, J.
    pub fn of_walls(&self, step: &Step<'_>, given: f64) -> String {
        if step.resources.try_get::<FlowCloud>().is_some_and(|cloud| cloud.gap_work > GAP_SHARE * given) {
            return "the pressure in gaps that no particle of the fluid fits into has moved a body, and no fluid has followed: start the body two spacings of the fluid from walls and others, hold it \
                    while the fluid strikes it, or take more particles"
                .to_owned();
        }
        let lacks_diffusion = step.resources.try_get::<FlowCloud>().is_some_and(|cloud| {
            let mut fluids = cloud.groups.iter().filter(|group| group.fluid().is_some());
            fluids.any(|group| !self.has(group.body, "density_diffusion"))
        });
        let noise = if lacks_diffusion { "`density_diffusion()` for its noise, " } else { "" };
        let is_open = |cloud: &FlowCloud| !cloud.is_confined() && !cloud.groups.iter().any(Group::is_wall);
        let pull = if step.resources.try_get::<FlowCloud>().is_some_and(|cloud| is_open(&cloud)) {
            "where bodies alone enclose the fluid, a domain that is periodic along all axes, in which they have suction, "
        } else {
            ""
        };
        let rest = format!("{noise}{pull}no particle inside of a wall or body, more particles");
        match self.of_tension(step, None) {
            Some(text) => format!("{text}; else {rest}"),
            None => format!("the pressure that walls and bodies take from the flow does not fit it: {rest}"),
        }
    }

    /// Advice for a fluid under tension, or for the one of that name; none if it has the plugin.
    pub fn of_tension(&self, step: &Step<'_>, name: Option<&str>) -> Option<String> {
        let cloud = FlowCloud::whole(step.resources)?;
        let mut fluids = cloud.groups.iter().filter(|group| group.fluid().is_some());
        fluids.find_map(|group| {
            let body = &step.world.body(group.body).name;
            if name.is_some_and(|name| name != body) || self.has(group.body, "tensile_control") {
                return None;
            }
            let pressures = cloud.records()[group.cloud.clone()].iter().map(FlowParticle::pressure);
            let (least, largest) = pressures.fold((0.0_f64, 0.0_f64), |(least, largest), pressure| {
                (least.min(pressure), largest.max(pressure.abs()))
            });
            (least < -TENSION * largest).then(|| {
                format!(
                    "`{body}` is under tension, down to {}, which causes pairing of particles and voids: `tensile_control()` among its `plugins`, or, in a closed flow, a pressure at the start that keeps it above zero, `Fluid(pressure: ...)`",
                    quantity(least, "Pa")
                )
            })
        })
    }
}
