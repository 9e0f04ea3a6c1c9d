//! What stands around the particles: title, time, colour bar, and a scale or the directions of the axes.

use super::canvas::{Canvas, Rgb, rgb};
use super::text::{Align, write};
use super::view::View;
use crate::reading::RecordedFrame;

const INK: Rgb = [0.07, 0.08, 0.10];
const FAINT: Rgb = [0.35, 0.37, 0.40];

/// The part of the picture that the particles have, and the size of what is around.
pub struct Area {
    /// A unit of length: the picture looks alike at all sizes \[pixels\].
    unit: f32,
    width: usize,
    head: usize,
    height: usize,
}

impl Area {
    /// The part of a picture that is left for the particles of a frame.
    pub fn of(canvas: &Canvas, frame: &RecordedFrame) -> Self {
        let unit = canvas.height().min(canvas.width()) as f32 / 40.0;
        let head = (2.6 * unit) as usize;
        let foot = if frame.bar.is_empty() { unit as usize } else { (5.8 * unit) as usize };
        Self { unit, width: canvas.width(), head, height: canvas.height().saturating_sub(head + foot).max(1) }
    }

    pub fn width(&self) -> usize {
        self.width
    }

    pub fn height(&self) -> usize {
        self.height
    }

    /// Its upper edge.
    pub fn top(&self) -> usize {
        self.head
    }
}

/// Draws what stands around the particles.
pub fn draw(canvas: &mut Canvas, area: &Area, frame: &RecordedFrame, view: &View) {
    let (unit, width) = (area.unit, canvas.width() as f32);
    let base = 1.8 * unit;
    write(canvas, &frame.title, [unit, base], 1.3 * unit, Align::Left, INK);
    let time = format!("t = {}", meshless_engine::notation::quantity(frame.time, "s"));
    write(canvas, &time, [width - unit, base], 1.3 * unit, Align::Right, INK);
    bar(canvas, area, frame);
    let corner = [1.4 * unit, (area.head + area.height) as f32 - 1.0 * unit];
    if view.is_plane() {
        ruler(canvas, unit, corner, view);
    } else {
        axes(canvas, unit, corner, view);
    }
}

/// The colour bar with its values; over it the field, below it the extreme values.
fn bar(canvas: &mut Canvas, area: &Area, frame: &RecordedFrame) {
    if frame.bar.is_empty() {
        return;
    }
    let (unit, width) = (area.unit, canvas.width() as f32);
    let top = (area.head + area.height) as f32;
    let (left, right) = (0.2 * width, 0.8 * width);
    write(canvas, &frame.field, [0.5 * width, top + 1.0 * unit], 1.1 * unit, Align::Middle, INK);
    let rows = (top + 1.5 * unit) as i32..(top + 2.5 * unit) as i32;
    for x in left as i32..right as i32 {
        let share = (x as f32 - left) / (right - left);
        let k = (share * (frame.bar.len() - 1) as f32).round() as usize;
        for y in rows.clone() {
            canvas.cover(x, y, rgb(frame.bar[k]), 1.0);
        }
    }
    let pieces = frame.values.len().saturating_sub(1).max(1) as f32;
    for (k, value) in frame.values.iter().enumerate() {
        let x = left + k as f32 / pieces * (right - left);
        write(canvas, value, [x, top + 3.7 * unit], unit, Align::Middle, INK);
    }
    for (text, share) in frame.extremes.iter().zip([0.25, 0.75]) {
        write(canvas, text, [share * width, top + 5.1 * unit], 0.9 * unit, Align::Middle, FAINT);
    }
}

/// A line of a round length, about a sixth of the picture.
fn ruler(canvas: &mut Canvas, unit: f32, corner: [f32; 2], view: &View) {
    // The particles are drawn at twice the size.
    let per_metre = 0.5 * f64::from(view.scale());
    let length = round_below(canvas.width() as f64 / 6.0 / per_metre);
    let end = corner[0] + (length * per_metre) as f32;
    for (from, to) in [
        ([corner[0], corner[1]], [end, corner[1]]),
        ([corner[0], corner[1] - 0.3 * unit], [corner[0], corner[1] + 0.3 * unit]),
        ([end, corner[1] - 0.3 * unit], [end, corner[1] + 0.3 * unit]),
    ] {
        canvas.line(from, to, FAINT);
    }
    let text = meshless_engine::notation::quantity(length, "m");
    write(canvas, &text, [0.5 * (corner[0] + end), corner[1] - 0.5 * unit], 0.9 * unit, Align::Middle, FAINT);
}

/// The largest 1, 2 or 5 times a power of ten that is no larger than `length`.
fn round_below(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * power <= length).unwrap_or(1.0);
    digit * power
}

/// Arrows along x, y and z.
fn axes(canvas: &mut Canvas, unit: f32, corner: [f32; 2], view: &View) {
    let origin = [corner[0] + 2.0 * unit, corner[1] - 1.5 * unit];
    let names = [("x", [0.75, 0.2, 0.15]), ("y", [0.15, 0.55, 0.2]), ("z", [0.15, 0.3, 0.75])];
    for (k, (name, color)) in names.into_iter().enumerate() {
        let axis = view.axis(k);
        let at = |length: f32| [origin[0] + length * unit * axis[0], origin[1] + length * unit * axis[1]];
        canvas.line(origin, at(2.0), color);
        let tip = at(2.6);
        write(canvas, name, [tip[0], tip[1] + 0.3 * unit], unit, Align::Middle, color);
    }
}

#[cfg(test)]
mod tests {
    use super::round_below;

    #[test]
    fn rulers_have_round_lengths() {
        for (length, round) in [(0.37, 0.2), (0.5, 0.5), (0.99e-3, 0.5e-3), (1.2, 1.0), (47.0, 20.0)] {
            assert!((round_below(length) / round - 1.0).abs() < 1e-12, "{length}: {}", round_below(length));
        }
    }
}
