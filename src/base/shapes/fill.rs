//! Filling a shape with particles, so that mass = density x volume of the shape.

use std::path::Path;

use glam::DVec3;

use super::cells::{self, Packing};
use super::check::ShapeCheck;
use super::error::{FillError, FillErrorKind};
use super::lattice::Lattice;
use super::region::Region;
use super::shape::Shape;
use super::site::{Content, Site};
use super::surface::Surface;
use super::tiling::Tiling;
use super::transform::turned;
use super::{concentric, fitted, morton_order, points, quadrature, relaxed};
use crate::space::Dimension;

/// Maximum number of relaxation steps; particles hardly move after them.
const MAX_ITERATIONS: u32 = 1000;

/// Options for filling a shape.
#[derive(Clone, Copy, Debug)]
pub struct Filling<'a> {
    /// Arrangement of the particles.
    pub lattice: Lattice,
    /// Particle spacing, m.
    pub spacing: f64,
    /// Dimension of the scene.
    pub dimension: Dimension,
    /// Folder of particle files and meshes.
    pub folder: &'a Path,
    /// Maximum number of particles.
    pub limit: usize,
    /// Whether the shape is the wall of a flow. Its cells end at the faces of a box-shaped cavity, and its
    /// volumes are those of the cells.
    pub is_wall: bool,
}

/// The particles that fill `shape`, in the order of a Morton curve.
///
/// The volumes add up to that of the shape, in closed form or, for combinations without one, by quadrature to
/// 0.1 %. A regular or hexagonal lattice divides the bounding box of the shape evenly (for a combination that
/// of its first shape): a side that is not a multiple of the spacing gets the nearest number of particles.
/// The lattice is translated and rotated with the shape.
///
/// # Errors
/// The spacing is not positive; the shape is not valid in this dimension, is empty, is thinner than two
/// particles, or does not fit the lattice; it needs more particles than the limit; the particle file is
/// missing or invalid.
pub fn fill(shape: &Shape, filling: Filling<'_>) -> Result<Vec<Site>, FillError> {
    let spacing = filling.spacing;
    if !spacing.is_finite() {
        return Err(FillError::new("spacing", FillErrorKind::NotFinite(spacing)));
    }
    if spacing <= 0.0 {
        return Err(FillError::new("spacing", FillErrorKind::NotPositive(spacing)));
    }
    let filling = Filling { limit: filling.limit.min(u32::MAX as usize), ..filling };
    let sites = filling.sites(shape, "shape")?;
    let positions: Vec<DVec3> = sites.iter().map(|site| site.position).collect();
    // A rotation or translation of very distant points may overflow.
    if let Some(lost) = positions.iter().find(|position| !position.is_finite()) {
        let lost = lost.to_array().into_iter().find(|x| !x.is_finite()).unwrap_or(f64::NAN);
        return Err(FillError::new("shape", FillErrorKind::NotFinite(lost)));
    }
    Ok(morton_order(&positions, spacing).into_iter().map(|n| sites[n as usize]).collect())
}

impl Filling<'_> {
    fn sites(&self, shape: &Shape, path: &str) -> Result<Vec<Site>, FillError> {
        let check = ShapeCheck { dimension: self.dimension, folder: self.folder, path };
        match shape {
            Shape::Points { file } => {
                let sites = points::read(self.folder, file, self.dimension, self.limit, path)?;
                points::check(&sites, self.spacing, self.dimension, &self.folder.join(file), path)?;
                Ok(sites)
            }
            Shape::Translate { shape, by } => {
                let by = check.point("by", *by)?;
                self.moved(shape, &check, 1.0, |position| position + by)
            }
            Shape::Rotate { shape, axis, angle_degrees, about } => {
                let (turn, about) = check.turn(*axis, *angle_degrees, *about)?;
                self.moved(shape, &check, 1.0, |position| turned(turn, about, position))
            }
            Shape::Scale { shape, by, about } if is_uniform(shape, by.0, self.dimension) => {
                let (by, about) = check.scale(*by, *about)?;
                let growth = by.element_product();
                let inner = Filling { spacing: self.spacing / by.x, ..*self };
                inner.moved(shape, &check, growth, |position| about + by * (position - about))
            }
            Shape::Mesh { .. } => {
                let region = check.single(shape)?;
                self.check_size(region.as_ref(), &check)?;
                self.of_region(region.as_ref(), path)
            }
            _ => self.of_region(shape.region(self.dimension, self.folder, path)?.as_ref(), path),
        }
    }

    /// The transformed particles of the inner shape of a transform.
    fn moved(
        &self,
        shape: &Shape,
        check: &ShapeCheck,
        growth: f64,
        to: impl Fn(DVec3) -> DVec3,
    ) -> Result<Vec<Site>, FillError> {
        let sites = self.sites(shape, &check.field("shape"))?;
        let moved = |site: Site| Site { position: to(site.position), volume: growth * site.volume };
        Ok(sites.into_iter().map(moved).collect())
    }

    /// A mesh that is too small or too large for the spacing is usually in another unit.
    fn check_size(&self, mesh: &dyn Surface, check: &ShapeCheck) -> Result<(), FillError> {
        let spacing = self.spacing;
        let extent = mesh.bounds().extent();
        let estimate = mesh.volume().unwrap_or(0.0) / spacing.powi(3);
        if extent.max_element() < 2.0 * spacing || estimate > self.limit as f64 {
            return Err(FillError::new(check.path, FillErrorKind::MeshSize { extent, spacing }));
        }
        Ok(())
    }

    fn of_region(&self, region: &dyn Region, path: &str) -> Result<Vec<Site>, FillError> {
        if !region.bounds().is_bounded() {
            return Err(FillError::new(path, FillErrorKind::Unbounded));
        }
        let content = self.measured(region, path)?;
        let at = |kind: FillErrorKind| match kind {
            FillErrorKind::Thin { .. } => FillError::new("spacing", kind),
            FillErrorKind::NotConcentric => FillError::new("lattice", kind),
            FillErrorKind::Iterations { .. } => FillError::new("lattice.iterations", kind),
            _ => FillError::new(path, kind),
        };
        self.of_content(content).map_err(at)
    }

    /// The region with its volume, checked against the maximum number of particles.
    fn measured<'r>(&self, region: &'r dyn Region, path: &str) -> Result<Content<'r>, FillError> {
        let (axes, spacing) = (self.dimension.count(), self.spacing);
        let within_limit = |volume: f64, factor: f64| {
            let estimate = volume / spacing.powi(axes as i32);
            if estimate <= factor * self.limit as f64 {
                return Ok(());
            }
            Err(FillError::new("spacing", FillErrorKind::TooMany { estimate, limit: self.limit }))
        };
        // The exact volume may be expensive where the spacing is far too small, so a rough estimate is
        // checked first.
        within_limit(quadrature::volume(region, f64::INFINITY, axes), 2.0)?;
        let volume = quadrature::volume(region, spacing, axes);
        within_limit(volume, 1.0)?;
        if volume <= 0.0 {
            return Err(FillError::new(path, FillErrorKind::NoParticle(spacing)));
        }
        Ok(Content { region, volume, spacing, axes })
    }

    fn of_content(&self, content: Content<'_>) -> Result<Vec<Site>, FillErrorKind> {
        let Content { region, volume, spacing, axes } = content;
        if self.lattice == Lattice::Concentric {
            let rings = region.rings().ok_or(FillErrorKind::NotConcentric)?;
            return concentric::sites(&rings, spacing);
        }
        let packing = if self.lattice == Lattice::Hexagonal { Packing::Hexagonal } else { Packing::Centered };
        let is_regular = matches!(self.lattice, Lattice::Automatic | Lattice::Regular);
        let cavity = if self.is_wall && is_regular { region.wall_frame(spacing) } else { None };
        let frame = cavity.unwrap_or_else(|| region.frame());
        let positions = cells::points(region, &frame, packing, spacing, axes)?;
        let alike = |positions: Vec<DVec3>, volume: f64| {
            positions.into_iter().map(|position| Site { position, volume }).collect()
        };
        if cavity.is_some() {
            let cell = Tiling::new(&frame, &frame, packing.cell(spacing, axes), axes).cell_volume();
            return Ok(alike(positions, cell));
        }
        Ok(match self.lattice {
            Lattice::Relaxed { iterations: found, .. } | Lattice::BodyFitted { iterations: found }
                if found > MAX_ITERATIONS =>
            {
                return Err(FillErrorKind::Iterations { found, limit: MAX_ITERATIONS });
            }
            Lattice::Relaxed { seed, iterations } => relaxed::sites(content, seed, iterations),
            Lattice::BodyFitted { iterations } => fitted::sites(content, positions, iterations),
            _ => {
                let share = volume / positions.len() as f64;
                alike(positions, share)
            }
        })
    }
}

/// Whether a shape is filled before it is scaled: particle files always, others for uniform scaling.
pub(super) fn is_uniform(shape: &Shape, by: DVec3, dimension: Dimension) -> bool {
    matches!(shape, Shape::Points { .. }) || (by.x == by.y && (dimension == Dimension::Two || by.y == by.z))
}
