//! Mass, centre and inertia of a body from its particles.

use glam::DVec3;

use crate::linalg::Sym3;
use crate::plugin::BodyPlan;
use crate::scene::Dimension;
use crate::shapes::Shape;

/// What a rigid body weighs.
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
    /// Each particle counts as the square or cube of its volume, so that the inertia of a box is exact; that of a sphere or
    /// disc has a closed form.
    pub fn new(body: &BodyPlan, shape: &Shape, dimension: Dimension) -> Self {
        let density = body.material.density;
        let volume: f64 = body.sites.iter().map(|site| site.volume).sum();
        let mass = density * volume;
        let sphere = sphere_of(shape);
        let moment = body.sites.iter().map(|site| site.volume * site.position).sum::<DVec3>();
        let center = sphere.map_or(moment / volume, |(center, _)| center);
        let mut points = Sym3::ZERO;
        let mut cells = 0.0;
        for site in &body.sites {
            let (m, r) = (density * site.volume, site.position - center);
            points += (Sym3::IDENTITY * r.length_squared() - Sym3::dyad(r)) * m;
            let side_squared = match dimension {
                Dimension::Two => site.volume,
                Dimension::Three => site.volume.powf(2.0 / 3.0),
            };
            cells += m * side_squared / 6.0;
        }
        let tensor = match (sphere, dimension) {
            (Some((_, radius)), Dimension::Two) => {
                let square = mass * radius * radius;
                Sym3::from_diagonal(DVec3::new(0.25 * square, 0.25 * square, 0.5 * square))
            }
            (Some((_, radius)), Dimension::Three) => Sym3::IDENTITY * (0.4 * mass * radius * radius),
            (None, _) => points + Sym3::IDENTITY * cells,
        };
        Self { mass, center, tensor, points }
    }
}

/// Centre and radius of a shape that is a sphere or disc, m.
pub(crate) fn sphere_of(shape: &Shape) -> Option<(DVec3, f64)> {
    match shape {
        Shape::Sphere { center, radius } => Some((center.0, *radius)),
        Shape::Translate { shape, by } => sphere_of(shape).map(|(center, radius)| (center + by.0, radius)),
        _ => None,
    }
}
