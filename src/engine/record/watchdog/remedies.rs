//! Remedies that a message proposes for a flow that goes wrong: never a plugin that it has.

use crate::formulations::fluid::{FlowCloud, Group, Tension};
use crate::notation::quantity;
use crate::plugin::SimBuilder;
use crate::schedule::Step;
use crate::world::{BodyId, Damage, Removed};

/// Share of the energy that walls have given above which it is that of gaps.
const GAP_SHARE: f64 = 0.5;

/// Spacing over that of the fluid below which a wall or a body is finer.
const FINE: f64 = 0.95;

/// The bodies that have the plugins proposed.
pub(super) struct Remedies {
    diffused: Vec<bool>,
    controlled: Vec<bool>,
    cleared: Vec<bool>,
}

impl Remedies {
    /// Those of a scene.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let scene = sim.scene();
        let having = |plugin| (0..scene.bodies.len()).map(|body| scene.has_plugin(body, plugin)).collect();
        Self {
            diffused: having("density_diffusion"),
            controlled: having("tensile_control"),
            cleared: having("remove_fragments"),
        }
    }

    /// Advice for a shift beside walls and bodies that are finer than the fluid. Their first row is nearer to
    /// it, and where they have suction the shift presses the fluid off them, without end where it is sheared.
    pub fn of_finer_bodies(step: &Step<'_>) -> Option<String> {
        let cloud = step.resources.try_get::<FlowCloud>().filter(|cloud| cloud.is_confined())?;
        let spacing = |group: &Group| step.world.body(group.body).spacing;
        let of_fluid = cloud.groups.iter().find(|group| group.fluid().is_some()).map(spacing)?;
        let is_finer = |group: &&Group| group.fluid().is_none() && spacing(group) < FINE * of_fluid;
        let finer = cloud.groups.iter().find(is_finer)?;
        Some(format!(
            "it presses the fluid off `{}`, whose particles are finer than those of the fluid, and the pressure grows: give them the spacing of the fluid, or leave the \
             plugin out",
            step.world.body(finer.body).name
        ))
    }

    /// Advice for walls that have given so much energy, J.
    pub fn of_walls(&self, step: &Step<'_>, given: f64) -> String {
        if step.resources.try_get::<FlowCloud>().is_some_and(|cloud| cloud.gap_work > GAP_SHARE * given) {
            return "the pressure in gaps that no particle of the fluid fits into has moved a body, and no fluid has followed: start the body two spacings of the fluid from walls and others, hold it \
                    while the fluid strikes it, or take more particles"
                .to_owned();
        }
        if let Some(text) = self.of_debris(step) {
            return text;
        }
        let lacks_diffusion = step.resources.try_get::<FlowCloud>().is_some_and(|cloud| {
            let mut fluids = cloud.groups.iter().filter(|group| group.fluid().is_some());
            fluids.any(|group| !self.diffused[group.body.0])
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

    /// Advice where particles that have failed are left in a flow, which presses on each of them as on a part
    /// of a solid.
    pub fn of_debris(&self, step: &Step<'_>) -> Option<String> {
        FlowCloud::whole(step.resources)?;
        let has_debris = |id: BodyId| {
            let (view, mut rows) = step.world.body_view(id);
            let (Ok(damage), Ok(removed)) = (view.read::<Damage>(), view.read::<Removed>()) else {
                return false;
            };
            rows.any(|row| damage[row].0 >= 1.0 && removed[row] == Removed::NO)
        };
        let id = (0..step.world.bodies().len()).map(BodyId).find(|id| has_debris(*id))?;
        let pieces = if self.cleared[id.0] { "" } else { ", and `remove_fragments()` loose pieces" };
        Some(format!(
            "particles of `{}` that have failed are in the flow, which presses on each of them as on a part of a solid: `failure` with `then: Removed` takes them out{pieces}",
            step.world.body(id).name
        ))
    }

    /// Advice for a fluid under tension, or for the one of that name; none if it has the plugin.
    pub fn of_tension(&self, step: &Step<'_>, name: Option<&str>) -> Option<String> {
        let cloud = FlowCloud::whole(step.resources)?;
        let mut fluids = cloud.groups.iter().filter(|group| group.fluid().is_some());
        fluids.find_map(|group| {
            let body = &step.world.body(group.body).name;
            if name.is_some_and(|name| name != body) || self.controlled[group.body.0] {
                return None;
            }
            let tension = Tension::of(&cloud.records()[group.cloud.clone()], 0.0);
            (tension.share() > 0.0).then(|| {
                format!(
                    "`{body}` is under tension, down to {}, which causes pairing of particles and voids: `tensile_control()` among its `plugins`, or, in a closed flow, a pressure at the start that keeps it above zero, `Fluid(pressure: ...)`",
                    quantity(tension.minimum, "Pa")
                )
            })
        })
    }
}
