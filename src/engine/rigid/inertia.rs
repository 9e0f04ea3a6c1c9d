//! Mass, centre and inertia of a body from its shape.

use glam::DVec3;

use crate::linalg::Sym3;
use crate::plugin::BodyPlan;
use crate::scene::Dimension;
use crate::shapes::{Moments, Shape, Surface, counted_moments};

/// Mass, centre and inertia of a rigid body.
#[derive(Clone, Copy, Debug)]
pub(super) struct MassProperties {
    /// Mass, kg; in two dimensions per metre of thickness.
    pub mass: f64,
    /// Centre in the reference configuration, m.
    pub center: DVec3,
    /// Inertia about the centre, kg m2: that of the shape.
    pub tensor: Sym3,
    /// Inertia of the particles as points, kg m2.
    pub points: Sym3,
}

impl MassProperties {
    /// Where the shape has no closed form, its moments are counted; an unbounded one has those of its
    /// particles, with next to no mass: it is a tool, whose weight is in no force that others exert on it.
    pub fn new(body: &BodyPlan, surface: &dyn Surface, dimension: Dimension) -> Self {
        let share = if surface.bounds().is_bounded() { 1.0 } else { UNBOUNDED };
        let density = share * body.material.density;
        let volume = body.volume();
        let moments = match surface.moments() {
            Some(moments) => moments,
            None if surface.bounds().is_bounded() => counted_moments(surface, dimension.count()),
            None => of_particles(body, volume, dimension),
        };
        let masses = body.sites.iter().map(|site| (density * site.volume, site.position));
        let tilt = Tilt::new(masses.clone(), moments.center);
        let mut points = Sym3::ZERO;
        for (mass, place) in masses {
            points += about(&Sym3::dyad(place - moments.center)) * (mass * tilt.at(place));
        }
        // The mass is that of the particles: files of particles say their volumes themselves.
        let mass = density * volume;
        let tensor = about(&moments.second) * (mass / moments.volume);
        Self { mass, center: moments.center, tensor, points }
    }
}

/// Mass of the particles of an unbounded body, over that of their volume: forces are shared out by mass, so
/// that it is not zero.
const UNBOUNDED: f64 = 1e-12;
/// Distance of the centre of the particles from that of the body, over their radius of gyration, below which
/// it is round-off.
const ROUND_OFF: f64 = 1e-9;
/// Second moment that is added along all axes, over the trace: particles in a plane, as in two dimensions,
/// have none across it.
const REGULAR: f64 = 1e-12;
/// Largest change of the mass of a particle.
const LARGEST_TILT: f64 = 0.5;

/// A factor on the masses of particles, linear in their places, with which their mass centre is that of the
/// body: their weight then has no torque about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tilt {
    middle: DVec3,
    slope: DVec3,
}

impl Tilt {
    /// For particles of these masses, kg, at these places, m.
    pub fn new(masses: impl Iterator<Item = (f64, DVec3)> + Clone, center: DVec3) -> Self {
        let total: f64 = masses.clone().map(|(mass, _)| mass).sum();
        let middle = masses.clone().map(|(mass, place)| mass * place).sum::<DVec3>() / total;
        let none = Self { middle: center, slope: DVec3::ZERO };
        let mut second = Sym3::ZERO;
        for (mass, place) in masses.clone() {
            second += Sym3::dyad(place - middle) * mass;
        }
        let gyration = (second.trace() / total).sqrt();
        let aside = center - middle;
        // Not so where there are no particles, or all in one place.
        let is_aside = aside.length() > ROUND_OFF * gyration;
        if !is_aside {
            return none;
        }
        let regular = second + Sym3::IDENTITY * (REGULAR * second.trace());
        let tilt = Self { middle, slope: regular.inverse() * (total * aside) };
        let is_small = |(_, place): (f64, DVec3)| (tilt.at(place) - 1.0).abs() <= LARGEST_TILT;
        if masses.clone().all(is_small) { tilt } else { none }
    }

    pub fn at(&self, place: DVec3) -> f64 {
        1.0 + self.slope.dot(place - self.middle)
    }
}

/// The inertia of second moments.
fn about(second: &Sym3) -> Sym3 {
    Sym3::IDENTITY * second.trace() - *second
}

fn of_particles(body: &BodyPlan, volume: f64, dimension: Dimension) -> Moments {
    let center = body.sites.iter().map(|site| site.volume * site.position).sum::<DVec3>() / volume;
    let mut second = Sym3::ZERO;
    for site in &body.sites {
        let (side_squared, axes) = match dimension {
            Dimension::Two => (site.volume, DVec3::new(1.0, 1.0, 0.0)),
            Dimension::Three => (site.volume.powf(2.0 / 3.0), DVec3::ONE),
        };
        second += (Sym3::dyad(site.position - center) + Sym3::from_diagonal(axes * (side_squared / 12.0)))
            * site.volume;
    }
    Moments { volume, center, second }
}

/// Centre and radius of a shape that is a sphere or disc, m.
pub(crate) fn sphere_of(shape: &Shape) -> Option<(DVec3, f64)> {
    match shape {
        Shape::Sphere { center, radius } => Some((center.0, *radius)),
        Shape::Translate { shape, by } => sphere_of(shape).map(|(center, radius)| (center + by.0, radius)),
        _ => None,
    }
}
