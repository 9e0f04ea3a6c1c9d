//! Concentric lattices: rings of sectors about an axis, or shells of equal parts about a centre.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::error::FillErrorKind;
use super::rings::Rings;
use super::site::Site;

/// Particles with about the volume of a cube (square) of side `spacing`; each has the exact volume of its
/// sector or part.
///
/// # Errors
/// A wall thickness, radius or length of less than two particles.
pub(super) fn sites(rings: &Rings, spacing: f64) -> Result<Vec<Site>, FillErrorKind> {
    match *rings {
        Rings::Plane { center, inner, outer } => {
            let sector = |(x, y, volume)| Site { position: center + DVec3::new(x, y, 0.0), volume };
            Ok(sectors(inner, outer, spacing)?.into_iter().map(sector).collect())
        }
        Rings::Axial { from, to, inner, outer } => {
            let sectors = sectors(inner, outer, spacing)?;
            let axis = to - from;
            let layers = layers(axis.length(), spacing, "the axis")?;
            let (u, v) = axis.normalize().any_orthonormal_pair();
            let mut sites = Vec::with_capacity(layers * sectors.len());
            for layer in 0..layers {
                let center = from + (layer as f64 + 0.5) / layers as f64 * axis;
                let height = axis.length() / layers as f64;
                sites.extend(
                    sectors.iter().map(|&(x, y, area)| Site {
                        position: center + x * u + y * v,
                        volume: area * height,
                    }),
                );
            }
            Ok(sites)
        }
        Rings::Shells { center, inner, outer } => {
            let count = radial_layers(inner, outer, spacing)?;
            let width = (outer - inner) / count as f64;
            let shells = (0..count).flat_map(|shell| {
                let r0 = inner + width * shell as f64;
                shell_parts(r0, r0 + width, spacing, shell)
            });
            Ok(shells.map(|(position, volume)| Site { position: center + position, volume }).collect())
        }
    }
}

fn layers(thickness: f64, spacing: f64, direction: &'static str) -> Result<usize, FillErrorKind> {
    let layers = (thickness / spacing).round();
    if layers < 2.0 {
        return Err(FillErrorKind::Thin { direction, thickness, spacing });
    }
    Ok(layers as usize)
}

/// Number of rings or shells between two radii; the inner one is 0 without a hole.
fn radial_layers(inner: f64, outer: f64, spacing: f64) -> Result<usize, FillErrorKind> {
    if inner > 0.0 {
        return layers(outer - inner, spacing, "the radius");
    }
    layers(2.0 * outer, spacing, "the radius")?;
    Ok((outer / spacing).round().max(1.0) as usize)
}

/// Sectors of rings as (x, y, area), with each particle at the centroid of its sector.
fn sectors(inner: f64, outer: f64, spacing: f64) -> Result<Vec<(f64, f64, f64)>, FillErrorKind> {
    let rings = radial_layers(inner, outer, spacing)?;
    let width = (outer - inner) / rings as f64;
    let mut sectors = Vec::new();
    for ring in 0..rings {
        let (r0, r1) = (inner + ring as f64 * width, inner + (ring + 1) as f64 * width);
        let area = PI * (r1 - r0) * (r1 + r0);
        let count = (area / spacing.powi(2)).round().max(3.0);
        let half_angle = PI / count;
        let radius = 2.0 / 3.0 * (r1 * r1 + r1 * r0 + r0 * r0) / (r1 + r0) * half_angle.sin() / half_angle;
        for sector in 0..count as usize {
            let (sin, cos) = (TAU * (sector as f64 + 0.5) / count).sin_cos();
            sectors.push((radius * cos, radius * sin, area / count));
        }
    }
    Ok(sectors)
}

/// Points of a Fibonacci spiral on the sphere of the mean radius of a shell, with equal volumes. (Swinbank
/// and Purser, Q. J. R. Meteorol. Soc. 132, 2006: z is at the middles of zones of equal area, and the
/// longitude increases by the golden angle from point to point.)
fn shell_parts(r0: f64, r1: f64, spacing: f64, shell: usize) -> impl Iterator<Item = (DVec3, f64)> {
    let volume = 4.0 / 3.0 * PI * (r1.powi(3) - r0.powi(3));
    let count = (volume / spacing.powi(3)).round().max(4.0);
    let radius = 0.75 * (r1.powi(4) - r0.powi(4)) / (r1.powi(3) - r0.powi(3));
    let golden = PI * (3.0 - 5f64.sqrt());
    (0..count as usize).map(move |n| {
        let z = 1.0 - (2.0 * n as f64 + 1.0) / count;
        // Shells are rotated relative to each other, so that the patterns at their poles are not aligned.
        let (sin, cos) = (golden * n as f64 + shell as f64).sin_cos();
        let around = (1.0 - z * z).sqrt();
        (radius * DVec3::new(around * cos, around * sin, z), volume / count)
    })
}
