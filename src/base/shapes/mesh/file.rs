//! Reading of a mesh file to a checked solid.

use std::path::Path;

use glam::DVec3;

use super::solid::MeshSolid;
use super::{obj, stl};
use crate::files;
use crate::shapes::error::FillErrorKind;
use crate::shapes::mesh_fault::MeshFault;

/// Reads a mesh and multiplies its coordinates by `scale` \[m per unit of the file\].
///
/// # Errors
/// The file cannot be read, or its mesh does not bound a solid.
pub(in crate::shapes) fn load(folder: &Path, file: &str, scale: f64) -> Result<MeshSolid, FillErrorKind> {
    let full = folder.join(file);
    let shown = full.display().to_string();
    let bytes = match files::read(&full, files::MAX_GEOMETRY) {
        Ok(bytes) => bytes,
        Err(source) => return Err(FillErrorKind::File { file: shown, source }),
    };
    let extension = full.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let triangles = match extension.as_deref() {
        Some("stl") => stl::read(&bytes),
        Some("obj") => obj::read(&String::from_utf8_lossy(&bytes)),
        _ => Err(MeshFault::Extension),
    };
    let scaled = |corners: [DVec3; 3]| corners.map(|corner| scale * corner);
    let solid = triangles
        .and_then(|triangles| MeshSolid::new(&triangles.into_iter().map(scaled).collect::<Vec<_>>()));
    solid.map_err(|fault| FillErrorKind::Mesh { file: shown, fault })
}
