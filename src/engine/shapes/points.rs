//! Particles from a CSV file.

use std::path::Path;

use glam::DVec3;

use super::error::{FillError, FillErrorKind};
use super::fill::Site;
use crate::space::Dimension;

/// Reads the columns x, y, z (three dimensions), volume of the file, in any order. A unit in brackets may follow a name (`x[m]`); empty
/// lines and those that begin with `#` are passed over, other columns are ignored.
///
/// # Errors
/// The file cannot be read or has no particle, a column is missing, a value is not a finite number, a volume is not positive, z is
/// not 0 in two dimensions, there are more particles than `limit`.
pub(super) fn read(
    folder: &Path,
    file: &str,
    dimension: Dimension,
    limit: usize,
    path: &str,
) -> Result<Vec<Site>, FillError> {
    let full = folder.join(file);
    let shown = full.display().to_string();
    let error = |kind| FillError::new(format!("{path}.file"), kind);
    let text = std::fs::read_to_string(&full)
        .map_err(|source| error(FillErrorKind::File { file: shown.clone(), source }))?;
    let wrong = |line, message| error(FillErrorKind::Csv { file: shown.clone(), line, message });
    let mut lines = text
        .lines()
        .zip(1u64..)
        .map(|(content, line)| (content.trim(), line))
        .filter(|(content, _)| !content.is_empty() && !content.starts_with('#'));
    let (header, header_line) = lines
        .next()
        .ok_or_else(|| wrong(1, "the file is empty, expected a header `x,y,volume`".to_owned()))?;
    let names: Vec<&str> = values(header).map(|name| name.split('[').next().unwrap_or(name).trim()).collect();
    let column = |name: &str| names.iter().position(|&title| title == name);
    let required = |name: &str| {
        column(name)
            .ok_or_else(|| wrong(header_line, format!("the header `{header}` has no column `{name}`")))
    };
    let (x, y, volume) = (required("x")?, required("y")?, required("volume")?);
    let z = if dimension == Dimension::Three { Some(required("z")?) } else { column("z") };
    let mut sites = Vec::new();
    for (content, line) in lines {
        let row: Vec<&str> = values(content).collect();
        if row.len() != names.len() {
            let message = format!("expected {} values as in the header, found {}", names.len(), row.len());
            return Err(wrong(line, message));
        }
        let value = |column: usize| match row[column].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(wrong(
                line,
                format!("expected a number for `{}`, found `{}`", names[column], row[column]),
            )),
        };
        let site = Site {
            position: DVec3::new(value(x)?, value(y)?, z.map_or(Ok(0.0), value)?),
            volume: value(volume)?,
        };
        if site.volume <= 0.0 {
            return Err(wrong(line, format!("the volume must be greater than 0, found {}", site.volume)));
        }
        if dimension == Dimension::Two && site.position.z != 0.0 {
            return Err(wrong(line, format!("z must be 0 in two dimensions, found {}", site.position.z)));
        }
        if sites.len() == limit {
            return Err(error(FillErrorKind::TooMany { estimate: (limit + 1) as f64, limit }));
        }
        sites.push(site);
    }
    if sites.is_empty() {
        return Err(wrong(header_line, "the file has no particle".to_owned()));
    }
    Ok(sites)
}

/// The values of a line, without spaces and quotes about them.
fn values(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|value| value.trim().trim_matches('"').trim())
}
