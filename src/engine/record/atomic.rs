//! Files that appear whole or not at all.
//!
//! The content goes to a temporary file in the same folder (a rename is atomic within one file system only),
//! is forced to the disk, and then takes its name. A run killed at any moment leaves the earlier file or the
//! new one, and at worst a stray `.<name>.*.tmp` beside it.

use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::ranks;

/// What happens to a file that is there already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// It stays and the write fails with [`WriteError::Exists`].
    Refuse,
    /// It is replaced once the new content is complete.
    Replace,
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file exists and may not be replaced.
    #[error("`{}` already exists; remove it, or choose another place", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The folder that should hold the file does not exist.
    #[error(
        "cannot write `{}`: there is no folder `{}`; create it or choose another place",
        path.display(), folder.display()
    )]
    FolderMissing {
        /// The file.
        path: PathBuf,
        /// The folder that is missing.
        folder: PathBuf,
    },
    /// What should be the file or its folder is something else.
    #[error("cannot write `{}`: `{}` is {found}, expected {expected}", path.display(), obstacle.display())]
    WrongKind {
        /// The file.
        path: PathBuf,
        /// The path in the way.
        obstacle: PathBuf,
        /// The kind found.
        found: &'static str,
        /// The kind expected.
        expected: &'static str,
    },
    /// The user may not write there.
    #[error(
        "cannot write `{}`: permission denied; make its folder writable or choose another place",
        path.display()
    )]
    Permission {
        /// The file.
        path: PathBuf,
    },
    /// The disk or the quota is used up.
    #[error("cannot write `{}`: no space left; free some or choose another disk", path.display())]
    DiskFull {
        /// The file.
        path: PathBuf,
    },
    /// Any other failure of the operating system.
    #[error("cannot write `{}`: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
}

impl WriteError {
    /// The error for `source`, met while writing `path`.
    pub fn new(path: &Path, source: io::Error) -> Self {
        let folder = folder_of(path);
        let path = path.to_path_buf();
        match source.kind() {
            ErrorKind::AlreadyExists => Self::Exists { path },
            ErrorKind::NotFound if !folder.exists() => {
                Self::FolderMissing { path, folder: folder.to_path_buf() }
            }
            ErrorKind::NotADirectory => Self::WrongKind {
                path,
                obstacle: folder.to_path_buf(),
                found: "not a folder",
                expected: "a folder",
            },
            ErrorKind::IsADirectory => {
                Self::WrongKind { obstacle: path.clone(), path, found: "a folder", expected: "a file" }
            }
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => Self::Permission { path },
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Self::DiskFull { path },
            _ => Self::Io { path, source },
        }
    }
}

/// Writes what `content` produces to `path`, whole or not at all.
///
/// Of several ranks the first one alone writes. The writer handed to `content` is buffered. On any error the
/// file that was at `path` is untouched and the temporary file is gone.
pub fn write_atomically(
    path: &Path,
    existing: Existing,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    if !ranks::is_first() {
        return Ok(());
    }
    // Asked before the work as well as at the rename, which alone is free of races.
    if existing == Existing::Refuse && path.exists() {
        return Err(WriteError::Exists { path: path.to_path_buf() });
    }
    write_to_temporary(path, existing, content).map_err(|source| WriteError::new(path, source))?;
    sync_folder(folder_of(path)).map_err(|source| WriteError::new(path, source))
}

fn write_to_temporary(
    path: &Path,
    existing: Existing,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    if path.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let name = path.file_name().ok_or(ErrorKind::InvalidInput)?;
    let prefix = format!(".{}.", name.to_string_lossy());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".tmp");
    // Temporary files are private by default; results get the permissions of any new file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut temporary = builder.tempfile_in(folder_of(path)).map_err(bare)?;

    let mut buffered = BufWriter::with_capacity(1 << 18, temporary.as_file_mut());
    content(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    temporary.as_file().sync_all()?;

    match existing {
        Existing::Refuse => temporary.persist_noclobber(path),
        Existing::Replace => temporary.persist(path),
    }
    .map_err(|error| error.error)?;
    Ok(())
}

/// The folder that holds `path`; the current one for a bare file name.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The operating system's error without the temporary file's name, which means nothing to the user.
fn bare(error: io::Error) -> io::Error {
    match error.get_ref().and_then(|inner| inner.source()).and_then(|s| s.downcast_ref::<io::Error>()) {
        Some(inner) => inner.raw_os_error().map_or(inner.kind().into(), io::Error::from_raw_os_error),
        None => error,
    }
}

/// Makes the rename itself survive a power failure, where folders can be synchronised.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names_in(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn content_arrives_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        for text in ["first", "second"] {
            write_atomically(&path, Existing::Replace, |w| w.write_all(text.as_bytes())).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(names_in(folder.path()), ["a.bin"]);
    }

    #[test]
    fn a_failed_write_leaves_the_earlier_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        fs::write(&path, "earlier").unwrap();
        let result = write_atomically(&path, Existing::Replace, |w| {
            w.write_all(&vec![7; 1 << 20])?;
            Err(ErrorKind::StorageFull.into())
        });
        assert!(matches!(result, Err(WriteError::DiskFull { .. })), "{result:?}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "earlier");
        assert_eq!(names_in(folder.path()), ["a.bin"]);
    }

    #[test]
    fn a_panic_while_writing_leaves_the_earlier_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        fs::write(&path, "earlier").unwrap();
        let outcome = std::panic::catch_unwind(|| {
            let _ = write_atomically(&path, Existing::Replace, |_| panic!("interrupted"));
        });
        assert!(outcome.is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "earlier");
        assert_eq!(names_in(folder.path()), ["a.bin"]);
    }

    #[test]
    fn an_existing_file_is_refused_before_any_work() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        fs::write(&path, "mine").unwrap();
        let result = write_atomically(&path, Existing::Refuse, |_| panic!("must not be called"));
        assert!(matches!(result, Err(WriteError::Exists { .. })));

        // A file that turns up while the content is being written is kept, too.
        let late = folder.path().join("b.bin");
        let result = write_atomically(&late, Existing::Refuse, |_| fs::write(&late, "theirs"));
        assert!(matches!(result, Err(WriteError::Exists { .. })), "{result:?}");
        assert_eq!(fs::read_to_string(&late).unwrap(), "theirs");
    }

    #[test]
    fn errors_name_the_path_and_the_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let inside = |name: &str| folder.path().join(name);
        fs::write(inside("file"), "").unwrap();
        fs::create_dir(inside("dir")).unwrap();
        let message =
            |path: &Path| write_atomically(path, Existing::Replace, |_| Ok(())).unwrap_err().to_string();

        let text = message(&inside("none/a.bin"));
        assert!(text.contains("none/a.bin") && text.contains("there is no folder"), "{text}");
        let text = message(&inside("file/a.bin"));
        assert!(text.contains("file` is not a folder, expected a folder"), "{text}");
        let text = message(&inside("dir"));
        assert!(text.contains("dir` is a folder, expected a file"), "{text}");
        let text = WriteError::new(Path::new("a.bin"), ErrorKind::PermissionDenied.into()).to_string();
        assert!(text.contains("a.bin") && text.contains("make its folder writable"), "{text}");
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (plain, atomic) = (folder.path().join("plain"), folder.path().join("atomic"));
        fs::write(&plain, "").unwrap();
        write_atomically(&atomic, Existing::Replace, |_| Ok(())).unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&atomic), mode(&plain));
    }
}
