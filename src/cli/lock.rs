//! One run at a time in a folder.

use std::fs::{File, TryLockError};
use std::path::Path;

use meshless_engine::ranks;

use super::failure::CommandFailure;

/// A lock on the folder of a run, held until it is dropped or the program ends.
pub struct Lock {
    /// None if the system cannot lock folders; concurrent runs are then not detected.
    _folder: Option<File>,
}

impl Lock {
    /// Locks the folder, which must exist; of several ranks only the first one locks it.
    pub fn of(folder: &Path) -> Result<Self, CommandFailure> {
        let held = ranks::is_first().then(|| File::open(folder).ok()).flatten();
        let Some(file) = held else { return Ok(Self { _folder: None }) };
        match file.try_lock() {
            Ok(()) => Ok(Self { _folder: Some(file) }),
            Err(TryLockError::WouldBlock) => Err(CommandFailure::Usage(format!(
                "another run is writing to `{}`; wait for its end, or choose another folder with `--out`",
                folder.display()
            ))),
            Err(TryLockError::Error(_)) => Ok(Self { _folder: None }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_is_held_by_one_run() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Lock::of(folder.path()).expect("a free folder");
        let second = Lock::of(folder.path()).err().expect("a folder that is held");
        assert!(second.to_string().contains("another run is writing to"), "{second}");
        drop(first);
        assert!(Lock::of(folder.path()).is_ok());
    }
}
