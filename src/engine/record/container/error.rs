//! Errors of reading a container.

use std::io;
use std::path::PathBuf;

use super::FORMAT_VERSION;
use crate::record::atomic::WriteError;

/// Why a container could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum ContainerError {
    /// The operating system could not read the file.
    #[error("cannot read the checkpoint `{}`: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file is of another kind.
    #[error("`{}` is not a checkpoint of this program: it has no checkpoint signature", path.display())]
    NotACheckpoint {
        /// The file.
        path: PathBuf,
    },
    /// The file was written in a format of the future.
    #[error(
        "the checkpoint `{}` has format version {found}, this program reads up to {FORMAT_VERSION}; \
         use the version of the program that wrote it or a newer one",
        path.display()
    )]
    NewerVersion {
        /// The file.
        path: PathBuf,
        /// The version found.
        found: u32,
    },
    /// The file is cut off.
    #[error(
        "the checkpoint `{}` is cut off: it has {found} of {expected} bytes; copy it again or use an earlier one",
        path.display()
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Bytes found.
        found: u64,
        /// Bytes that its header speaks of, at least.
        expected: u64,
    },
    /// The file is damaged.
    #[error("the checkpoint `{}` is damaged: {what}; copy it again or use an earlier one", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The mismatch.
        what: String,
    },
    /// A section that is needed is not there.
    #[error("the checkpoint has no section `{name}`; it holds {known}")]
    NoSection {
        /// The section asked for.
        name: String,
        /// The sections there are.
        known: String,
    },
    /// A section holds values of another type.
    #[error("section `{name}` of the checkpoint holds {found}, expected {expected}")]
    WrongType {
        /// The section.
        name: String,
        /// Type and size found.
        found: String,
        /// Type and size asked for.
        expected: String,
    },
    /// Two sections of one name.
    #[error("section `{name}` of the checkpoint is given twice; names must differ")]
    Duplicate {
        /// The name.
        name: String,
    },
    /// A section that is no whole number of elements.
    #[error("section `{name}` of the checkpoint has {bytes} bytes, expected a multiple of {element_size}")]
    Uneven {
        /// The section.
        name: String,
        /// Its length.
        bytes: usize,
        /// Bytes of one element.
        element_size: usize,
    },
    /// The container could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}
