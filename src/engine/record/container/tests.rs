use super::*;
use crate::record::atomic::WriteError;
use proptest::prelude::*;
use std::fs;

/// Columns as a run has them: smooth, constant, empty, and one of several chunks.
struct Columns {
    position: Vec<[f64; 3]>,
    body: Vec<u32>,
    scene: String,
    large: Vec<u64>,
}

fn columns() -> Columns {
    Columns {
        position: (0..500).map(|i| [f64::from(i).sin(), -0.0, f64::NAN]).collect(),
        body: vec![3; 500],
        scene: "Scene(title: \"\u{3b1}\")".to_owned(),
        large: (0..1_300_000_u64).map(|i| i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40).collect(),
    }
}

fn writer(columns: &Columns) -> ContainerWriter<'_> {
    let mut writer = ContainerWriter::new();
    writer.section_of("position", "DVec3", &columns.position).unwrap();
    writer.section_of("body", "u32", &columns.body).unwrap();
    writer.section("scene", "text", 1, columns.scene.as_bytes()).unwrap();
    writer.section("none", "f64", 8, &[]).unwrap();
    writer
}

/// The bytes of a small container.
fn small() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.checkpoint");
    writer(&columns()).write(&path, Existing::Refuse).unwrap();
    fs::read(path).unwrap()
}

fn parse(bytes: &[u8]) -> Result<Container, ContainerError> {
    Container::parse(Path::new("a.checkpoint"), bytes)
}

/// A file with this header and these stored bytes, checksums right.
fn forged(sections: Vec<SectionInfo>, stored: &[u8]) -> Vec<u8> {
    let header = postcard::to_stdvec(&Header { program_version: "9".to_owned(), sections }).unwrap();
    let mut bytes = MAGIC.to_vec();
    bytes.extend(FORMAT_VERSION.to_le_bytes());
    bytes.extend((header.len() as u32).to_le_bytes());
    bytes.extend(xxh3_64(&header).to_le_bytes());
    bytes.extend(header);
    bytes.extend(stored);
    bytes
}

fn info(element_size: u64, count: u64, chunks: &[u32], stored: &[u8]) -> SectionInfo {
    SectionInfo {
        name: "x".to_owned(),
        type_name: "f64".to_owned(),
        element_size,
        count,
        chunks: chunks.to_vec(),
        checksum: xxh3_64(stored),
    }
}

#[test]
fn everything_comes_back_bit_by_bit() {
    let columns = columns();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.checkpoint");
    let mut writer = writer(&columns);
    writer.section_of("large", "u64", &columns.large).unwrap();
    writer.write(&path, Existing::Refuse).unwrap();

    let read = Container::read(&path).unwrap();
    let names: Vec<_> = read.sections().iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["position", "body", "scene", "none", "large"]);
    assert_eq!(read.program_version(), env!("CARGO_PKG_VERSION"));
    let position: Vec<[f64; 3]> = read.section_as("position", "DVec3").unwrap();
    let bits = |v: &[[f64; 3]]| v.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&position), bits(&columns.position));
    assert_eq!(read.section_as::<u32>("body", "u32").unwrap(), columns.body);
    assert_eq!(read.section("scene").unwrap().bytes, columns.scene.as_bytes());
    assert_eq!(read.section("none").unwrap().count(), 0);
    assert_eq!(read.section("large").unwrap().count(), columns.large.len());
    assert_eq!(read.section_as::<u64>("large", "u64").unwrap(), columns.large);
    assert!(read.section("velocity").is_none());
}

#[test]
fn the_file_is_the_same_for_any_number_of_threads() {
    let columns = columns();
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<_> = [1, 2, 7]
        .map(|threads| {
            let path = folder.path().join(threads.to_string());
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut writer = writer(&columns);
            writer.section_of("large", "u64", &columns.large).unwrap();
            pool.install(|| writer.write(&path, Existing::Refuse)).unwrap();
            fs::read(path).unwrap()
        })
        .into();
    assert!(files[0] == files[1] && files[1] == files[2]);
}

#[test]
fn an_earlier_checkpoint_survives_a_failed_write() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.checkpoint");
    let columns = columns();
    writer(&columns).write(&path, Existing::Refuse).unwrap();
    let before = fs::read(&path).unwrap();

    let refused = ContainerWriter::new().write(&path, Existing::Refuse);
    assert!(matches!(refused, Err(ContainerError::Write(WriteError::Exists { .. }))));
    let half = before.len() / 2;
    let killed = write_atomically(&path, Existing::Replace, |w| {
        w.write_all(&before[..half])?;
        Err(io::ErrorKind::StorageFull.into())
    });
    assert!(matches!(killed, Err(WriteError::DiskFull { .. })));
    // What a run killed while it wrote leaves beside it.
    fs::write(folder.path().join(".a.checkpoint.x1.tmp"), &before[..half]).unwrap();

    assert_eq!(fs::read(&path).unwrap(), before);
    assert_eq!(Container::read(&path).unwrap().section_as::<u32>("body", "u32").unwrap(), columns.body);
}

#[test]
fn wrong_use_is_an_error() {
    let mut writer = ContainerWriter::new();
    writer.section("x", "f64", 8, &[0; 16]).unwrap();
    assert!(matches!(writer.section("x", "f64", 8, &[]), Err(ContainerError::Duplicate { .. })));
    assert!(matches!(writer.section("y", "f64", 8, &[0; 9]), Err(ContainerError::Uneven { .. })));
    assert!(matches!(writer.section("y", "()", 0, &[]), Err(ContainerError::Uneven { .. })));

    let read = parse(&small()).unwrap();
    let text = read.section_as::<f64>("pressure", "f64").unwrap_err().to_string();
    assert_eq!(
        text,
        "the checkpoint has no section `pressure`; it holds `position`, `body`, `scene`, `none`"
    );
    let text = read.section_as::<f32>("body", "f32").unwrap_err().to_string();
    assert_eq!(text, "section `body` of the checkpoint holds `u32` of 4 bytes, expected `f32` of 4 bytes");
    assert!(matches!(read.section_as::<u64>("body", "u32"), Err(ContainerError::WrongType { .. })));
}

#[test]
fn files_of_other_kinds_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.checkpoint");
    assert!(matches!(Container::read(&path), Err(ContainerError::Read { .. })));
    assert!(matches!(Container::read(folder.path()), Err(ContainerError::Read { .. })));
    for other in ["", "Scene(", "Scene(title: \"a scene is not a checkpoint\")"] {
        fs::write(&path, other).unwrap();
        assert!(matches!(Container::read(&path), Err(ContainerError::NotACheckpoint { .. })), "{other}");
    }
    let mut newer = small();
    newer[8] = 2;
    let text = parse(&newer).unwrap_err().to_string();
    assert!(text.contains("format version 2, this program reads up to 1"), "{text}");
    newer[8] = 0;
    assert!(matches!(parse(&newer), Err(ContainerError::Damaged { .. })));
}

#[test]
fn every_cut_and_every_tail_is_an_error() {
    let bytes = small();
    for len in 1..bytes.len() {
        assert!(matches!(parse(&bytes[..len]), Err(ContainerError::Truncated { .. })), "cut to {len}");
    }
    let longer = [bytes.as_slice(), &[0]].concat();
    assert!(parse(&longer).unwrap_err().to_string().contains("1 bytes follow its end"));
}

#[test]
fn lying_sizes_are_errors_without_large_allocations() {
    let raw = [1_u8; 64];
    let stored = lz4_flex::block::compress(&raw);
    let len = stored.len() as u32;
    let honest = info(8, 8, &[len], &stored);
    assert_eq!(parse(&forged(vec![honest], &stored)).unwrap().sections()[0].bytes, raw);

    let many_chunks = vec![0; 1 << 16];
    for (element_size, count, chunks) in [
        (8, 1 << 60, &[len][..]),
        (u64::MAX, u64::MAX, &[len]),
        (1 << 40, 1, &[len]),
        // As many chunks as the size asks for, but empty ones: 256 GiB from a few bytes.
        (4 << 20, 1 << 16, &many_chunks),
        (8, 0, &[len]),
        (0, 8, &[]),
        (8, 9, &[len]),
        (8, 7, &[len]),
        (8, 8, &[]),
        (8, 8, &[len - 1, 1]),
    ] {
        let stored_len: u32 = chunks.iter().sum();
        let own = &stored[..stored_len as usize];
        let bytes = forged(vec![info(element_size, count, chunks, own)], own);
        let result = parse(&bytes);
        assert!(
            matches!(result, Err(ContainerError::Damaged { .. })),
            "{element_size} x {count} in {} chunks: {result:?}",
            chunks.len()
        );
    }
    let beyond = forged(vec![info(8, 8, &[u32::MAX], &stored)], &stored);
    assert!(matches!(parse(&beyond), Err(ContainerError::Truncated { .. })));
}

#[test]
fn chunks_that_are_no_lz4_are_an_error() {
    let stored = [0xff; 40];
    let result = parse(&forged(vec![info(1, 64, &[40], &stored)], &stored));
    assert!(result.unwrap_err().to_string().contains("section `x` cannot be decompressed to 64 bytes"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases()) })]

    #[test]
    fn every_changed_byte_is_an_error(place: prop::sample::Index, change in 1..=255_u8) {
        let mut bytes = small_once().to_vec();
        let place = place.index(bytes.len());
        bytes[place] ^= change;
        prop_assert!(parse(&bytes).is_err(), "byte {place} changed by {change}");
    }

    #[test]
    fn a_header_of_noise_is_an_error(noise in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(FORMAT_VERSION.to_le_bytes());
        bytes.extend((noise.len() as u32).to_le_bytes());
        bytes.extend(xxh3_64(&noise).to_le_bytes());
        bytes.extend(&noise);
        // Noise may spell an empty container; it must never panic.
        if let Ok(container) = parse(&bytes) {
            prop_assert!(container.sections().iter().all(|section| section.bytes.is_empty()));
        }
    }
}

fn small_once() -> &'static [u8] {
    static BYTES: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    BYTES.get_or_init(small)
}

/// Few in the continuous integration; as many as `PROPTEST_CASES` asks for in a hunt.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(2000)
}
