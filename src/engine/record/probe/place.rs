//! From the place of a probe to the gauge of a field there.

use glam::DVec3;

use super::body_points::{BodyPoints, PointReduction};
use super::gauge::{Gauge, at_probe};
use super::line::SpaceLine;
use super::particles::ParticleGauge;
use super::point::PointGauge;
use super::stencil::Stencil;
use super::surface::MeasuredPoints;
use super::taken::Extremal;
use crate::fields::ChosenField;
use crate::notation;
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::scene::{self, Line, Problem, Quantity, Reduction, RelativeTo, Select};
use crate::skins::{SelectedFacet, selected_facets};
use crate::symmetry::repeats_of;
use crate::world::BodySet;

/// Place of a probe.
pub(super) struct ProbePlace<'a> {
    /// Number of the probe in the scene, and the path of the place in it: empty, or that of the second place.
    k: usize,
    path: &'static str,
    on: Option<&'a Select>,
    at: DVec3,
    line: Option<Line>,
    follows: Option<&'a str>,
    take: Reduction,
    may_be_empty: bool,
}

impl<'a> ProbePlace<'a> {
    /// The place of a probe.
    pub fn of(k: usize, probe: &'a scene::Probe) -> Self {
        let default = if probe.quantity == Quantity::Force { Reduction::Sum } else { Reduction::Mean };
        Self {
            k,
            path: "",
            on: probe.on.as_ref(),
            at: probe.at.map_or(DVec3::ZERO, |point| point.0),
            line: probe.line,
            follows: probe.follows.as_deref(),
            take: probe.take.unwrap_or(default),
            may_be_empty: probe.may_be_empty,
        }
    }

    /// The place to which it is relative.
    pub fn of_second(k: usize, probe: &scene::Probe, to: &'a RelativeTo) -> Self {
        Self {
            k,
            path: "relative_to.",
            on: to.on.as_ref(),
            at: to.at.map_or(DVec3::ZERO, |point| point.0),
            line: None,
            follows: to.follows.as_deref(),
            take: probe.take.unwrap_or(Reduction::Mean),
            may_be_empty: probe.may_be_empty,
        }
    }

    fn problem(&self, field: &str, message: impl Into<String>, help: impl Into<String>) -> Vec<Problem> {
        let path = format!("probes[{}].{}{field}", self.k, self.path);
        vec![Problem::at_path(path, message.into()).help(help.into())]
    }

    /// The places on its line with their distances from the first one, or the only one.
    fn points(&self) -> (Vec<DVec3>, Vec<f64>) {
        let Some(line) = self.line else { return (vec![self.at], vec![0.0]) };
        let (from, to) = (line.from.0, line.to.0);
        let share = |n: u32| f64::from(n) / f64::from(line.points - 1);
        let points = (0..line.points).map(|n| from.lerp(to, share(n))).collect();
        (points, (0..line.points).map(|n| from.distance(to) * share(n)).collect())
    }
}

/// Finds a field in bodies: in at least one of them, or in all.
type Find<'a> = dyn Fn(&BodySet, bool) -> Result<ChosenField, Vec<Problem>> + 'a;

/// The gauge of a field at a place.
pub(super) fn gauge_at(
    place: &ProbePlace<'_>,
    field: &Find<'_>,
    sim: &SimBuilder<'_>,
) -> Result<Gauge, Vec<Problem>> {
    let Some(on) = place.on else {
        return match place.follows {
            Some(name) => points_of_body(place, name, field, sim),
            None => points_of_space(place, field, sim),
        };
    };
    if on.surface.is_some() {
        return surface(place, on, field, sim);
    }
    let selection =
        sim.select_at_start(on, &format!("{}on", place.path)).map_err(|error| at_probe(place.k, error))?;
    let field = field(&BodySet::new(selection.parts.iter().map(|(id, _)| *id)), true)?;
    match place.take {
        Reduction::Mean | Reduction::Sum => {
            Ok(Gauge::Particles(ParticleGauge { selection, field, sum: place.take == Reduction::Sum }))
        }
        take => {
            check_number(place, &field)?;
            Ok(Gauge::Measure(Box::new(Extremal { selection, field, take })))
        }
    }
}

fn check_number(place: &ProbePlace<'_>, field: &ChosenField) -> Result<(), Vec<Problem>> {
    if field.width() <= 3 {
        return Ok(());
    }
    let help = format!("name a component, such as `{}.xx`, or a number such as `von_mises`", field.name());
    Err(place.problem("take", "a tensor has no minimum or maximum", help))
}

fn points_of_space(
    place: &ProbePlace<'_>,
    field: &Find<'_>,
    sim: &SimBuilder<'_>,
) -> Result<Gauge, Vec<Problem>> {
    // The particles of walls have the pressure for the pair force on the fluid, which is not that at
    // their places.
    let all = || sim.bodies().iter();
    let flows = all().any(|body| body.kind == BodyKind::Fluid);
    let bodies = all().filter(|body| !(flows && body.kind == BodyKind::Boundary)).map(|body| body.id);
    let field = field(&BodySet::new(bodies), false)?;
    let gauge = |at| PointGauge { at, field: field.clone(), periodic: sim.periodic() };
    let (points, along) = place.points();
    let points: Vec<PointGauge> = points.into_iter().map(gauge).collect();
    if !place.may_be_empty && points.iter().all(|point| point.is_empty(sim.bodies())) {
        let measured: Vec<&BodyPlan> = all().filter(|body| field.is_in(body.id)).collect();
        let (at, is_line) = (if place.line.is_some() { "line" } else { "at" }, place.line.is_some());
        let message = format!(
            "no particle with `{}` is near {} at the start",
            field.name(),
            if is_line { "the line".to_owned() } else { points[0].at.to_string() }
        );
        let help = format!("{}; `may_be_empty: true` if something gets there later", extents(&measured));
        return Err(place.problem(at, message, help));
    }
    if place.line.is_some() {
        return Ok(Gauge::Measure(Box::new(SpaceLine { points, along })));
    }
    points.into_iter().next().map(Gauge::Point).ok_or_else(Vec::new)
}

fn points_of_body(
    place: &ProbePlace<'_>,
    name: &str,
    field: &Find<'_>,
    sim: &SimBuilder<'_>,
) -> Result<Gauge, Vec<Problem>> {
    let Some(body) = sim.bodies().iter().find(|body| body.name == name) else {
        // Reported by the checks of the scene.
        return Err(Vec::new());
    };
    if body.kind == BodyKind::Fluid {
        let help = "leave `follows` out to measure at a point of space";
        return Err(place.problem("follows", format!("body `{name}` is a fluid, whose points mix"), help));
    }
    let field = field(&BodySet::new([body.id]), true)?;
    let (points, along) = place.points();
    let found = Stencil::of_points(&points, body, sim.dimension().count());
    let stencil = |(stencil, point): (Option<Stencil>, &DVec3)| {
        stencil.ok_or_else(|| {
            let message = format!("body `{name}` has no point {point} at the start");
            place.problem(if place.line.is_some() { "line" } else { "at" }, message, extents(&[body]))
        })
    };
    let stencils = found.into_iter().zip(&points).map(stencil).collect::<Result<Vec<_>, _>>()?;
    let made = if place.line.is_some() { PointReduction::Line(along) } else { PointReduction::Value };
    let surface = MeasuredPoints { body, field: &field, sim }.at(&points);
    Ok(Gauge::Measure(Box::new(BodyPoints { body: body.id, field, stencils, surface, made })))
}

/// The gauge of the surface of one body, at the middles of its facets or of the selected parts of them.
fn surface(
    place: &ProbePlace<'_>,
    on: &Select,
    field: &Find<'_>,
    sim: &SimBuilder<'_>,
) -> Result<Gauge, Vec<Problem>> {
    let named = |body: &&BodyPlan| on.body.as_ref().is_none_or(|name| body.name == *name);
    let mut bodies = sim.bodies().iter().filter(named);
    let (Some(body), None) = (bodies.next(), bodies.next()) else {
        let help = "name it: `Select(body: \"plate\", surface: Inner)`";
        return Err(place.problem("on", "a surface is that of one body", help));
    };
    let shape = &sim.scene().bodies[body.id.0].shape;
    let Some(facets) = shape.facets(sim.dimension(), sim.folder(), body.spacing) else {
        let help = "select particles by `within`, `face` or `nearest` instead";
        return Err(place.problem(
            "on.surface",
            format!("the surface of body `{}` is not known", body.name),
            help,
        ));
    };
    if place.take == Reduction::Sum {
        return Err(place.problem(
            "take",
            "a surface has no sum over particles",
            "take `Mean`, `Minimum` or `Maximum`",
        ));
    }
    let field = field(&BodySet::new([body.id]), true)?;
    if place.take != Reduction::Mean {
        check_number(place, &field)?;
    }
    // Faults of planes and periods are those of the formulation.
    let repeats = repeats_of(body, 0.0, sim).unwrap_or_default();
    let chosen = selected_facets(on, body.id, &facets, &repeats, sim);
    let chosen = chosen.map_err(|error| at_probe(place.k, error))?;
    let centers: Vec<DVec3> = chosen.iter().map(|part| part.middle(&facets)).collect();
    let found = Stencil::of_points(&centers, body, sim.dimension().count());
    let area = |part: &SelectedFacet| part.share * facets.normal_and_measure(part.facet as usize).1;
    let known = found.into_iter().zip(&chosen).filter_map(|(stencil, part)| Some((stencil?, part)));
    let (stencils, parts): (Vec<Stencil>, Vec<&SelectedFacet>) = known.unzip();
    let areas = parts.iter().map(|part| area(part)).collect();
    if stencils.is_empty() {
        return Err(place.problem("on", "no part of the surface is selected", extents(&[body])));
    }
    let made = PointReduction::Taken(place.take, areas);
    let surface = MeasuredPoints { body, field: &field, sim }.on(&facets, &parts);
    Ok(Gauge::Measure(Box::new(BodyPoints { body: body.id, field, stencils, surface, made })))
}

/// Where bodies are at the start.
fn extents(bodies: &[&BodyPlan]) -> String {
    let of = |body: &&BodyPlan| {
        format!(
            "`{}` extends from {} to {}",
            body.name,
            notation::place(body.bounds.min),
            notation::place(body.bounds.max)
        )
    };
    bodies.iter().map(of).collect::<Vec<_>>().join("; ")
}
