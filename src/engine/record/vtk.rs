//! ParaView files: one `.vtu` per frame and body, and a `.pvd` that lists them with their times.
//!
//! An own writer, because the need is small and the library is not well maintained: the last stable release
//! of vtkio (0.6.3) depends on outdated parsers, its successor is a release candidate, it requires an owned
//! data model, and it does not write `.pvd`. Here columns go from memory to the file unchanged: each particle
//! is a vertex cell, the XML head states the offset of each array, and the arrays follow as raw little-endian
//! bytes ("appended, raw"), each after its length as 64-bit number. They follow from the last to the first:
//! meshio 5 looks arrays up by their offsets, and takes the first of the head that has one, while it replaces
//! those of the arrays that it has read. In the order of the head another array could have that number by
//! then: of two vectors and two numbers, or of a tensor and a vector, some came out as others, or as corrupt.
//!
//! Format: VTK file formats, section "XML file formats", versions 1.0 (`UnstructuredGrid`) and 0.1
//! (`Collection`).

use std::io::{self, Write};
use std::path::Path;

use super::atomic::{Existing, WriteError, write_atomically};

mod pvd;
#[cfg(test)]
mod tests;

pub use pvd::{PvdFrame, PvdWriter};

/// Why a ParaView file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum VtkError {
    /// An array that does not fit the points.
    #[error(
        "array `{name}` has {found} numbers, expected {expected}: {components} for each of {points} points"
    )]
    Length {
        /// The array.
        name: String,
        /// Numbers found.
        found: usize,
        /// Numbers needed.
        expected: usize,
        /// Numbers of one point.
        components: usize,
        /// Points.
        points: usize,
    },
    /// Two arrays of one name, of which ParaView would show one.
    #[error("two arrays are named `{name}`; names must differ")]
    Duplicate {
        /// The name.
        name: String,
    },
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// The numbers of an array, point by point.
#[derive(Debug, Clone, Copy)]
pub enum PointValues<'a> {
    /// Double precision.
    F64(&'a [f64]),
    /// Single precision.
    F32(&'a [f32]),
    /// Unsigned integers: identities, flags.
    U32(&'a [u32]),
}

impl PointValues<'_> {
    fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::F32(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }

    fn type_name(&self) -> &'static str {
        match self {
            Self::F64(_) => "Float64",
            Self::F32(_) => "Float32",
            Self::U32(_) => "UInt32",
        }
    }

    fn bytes(&self) -> &[u8] {
        match self {
            Self::F64(values) => bytemuck::cast_slice(values),
            Self::F32(values) => bytemuck::cast_slice(values),
            Self::U32(values) => bytemuck::cast_slice(values),
        }
    }
}

/// A quantity at the points.
#[derive(Debug, Clone, Copy)]
pub struct PointArray<'a> {
    name: &'a str,
    components: usize,
    values: PointValues<'a>,
}

impl<'a> PointArray<'a> {
    /// One number a point.
    pub fn scalar(name: &'a str, values: PointValues<'a>) -> Self {
        Self { name, components: 1, values }
    }

    /// Three numbers a point.
    pub fn vector(name: &'a str, values: PointValues<'a>) -> Self {
        Self { name, components: 3, values }
    }

    /// Nine numbers a point, row by row (xx, xy, xz, yx, ...).
    ///
    /// Matrices that lie in memory by columns come out transposed unless they are symmetric.
    pub fn tensor(name: &'a str, values: PointValues<'a>) -> Self {
        Self { name, components: 9, values }
    }
}

/// Writes the points \[m\] and their data at the time `time` \[s\] as a `.vtu` file, whole or not at all.
pub fn write_vtu(
    path: &Path,
    time: f64,
    points: &[[f64; 3]],
    arrays: &[PointArray],
    existing: Existing,
) -> Result<(), VtkError> {
    for (index, array) in arrays.iter().enumerate() {
        let (found, expected) = (array.values.len(), array.components * points.len());
        if found != expected {
            let (name, components) = (array.name.to_owned(), array.components);
            return Err(VtkError::Length { name, found, expected, components, points: points.len() });
        }
        if arrays[..index].iter().any(|earlier| earlier.name == array.name) {
            return Err(VtkError::Duplicate { name: array.name.to_owned() });
        }
    }
    write_atomically(path, existing, |w| write_grid(w, time, points, arrays))?;
    Ok(())
}

/// The head of a file under construction, which counts down where the appended arrays will lie.
struct Head {
    xml: String,
    offset: usize,
}

impl Head {
    fn line(&mut self, text: &str) {
        self.xml.push_str(text);
        self.xml.push('\n');
    }

    /// Announces an array of `bytes` bytes; `shape` are further attributes.
    fn array(&mut self, type_name: &str, name: &str, shape: &str, bytes: usize) {
        self.offset -= size_of::<u64>() + bytes;
        let (name, offset) = (escaped(name), self.offset);
        self.line(&format!(
            r#"<DataArray type="{type_name}" Name="{name}" {shape} format="appended" offset="{offset}"/>"#
        ));
    }
}

fn write_grid(w: &mut dyn Write, time: f64, points: &[[f64; 3]], arrays: &[PointArray]) -> io::Result<()> {
    let n = points.len();
    let of_arrays: usize = arrays.iter().map(|array| array.values.bytes().len()).sum();
    // Time, arrays, points, and what makes a cell of each point.
    let bytes = 8 + of_arrays + size_of_val(points) + (8 + 8 + 1) * n;
    let mut head = Head { xml: String::new(), offset: (arrays.len() + 5) * size_of::<u64>() + bytes };
    head.line(r#"<?xml version="1.0"?>"#);
    head.line(
        r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#,
    );
    head.line("<UnstructuredGrid>\n<FieldData>");
    head.array("Float64", "TimeValue", r#"NumberOfTuples="1""#, 8);
    head.line(&format!("</FieldData>\n<Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{n}\">\n<PointData>"));
    for array in arrays {
        let shape = format!(r#"NumberOfComponents="{}""#, array.components);
        head.array(array.values.type_name(), array.name, &shape, array.values.bytes().len());
    }
    head.line("</PointData>\n<Points>");
    head.array("Float64", "Points", r#"NumberOfComponents="3""#, size_of_val(points));
    head.line("</Points>\n<Cells>");
    head.array("Int64", "connectivity", "", 8 * n);
    head.array("Int64", "offsets", "", 8 * n);
    head.array("UInt8", "types", "", n);
    head.line("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">");
    // The underscore marks where offset 0 is.
    head.xml.push('_');
    w.write_all(head.xml.as_bytes())?;

    append(w, &vec![VTK_VERTEX; n])?;
    let ends: Vec<i64> = (1..=n as i64).collect();
    append(w, bytemuck::cast_slice(&ends))?;
    let first_points: Vec<i64> = (0..n as i64).collect();
    append(w, bytemuck::cast_slice(&first_points))?;
    append(w, bytemuck::cast_slice(points))?;
    arrays.iter().rev().try_for_each(|array| append(w, array.values.bytes()))?;
    append(w, &time.to_le_bytes())?;
    w.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

/// The cell type of a single point.
const VTK_VERTEX: u8 = 1;

fn append(w: &mut dyn Write, bytes: &[u8]) -> io::Result<()> {
    w.write_all(&(bytes.len() as u64).to_le_bytes())?;
    w.write_all(bytes)
}

/// `text` as the value of an XML attribute.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // Line ends would be read as blanks; other control characters are not allowed at all.
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
