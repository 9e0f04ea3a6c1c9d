//! OBJ files: vertices and faces; normals, textures and groups are skipped.

use glam::DVec3;

use crate::shapes::mesh_fault::MeshFault;

/// The triangles of an OBJ file \[unit of the file\]. Faces of more than three corners are triangulated as
/// fans from their first corner, which is correct for convex faces.
pub(super) fn read(text: &str) -> Result<Vec<[DVec3; 3]>, MeshFault> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for (content, line) in text.lines().zip(1..) {
        let mut words = content.split_whitespace();
        match words.next() {
            Some("v") => points.push(super::point::point(words, line)?),
            Some("f") => {
                let corners = words.map(|word| corner(word, &points, line)).collect::<Result<Vec<_>, _>>()?;
                if corners.len() < 3 {
                    let message = format!("expected a face of at least 3 corners, found {}", corners.len());
                    return Err(MeshFault::Line { line, message });
                }
                triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    Ok(triangles)
}

/// The vertex reference of a face: `7`, `7/1`, `7//3`, `7/1/3`; counted from 1, or backwards from -1.
fn corner(word: &str, points: &[DVec3], line: usize) -> Result<DVec3, MeshFault> {
    let number = word.split('/').next().unwrap_or(word);
    let index = match number.parse::<i64>() {
        Ok(n) if n > 0 => usize::try_from(n - 1).ok(),
        Ok(n) if n < 0 => usize::try_from(points.len() as i64 + n).ok(),
        _ => None,
    };
    index.and_then(|index| points.get(index).copied()).ok_or_else(|| MeshFault::Line {
        line,
        message: format!("the face names corner `{number}`, there are {} so far", points.len()),
    })
}
