//! Particles from a CSV file.

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;

use super::error::{FillError, FillErrorKind};
use super::site::Site;
use crate::files;
use crate::notation::{number, place};
use crate::space::Dimension;

/// Reads the columns x, y, z (three dimensions), volume of the file, in any order. A unit in brackets may
/// follow a name (`x[m]`); empty lines, those that begin with `#` and other columns are ignored.
///
/// # Errors
/// The file cannot be read or has no particle, a column is missing, a value is not a finite number, a volume
/// is not positive, z is not 0 in two dimensions, there are more particles than `limit`.
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
    let text = files::read(&full, files::MAX_GEOMETRY)
        .and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other))
        .map_err(|source| error(FillErrorKind::File { file: shown.clone(), source }))?;
    // Excel writes a byte-order mark in UTF-8.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let wrong = |line, message| error(FillErrorKind::Csv { file: shown.clone(), line, message });
    let mut lines = text
        .lines()
        .zip(1u64..)
        .map(|(content, line)| (content.trim(), line))
        .filter(|(content, _)| !content.is_empty() && !content.starts_with('#'));
    let (header, header_line) = lines
        .next()
        .ok_or_else(|| wrong(1, "the file is empty, expected a header `x,y,volume`".to_owned()))?;
    if header.contains(';') && !header.contains(',') {
        let message =
            "the values of a line must be separated by `,`, found `;`; decimals are written with a point";
        return Err(wrong(header_line, message.to_owned()));
    }
    let names: Vec<&str> = values(header).map(|name| name.split('[').next().unwrap_or(name).trim()).collect();
    let column = |name: &str| names.iter().position(|&title| title == name);
    let required = |name: &str| {
        column(name).ok_or_else(|| {
            wrong(header_line, format!("the header must have a column `{name}`, found {}", columns(&names)))
        })
    };
    let (x, y, volume) = (required("x")?, required("y")?, required("volume")?);
    let z = if dimension == Dimension::Three { Some(required("z")?) } else { column("z") };
    let columns = Columns { names: &names, x, y, z, volume };
    let mut sites = Vec::new();
    for (content, line) in lines {
        let row: Vec<&str> = values(content).collect();
        let site = columns.site(&row, dimension).map_err(|message| wrong(line, message))?;
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

/// The columns of a file, and the indices of those that are read.
struct Columns<'a> {
    names: &'a [&'a str],
    x: usize,
    y: usize,
    z: Option<usize>,
    volume: usize,
}

impl Columns<'_> {
    /// The particle of a line, or its error message.
    fn site(&self, row: &[&str], dimension: Dimension) -> Result<Site, String> {
        let Self { names, x, y, z, volume } = *self;
        if row.len() != names.len() {
            return Err(format!("expected {} values as in the header, found {}", names.len(), row.len()));
        }
        let value = |column: usize| match row[column].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(format!("expected a number for `{}`, found `{}`", names[column], row[column])),
        };
        let site = Site {
            position: DVec3::new(value(x)?, value(y)?, z.map_or(Ok(0.0), value)?),
            volume: value(volume)?,
        };
        if site.volume <= 0.0 {
            return Err(format!("the volume must be greater than 0, found {}", site.volume));
        }
        if dimension == Dimension::Two && site.position.z != 0.0 {
            return Err(format!("z must be 0 in two dimensions, found {}", site.position.z));
        }
        Ok(site)
    }
}

/// Ratio between the volume of a particle and that of its spacing beyond which a wrong unit is likely.
const VOLUME_RATIO: f64 = 100.0;
/// Distance in spacings below which two particles are duplicates.
const TWICE: f64 = 0.01;

/// Checks the consistency of positions and volumes with the spacing \[m\] of the body.
///
/// # Errors
/// Two particles coincide, or the volumes are those of another spacing.
pub(super) fn check(
    sites: &[Site],
    spacing: f64,
    dimension: Dimension,
    file: &Path,
    path: &str,
) -> Result<(), FillError> {
    let file = file.display().to_string();
    let error = |message: String| {
        FillError::new(format!("{path}.file"), FillErrorKind::Particles { file: file.clone(), message })
    };
    let expected = spacing.powi(dimension.count() as i32);
    let mean = sites.iter().map(|site| site.volume).sum::<f64>() / sites.len().max(1) as f64;
    if !(1.0 / VOLUME_RATIO..=VOLUME_RATIO).contains(&(mean / expected)) {
        return Err(error(format!(
            "the mean volume of a particle must be near spacing^{} = {}, found {}",
            dimension.count(),
            number(expected),
            number(mean)
        )));
    }
    let cell = |x: DVec3| (x / (TWICE * spacing)).floor().to_array().map(|k| k as i64);
    let mut cells: HashMap<[i64; 3], usize> = HashMap::with_capacity(sites.len());
    for (k, site) in sites.iter().enumerate() {
        let [x, y, z] = cell(site.position);
        // Cell indices of the most distant positions saturate.
        let beside = |k: i64| (-1..=1).map(move |by| k.saturating_add(by));
        let around = beside(x).flat_map(|x| beside(y).flat_map(move |y| beside(z).map(move |z| [x, y, z])));
        let near = |other: &usize| sites[*other].position.distance(site.position) < TWICE * spacing;
        if let Some(other) = around.filter_map(|cell| cells.get(&cell).copied()).find(near) {
            return Err(error(format!(
                "two particles must not be at one place, found particles {} and {} at {}",
                other + 1,
                k + 1,
                place(site.position)
            )));
        }
        cells.insert([x, y, z], k);
    }
    Ok(())
}

/// The columns of a header for an error message. A line that is not a header is not shown, because it may be
/// confidential.
fn columns(names: &[&str]) -> String {
    let is_sign = |sign: char| sign.is_alphanumeric() || " _-.".contains(sign);
    match names.iter().all(|name| name.len() < 40 && name.chars().all(is_sign)) {
        true => format!("`{}`", names.join(",")),
        false => "a line that is no header".to_owned(),
    }
}

/// The values of a line, without surrounding spaces and quotes.
fn values(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|value| value.trim().trim_matches('"').trim())
}
