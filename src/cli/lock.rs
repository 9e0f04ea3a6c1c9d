//! One run at a time in a folder.

use std::fs::{File, TryLockError};
use std::path::Path;

use meshless_engine::ranks;

use super::failure::CommandFailure;

/// Holds the folder of a run until it is dropped, or until the program ends in whatever way.
pub struct Lock {
    /// None where the system locks no folders: then nobody is kept out.
    _folder: Option<File>,
}

impl Lock {
    /// Takes the folder, which must exist; of several ranks the first one does.
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
