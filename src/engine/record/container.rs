//! The container of a checkpoint: named sections of raw columns, compressed and checked.
//!
//! All numbers are little endian. A file is
//!
//! | bytes  | content |
//! |--------|---------|
//! | 8      | magic `89 4d 53 48 4c 0d 0a 1a`: not text, and damaged by any transfer that takes it for text |
//! | 4      | format version |
//! | 4      | length of the header |
//! | 8      | XXH3 of the header |
//! | header | postcard: program version, then for each section name, type name, element size, count, chunks, checksum |
//! | rest   | the chunks of all sections in order, LZ4 blocks of 4 MiB of raw data each, the last one shorter |
//!
//! Chunks are compressed independently and in parallel; their bounds depend on the data alone, so the bytes
//! are the same for any number of threads. Checksums are of the stored bytes: no damaged byte reaches the
//! decompressor, and every size is held against the length of the file before anything is allocated for it.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use bytemuck::{NoUninit, Pod};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use super::atomic::{Existing, write_atomically};

mod error;
#[cfg(test)]
mod tests;

pub use error::ContainerError;

/// The version of the layout above. It rises when older programs could no longer read the files.
pub const FORMAT_VERSION: u32 = 1;

const MAGIC: [u8; 8] = *b"\x89MSHL\r\n\x1a";
const PREFIX: usize = 24;
const CHUNK: usize = 4 << 20;
/// An LZ4 block grows by at most this factor, by construction of its length bytes.
const MAX_EXPANSION: u64 = 255;

// Sections are the memory of columns as it is.
const _: () = assert!(cfg!(target_endian = "little"), "checkpoints are little endian");

#[derive(Debug, Serialize, Deserialize)]
struct Header {
    program_version: String,
    sections: Vec<SectionInfo>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct SectionInfo {
    name: String,
    type_name: String,
    element_size: u64,
    count: u64,
    /// Stored length of each chunk.
    chunks: Vec<u32>,
    /// XXH3 of the stored bytes of all chunks.
    checksum: u64,
}

impl SectionInfo {
    fn stored_len(&self) -> u64 {
        self.chunks.iter().map(|&len| u64::from(len)).sum()
    }

    /// The raw length, if it is one that the chunks can hold.
    fn raw_len(&self) -> Option<usize> {
        let raw = self.element_size.checked_mul(self.count)?;
        let fits = raw.div_ceil(CHUNK as u64) == self.chunks.len() as u64
            && raw / MAX_EXPANSION <= self.stored_len()
            && self.element_size > 0;
        if fits { usize::try_from(raw).ok() } else { None }
    }
}

/// Collects sections and writes them as one container.
#[derive(Default)]
pub struct ContainerWriter<'a> {
    sections: Vec<(SectionInfo, &'a [u8])>,
}

impl<'a> ContainerWriter<'a> {
    /// A container without sections.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the section `name`: elements of `element_size` bytes of the type `type_name`, which is free text
    /// that a reader compares. An error if there is a section of that name, or if the bytes are no whole
    /// number of elements.
    pub fn section(
        &mut self,
        name: &str,
        type_name: &str,
        element_size: usize,
        bytes: &'a [u8],
    ) -> Result<&mut Self, ContainerError> {
        if self.sections.iter().any(|(info, _)| info.name == name) {
            return Err(ContainerError::Duplicate { name: name.to_owned() });
        }
        if element_size == 0 || !bytes.len().is_multiple_of(element_size) {
            return Err(ContainerError::Uneven { name: name.to_owned(), bytes: bytes.len(), element_size });
        }
        let info = SectionInfo {
            name: name.to_owned(),
            type_name: type_name.to_owned(),
            element_size: element_size as u64,
            count: (bytes.len() / element_size) as u64,
            chunks: Vec::new(),
            checksum: 0,
        };
        self.sections.push((info, bytes));
        Ok(self)
    }

    /// Adds `values` as the section `name`. Errors as [`Self::section`].
    pub fn section_of<T: NoUninit>(
        &mut self,
        name: &str,
        type_name: &str,
        values: &'a [T],
    ) -> Result<&mut Self, ContainerError> {
        self.section(name, type_name, size_of::<T>(), bytemuck::cast_slice(values))
    }

    /// Compresses the sections and writes the file, whole or not at all. An error if it cannot be written.
    pub fn write(&self, path: &Path, existing: Existing) -> Result<(), ContainerError> {
        let compressed: Vec<Vec<Vec<u8>>> = self
            .sections
            .par_iter()
            .map(|(_, bytes)| bytes.par_chunks(CHUNK).map(lz4_flex::block::compress).collect())
            .collect();
        let sections = self
            .sections
            .iter()
            .zip(&compressed)
            .map(|((info, _), chunks)| {
                let mut digest = Xxh3::new();
                chunks.iter().for_each(|chunk| digest.update(chunk));
                let chunks = chunks.iter().map(|chunk| chunk.len() as u32).collect();
                SectionInfo { chunks, checksum: digest.digest(), ..info.clone() }
            })
            .collect();
        let header = Header { program_version: env!("CARGO_PKG_VERSION").to_owned(), sections };

        write_atomically(path, existing, |w| {
            let header = postcard::to_stdvec(&header).map_err(io::Error::other)?;
            let header_len = u32::try_from(header.len()).map_err(io::Error::other)?;
            w.write_all(&MAGIC)?;
            w.write_all(&FORMAT_VERSION.to_le_bytes())?;
            w.write_all(&header_len.to_le_bytes())?;
            w.write_all(&xxh3_64(&header).to_le_bytes())?;
            w.write_all(&header)?;
            compressed.iter().flatten().try_for_each(|chunk| w.write_all(chunk))
        })?;
        Ok(())
    }
}

/// One section that has been read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Section {
    /// Its name, unique in the container.
    pub name: String,
    /// The type of its elements, as the writer called it.
    pub type_name: String,
    /// Bytes of one element, at least 1.
    pub element_size: usize,
    /// The elements, one after the other.
    pub bytes: Vec<u8>,
}

impl Section {
    /// Number of elements.
    pub fn count(&self) -> usize {
        self.bytes.len() / self.element_size
    }

    /// The elements as values. An error unless they are of the type `type_name` and of the size of `T`.
    pub fn values<T: Pod>(&self, type_name: &str) -> Result<Vec<T>, ContainerError> {
        if self.type_name != type_name || self.element_size != size_of::<T>() {
            return Err(ContainerError::WrongType {
                name: self.name.clone(),
                found: format!("`{}` of {} bytes", self.type_name, self.element_size),
                expected: format!("`{type_name}` of {} bytes", size_of::<T>()),
            });
        }
        // A copy, because the bytes are not aligned for `T`.
        let mut values = vec![T::zeroed(); self.count()];
        bytemuck::cast_slice_mut(&mut values).copy_from_slice(&self.bytes);
        Ok(values)
    }
}

/// A container that has been read and found sound.
#[derive(Debug)]
pub struct Container {
    program_version: String,
    sections: Vec<Section>,
}

impl Container {
    /// Reads and checks the whole file.
    pub fn read(path: &Path) -> Result<Self, ContainerError> {
        let failed = |source| ContainerError::Read { path: path.to_path_buf(), source };
        let file = File::open(path).map_err(failed)?;
        // The mark is read first, so that a large file of another kind is not loaded.
        let mut bytes = Vec::new();
        (&file).take(PREFIX as u64).read_to_end(&mut bytes).map_err(failed)?;
        check_prefix(path, &bytes)?;
        (&file).read_to_end(&mut bytes).map_err(failed)?;
        Self::parse(path, &bytes)
    }

    fn parse(path: &Path, bytes: &[u8]) -> Result<Self, ContainerError> {
        let damaged = |what: String| ContainerError::Damaged { path: path.to_path_buf(), what };
        let cut_off = |expected| ContainerError::Truncated {
            path: path.to_path_buf(),
            found: bytes.len() as u64,
            expected,
        };
        let (header_len, checksum) = check_prefix(path, bytes)?;
        let body = &bytes[PREFIX..];
        let (header, mut stored) =
            body.split_at_checked(header_len).ok_or_else(|| cut_off(PREFIX as u64 + header_len as u64))?;
        if xxh3_64(header) != checksum {
            return Err(damaged("the checksum of its header does not match".to_owned()));
        }
        let header: Header = postcard::from_bytes(header)
            .map_err(|error| damaged(format!("its header cannot be decoded ({error})")))?;

        let stored_len: u64 = header.sections.iter().map(SectionInfo::stored_len).sum();
        if (stored.len() as u64) < stored_len {
            return Err(cut_off((PREFIX + header_len) as u64 + stored_len));
        } else if stored.len() as u64 > stored_len {
            return Err(damaged(format!("{} bytes follow its end", stored.len() as u64 - stored_len)));
        }
        let mut parts = Vec::with_capacity(header.sections.len());
        for info in &header.sections {
            let len = info
                .raw_len()
                .ok_or_else(|| damaged(format!("section `{}` has sizes that do not fit", info.name)))?;
            let (own, rest) = stored.split_at(info.stored_len() as usize);
            stored = rest;
            parts.push((info, len, own));
        }
        let sections: Vec<_> = parts.par_iter().map(|&(info, len, own)| decompress(info, len, own)).collect();
        let sections = sections.into_iter().collect::<Result<Vec<_>, _>>().map_err(damaged)?;
        Ok(Self { program_version: header.program_version, sections })
    }

    /// The version of the program that wrote the file.
    pub fn program_version(&self) -> &str {
        &self.program_version
    }

    /// All sections, in the order in which they were written.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// The section `name`, if there is one.
    pub fn section(&self, name: &str) -> Option<&Section> {
        self.sections.iter().find(|section| section.name == name)
    }

    /// The values of the section `name`, which must be there and of the type `type_name`.
    pub fn section_as<T: Pod>(&self, name: &str, type_name: &str) -> Result<Vec<T>, ContainerError> {
        let section = self.section(name).ok_or_else(|| ContainerError::NoSection {
            name: name.to_owned(),
            known: self.sections.iter().map(|s| format!("`{}`", s.name)).collect::<Vec<_>>().join(", "),
        })?;
        section.values(type_name)
    }
}

/// The length of the header and its checksum.
fn check_prefix(path: &Path, bytes: &[u8]) -> Result<(usize, u64), ContainerError> {
    let path = || path.to_path_buf();
    let Some(prefix) = bytes.first_chunk::<PREFIX>() else {
        return Err(if !bytes.is_empty() && (MAGIC.starts_with(bytes) || bytes.starts_with(&MAGIC)) {
            ContainerError::Truncated { path: path(), found: bytes.len() as u64, expected: PREFIX as u64 }
        } else {
            ContainerError::NotACheckpoint { path: path() }
        });
    };
    let [m0, m1, m2, m3, m4, m5, m6, m7, v0, v1, v2, v3, l0, l1, l2, l3, checksum @ ..] = *prefix;
    if [m0, m1, m2, m3, m4, m5, m6, m7] != MAGIC {
        return Err(ContainerError::NotACheckpoint { path: path() });
    }
    match u32::from_le_bytes([v0, v1, v2, v3]) {
        FORMAT_VERSION => Ok((u32::from_le_bytes([l0, l1, l2, l3]) as usize, u64::from_le_bytes(checksum))),
        0 => Err(ContainerError::Damaged { path: path(), what: "its format version is 0".to_owned() }),
        found => Err(ContainerError::NewerVersion { path: path(), found }),
    }
}

/// The section whose raw length is `len` from its stored bytes; the error says what is wrong with it.
fn decompress(info: &SectionInfo, len: usize, mut stored: &[u8]) -> Result<Section, String> {
    if xxh3_64(stored) != info.checksum {
        return Err(format!("the checksum of section `{}` does not match", info.name));
    }
    let mut blocks = Vec::with_capacity(info.chunks.len());
    for &chunk in &info.chunks {
        let (block, rest) = stored.split_at(chunk as usize);
        blocks.push(block);
        stored = rest;
    }
    let mut bytes = vec![0; len];
    let sound = bytes
        .par_chunks_mut(CHUNK)
        .zip(&blocks)
        .all(|(raw, block)| lz4_flex::block::decompress_into(block, raw).is_ok_and(|n| n == raw.len()));
    if !sound {
        return Err(format!("section `{}` cannot be decompressed to {len} bytes", info.name));
    }
    let element_size = info.element_size as usize;
    Ok(Section { name: info.name.clone(), type_name: info.type_name.clone(), element_size, bytes })
}
