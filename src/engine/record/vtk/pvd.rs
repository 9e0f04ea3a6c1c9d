//! The list of frames that ParaView opens as one animation.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{PointArray, VtkError, escaped, write_vtu};
use crate::record::atomic::{Existing, write_atomically};

/// One file of the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PvdFrame {
    /// Time t \[s\].
    pub time: f64,
    /// The body, or whatever else was written at this time under its own name.
    pub part: String,
    /// The `.vtu` file, in the folder of the list.
    pub file: String,
}

/// Writes frames beside a `.pvd` and keeps that list complete: after every frame the file is a valid one.
#[derive(Debug)]
pub struct PvdWriter {
    path: PathBuf,
    stem: String,
    existing: Existing,
    frames: Vec<PvdFrame>,
}

impl PvdWriter {
    /// Begins the list `path`, with no frame yet.
    pub fn create(path: &Path, existing: Existing) -> Result<Self, VtkError> {
        let writer = Self::with_frames(path, existing, Vec::new());
        writer.write_list(existing)?;
        Ok(writer)
    }

    /// Continues the list `path` of an interrupted run from `frames`, as [`Self::frames`] gave them at the
    /// checkpoint; files of later frames are replaced when their turn comes.
    pub fn resume(path: &Path, frames: Vec<PvdFrame>) -> Result<Self, VtkError> {
        let writer = Self::with_frames(path, Existing::Replace, frames);
        writer.write_list(Existing::Replace)?;
        Ok(writer)
    }

    fn with_frames(path: &Path, existing: Existing, frames: Vec<PvdFrame>) -> Self {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Self { path: path.to_path_buf(), stem, existing, frames }
    }

    /// Writes the points \[m\] and arrays of `part` at the time `time` \[s\] as a new frame, and lists it.
    pub fn write(
        &mut self,
        time: f64,
        part: &str,
        points: &[[f64; 3]],
        arrays: &[PointArray],
    ) -> Result<(), VtkError> {
        let earlier = self.frames.iter().filter(|frame| frame.part == part).count();
        let file = format!("{}_{earlier:06}.vtu", self.series(part));
        write_vtu(&self.path.with_file_name(&file), time, points, arrays, self.existing)?;
        self.frames.push(PvdFrame { time, part: part.to_owned(), file });
        self.write_list(Existing::Replace)
    }

    /// The files of a part up to the number of the frame, which stands last: so ParaView groups them as a
    /// series without the list.
    fn series(&self, part: &str) -> String {
        let plain = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
        let name: String = part.chars().map(plain).collect();
        let series = |frame: &PvdFrame| frame.file.rsplit_once('_').map(|(series, _)| series.to_owned());
        if let Some(known) = self.frames.iter().find(|frame| frame.part == part).and_then(series) {
            return known;
        }
        let is_taken = |name: &String| self.frames.iter().filter_map(series).any(|other| other == *name);
        let numbered = (2..).map(|k| format!("{}_{name}-{k}", self.stem));
        std::iter::once(format!("{}_{name}", self.stem))
            .chain(numbered)
            .find(|name| !is_taken(name))
            .unwrap_or_default()
    }

    /// All frames so far, to be kept in a checkpoint.
    pub fn frames(&self) -> &[PvdFrame] {
        &self.frames
    }

    fn write_list(&self, existing: Existing) -> Result<(), VtkError> {
        let mut parts: Vec<&str> = Vec::new();
        write_atomically(&self.path, existing, |w| {
            writeln!(w, r#"<?xml version="1.0"?>"#)?;
            writeln!(w, r#"<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">"#)?;
            writeln!(w, "<Collection>")?;
            for PvdFrame { time, part, file } in &self.frames {
                let index = parts.iter().position(|known| known == part).unwrap_or_else(|| {
                    parts.push(part);
                    parts.len() - 1
                });
                let (part, file) = (escaped(part), escaped(file));
                writeln!(w, r#"<DataSet timestep="{time:?}" part="{index}" name="{part}" file="{file}"/>"#)?;
            }
            writeln!(w, "</Collection>\n</VTKFile>")
        })?;
        Ok(())
    }
}
