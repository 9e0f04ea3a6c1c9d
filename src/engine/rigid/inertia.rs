//! Mass, centre and inertia of a body from its shape, or from its particles.

use glam::DVec3;

use crate::linalg::Sym3;
use crate::plugin::BodyPlan;
use crate::scene::Dimension;
use crate::shapes::{Moments, Shape, Surface};

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
    /// Where the shape has no closed form, each particle counts as the square or cube of its volume.
    pub fn new(body: &BodyPlan, surface: &dyn Surface, dimension: Dimension) -> Self {
        let density = body.material.density;
        let volume: f64 = body.sites.iter().map(|site| site.volume).sum();
        let moments = surface.moments().unwrap_or_else(|| of_particles(body, volume, dimension));
        let mut points = Sym3::ZERO;
        for site in &body.sites {
            points += about(&Sym3::dyad(site.position - moments.center)) * (density * site.volume);
        }
        // The mass is that of the particles: files of particles say their volumes themselves.
        let mass = density * volume;
        let tensor = about(&moments.second) * (mass / moments.volume);
        Self { mass, center: moments.center, tensor, points }
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
