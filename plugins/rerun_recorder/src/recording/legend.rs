//! The colour bar: a strip of the colours with five values under it, and under these the extreme values with
//! their places.

use re_sdk_types::archetypes::{Image, Points2D};
use re_sdk_types::components::Color;

use super::color_scale::ColorScale;
use super::error::RerunError;
use super::output::RecordingOutput;
use super::paths::legend_part;
use crate::colormap::Colormap;

/// Width of the bar in the units of its view.
pub const WIDTH: u32 = 512;
/// Height of the bar.
const HEIGHT: u32 = 18;
/// Where the values are.
const TEXT_AT: f32 = 24.0;
/// Where the extreme values are.
const EXTREMES_AT: f32 = 48.0;
/// Colour of the values: the viewer puts them on grey in its dark theme, on light grey in its light one.
const LABEL: [u8; 3] = [18, 20, 24];
/// The part of the plane that the view of the bar shows, x and y.
pub const VISIBLE: [[f64; 2]; 2] = [[-40.0, WIDTH as f64 + 40.0], [-9.0, 76.0]];

/// A colour bar that is logged again only when it changes.
pub struct Legend {
    unit: String,
    shown: Option<(ColorScale, Colormap, [bool; 2])>,
}

impl Legend {
    /// The colour bar of a field with that unit.
    pub fn new(unit: &str) -> Self {
        Self { unit: unit.to_owned(), shown: None }
    }

    /// Shows a scale; `beyond` says whether values are below its lower and above its upper end.
    pub fn show(
        &mut self,
        output: &RecordingOutput,
        scale: ColorScale,
        map: Colormap,
        beyond: [bool; 2],
    ) -> Result<(), RerunError> {
        if self.shown == Some((scale, map, beyond)) {
            return Ok(());
        }
        self.shown = Some((scale, map, beyond));
        output.log(&legend_part("bar"), &strip(map))?;
        let ticks = if scale.high > scale.low { 5 } else { 1 };
        let place = |k: usize| k as f64 / 4.0;
        let labels = (0..ticks).map(|k| {
            let value = scale.low + place(k) * (scale.high - scale.low);
            let sign = match k {
                0 if beyond[0] => "≤ ",
                4 if beyond[1] => "≥ ",
                _ => "",
            };
            format!("{sign}{}", with_unit(value, &self.unit))
        });
        let at = (0..ticks).map(|k| [place(k) as f32 * WIDTH as f32, TEXT_AT]);
        let points = Points2D::new(at)
            .with_labels(labels)
            .with_show_labels(true)
            .with_colors([Color::from_rgb(LABEL[0], LABEL[1], LABEL[2])])
            .with_radii([0.01f32]);
        output.log(&legend_part("values"), &points)
    }
}

/// A value with the place of its particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedExtreme {
    /// Value, in the unit of the field.
    pub value: f64,
    /// Position \[m\].
    pub place: [f32; 3],
}

impl Legend {
    /// Shows the minimum and the maximum value of a frame.
    pub fn show_extremes(
        &self,
        output: &RecordingOutput,
        ends: [PlacedExtreme; 2],
        axes: usize,
    ) -> Result<(), RerunError> {
        let text = |name: &str, end: PlacedExtreme| {
            let place: Vec<String> = even(&end.place[..axes]).into_iter().map(short).collect();
            format!("{name} {} at ({}) m", with_unit(end.value, &self.unit), place.join(", "))
        };
        let labels = [text("minimum", ends[0]), text("maximum", ends[1])];
        let at = [0.25, 0.75].map(|share| [share * WIDTH as f32, EXTREMES_AT]);
        let points = Points2D::new(at)
            .with_labels(labels)
            .with_show_labels(true)
            .with_colors([Color::from_rgb(LABEL[0], LABEL[1], LABEL[2])])
            .with_radii([0.01f32]);
        output.log(&legend_part("extremes"), &points)
    }
}

/// Coordinates without what is rounding beside the largest of them.
pub fn even(place: &[f32]) -> Vec<f64> {
    let largest = place.iter().fold(0f32, |largest, x| largest.max(x.abs()));
    place.iter().map(|&x| if x.abs() < 1e-4 * largest { 0.0 } else { f64::from(x) }).collect()
}

/// The name of a field as people write it: `von_mises` is the von Mises stress.
pub fn title(field: &str) -> String {
    let (base, component) = field.split_once('.').unwrap_or((field, ""));
    let name = if base == "von_mises" { "von Mises stress".to_owned() } else { base.replace('_', " ") };
    format!("{name} {component}").trim_end().to_owned()
}

fn strip(map: Colormap) -> Image {
    let row: Vec<u8> = (0..WIDTH).flat_map(|k| map.color(f64::from(k) / f64::from(WIDTH - 1))).collect();
    Image::from_rgb24(row.repeat(HEIGHT as usize), [WIDTH, HEIGHT])
}

/// The number with its unit, in thousands, millions and so on where that is customary for the unit.
pub fn with_unit(value: f64, unit: &str) -> String {
    const PREFIXES: [(&str, i32); 9] =
        [("T", 12), ("G", 9), ("M", 6), ("k", 3), ("", 0), ("m", -3), ("µ", -6), ("n", -9), ("p", -12)];
    if value == 0.0 || unit == "1" || unit.is_empty() {
        return if unit == "1" || unit.is_empty() {
            short(value)
        } else {
            format!("{} {unit}", short(value))
        };
    }
    if matches!(unit, "Pa" | "N" | "J" | "W") {
        let size = value.abs() * (1.0 + 1e-12);
        if let Some((prefix, power)) = PREFIXES.iter().find(|(_, power)| size >= 10f64.powi(*power)) {
            return format!("{} {prefix}{unit}", short(value / 10f64.powi(*power)));
        }
    }
    format!("{} {unit}", short(value))
}

/// The number with up to four digits.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-3..6).contains(&exponent) {
        let text = format!("{value:.3e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    let decimals = usize::try_from(3 - exponent).unwrap_or(0);
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

fn trimmed(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_have_the_names_that_people_write() {
        let names = ["von_mises", "stress.xy", "max_principal_stress", "velocity"].map(title);
        assert_eq!(names, ["von Mises stress", "stress xy", "max principal stress", "velocity"]);
    }

    #[test]
    fn places_have_no_rounding() {
        assert_eq!(even(&[-2.5e-7, 0.5, 0.0]), [0.0, 0.5, 0.0]);
        assert_eq!(even(&[-2.5e-7, 0.0]), [f64::from(-2.5e-7f32), 0.0]);
    }

    #[test]
    fn values_are_written_short_and_with_the_customary_prefix() {
        assert_eq!(with_unit(1.2e5, "Pa"), "120 kPa");
        assert_eq!(with_unit(-2.5e6, "Pa"), "-2.5 MPa");
        assert_eq!(with_unit(1e9, "Pa"), "1 GPa");
        assert_eq!(with_unit(0.0, "Pa"), "0 Pa");
        assert_eq!(with_unit(3.75, "m/s"), "3.75 m/s");
        assert_eq!(with_unit(1012.0, "kg/m^3"), "1012 kg/m^3");
        assert_eq!(with_unit(0.000012, "1"), "1.2e-5");
        assert_eq!(with_unit(123456.0, "1"), "123456");
        assert_eq!(with_unit(4e-15, "J"), "4e-15 J");
    }
}
