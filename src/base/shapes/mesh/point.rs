//! Points in the text formats of meshes.

use glam::DVec3;

use crate::shapes::mesh_fault::MeshFault;

/// Three numbers of a line; further ones are ignored.
pub(super) fn point<'a>(words: impl Iterator<Item = &'a str>, line: usize) -> Result<DVec3, MeshFault> {
    let wrong = |message: String| MeshFault::Line { line, message };
    let mut point = [0.0; 3];
    let mut found = 0;
    for (value, word) in point.iter_mut().zip(words) {
        *value = word.parse().map_err(|_| wrong(format!("expected a number, found `{word}`")))?;
        found += 1;
    }
    if found == 3 { Ok(point.into()) } else { Err(wrong(format!("expected 3 coordinates, found {found}"))) }
}
