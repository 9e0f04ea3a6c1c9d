//! Hydrostatic pressure of fluids at rest under gravity, below a surface of any shape.
//!
//! A line from each particle against gravity, through its fluid and the fluids above it, ends at a free
//! surface: `p = sum_k rho_k g l_k` with the lengths l_k in each fluid. Where the line ends at a wall or a
//! body, the pressure is continued hydrostatically from neighbouring particles that have one; in fluids
//! without a free surface, which are beside each other, it is zero at their highest point. Above the level of
//! the free surface, as in a siphon, it is negative where boundaries have suction, else zero. Fluids that
//! nothing carries fall freely: their pressure is zero (`carried`). Gravity along a periodic axis on which
//! fluids are endless drives them, and causes no pressure.

use glam::DVec3;
use rayon::prelude::*;

use super::carried::{Touchable, carried, uncarried};
use super::endless;
use super::roofs::Roofed;
use super::spread::AllFluids;
use super::start::StartPressure;
use crate::formulations::fluid::walls::has_suction;
use crate::neighbors::Periodic;
use crate::plugin::{SetupError, SimBuilder};
use crate::scene::Expression;
use crate::shapes::{Region, images_near};
use crate::world::BodyId;

/// Largest distance of the end of a line from the boundary that ends it, over the spacing.
const PRECISION: f64 = 1e-4;
/// Distance from a boundary that is none, over the spacing: a line that has come to it goes no step beyond.
const ROUND_OFF: f64 = 1e-8;
/// Distance beyond the boundary of a fluid at which is looked for what covers it, over the spacing.
const BEYOND: f64 = 0.25;
/// Distance of a particle from a wall, a body or another fluid below which its fluid touches it, over the
/// spacing: particles begin half a spacing inside, and gaps narrower than two spacings cause a warning.
const TOUCH: f64 = 2.5;
/// Largest number of times that a line passes through periodic sides.
const CROSSINGS: usize = 100;

/// A fluid as a line through it sees it.
struct Layer {
    id: BodyId,
    /// None for one whose particles come from a file.
    region: Option<Box<dyn Region>>,
    density: f64,
    /// Pressure that the scene gives.
    given: Option<Expression>,
}

/// Everything that lines can meet.
struct RestLines {
    layers: Vec<Layer>,
    covers: Vec<(BodyId, Box<dyn Region>)>,
    /// That which pressure balances.
    gravity: DVec3,
    spacing: f64,
    periodic: Periodic,
}

/// The pressures at the start of the fluids, in the order of the scene; `given` are those that it gives.
pub fn pressures(
    fluids: Vec<(BodyId, Option<Expression>)>,
    support: f64,
    sim: &mut SimBuilder<'_>,
) -> Result<Vec<StartPressure>, SetupError> {
    let rest = RestLines::new(fluids, sim)?;
    let mut found: Vec<Vec<Option<f64>>> =
        (0..rest.layers.len()).map(|k| rest.below_surface(k, sim)).collect();
    if found.iter().flatten().any(Option::is_none) {
        let roofed = rest.spread(&mut found, support, sim)?;
        let texts: Vec<String> = roofed.iter().filter_map(|piece| rest.pressed(piece, sim)).collect();
        texts.into_iter().for_each(|text| sim.warn(text));
    }
    let held = rest.held(sim);
    uncarried(rest.gravity, sim).into_iter().for_each(|text| sim.warn(text));
    let least = if has_suction(sim) { f64::NEG_INFINITY } else { 0.0 };
    let pressures = rest.layers.into_iter().zip(found).zip(held).map(|((layer, found), is_held)| {
        let at_rest = |p: Option<f64>| if is_held { p.unwrap_or(0.0).max(least) } else { 0.0 };
        match layer.given {
            Some(expression) => StartPressure::Given(expression),
            None => StartPressure::AtRest(found.into_iter().map(at_rest).collect()),
        }
    });
    Ok(pressures.collect())
}

/// Gravity without its parts along the periodic axes on which the fluids are endless, m/s^2.
fn balanced_gravity(layers: &[Layer], spacing: f64, sim: &SimBuilder<'_>) -> Result<DVec3, SetupError> {
    let (mut gravity, periodic) = (sim.gravity(), sim.periodic());
    if (0..3).any(|a| periodic.axes()[a] && gravity[a] != 0.0) {
        let endless = endless::axes(&positions(layers, sim), spacing, &periodic)
            .map_err(|error| SetupError::internal(&error))?;
        (0..3).filter(|&a| endless[a]).for_each(|a| gravity[a] = 0.0);
    }
    Ok(gravity)
}

/// Positions of the particles of the fluids, one fluid after the other.
fn positions(layers: &[Layer], sim: &SimBuilder<'_>) -> Vec<DVec3> {
    layers.iter().flat_map(|layer| sim.body(layer.id).sites.iter().map(|site| site.position)).collect()
}

impl RestLines {
    fn new(fluids: Vec<(BodyId, Option<Expression>)>, sim: &SimBuilder<'_>) -> Result<Self, SetupError> {
        let region = |id: BodyId| {
            let shape = &sim.scene().bodies[id.0].shape;
            shape.region(sim.dimension(), sim.folder(), "shape").ok()
        };
        let is_fluid = |id: BodyId| fluids.iter().any(|(fluid, _)| *fluid == id);
        let covers = sim.bodies().iter().map(|body| body.id).filter(|id| !is_fluid(*id));
        let covers = covers.filter_map(|id| Some((id, region(id)?))).collect();
        let spacing = fluids.first().map_or(0.0, |(id, _)| sim.body(*id).spacing);
        let layer =
            |(id, given)| Layer { id, region: region(id), density: sim.body(id).material.density, given };
        let layers: Vec<Layer> = fluids.into_iter().map(layer).collect();
        let gravity = balanced_gravity(&layers, spacing, sim)?;
        Ok(Self { covers, gravity, spacing, periodic: sim.periodic(), layers })
    }

    /// What is to be said of a piece of the fluids below a roof.
    fn pressed(&self, piece: &Roofed, sim: &SimBuilder<'_>) -> Option<String> {
        let reach = TOUCH * self.spacing;
        piece.pressed(&self.covers, reach, self.spacing * self.gravity.length(), sim)
    }

    /// Whether something carries each fluid; so it does where the extent of one body is not known.
    fn held(&self, sim: &SimBuilder<'_>) -> Vec<bool> {
        let fluids = self.layers.iter().map(|layer| (layer.id, layer.region.as_deref()));
        let covers = self.covers.iter().map(|(id, region)| (*id, Some(region.as_ref())));
        let bodies: Option<Vec<_>> =
            fluids.chain(covers).map(|(id, region)| Some(Touchable { id, region: region? })).collect();
        match bodies.filter(|bodies| bodies.len() == sim.bodies().len()) {
            Some(bodies) => carried(&bodies, self.layers.len(), self.gravity, TOUCH * self.spacing, sim),
            None => vec![true; self.layers.len()],
        }
    }

    /// Pressure of the particles of a fluid, where a line from them ends at a free surface, Pa.
    fn below_surface(&self, k: usize, sim: &SimBuilder<'_>) -> Vec<Option<f64>> {
        let sites = &sim.body(self.layers[k].id).sites;
        sites.par_iter().map(|site| self.pressure(k, site.position)).collect()
    }

    fn pressure(&self, mut k: usize, mut at: DVec3) -> Option<f64> {
        if let Some(given) = &self.layers[k].given {
            return Some(given.eval(at, 0.0));
        }
        let Some(up) = (-self.gravity).try_normalize() else { return Some(0.0) };
        let mut p = 0.0;
        // Every turn leaves one fluid, into which a line comes back through a periodic side alone.
        for _ in 0..=2 * self.layers.len() + CROSSINGS {
            let layer = &self.layers[k];
            let length = self.distance_out(layer.region.as_deref()?, at, up);
            p += layer.density * self.gravity.length() * length;
            let step = BEYOND * self.spacing;
            let end = at + (length + step) * up;
            let in_layer = |other: usize| {
                let region = self.layers[other].region.as_deref()?;
                let place = self
                    .images(region, end, step)
                    .find(|place| (other != k || *place != end) && region.contains(*place))?;
                Some((other, place))
            };
            let is_in = |cover: &dyn Region| self.images(cover, end, step).any(|place| cover.contains(place));
            if let Some((next, beyond)) = (0..self.layers.len()).find_map(in_layer) {
                if let Some(given) = &self.layers[next].given {
                    return Some(p + given.eval(beyond, 0.0));
                }
                p += self.layers[next].density * self.gravity.length() * step;
                (k, at) = (next, beyond);
            } else if self.covers.iter().any(|(_, cover)| is_in(cover.as_ref())) {
                return None;
            } else {
                return Some(p);
            }
        }
        Some(p)
    }

    /// The images of a place within `reach`, m, of a region.
    fn images(&self, region: &dyn Region, place: DVec3, reach: f64) -> impl Iterator<Item = DVec3> {
        images_near(&region.bounds(), place, self.periodic.lengths(), reach)
    }

    /// Length of the line from a point out of a region, m. Where parts of a region meet, it continues.
    fn distance_out(&self, region: &dyn Region, from: DVec3, up: DVec3) -> f64 {
        let (least, step) = (PRECISION * self.spacing, BEYOND * self.spacing);
        let (mut length, most) = (0.0, region.bounds().extent().length());
        while length < most {
            let depth = -region.distance(from + length * up);
            if depth > ROUND_OFF * self.spacing {
                length += depth.max(least);
            } else if region.distance(from + (length + step) * up) < 0.0 {
                length += step;
            } else {
                break;
            }
        }
        length
    }

    /// Gives particles without pressure that of those beside them. The pieces without a free surface are
    /// returned.
    fn spread(
        &self,
        found: &mut [Vec<Option<f64>>],
        support: f64,
        sim: &SimBuilder<'_>,
    ) -> Result<Vec<Roofed>, SetupError> {
        let of_each = || (0..self.layers.len()).flat_map(|k| vec![k; found[k].len()]);
        let layers: Vec<usize> = of_each().collect();
        let all = AllFluids {
            positions: positions(&self.layers, sim),
            densities: layers.iter().map(|&k| self.layers[k].density).collect(),
            gravity: self.gravity,
            spacing: self.spacing,
            periodic: self.periodic,
        };
        let below_top = |i: usize| {
            let (layer, at) = (&self.layers[layers[i]], all.positions[i]);
            let up = (-self.gravity).normalize_or_zero();
            let to_top = layer.region.as_deref().map(|region| self.distance_out(region, at, up));
            layer.density * self.gravity.length() * to_top.unwrap_or(0.5 * self.spacing)
        };
        let mut pressure: Vec<Option<f64>> = found.iter().flatten().copied().collect();
        let pieces =
            all.spread(&mut pressure, support, below_top).map_err(|error| SetupError::internal(&error))?;
        let roofed = |piece: &Vec<usize>| {
            let places = piece.iter().map(|&i| all.positions[i]).collect();
            let pressures = piece.iter().filter_map(|&i| Some((i, pressure[i]?)));
            let (top, _) = pressures.clone().min_by(|a, b| a.1.total_cmp(&b.1))?;
            let largest = pressures.map(|(_, p)| p).fold(0.0, f64::max);
            Some(Roofed { fluid: self.layers[layers[top]].id, density: all.densities[top], places, largest })
        };
        let roofed = pieces.iter().filter_map(roofed).collect();
        found.iter_mut().flatten().zip(pressure).for_each(|(found, pressure)| *found = pressure);
        Ok(roofed)
    }
}
