//! Reading of whole input files, up to a size limit.

use std::fs::File;
use std::io::{Error, Read};
use std::path::Path;

/// Maximum size of a scene, and of an input that is not a regular file, B.
pub(crate) const MAX_TEXT: u64 = 64 << 20;
/// Maximum size of a mesh or particle file, B.
pub(crate) const MAX_GEOMETRY: u64 = 4 << 30;

/// The content of a file of at most `limit` bytes. A device or pipe has no length, so the limit for scenes
/// applies to it.
///
/// # Errors
/// The file cannot be read, or is longer than the limit.
pub(crate) fn read(path: &Path, limit: u64) -> Result<Vec<u8>, Error> {
    let file = File::open(path)?;
    let data = file.metadata()?;
    let limit = if data.is_file() { limit } else { limit.min(MAX_TEXT) };
    let too_long = || Error::other(format!("it is longer than {} MiB", limit >> 20));
    if data.is_file() && data.len() > limit {
        return Err(too_long());
    }
    let mut bytes = Vec::new();
    file.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit { Err(too_long()) } else { Ok(bytes) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_files_and_endless_ones_are_refused() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), [b'x'; 100]).unwrap();
        assert_eq!(read(file.path(), 100).unwrap().len(), 100);
        assert!(read(file.path(), 99).unwrap_err().to_string().contains("longer than"));
        // A sparse file has a length and no content, so it is rejected before it is read.
        file.as_file().set_len(MAX_GEOMETRY + 1).unwrap();
        assert!(read(file.path(), MAX_GEOMETRY).is_err());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_without_end_is_refused() {
        assert!(read(Path::new("/dev/zero"), MAX_GEOMETRY).unwrap_err().to_string().contains("64 MiB"));
    }
}
