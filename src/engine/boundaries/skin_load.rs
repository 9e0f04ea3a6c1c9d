//! Tractions and pressures on the surface of a body, which its skin distributes to the particles.
//!
//! The work of a step is the mean of the forces at its two ends times the displacement of the vertices.
//!
//! On bodies that can fail, loads on a `face` act so until the first particle that carries it fails, and from
//! that step on they act on the selected particles ([`BrokenSkinLoad`](super::broken_skin::BrokenSkinLoad)).
//! Loads on another part of the `surface` have no such particles: they leave out the facets whose particles
//! have failed.

use std::sync::Arc;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::beside_held;
use super::field::VectorField;
use super::pulses;
use super::symmetry::planes_of;
use crate::notation::{place, quantity};
use crate::plugin::{BodyPlan, Offer, Selection, SetupError, SimBuilder};
use crate::scene::{Expression, Select};
use crate::schedule::{AccountKind, Mode, Resources, Run, Shared, Stage, Step, StepError, System};
use crate::shapes::directed_area;
use crate::skins::{Last, Patch, SelectedFacet, Skin, SkinColumns, Wanted, selected_facets};
use crate::solids::CORRECTED_STRESS;
use crate::symmetry::{Repeat, periods_of};
use crate::world::{
    Body, BodyId, BodySet, Damage, DeformationGradient, Force, Mobility, Position, Removed, Velocity,
};

/// Kind of the force on a facet.
pub(super) enum LoadKind {
    /// A force per area of the reference configuration.
    Traction(VectorField),
    /// Against the normal, per area of now.
    Pressure(Expression),
}

impl LoadKind {
    /// The functions of place and time.
    pub fn functions(&self) -> Vec<Expression> {
        match self {
            Self::Traction(field) => field.functions().cloned().collect(),
            Self::Pressure(value) => vec![value.clone()],
        }
    }
}

/// A load on facets of the skin of a body.
struct SkinLoad {
    label: &'static str,
    kind: LoadKind,
    patch: Patch,
    /// The loaded parts of facets, with their middles in the reference configuration, m, and their areas
    /// there, m2; stated areas come in as a factor.
    facets: Vec<(SelectedFacet, DVec3, f64)>,
    factor: f64,
    /// Forces on the vertices at the end of the last step, N.
    last: Vec<DVec3>,
    /// Treatment of the load where the body fails, if it can.
    breaking: Breaking,
    /// Whether particles that carry the facets have failed and act in their place.
    is_broken: bool,
    /// Whether the user has been told of facets that are left out.
    is_told: bool,
}

/// Treatment of a load where particles that carry its facets fail.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Breaking {
    /// The body cannot fail.
    Never,
    /// Particles are loaded in place of all facets.
    OnParticles,
    /// Those facets are loaded no more.
    LeftOut,
}

impl Breaking {
    fn of(select: &Select, body: &BodyPlan) -> Self {
        match (body.can_fail(), select.surface.is_some()) {
            (false, _) => Self::Never,
            (true, false) => Self::OnParticles,
            (true, true) => Self::LeftOut,
        }
    }
}

/// The loads of a condition on the skins of bodies.
pub(super) struct SkinLoads(Vec<SkinLoad>);

impl SkinLoads {
    /// Whether the load on a body acts on its skin.
    pub fn act_on(&self, body: BodyId) -> bool {
        self.0.iter().any(|load| load.patch.skin.body == body && !load.is_broken)
    }
}

/// The skins of the bodies of a selection; none if the load has to act on particles.
pub(super) fn skins_of(
    select: &Select,
    selection: &Selection,
    sim: &SimBuilder<'_>,
) -> Result<Option<Vec<Arc<Skin>>>, SetupError> {
    let skins = selection.parts.iter().map(|(id, _)| skin_of(select, sim.body(*id), sim));
    let skins: Option<Vec<_>> = skins.collect();
    if skins.is_none() && select.surface.is_some() {
        let message = "the surface of a selected body is not known, or is not carried by its formulation";
        return Err(SetupError::parameter("on.surface", message, "select particles of a `face` instead"));
    }
    // A face of a shape without one: the load on particles says what is wrong.
    let has_any = |skins: &Vec<Arc<Skin>>| -> Result<bool, SetupError> {
        for skin in skins {
            if !selected_facets(select, skin.body, &skin.facets, &repeats_of(sim.body(skin.body), sim), sim)?
                .is_empty()
            {
                return Ok(true);
            }
        }
        Ok(false)
    };
    match skins {
        Some(skins) if select.surface.is_some() || has_any(&skins)? => Ok(Some(skins)),
        _ => Ok(None),
    }
}

/// The skin of a body on which a load acts; none if the load has to act on particles.
fn skin_of(select: &Select, body: &BodyPlan, sim: &SimBuilder<'_>) -> Option<Arc<Skin>> {
    body.solid_law().ok()?;
    let is_surface = (select.face.is_some() || select.surface.is_some()) && select.nearest.is_none();
    if !body.offers(Offer::DeformedContact) || !is_surface {
        return None;
    }
    let shape = &sim.scene().bodies[body.id.0].shape;
    // Vertices where the body goes on are carried from both sides, so that a uniform load stays uniform.
    Skin::of(body, shape, &repeats_of(body, sim), sim.dimension(), sim.folder()).map(Arc::new)
}

/// Where a body continues, whether the conditions of the planes are built already or not.
fn repeats_of(body: &BodyPlan, sim: &SimBuilder<'_>) -> Vec<Repeat> {
    planes_of(body, sim).iter().map(Repeat::from).chain(periods_of(body, sim)).collect()
}

/// The loaded surface in a scene.
#[derive(Clone, Copy)]
pub(super) struct LoadedSurface<'a> {
    pub select: &'a Select,
    /// Its area, m2, where it is stated.
    pub area: Option<f64>,
}

/// Adds a load on the skins of bodies.
pub(super) fn apply(
    label: &'static str,
    make: impl Fn() -> LoadKind,
    on: LoadedSurface<'_>,
    skins: Vec<Arc<Skin>>,
    sim: &mut SimBuilder<'_>,
) -> Result<Shared<SkinLoads>, SetupError> {
    let LoadedSurface { select, area } = on;
    let mut loads = Vec::new();
    let mut total = 0.0;
    for skin in skins {
        let of = |loaded: SelectedFacet| {
            let area = loaded.share * skin.measure[loaded.facet as usize];
            (loaded, loaded.middle(&skin.facets), area)
        };
        let facets: Vec<_> =
            selected_facets(select, skin.body, &skin.facets, &repeats_of(sim.body(skin.body), sim), sim)?
                .into_iter()
                .map(of)
                .collect();
        let chosen: Vec<u32> = facets.iter().map(|(loaded, ..)| loaded.facet).collect();
        total += facets.iter().map(|facet| facet.2).sum::<f64>();
        if facets.is_empty() {
            continue;
        }
        // A load on a `face` is warned of where the scene is built, with what it does to other bodies.
        if select.surface.is_some() {
            let warning = beside_held::warning(label, sim.body(skin.body), &skin, &chosen);
            warning.into_iter().for_each(|warning| sim.warn(warning));
        }
        let mut patch = Patch::new(skin);
        patch.select(chosen);
        loads.push((facets, patch));
    }
    if loads.is_empty() {
        let help = "name a side that the body has, or a larger `within`";
        return Err(SetupError::parameter("on", "no part of the surface is selected", help));
    }
    let places = loads.iter().flat_map(|(facets, patch): &(Vec<(SelectedFacet, DVec3, f64)>, Patch)| {
        let body = patch.skin.body;
        pulses::some_of(facets).map(move |(_, middle, _)| (body, middle))
    });
    pulses::watch(label, &make().functions(), places, sim);
    let factor = area.map_or(1.0, |area| area / total);
    let loads = loads.into_iter().map(|(facets, patch)| SkinLoad {
        label,
        kind: make(),
        breaking: Breaking::of(select, sim.body(patch.skin.body)),
        patch,
        facets,
        factor,
        last: Vec::new(),
        is_broken: false,
        is_told: false,
    });
    let loads = SkinLoads(loads.collect());
    Ok(add_systems(label, loads, sim))
}

fn add_systems(label: &'static str, loads: SkinLoads, sim: &mut SimBuilder<'_>) -> Shared<SkinLoads> {
    let bodies = BodySet::new(loads.0.iter().map(|load| load.patch.skin.body));
    let phases = sim.phases_of(&bodies);
    let can_break = loads.0.iter().any(|load| load.breaking != Breaking::Never);
    let shared = sim.share(loads);
    let mut make = System::new(Stage::Boundary, label, Make(shared));
    if can_break {
        make = make.reads_near::<Damage>();
    }
    sim.add_system(
        make.on_phases(phases.clone())
            .reads_near::<Position>()
            .reads_near::<Velocity>()
            .reads_near::<Mobility>()
            .reads_near::<Removed>()
            .reads_near::<DeformationGradient>()
            .touches(CORRECTED_STRESS, Mode::Adds),
    );
    let push =
        move |step: &mut Step<'_>| step.resources.of(shared).0.iter().try_for_each(|load| load.push(step));
    sim.add_system(System::new(Stage::External, label, push).on_phases(phases).adds::<Force>());
    shared
}

/// The system that computes the forces.
struct Make(Shared<SkinLoads>);

impl Run for Make {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        resources.of_mut(self.0).0.iter_mut().try_for_each(|load| load.make(step))?;
        for phase in step.world.phases() {
            if let Some(mut solid) = step.resources.solid_mut(phase) {
                solid.renew_ghosts();
            }
        }
        Ok(())
    }

    fn save_with(&self, resources: &Resources) -> Vec<u8> {
        let loads = resources.of(self.0);
        let save = |load: &SkinLoad| Saved {
            last: load.last.clone(),
            places: load.patch.saved(),
            is_broken: load.is_broken,
            is_told: load.is_told,
        };
        let saved: Vec<Saved> = loads.0.iter().map(save).collect();
        postcard::to_stdvec(&saved).unwrap_or_default()
    }

    fn restore_with(&mut self, state: &[u8], resources: &Resources) -> bool {
        let Ok(saved) = postcard::from_bytes::<Vec<Saved>>(state) else { return false };
        let mut loads = resources.of_mut(self.0);
        let fits = saved.len() == loads.0.len();
        for (load, saved) in loads.0.iter_mut().zip(saved) {
            let facets: Vec<u32> = load.facets.iter().map(|(loaded, ..)| loaded.facet).collect();
            load.patch.restore(&saved.places);
            load.patch.select(facets);
            (load.last, load.is_broken, load.is_told) = (saved.last, saved.is_broken, saved.is_told);
        }
        fits
    }
}

/// State of a load in a checkpoint; facets that are left out follow from the damage of the particles.
#[derive(Serialize, Deserialize)]
struct Saved {
    last: Vec<DVec3>,
    places: Vec<(u32, Last)>,
    is_broken: bool,
    is_told: bool,
}

impl SkinLoad {
    /// The forces at the end of the step, and their work; that of the last forces is left where the skin
    /// breaks in this step.
    fn make(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        if self.is_broken {
            return Ok(());
        }
        self.look(step)?;
        let skin = Arc::clone(&self.patch.skin);
        let columns = SkinColumns::new(&skin, step.world)?;
        self.patch.update(&columns.view(), step.clock.dt, Wanted::default());
        if !self.is_broken {
            self.load(step)?;
        }
        let account = step.ledger.account(self.label, AccountKind::Supplied);
        step.ledger.add(account, skin.body, self.patch.work(&mut self.last, step.clock.dt));
        self.patch.transfer_forces();
        let body = step.world.body(skin.body);
        if let Some(mut solid) = step.resources.solid_mut(body.phase) {
            self.patch.add_couples(&mut *solid, body.rows.start);
        }
        Ok(())
    }

    /// Checks whether particles that carry the facets have failed in this step, and warns.
    fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        if self.breaking == Breaking::Never {
            return Ok(());
        }
        let Body { name, rows, .. } = step.world.body(self.patch.skin.body);
        let (view, _) = step.world.body_view(self.patch.skin.body);
        let damage = view.read_near::<Damage>()?;
        let has_failed = |&particle: &u32| damage[rows.start + particle as usize].0 >= 1.0;
        if !self.patch.particles().iter().any(has_failed) {
            return Ok(());
        }
        let (label, now) = (self.label, quantity(step.clock.end(), "s"));
        if self.breaking == Breaking::OnParticles {
            self.is_broken = true;
            step.warnings.push(format!(
                "the {label} on body `{name}` acts on particles and no longer on its surface from {now} on, because particles of that surface have failed"
            ));
            return Ok(());
        }
        let skin = &self.patch.skin;
        self.facets
            .retain(|(loaded, ..)| !skin.particles_of(loaded.facet).any(|particle| has_failed(&particle)));
        if !std::mem::replace(&mut self.is_told, true) {
            step.warnings.push(format!(
                "the {label} on body `{name}` leaves out the parts of the surface whose particles have failed, from {now} on: the load there is lost"
            ));
        }
        Ok(())
    }

    /// Loads the facets.
    fn load(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let Self { label, kind, patch, facets, factor, .. } = self;
        let (axes, t) = (patch.skin.facets.axes, step.clock.end());
        for &(SelectedFacet { facet, share, weights }, middle, area) in &*facets {
            let corners = patch.corners(facet);
            if !corners.iter().all(|corner| corner.is_there) {
                continue;
            }
            let force = *factor
                * match kind {
                    LoadKind::Traction(field) => area * field.at(middle, t),
                    LoadKind::Pressure(value) => {
                        let whole = directed_area(axes, &corners.map(|corner| corner.place));
                        -value.eval(middle, t) * share * whole
                    }
                };
            if !force.is_finite() {
                let message = format!(
                    "the load must be finite, found {} N at the reference position {} m and {}",
                    place(force),
                    place(middle),
                    quantity(t, "s")
                );
                return Err(StepError::System { system: (*label).to_owned(), message });
            }
            (0..axes).for_each(|k| patch.push_corner(facet, k, weights[k] * force));
        }
        Ok(())
    }

    fn push(&self, step: &mut Step<'_>) -> Result<(), StepError> {
        if self.is_broken {
            return Ok(());
        }
        let (view, rows) = step.world.body_view(self.patch.skin.body);
        self.patch.add_forces(&mut view.write::<Force>()?[rows]);
        Ok(())
    }
}
