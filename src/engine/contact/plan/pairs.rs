//! From the contacts of a scene to the systems that compute them.

use std::sync::Arc;

use super::images::mirrors;
use super::skins_of::Skins;
use super::start::refuse_bodies_within_others;
use crate::contact::bodies::{Nodes, Particles, Sides};
use crate::contact::laws::{ContactPair, NormalForce, damping_ratio};
use crate::contact::particles::ParticleContact;
use crate::contact::response::Interaction;
use crate::contact::skins::{SkinOnTool, SkinPair};
use crate::contact::system;
use crate::contact::system::Touching;
use crate::contact::tools::SurfaceContact;
use crate::materials::{ElasticConstants, Law};
use crate::plugin::{BodyKind, BodyPlan, Offer, SimBuilder};
use crate::rigid::sphere_of;
use crate::scene::{Contact, ContactSurface, Item, Problem};
use crate::skins::Skin;
use crate::symmetry::MirrorPlane;
use crate::world::{BodyId, BodySet};

/// Makes the force of a law between two bodies.
pub type MakeLaw<'m> = &'m dyn Fn(&Item, &ContactPair) -> Result<Box<dyn NormalForce>, Vec<Problem>>;

/// Adds the contacts of the scene.
///
/// # Errors
/// Two contacts of one pair, a law whose parameters are wrong, bodies that cannot touch.
pub fn add_systems(sim: &mut SimBuilder<'_>, make: MakeLaw<'_>) -> Result<(), Vec<Problem>> {
    let planes: Vec<MirrorPlane> = sim.take_extensions();
    let scene = sim.scene();
    let mut problems = Vec::new();
    let mut touching = Vec::new();
    // The contact of the scene that each pair belongs to.
    let mut numbers = Vec::new();
    let (mut skins, mut warnings) = (Skins::default(), Vec::new());
    let pairs: Vec<(usize, Contact)> = scene.contact_pairs().collect();
    for (n, (k, contact)) in pairs.iter().enumerate() {
        let k = *k;
        if let Some(problem) = named_before(&pairs[..n], contact, k) {
            problems.push(problem);
            continue;
        }
        if contact.between.0 == contact.between.1 && is_rigid(find(sim, &contact.between.0)) {
            let message = format!("rigid body `{}` cannot touch itself", contact.between.0);
            problems.push(
                Problem::at_path(format!("contacts[{k}].between"), message).help("leave this contact out"),
            );
            continue;
        }
        if let Some(problem) = heat_without_temperature(contact, k, sim) {
            problems.push(problem);
            continue;
        }
        if let Some(problem) = own_contact_not_offered(contact, k, sim) {
            problems.push(problem);
            continue;
        }
        match pairs_of(
            contact,
            k,
            &planes,
            sim,
            make,
            &mut Surfaces { skins: &mut skins, warnings: &mut warnings },
        ) {
            Ok(pairs) => {
                numbers.resize(numbers.len() + pairs.len(), k);
                touching.extend(pairs);
            }
            Err(found) => problems.extend(found),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    warnings.into_iter().for_each(|warning| sim.warn(warning));
    if !touching.is_empty() {
        let bodies = BodySet::new(touching.iter().flat_map(Touching::bodies));
        refuse_bodies_within_others(sim, &touching, numbers);
        system::add(sim, touching, &bodies);
    }
    Ok(())
}

/// The problem of a body that is to touch itself and whose formulation has no such contact.
fn own_contact_not_offered(contact: &Contact, k: usize, sim: &SimBuilder<'_>) -> Option<Problem> {
    let body = find(sim, &contact.between.0);
    if contact.between.0 != contact.between.1 || body.offers(Offer::SelfContact) {
        return None;
    }
    let BodyPlan { name, formulation, .. } = body;
    let message =
        format!("`{formulation}`, by which body `{name}` moves, has no {}", Offer::SelfContact.words());
    let help = "leave this contact out: where its kernels overlap, the body joins with itself";
    Some(Problem::at_path(format!("contacts[{k}].between"), message).help(help))
}

/// The problem of a contact whose friction is to heat bodies that have no temperature.
fn heat_without_temperature(contact: &Contact, k: usize, sim: &SimBuilder<'_>) -> Option<Problem> {
    let (a, b) = &contact.between;
    let is_cold = [a, b].into_iter().all(|name| find(sim, name).specific_heat().is_none());
    (contact.friction_heat.is_some() && is_cold).then(|| {
        let message = format!("neither `{a}` nor `{b}` is of a material with a specific heat");
        Problem::at_path(format!("contacts[{k}].friction_heat"), message)
            .help("give one of them a material with `specific_heat`, or leave `friction_heat` out")
    })
}

fn named_before(others: &[(usize, Contact)], contact: &Contact, k: usize) -> Option<Problem> {
    let (a, b) = &contact.between;
    let same = |(_, other): &(usize, Contact)| {
        other.between == (a.clone(), b.clone()) || other.between == (b.clone(), a.clone())
    };
    others.iter().any(same).then(|| {
        let message = format!("the contact between `{a}` and `{b}` is given twice");
        Problem::at_path(format!("contacts[{k}].between"), message).help("give each pair of bodies once")
    })
}

/// Skins that bodies touch with, and what the user is told of those that do not.
struct Surfaces<'a> {
    skins: &'a mut Skins,
    warnings: &'a mut Vec<String>,
}

impl Surfaces<'_> {
    fn of(
        &mut self,
        body: &BodyPlan,
        (contact, number): (&Contact, usize),
        planes: &[MirrorPlane],
        sim: &SimBuilder<'_>,
    ) -> Option<Arc<Skin>> {
        let found = if contact.friction_heat.is_some() && contact.surface == ContactSurface::Skin {
            Err(Some("the heat of friction goes into particles"))
        } else {
            self.skins.of(body, contact.surface, planes, sim)
        };
        match found {
            Ok(skin) => Some(skin),
            Err(reason) => {
                let (name, (a, b)) = (&body.name, &sim.scene().contacts[number].between);
                let told = reason.map(|reason| {
                    format!(
                        "body `{name}` touches with its particles in the contact of `{a}` and `{b}`: {reason}"
                    )
                });
                // Once for all pairs of a contact.
                self.warnings.extend(told.filter(|told| !self.warnings.contains(told)));
                None
            }
        }
    }
}

fn pairs_of(
    contact: &Contact,
    number: usize,
    planes: &[MirrorPlane],
    sim: &SimBuilder<'_>,
    make: MakeLaw<'_>,
    surfaces: &mut Surfaces<'_>,
) -> Result<Vec<Touching>, Vec<Problem>> {
    let (first, second) = (find(sim, &contact.between.0), find(sim, &contact.between.1));
    let softness = |body: &BodyPlan| elastic_of(body).map_or(0.0, |e| (1.0 - e.poisson.powi(2)) / e.young);
    let modulus = 1.0 / (softness(first) + softness(second));
    let both = [first, second].into_iter().filter_map(elastic_of).map(|elastic| elastic.poisson);
    let (count, sum) = both.fold((0.0, 0.0), |(count, sum), poisson| (count + 1.0, sum + poisson));
    let poisson = if count > 0.0 { sum / count } else { 0.0 };
    let mut heat = contact.friction_heat.map_or([0.0; 2], |share| [share, 1.0 - share]);
    if is_rigid(first) && !is_rigid(second) {
        // The nodes are those of the deformable one.
        heat.reverse();
    }
    let interaction_of = |surface| -> Result<Interaction, Vec<Problem>> {
        Ok(Interaction {
            law: make(&contact.law, &ContactPair { dimension: sim.dimension(), surface, modulus })?,
            friction: contact.friction,
            damping_ratio: damping_ratio(contact.restitution),
            tangential: 2.0 * (1.0 - poisson) / (2.0 - poisson),
            heat,
        })
    };
    let interaction = || interaction_of(ContactSurface::Particles);
    let of_skins = || interaction_of(ContactSurface::Skin);
    let particles = |body| Nodes::Particles(Particles::of(body, sim.dimension()));
    let sides = |nodes, of: &BodyPlan, on: &BodyPlan| Sides {
        first: of.id,
        nodes,
        second: on.id,
        periodic: sim.periodic(),
    };
    let on_surface = |nodes, of: &BodyPlan, on: &BodyPlan| -> Result<Touching, Vec<Problem>> {
        Ok(Touching::Surface(Box::new(SurfaceContact::new(
            interaction()?,
            sides(nodes, of, on),
            sim.gravity().length(),
        ))))
    };
    let is_sphere = |body: &BodyPlan| sphere_of(&sim.scene().bodies[body.id.0].shape).is_some();
    Ok(match (is_rigid(first), is_rigid(second)) {
        (false, false) => {
            if first.id != second.id {
                let mut skin = |body| surfaces.of(body, (contact, number), planes, sim);
                if let (Some(first), Some(second)) = (skin(first), skin(second)) {
                    return Ok(vec![Touching::Skins(Box::new(SkinPair::new(of_skins()?, [first, second])))]);
                }
            } else if contact.surface == ContactSurface::Skin {
                surfaces.warnings.push(format!(
                    "body `{}` touches itself with its particles, not with its surface",
                    first.name
                ));
            }
            let mut pairs = Vec::new();
            for mirror in mirrors(planes, first.id, second.id) {
                let mut bodies = [first, second].map(|body| Particles::of(body, sim.dimension()));
                // Beside spheres the other side keeps spheres, too: then forces act along the line of the centres.
                let deform = bodies.iter().all(|particles| particles.deform);
                bodies.iter_mut().for_each(|particles| particles.deform = deform);
                let pair = ParticleContact::new(interaction()?, bodies, mirror, sim.periodic());
                refuse_short_periods(&pair, number, sim)?;
                pairs.push(Touching::Particles(Box::new(pair)));
            }
            pairs
        }
        (false, true) | (true, false) => {
            let (soft, tool) = if is_rigid(second) { (first, second) } else { (second, first) };
            vec![match surfaces.of(soft, (contact, number), planes, sim) {
                Some(skin) => Touching::SkinOnTool(Box::new(SkinOnTool::new(
                    of_skins()?,
                    skin,
                    sides(particles(soft), soft, tool),
                ))),
                None => on_surface(particles(soft), soft, tool)?,
            }]
        }
        // A sphere is one node, and touches the surface of the other exactly.
        (true, true) if is_sphere(first) => vec![on_surface(Nodes::Rigid, first, second)?],
        (true, true) if is_sphere(second) => vec![on_surface(Nodes::Rigid, second, first)?],
        (true, true) => {
            vec![on_surface(Nodes::Rigid, first, second)?, on_surface(Nodes::Rigid, second, first)?]
        }
    })
}

/// A particle must not see two images of another.
fn refuse_short_periods(
    pair: &ParticleContact,
    number: usize,
    sim: &SimBuilder<'_>,
) -> Result<(), Vec<Problem>> {
    let (periodic, least) = (sim.periodic(), pair.least_period());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let length = periodic.lengths()[axis];
        if periodic.axes()[axis] && length < least {
            let message = format!(
                "the period along {name} must be at least {least} m for this contact, found {length} m"
            );
            let problem = Problem::at_path(format!("contacts[{number}].between"), message);
            return Err(vec![problem.help("use a longer domain, or smaller particles")]);
        }
    }
    Ok(())
}

fn is_rigid(body: &BodyPlan) -> bool {
    body.kind == BodyKind::Rigid
}

fn find<'s>(sim: &'s SimBuilder<'_>, name: &str) -> &'s BodyPlan {
    let k = sim.bodies().iter().position(|body| body.name == name);
    // Names of bodies are checked with the scene.
    sim.body(BodyId(k.unwrap_or(0)))
}

/// The elastic constants of a body; none where nothing deforms it.
fn elastic_of(body: &BodyPlan) -> Option<&ElasticConstants> {
    match &body.material.law {
        Law::Solid(law) => Some(law.elastic()),
        Law::Fluid(_) | Law::Nothing => None,
    }
}
