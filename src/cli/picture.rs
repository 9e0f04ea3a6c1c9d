//! `meshless picture`: a frame of a recording as a PNG file, without a viewer and without a screen.

use std::path::PathBuf;

use clap::Args;

use super::failure::CommandFailure;
use super::values::time;

/// Draw a frame of a recording as a PNG file, without a viewer and without a screen
#[derive(Args)]
pub struct PictureArguments {
    /// Recording (.rrd), or an output folder whose newest recording is meant
    #[arg(value_name = "RECORDING")]
    path: PathBuf,
    /// Draw the last frame up to this time [s] [default: the last frame]
    #[arg(long, value_name = "TIME", value_parser = time, allow_negative_numbers = true)]
    at: Option<f64>,
    /// File to write [default: beside the recording, <recording>-<time>.png]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Width and height [pixels]
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x960", value_parser = size)]
    size: (usize, usize),
    /// Draw bodies as closed surfaces in place of particles
    #[arg(long)]
    smooth: bool,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Range of the number of pixels of a side.
const SIDES: std::ops::RangeInclusive<usize> = 64..=8192;

fn size(text: &str) -> Result<(usize, usize), String> {
    let sides =
        text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    sides.filter(|(width, height)| SIDES.contains(width) && SIDES.contains(height)).ok_or_else(|| {
        format!("give two numbers of pixels between {} and {}, such as 1280x960", SIDES.start(), SIDES.end())
    })
}

/// Draws the picture.
#[cfg(feature = "rerun")]
pub fn execute(arguments: &PictureArguments) -> Result<(), CommandFailure> {
    use super::folder;
    use super::text::{complain, quoted, say};
    use meshless_engine::notation::quantity;
    use meshless_engine::record::{Existing, write_atomically};

    let recording = folder::recording(&arguments.path)?;
    let frame = rerun_recorder::read_frame(&recording, arguments.at)
        .map_err(|error| CommandFailure::Run(error.to_string()))?;
    if let Some(end) = &frame.cut_off {
        complain(&format!("warning: the recording has no end, as that of a run that was killed: {end}"));
    }
    let (width, height) = arguments.size;
    let look = rerun_recorder::DrawStyle { width, height, smooth: arguments.smooth };
    let picture =
        rerun_recorder::draw(&frame, look).map_err(|error| CommandFailure::Run(error.to_string()))?;
    let file = arguments.out.clone().unwrap_or_else(|| {
        let stem = recording.file_stem().unwrap_or_default().to_string_lossy();
        let time = quantity(frame.time, "s").replace(' ', "").replace('µ', "u");
        recording.with_file_name(format!("{stem}-{time}.png"))
    });
    let existing = if arguments.force { Existing::Replace } else { Existing::Refuse };
    write_atomically(&file, existing, |out| out.write_all(&picture))?;
    say(&format!("{}: the frame at {}", quoted(&file.to_string_lossy()), quantity(frame.time, "s")));
    Ok(())
}

/// A build without rerun cannot read recordings.
#[cfg(not(feature = "rerun"))]
pub fn execute(arguments: &PictureArguments) -> Result<(), CommandFailure> {
    let PictureArguments { path, .. } = arguments;
    Err(CommandFailure::Run(format!(
        "this program was built without rerun and cannot read `{}`; build it with its default features",
        path.display()
    )))
}
