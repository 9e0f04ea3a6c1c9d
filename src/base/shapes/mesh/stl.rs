//! STL files, ASCII and binary.

use glam::DVec3;

use crate::shapes::mesh_fault::MeshFault;

/// Header and number of triangles of a binary file, bytes.
const HEAD: usize = 84;
/// A triangle of a binary file: normal, three corners, two bytes, all f32 and little endian, bytes.
const RECORD: usize = 50;

/// The triangles of an STL file \[unit of the file\]. Normals in the file are not used: they follow from the
/// order of the corners.
///
/// A file with the length of a binary file is binary, even if it begins with `solid`, as those of some
/// programs do.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>, MeshFault> {
    let count = bytes.get(HEAD - 4..HEAD).map_or(0, u32_of);
    let expected = HEAD as u64 + RECORD as u64 * u64::from(count);
    if bytes.len() as u64 == expected {
        return Ok(bytes[HEAD..].chunks_exact(RECORD).map(record).collect());
    }
    match std::str::from_utf8(bytes) {
        Ok(text) if text.trim_start().starts_with("solid") => of_text(text),
        _ => Err(MeshFault::NotStl { size: bytes.len(), expected }),
    }
}

fn u32_of(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

fn record(bytes: &[u8]) -> [DVec3; 3] {
    let value = |n: usize| f64::from(f32::from_bits(u32_of(&bytes[4 * n..])));
    [3, 6, 9].map(|n| DVec3::new(value(n), value(n + 1), value(n + 2)))
}

fn of_text(text: &str) -> Result<Vec<[DVec3; 3]>, MeshFault> {
    let mut triangles = Vec::new();
    let mut corners = Vec::new();
    for (content, line) in text.lines().zip(1..) {
        let mut words = content.split_whitespace();
        match words.next() {
            Some("vertex") => corners.push(super::point::point(words, line)?),
            Some("endfacet") => {
                let [a, b, c] = corners[..] else {
                    let message = format!("expected a facet of 3 corners, found {}", corners.len());
                    return Err(MeshFault::Line { line, message });
                };
                triangles.push([a, b, c]);
                corners.clear();
            }
            Some("solid" | "facet" | "outer" | "endloop" | "endsolid") | None => {}
            Some(word) => {
                let message = format!("expected a word of an STL file such as `vertex`, found `{word}`");
                return Err(MeshFault::Line { line, message });
            }
        }
    }
    Ok(triangles)
}
