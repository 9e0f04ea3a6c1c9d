//! Bodies drawn as closed surfaces.

use meshless_engine::record::BodyFrame;
use re_sdk_types::components::Color;

use super::error::RerunError;
use super::output::RecordingOutput;
#[cfg(feature = "surfaces")]
use crate::surface::{SurfaceError, SurfaceMesh, surface_of};

/// Logs the surface of a body.
#[cfg(feature = "surfaces")]
pub fn show_surface(
    output: &RecordingOutput,
    body: &BodyFrame<'_>,
    colors: &[Color],
) -> Result<(), RerunError> {
    use re_sdk_types::archetypes::Mesh3D;

    let rgb = |color: &Color| {
        let [r, g, b, _] = color.to_array();
        [r, g, b]
    };
    let colors: Vec<[u8; 3]> = colors.iter().map(rgb).collect();
    let mesh = match surface_of(body.positions, body.radius, &colors) {
        // The rest of a body of which particles have been removed may lie in a plane, which has no surface.
        Err(SurfaceError::Plane) => SurfaceMesh::default(),
        made => made?,
    };
    let colors = mesh.colors.iter().map(|[r, g, b]| Color::from_rgb(*r, *g, *b));
    let shown = Mesh3D::new(mesh.positions)
        .with_vertex_normals(mesh.normals)
        .with_triangle_indices(mesh.triangles)
        .with_vertex_colors(colors);
    output.log(&super::paths::surface(body.name), &shown)
}

/// Scenes that ask for surfaces are refused by a program that has none.
#[cfg(not(feature = "surfaces"))]
pub fn show_surface(_: &RecordingOutput, _: &BodyFrame<'_>, _: &[Color]) -> Result<(), RerunError> {
    Ok(())
}
