//! What relaxation zones warn of before a run.

use glam::DVec3;

use super::zone_flow::{FlowZone, NAME};
use crate::notation::{place as words, quantity, quantity_to};
use crate::plugin::{BodyPlan, SimBuilder};

/// Length of a zone below which it is warned of, in spacings.
const SHORT: f64 = 10.0;
/// Change of density by the acceleration of a column of fluid that is worth a warning, and the number of
/// intervals of the run in which it is looked for.
const COMPRESSED: f64 = 0.02;
const TIMES: usize = 200;
/// Half of the width of a section, in spacings: a row of a lattice counts the same wherever it is between the
/// middles of two sections.
const SECTION: f64 = 3.0;
/// Difference between the fluxes of two sections, over the largest, that is worth a warning.
const UNEVEN: f64 = 0.05;

/// Warnings of a zone that is empty or short, or that the fluid can flow past.
pub(super) fn warnings(zone: &FlowZone, sim: &SimBuilder<'_>) -> Vec<String> {
    let mut warnings = Vec::new();
    let bodies: Vec<&BodyPlan> = zone.bodies.iter().map(|id| sim.body(*id)).collect();
    let sites = || bodies.iter().flat_map(|body| body.sites.iter()).map(|site| site.position);
    if !sites().any(|site| zone.place.contains(site)) {
        warnings.push(format!("no fluid is in the `{NAME}` {} at the start", zone.place.words()));
    }
    let spacing = bodies.iter().map(|body| body.spacing).fold(0.0, f64::max);
    if zone.place.length < SHORT * spacing {
        warnings.push(format!(
            "a `{NAME}` is {} long, less than {SHORT} spacings of its fluid: the flow has no room in it to take the velocity that is given",
            quantity(zone.place.length, "m")
        ));
    }
    let within = |site: DVec3| (0.0..=1.0).contains(&zone.place.depth(site));
    if let Some(site) = sites().find(|&site| within(site) && !zone.place.contains(site)) {
        warnings.push(format!(
            "the fluid reaches past the sides of a `{NAME}`, such as to {}: it can flow past the zone",
            words(site)
        ));
    }
    if let Some(axis) = (0..3).find(|&axis| zone.place.repeats(axis) && zone.axes[axis] == 0.0) {
        let along = ["x", "y", "z"][axis];
        warnings.push(format!(
            "a `{NAME}` closes the period along {along}, but its `value` leaves {along} free: nothing holds the flux"
        ));
    }
    warnings.extend(of_flow(zone, &bodies, sim));
    warnings
}

/// Warnings of a mean velocity along a period that is against the direction of the zone, or that changes
/// faster than sound can follow: the whole column of fluid has to take part in it.
fn of_flow(zone: &FlowZone, bodies: &[&BodyPlan], sim: &SimBuilder<'_>) -> Vec<String> {
    let inside: Vec<(f64, DVec3)> = bodies
        .iter()
        .flat_map(|body| &body.sites)
        .map(|site| (zone.place.strength(site.position), zone.place.image(site.position)))
        .filter(|(strength, _)| *strength > 0.0)
        .collect();
    let weight = inside.iter().map(|(strength, _)| strength).sum::<f64>();
    if weight == 0.0 || zone.driven == DVec3::ZERO {
        return Vec::new();
    }
    let mean = |time: f64| {
        let values =
            inside.iter().map(|&(strength, site)| strength * zone.driven * zone.field.at(site, time));
        values.sum::<DVec3>() / weight
    };
    let times = if zone.field.depends_on_time() { TIMES } else { 1 };
    let step = sim.scene().time.end / times as f64;
    let means: Vec<DVec3> = (0..=times).map(|k| mean(k as f64 * step)).collect();
    let mut warnings = Vec::new();
    let forward = means.iter().sum::<DVec3>().dot(zone.place.along);
    if forward < 0.0 {
        warnings.push(format!(
            "the velocity of a `{NAME}` is against `along`: the zone is strongest where the flow enters it, and weakest at the inlet of the domain; turn `along` around"
        ));
    }
    let speed = |k: &usize| means[*k].length();
    let fastest = (0..means.len()).max_by(|j, k| speed(j).total_cmp(&speed(k))).unwrap_or_default();
    warnings.extend(of_sections(zone, bodies, fastest as f64 * step));
    let rate = means.windows(2).map(|pair| pair[0].distance(pair[1]) / step).fold(0.0, f64::max);
    let length = zone.place.period();
    let compression = rate * length / (zone.sound * zone.sound);
    if compression > COMPRESSED {
        warnings.push(format!(
            "the velocity of a `{NAME}` changes by up to {}: the acceleration of all fluid along the period of {} compresses it by some {:.0} %; let the velocity change {:.0} times as slowly, \
             or start with it, by an `InitialVelocity`",
            quantity_to(rate, "m/s2", 2),
            quantity(length, "m"),
            100.0 * compression,
            (compression / COMPRESSED).ceil()
        ));
    }
    warnings
}

/// Warning of a flux that differs from section to section of the zone: a body stands in it, the channel
/// narrows, or it is not full.
fn of_sections(zone: &FlowZone, bodies: &[&BodyPlan], time: f64) -> Option<String> {
    // Sections across an oblique direction are cut off by the sides of the box.
    if zone.place.along.abs().max_element() < 1.0 {
        return None;
    }
    let width = SECTION * bodies.iter().map(|body| body.spacing).fold(0.0, f64::max);
    let count = (zone.place.length / width) as usize;
    // Sections overlap by half; those at both ends of the zone are not whole.
    let mut flux = vec![0.0; count + 2];
    for site in bodies.iter().flat_map(|body| &body.sites).filter(|site| zone.place.contains(site.position)) {
        let place = zone.place.image(site.position);
        let along = (zone.axes * zone.field.at(place, time)).dot(zone.place.along);
        let at = (zone.place.depth(place) * zone.place.length / width).max(0.0);
        let (section, share) = ((at as usize).min(count), at.fract());
        flux[section] += (1.0 - share) * site.volume * along / width;
        flux[section + 1] += share * site.volume * along / width;
    }
    let whole = flux.get(1..count)?;
    let of = |k: &usize| whole[*k].abs();
    let least = (0..whole.len()).min_by(|j, k| of(j).total_cmp(&of(k)))?;
    let largest = of(&(0..whole.len()).max_by(|j, k| of(j).total_cmp(&of(k)))?);
    let missing = (largest - of(&least)) / largest;
    (missing > UNEVEN).then(|| {
        format!(
            "the flux that a `{NAME}` asks for is {:.0} % less {} behind its beginning than elsewhere in it: the fluid has not the same section there; keep the zone free of bodies and full of fluid, \
             or give a velocity with the same flux in every section",
            100.0 * missing,
            quantity_to((least + 1) as f64 * width, "m", 2)
        )
    })
}
