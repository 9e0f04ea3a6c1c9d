//! `meshless surface`: the surface of a body in a recording as a mesh file.

use std::path::PathBuf;

use clap::Args;

use super::failure::CommandFailure;
use super::values::time;

/// Write the surface of a body in a recording as a mesh, .obj or .vtp (three dimensions; needs a build with
/// `--features surfaces`)
#[derive(Args)]
pub struct SurfaceArguments {
    /// Recording (.rrd), or an output folder whose newest recording is meant
    #[arg(value_name = "RECORDING")]
    path: PathBuf,
    /// Body whose surface is meant
    #[arg(long, value_name = "NAME")]
    body: String,
    /// File to write; its extension, .obj or .vtp, selects the format
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Take the last frame up to this time [s] [default: the last frame]
    #[arg(long, value_name = "TIME", value_parser = time, allow_negative_numbers = true)]
    at: Option<f64>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Writes the mesh.
#[cfg(feature = "surfaces")]
pub fn execute(arguments: &SurfaceArguments) -> Result<(), CommandFailure> {
    use super::folder;
    use super::text::{quoted, say};
    use meshless_engine::notation::quantity;
    use meshless_engine::record::{Existing, write_atomically};
    use rerun_recorder::{SurfaceMesh, read_frame, surface_of};

    let failed = |error: &dyn std::error::Error| CommandFailure::Run(error.to_string());
    let extension = arguments.out.extension().and_then(|extension| extension.to_str());
    let write = match extension {
        Some("obj") => SurfaceMesh::write_obj,
        Some("vtp") => SurfaceMesh::write_vtp,
        _ => return Err(CommandFailure::Usage("the file to write must end in .obj or .vtp".to_owned())),
    };
    let frame =
        read_frame(&folder::recording(&arguments.path)?, arguments.at).map_err(|error| failed(&error))?;
    let Some(body) = frame.bodies.iter().find(|body| body.name == arguments.body) else {
        let known: Vec<_> = frame.bodies.iter().map(|body| format!("`{}`", body.name)).collect();
        let message = format!("the recording has no body `{}`; it has {}", arguments.body, known.join(", "));
        return Err(CommandFailure::Usage(message));
    };
    let mesh = surface_of(&body.positions, body.radius, &body.colors).map_err(|error| failed(&error))?;
    let existing = if arguments.force { Existing::Replace } else { Existing::Refuse };
    write_atomically(&arguments.out, existing, |out| write(&mesh, out))?;
    say(&format!(
        "{}: {} triangles, the frame at {}",
        quoted(&arguments.out.to_string_lossy()),
        mesh.triangles.len(),
        quantity(frame.time, "s")
    ));
    Ok(())
}

/// A build without surfaces cannot reconstruct any.
#[cfg(not(feature = "surfaces"))]
pub fn execute(arguments: &SurfaceArguments) -> Result<(), CommandFailure> {
    let SurfaceArguments { path, .. } = arguments;
    Err(CommandFailure::Run(format!(
        "this program was built without surfaces: `cargo run --release --features surfaces -- surface {}`",
        path.display()
    )))
}
