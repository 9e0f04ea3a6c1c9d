//! Hydrostatic pressure of fluids at rest under gravity, below a surface of any shape.
//!
//! A line from each particle against gravity, through its fluid and the fluids above it, ends at a free
//! surface: `p = sum_k rho_k g l_k` with the lengths l_k in each fluid. Where the line ends at a wall or a
//! body, the pressure is continued hydrostatically from neighbouring particles that have one; in a fluid
//! without a free surface it is zero at the highest point. Fluids that touch no wall and no body, alone or
//! together, fall freely: their pressure is zero.

use glam::DVec3;
use rayon::prelude::*;

use super::start::StartPressure;
use crate::neighbors::{Cloud, NeighborList};
use crate::plugin::{SetupError, SimBuilder};
use crate::scene::Expression;
use crate::shapes::Region;
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
    covers: Vec<Box<dyn Region>>,
    gravity: DVec3,
    spacing: f64,
}

/// The pressures at the start of the fluids, in the order of the scene; `given` are those that it gives.
pub fn pressures(
    fluids: Vec<(BodyId, Option<Expression>)>,
    support: f64,
    sim: &SimBuilder<'_>,
) -> Result<Vec<StartPressure>, SetupError> {
    let rest = RestLines::new(fluids, sim);
    let mut found: Vec<Vec<Option<f64>>> =
        (0..rest.layers.len()).map(|k| rest.below_surface(k, sim)).collect();
    if found.iter().flatten().any(Option::is_none) {
        rest.spread(&mut found, support, sim)?;
    }
    let held = rest.held(sim);
    let pressures = rest.layers.into_iter().zip(found).zip(held).map(|((layer, found), is_held)| {
        let at_rest = |p: Option<f64>| if is_held { p.unwrap_or(0.0).max(0.0) } else { 0.0 };
        match layer.given {
            Some(expression) => StartPressure::Given(expression),
            None => StartPressure::AtRest(found.into_iter().map(at_rest).collect()),
        }
    });
    Ok(pressures.collect())
}

impl RestLines {
    fn new(fluids: Vec<(BodyId, Option<Expression>)>, sim: &SimBuilder<'_>) -> Self {
        let region = |id: BodyId| {
            let shape = &sim.scene().bodies[id.0].shape;
            shape.region(sim.dimension(), sim.folder(), "shape").ok()
        };
        let is_fluid = |id: BodyId| fluids.iter().any(|(fluid, _)| *fluid == id);
        let covers = sim.bodies().iter().filter(|body| !is_fluid(body.id)).filter_map(|body| region(body.id));
        let covers = covers.collect();
        let spacing = fluids.first().map_or(0.0, |(id, _)| sim.body(*id).spacing);
        let layer =
            |(id, given)| Layer { id, region: region(id), density: sim.body(id).material.density, given };
        Self { covers, gravity: sim.gravity(), spacing, layers: fluids.into_iter().map(layer).collect() }
    }

    /// Whether each fluid touches a wall or a body, directly or by other fluids; so does one whose extent, or
    /// that of something in the scene, is not known.
    fn held(&self, sim: &SimBuilder<'_>) -> Vec<bool> {
        let others = sim.bodies().iter().count() - self.layers.len();
        let are_known = self.covers.len() == others && self.layers.iter().all(|layer| layer.region.is_some());
        let touches = |k: usize, region: &dyn Region| {
            let sites = &sim.body(self.layers[k].id).sites;
            sites.par_iter().any(|site| region.distance(site.position) < TOUCH * self.spacing)
        };
        let by_cover = |k: usize| self.covers.iter().any(|cover| touches(k, cover.as_ref()));
        let mut held: Vec<bool> = (0..self.layers.len()).map(|k| !are_known || by_cover(k)).collect();
        for _ in 1..self.layers.len() {
            for k in 0..self.layers.len() {
                let by_fluid = |other: usize| {
                    let region = self.layers[other].region.as_deref();
                    other != k && held[other] && region.is_some_and(|region| touches(k, region))
                };
                held[k] = held[k] || (0..self.layers.len()).any(by_fluid);
            }
        }
        held
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
        // Every turn leaves one fluid; lines do not come back into one that they have left.
        for _ in 0..=2 * self.layers.len() {
            let layer = &self.layers[k];
            let length = self.distance_out(layer.region.as_deref()?, at, up);
            p += layer.density * self.gravity.length() * length;
            let step = BEYOND * self.spacing;
            let beyond = at + (length + step) * up;
            let holds = |layer: &Layer| layer.region.as_ref().is_some_and(|region| region.contains(beyond));
            if let Some(next) = (0..self.layers.len()).find(|&other| other != k && holds(&self.layers[other]))
            {
                if let Some(given) = &self.layers[next].given {
                    return Some(p + given.eval(beyond, 0.0));
                }
                p += self.layers[next].density * self.gravity.length() * step;
                (k, at) = (next, beyond);
            } else if self.covers.iter().any(|cover| cover.contains(beyond)) {
                return None;
            } else {
                return Some(p);
            }
        }
        Some(p)
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

    /// Gives particles without pressure that of those beside them, from one to the next.
    fn spread(
        &self,
        found: &mut [Vec<Option<f64>>],
        support: f64,
        sim: &SimBuilder<'_>,
    ) -> Result<(), SetupError> {
        let bodies = || self.layers.iter().map(|layer| sim.body(layer.id));
        let positions: Vec<DVec3> =
            bodies().flat_map(|body| body.sites.iter().map(|site| site.position)).collect();
        let density: Vec<f64> =
            self.layers.iter().zip(&*found).flat_map(|(layer, p)| vec![layer.density; p.len()]).collect();
        let periodic = sim.periodic();
        let list = NeighborList::reference(Cloud::uniform(&positions, support), &periodic)
            .map_err(|error| SetupError::internal(&error))?;
        let mut pressure: Vec<Option<f64>> = found.iter().flatten().copied().collect();
        let weight = |i: usize, j: usize| {
            let x_ji = periodic.minimal_image(positions[i] - positions[j]);
            0.5 * (density[i] + density[j]) * self.gravity.dot(x_ji)
        };
        let mut rest: Vec<usize> = (0..pressure.len()).filter(|&i| pressure[i].is_none()).collect();
        loop {
            let beside = |i: usize| {
                let known = list.row(i).iter().filter_map(|&j| Some((j as usize, pressure[j as usize]?)));
                let (sum, count) =
                    known.fold((0.0, 0), |(sum, count), (j, p)| (sum + p + weight(i, j), count + 1));
                (count > 0).then(|| (i, sum / f64::from(count)))
            };
            let next: Vec<(usize, f64)> = rest.par_iter().filter_map(|&i| beside(i)).collect();
            if next.is_empty() {
                break;
            }
            next.into_iter().for_each(|(i, p)| pressure[i] = Some(p));
            rest.retain(|&i| pressure[i].is_none());
        }
        let mut all = pressure.into_iter();
        for ((layer, body), found) in self.layers.iter().zip(bodies()).zip(found) {
            let top = DVec3::select(self.gravity.cmplt(DVec3::ZERO), body.bounds.max, body.bounds.min);
            for (site, p) in body.sites.iter().zip(found) {
                let below_top = || layer.density * self.gravity.dot(site.position - top);
                *p = Some(all.next().flatten().unwrap_or_else(below_top));
            }
        }
        Ok(())
    }
}
