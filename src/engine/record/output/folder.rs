//! The folder of a run: the names of its files, and the files already there.

use std::fs;
use std::path::PathBuf;

use super::options::OutputOptions;
use crate::ranks;
use crate::record::Existing;
use crate::scene::Problem;

/// File of the last checkpoint.
pub const CHECKPOINT: &str = "checkpoint.mlc";
/// File of the energy ledger.
pub const ENERGY: &str = "energy.csv";
/// File of the summary.
pub const SUMMARY: &str = "summary.json";

/// The folder of a run.
#[derive(Clone, Debug)]
pub struct OutputFolder {
    /// The folder.
    pub path: PathBuf,
    /// What happens to files that are there.
    pub existing: Existing,
    /// The run goes on from a checkpoint.
    pub resume: bool,
    /// Name of the scene, from which some files take their names.
    scene_name: String,
    vtk: bool,
}

impl OutputFolder {
    /// The folder that the options name.
    pub fn new(options: &OutputOptions, scene_name: &str, vtk: bool) -> Self {
        Self {
            path: options.folder.clone(),
            existing: options.existing,
            resume: options.resume,
            scene_name: scene_name.to_owned(),
            vtk,
        }
    }

    /// A file of the folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The list of ParaView frames.
    pub fn pvd(&self) -> PathBuf {
        self.file(&format!("{}.pvd", self.scene_name))
    }

    /// Makes the folder, and makes sure that the run can write there and overwrites nothing that it must not;
    /// `names` are the files it will write beside those it always writes.
    ///
    /// # Errors
    /// A file is there, or nothing can be written.
    pub fn prepare(&self, names: &[String]) -> Result<(), Box<Problem>> {
        if !ranks::is_first() {
            return Ok(());
        }
        if self.existing == Existing::Refuse && !self.resume {
            let fixed = [ENERGY, SUMMARY, CHECKPOINT].map(str::to_owned);
            let found = fixed.iter().chain(names).map(|name| self.file(name)).find(|file| file.exists());
            if let Some(file) = found.or_else(|| self.frames_there().into_iter().next()) {
                let problem = Problem::new(format!("`{}` already exists", file.display()));
                return Err(Box::new(
                    problem.help(
                        "choose another folder, or replace the files of the earlier run with `--force`",
                    ),
                ));
            }
        }
        let failed = |what: &str, error: std::io::Error| {
            let problem = Problem::new(format!("{what} `{}`: {error}", self.path.display()));
            Box::new(problem.help("choose a folder in which you may write"))
        };
        if let Some(file) = self.path.ancestors().find(|path| path.is_file()) {
            let message = format!(
                "cannot make the output folder `{}`: `{}` is a file",
                self.path.display(),
                file.display()
            );
            return Err(Box::new(Problem::new(message).help("choose a folder in which you may write")));
        }
        fs::create_dir_all(&self.path).map_err(|error| failed("cannot make the output folder", error))?;
        // A temporary file that is gone at once: the only sure way to know.
        tempfile::tempfile_in(&self.path)
            .map_err(|error| failed("cannot write in the output folder", error))?;
        Ok(())
    }

    /// Removes what an earlier run has left and this run may not write at once: an old checkpoint or summary
    /// beside new results would be taken for theirs.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn clear(&self) -> std::io::Result<()> {
        if !ranks::is_first() {
            return Ok(());
        }
        self.clear_temporaries()?;
        let mut old = self.all_frames();
        old.extend([CHECKPOINT, SUMMARY].map(|name| self.file(name)));
        old.iter().filter(|file| file.exists()).try_for_each(fs::remove_file)
    }

    /// Removes the halves of checkpoints that runs have left which were killed while they wrote.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn clear_temporaries(&self) -> std::io::Result<()> {
        if !ranks::is_first() {
            return Ok(());
        }
        let prefix = format!(".{CHECKPOINT}.");
        let ours = |name: &str| name.starts_with(&prefix) && name.ends_with(".tmp");
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let mut halves = entries.filter(|entry| entry.file_name().to_str().is_some_and(ours));
        halves.try_for_each(|entry| fs::remove_file(entry.path()))
    }

    /// ParaView files that this run would write over.
    fn frames_there(&self) -> Vec<PathBuf> {
        if self.vtk { self.all_frames() } else { Vec::new() }
    }

    /// ParaView files of this scene that are there.
    fn all_frames(&self) -> Vec<PathBuf> {
        let prefix = format!("{}_", self.scene_name);
        let ours = |name: &str| {
            let series = name.strip_prefix(&prefix).and_then(|rest| rest.strip_suffix(".vtu"));
            let frame = series.and_then(|series| series.rsplit_once('_')).map(|(_, frame)| frame);
            frame.is_some_and(|frame| frame.len() == 6 && frame.bytes().all(|digit| digit.is_ascii_digit()))
        };
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> =
            entries.filter(|e| e.file_name().to_str().is_some_and(ours)).map(|e| e.path()).collect();
        files.extend([self.pvd()].into_iter().filter(|file| file.exists()));
        files.sort();
        files
    }
}
