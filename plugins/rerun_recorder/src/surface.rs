//! The surface of a body as a mesh of triangles, reconstructed from its particles.
//!
//! The density of the particles is contoured by marching cubes (W. Lorensen, H. Cline, SIGGRAPH 1987; by the
//! crate `splashsurf_lib`), the mesh is smoothed by Laplacian steps, and its colours are Shepard means of
//! those of the particles around.

use std::fmt::Display;
use std::io::{self, Write};

use splashsurf_lib::mesh::Mesh3d;
use splashsurf_lib::nalgebra::Vector3;
use splashsurf_lib::postprocessing::par_laplacian_smoothing_inplace;
use splashsurf_lib::sph_interpolation::SphInterpolator;
use splashsurf_lib::{Parameters, SpatialDecomposition, reconstruct_surface};
use thiserror::Error;

/// Reach of a particle over its radius: two spacings.
const REACH: f32 = 4.0;
/// Edge of the cubes of the contour over the radius of a particle.
const CUBE: f32 = 0.75;
/// Steps of smoothing.
const SMOOTHING: usize = 10;

/// A mesh of triangles with colours.
#[derive(Clone, Debug, Default)]
pub struct SurfaceMesh {
    /// Vertices \[m\].
    pub positions: Vec<[f32; 3]>,
    /// Normals of the vertices, outward.
    pub normals: Vec<[f32; 3]>,
    /// Colours of the vertices.
    pub colors: Vec<[u8; 3]>,
    /// Vertices of each triangle, anticlockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Why a surface cannot be made.
#[derive(Debug, Error)]
pub enum SurfaceError {
    /// A plane body has no surface of triangles.
    #[error(
        "the particles lie in a plane: surfaces are meshes in three dimensions; `meshless picture --smooth` draws plane bodies as areas"
    )]
    Plane,
    /// The reconstruction failed.
    #[error("the surface cannot be reconstructed: {0}")]
    Reconstruction(String),
}

/// The surface of particles of that radius \[m\]; `colors` has one for each, or one for all. Nothing for no
/// particles.
///
/// # Errors
///
/// Particles in a plane; extents that no grid can hold.
pub fn surface_of(
    positions: &[[f32; 3]],
    radius: f32,
    colors: &[[u8; 3]],
) -> Result<SurfaceMesh, SurfaceError> {
    let finite = |place: &&[f32; 3]| place.iter().all(|x| x.is_finite());
    let places: Vec<_> = positions.iter().filter(finite).map(|&place| Vector3::from(place)).collect();
    if places.is_empty() {
        return Ok(SurfaceMesh::default());
    }
    if places.iter().all(|place| place.z == 0.0) {
        return Err(SurfaceError::Plane);
    }
    let mut parameters = Parameters::new(radius, REACH * radius, CUBE * radius);
    // The same bytes on any number of threads.
    parameters.enable_multi_threading = false;
    parameters.spatial_decomposition = SpatialDecomposition::None;
    let surface = reconstruct_surface::<i64, f32>(&places, &parameters)
        .map_err(|error| SurfaceError::Reconstruction(error.to_string()))?;
    let densities = surface.particle_densities.unwrap_or_default();
    let mut mesh = surface.mesh;
    let links = mesh.vertex_vertex_connectivity();
    let weights = vec![1.0; mesh.vertices.len()];
    par_laplacian_smoothing_inplace(&mut mesh, &links, SMOOTHING, 1.0, &weights);
    let of_particle = |k: usize| colors.get(k).or(colors.first()).copied().unwrap_or_default();
    let shades: Vec<Vector3<f32>> = positions
        .iter()
        .enumerate()
        .filter(|(_, place)| finite(place))
        .map(|(k, _)| Vector3::from(of_particle(k).map(f32::from)))
        .collect();
    let mass = parameters.rest_density * (2.0 * radius).powi(3);
    let field = SphInterpolator::new(&places, &densities, mass, REACH * radius);
    let means = field.interpolate_vector_quantity(&shades, &mesh.vertices, true);
    let normals = mesh.vertex_normals();
    Ok(SurfaceMesh {
        positions: mesh.vertices.iter().map(|place| [place.x, place.y, place.z]).collect(),
        normals: normals.iter().map(|normal| [normal.x, normal.y, normal.z]).collect(),
        colors: means.iter().map(|mean| [mean.x, mean.y, mean.z].map(|value| value.round() as u8)).collect(),
        triangles: mesh.triangles.iter().map(|corners| corners.map(|k| k as u32)).collect(),
    })
}

impl SurfaceMesh {
    /// Writes the mesh as a Wavefront file, with colours after the coordinates as most programs read them.
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write_obj(&self, out: &mut dyn Write) -> io::Result<()> {
        for ([x, y, z], color) in self.positions.iter().zip(&self.colors) {
            let [r, g, b] = color.map(|value| f32::from(value) / 255.0);
            writeln!(out, "v {x} {y} {z} {r:.4} {g:.4} {b:.4}")?;
        }
        for [x, y, z] in &self.normals {
            writeln!(out, "vn {x:.5} {y:.5} {z:.5}")?;
        }
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|k| k + 1);
            writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}")?;
        }
        Ok(())
    }

    /// Writes the mesh as a ParaView file of polygons (VTK file formats, XML, `PolyData`).
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write_vtp(&self, out: &mut dyn Write) -> io::Result<()> {
        let (points, faces) = (self.positions.len(), self.triangles.len());
        writeln!(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>")?;
        writeln!(out, "<Piece NumberOfPoints=\"{points}\" NumberOfPolys=\"{faces}\">")?;
        writeln!(out, "<Points>")?;
        array(out, "Float32", "Points", self.positions.iter())?;
        writeln!(out, "</Points>\n<PointData Normals=\"normals\" Scalars=\"color\">")?;
        array(out, "Float32", "normals", self.normals.iter())?;
        array(out, "UInt8", "color", self.colors.iter())?;
        writeln!(out, "</PointData>\n<Polys>")?;
        array(out, "Int64", "connectivity", self.triangles.iter())?;
        writeln!(out, "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">")?;
        for face in 1..=faces {
            writeln!(out, "{}", 3 * face)?;
        }
        writeln!(out, "</DataArray>\n</Polys>\n</Piece>\n</PolyData>\n</VTKFile>")
    }
}

/// An array of three numbers for each point or triangle.
fn array<'a, T: Display + 'a>(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    rows: impl Iterator<Item = &'a [T; 3]>,
) -> io::Result<()> {
    let components = if name == "connectivity" { "" } else { " NumberOfComponents=\"3\"" };
    writeln!(out, "<DataArray type=\"{kind}\" Name=\"{name}\"{components} format=\"ascii\">")?;
    for [x, y, z] in rows {
        writeln!(out, "{x} {y} {z}")?;
    }
    writeln!(out, "</DataArray>")
}
