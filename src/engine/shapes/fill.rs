//! Filling a shape with particles, so that mass = density x volume of the shape.

use std::path::Path;

use glam::DVec3;

use super::cells::{self, Packing};
use super::check::Check;
use super::error::{FillError, FillErrorKind};
use super::lattice::Lattice;
use super::region::Region;
use super::shape::Shape;
use super::surface::Surface;
use super::tiling::Tiling;
use super::transform::turned;
use super::{concentric, fitted, morton_order, points, quadrature, relaxed};
use crate::space::Dimension;

/// Steps of relaxation after which particles hardly move any more.
const MAX_ITERATIONS: u32 = 1000;

/// Where a particle is, and how much of the shape it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Position \[m\]; z is 0 in two dimensions.
    pub position: DVec3,
    /// Volume \[m³\]; in two dimensions area \[m²\], the volume of a slice 1 m thick.
    pub volume: f64,
}

/// How a shape is filled.
struct Filling<'a> {
    lattice: Lattice,
    dimension: Dimension,
    folder: &'a Path,
    limit: usize,
    /// Whether cells end at the cavity of the shape.
    is_wall: bool,
}

/// The particles that fill `shape`, in the order of a Morton curve.
///
/// The volumes add up to that of the shape: the closed form, or for combinations without one a numerical value good to 0.1 %. A regular
/// or hexagonal lattice divides the box about the shape evenly (that about the first shape of a combination): a side that is no
/// multiple of `spacing` \[m\] gets the nearest number of particles. Translations and rotations take the lattice with them. Particle files
/// are looked for in `folder`. At most `limit` particles are made.
///
/// # Errors
/// `spacing` is not positive; the shape is not valid in this dimension, is empty, is thinner than two particles, or does not fit the
/// lattice; it takes more than `limit` particles; the particle file is missing or wrong.
pub fn fill(
    shape: &Shape,
    lattice: Lattice,
    spacing: f64,
    dimension: Dimension,
    folder: &Path,
    limit: usize,
) -> Result<Vec<Site>, FillError> {
    fill_with(shape, spacing, Filling { lattice, dimension, folder, limit, is_wall: false })
}

/// The same for the wall of a flow: where a box is cut out of the shape, cells end at it, and volumes are those of cells.
///
/// # Errors
/// As [`fill`].
pub fn fill_wall(
    shape: &Shape,
    lattice: Lattice,
    spacing: f64,
    dimension: Dimension,
    folder: &Path,
    limit: usize,
) -> Result<Vec<Site>, FillError> {
    fill_with(shape, spacing, Filling { lattice, dimension, folder, limit, is_wall: true })
}

fn fill_with(shape: &Shape, spacing: f64, filling: Filling<'_>) -> Result<Vec<Site>, FillError> {
    if !spacing.is_finite() {
        return Err(FillError::new("spacing", FillErrorKind::NotFinite(spacing)));
    }
    if spacing <= 0.0 {
        return Err(FillError::new("spacing", FillErrorKind::NotPositive(spacing)));
    }
    let filling = Filling { limit: filling.limit.min(u32::MAX as usize), ..filling };
    let sites = filling.sites(shape, spacing, "shape")?;
    let positions: Vec<DVec3> = sites.iter().map(|site| site.position).collect();
    // A turn or a shift of what is very far away may leave the range of numbers.
    if let Some(lost) = positions.iter().find(|position| !position.is_finite()) {
        let lost = lost.to_array().into_iter().find(|x| !x.is_finite()).unwrap_or(f64::NAN);
        return Err(FillError::new("shape", FillErrorKind::NotFinite(lost)));
    }
    Ok(morton_order(&positions, spacing).into_iter().map(|n| sites[n as usize]).collect())
}

impl Filling<'_> {
    fn sites(&self, shape: &Shape, spacing: f64, path: &str) -> Result<Vec<Site>, FillError> {
        let check = Check { dimension: self.dimension, folder: self.folder, path };
        match shape {
            Shape::Points { file } => {
                let sites = points::read(self.folder, file, self.dimension, self.limit, path)?;
                points::check(&sites, spacing, self.dimension, &self.folder.join(file), path)?;
                Ok(sites)
            }
            Shape::Translate { shape, by } => {
                let by = check.point("by", *by)?;
                self.moved(shape, spacing, &check, 1.0, |position| position + by)
            }
            Shape::Rotate { shape, axis, angle_degrees, about } => {
                let (turn, about) = check.turn(*axis, *angle_degrees, *about)?;
                self.moved(shape, spacing, &check, 1.0, |position| turned(turn, about, position))
            }
            Shape::Scale { shape, by, about } if is_uniform(shape, by.0, self.dimension) => {
                let (by, about) = check.scale(*by, *about)?;
                let growth = by.element_product();
                self.moved(shape, spacing / by.x, &check, growth, |position| about + by * (position - about))
            }
            Shape::Mesh { .. } => {
                let region = check.single(shape)?;
                self.check_size(region.as_ref(), spacing, &check)?;
                self.of_region(region.as_ref(), spacing, path)
            }
            _ => self.of_region(shape.region(self.dimension, self.folder, path)?.as_ref(), spacing, path),
        }
    }

    /// The particles of the inner shape of a transform, taken along with it.
    fn moved(
        &self,
        shape: &Shape,
        spacing: f64,
        check: &Check,
        growth: f64,
        to: impl Fn(DVec3) -> DVec3,
    ) -> Result<Vec<Site>, FillError> {
        let sites = self.sites(shape, spacing, &check.field("shape"))?;
        let moved = |site: Site| Site { position: to(site.position), volume: growth * site.volume };
        Ok(sites.into_iter().map(moved).collect())
    }

    /// A mesh that is too small or too large for the spacing is in another unit, more often than not.
    fn check_size(&self, mesh: &dyn Surface, spacing: f64, check: &Check) -> Result<(), FillError> {
        let extent = mesh.bounds().extent();
        let estimate = mesh.volume().unwrap_or(0.0) / spacing.powi(3);
        if extent.max_element() < 2.0 * spacing || estimate > self.limit as f64 {
            return Err(FillError::new(check.path, FillErrorKind::MeshSize { extent, spacing }));
        }
        Ok(())
    }

    fn of_region(&self, region: &dyn Region, spacing: f64, path: &str) -> Result<Vec<Site>, FillError> {
        let axes = self.dimension.count();
        if !region.bounds().is_bounded() {
            return Err(FillError::new(path, FillErrorKind::Unbounded));
        }
        let within_limit = |volume: f64, factor: f64| {
            let estimate = volume / spacing.powi(axes as i32);
            if estimate <= factor * self.limit as f64 {
                return Ok(());
            }
            Err(FillError::new("spacing", FillErrorKind::TooMany { estimate, limit: self.limit }))
        };
        // The exact volume may take long where the spacing is far too small: a rough one is looked at first.
        within_limit(quadrature::volume(region, f64::INFINITY, axes), 2.0)?;
        let volume = quadrature::volume(region, spacing, axes);
        within_limit(volume, 1.0)?;
        if volume <= 0.0 {
            return Err(FillError::new(path, FillErrorKind::NoParticle(spacing)));
        }
        let at = |kind: FillErrorKind| match kind {
            FillErrorKind::Thin { .. } => FillError::new("spacing", kind),
            FillErrorKind::NotConcentric => FillError::new("lattice", kind),
            _ => FillError::new(path, kind),
        };
        if self.lattice == Lattice::Concentric {
            let rings = region.rings().ok_or_else(|| at(FillErrorKind::NotConcentric))?;
            return concentric::sites(&rings, spacing).map_err(at);
        }
        let packing = if self.lattice == Lattice::Hexagonal { Packing::Hexagonal } else { Packing::Centered };
        let cavity =
            if self.is_wall && self.lattice == Lattice::Regular { region.wall_frame(spacing) } else { None };
        let frame = cavity.unwrap_or_else(|| region.frame());
        let positions = cells::points(region, &frame, packing, spacing, axes).map_err(at)?;
        if cavity.is_some() {
            let cell = Tiling::new(&frame, &frame, packing.cell(spacing, axes), axes).cell_volume();
            return Ok(positions.into_iter().map(|position| Site { position, volume: cell }).collect());
        }
        match self.lattice {
            Lattice::Relaxed { iterations: found, .. } | Lattice::BodyFitted { iterations: found }
                if found > MAX_ITERATIONS =>
            {
                let kind = FillErrorKind::Iterations { found, limit: MAX_ITERATIONS };
                return Err(FillError::new("lattice.iterations", kind));
            }
            Lattice::Relaxed { seed, iterations } => {
                return Ok(relaxed::sites(region, volume, spacing, axes, seed, iterations));
            }
            Lattice::BodyFitted { iterations } => {
                return Ok(fitted::sites(region, positions, volume, spacing, axes, iterations));
            }
            _ => {}
        }
        let share = volume / positions.len() as f64;
        Ok(positions.into_iter().map(|position| Site { position, volume: share }).collect())
    }
}

/// Whether a scaled shape is filled before it is scaled: particle files always, others if the factors are equal.
fn is_uniform(shape: &Shape, by: DVec3, dimension: Dimension) -> bool {
    matches!(shape, Shape::Points { .. }) || (by.x == by.y && (dimension == Dimension::Two || by.y == by.z))
}
