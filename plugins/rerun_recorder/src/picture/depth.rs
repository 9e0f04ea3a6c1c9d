//! Particles in space, as shaded balls, or as the surface that their balls have when seen from the eye.
//!
//! The surface is that of screen-space fluids (W. van der Laan, S. Green, M. Sainz, Screen space fluid
//! rendering with curvature flow, Symposium on Interactive 3D Graphics and Games 2009): the depths of the
//! balls are smoothed where they differ by little, and normals are those of the smoothed depths.

use super::canvas::{Canvas, Rgb, rgb};
use super::plane::{color_of, pixels};
use super::view::View;
use crate::reading::RecordedFrame;

/// Where the light comes from: right, up, and towards the eye.
const LIGHT: [f32; 3] = [-0.40, 0.56, 0.726];
/// Share of the light that comes from everywhere.
const AMBIENT: f32 = 0.45;
/// Radius of the balls of a surface over that of the particles, so that they close it.
const CLOSED: f32 = 1.7;
/// Steps of smoothing.
const ROUNDS: usize = 2;

/// The particle or surface visible in a pixel.
#[derive(Clone, Copy)]
struct SeenPixel {
    /// Distance along the line of sight \[m\].
    depth: f32,
    /// Radius of the ball \[pixels\].
    radius: f32,
    /// Radius of the ball \[m\].
    length: f32,
    color: Rgb,
    /// Right, up, towards the eye.
    normal: [f32; 3],
}

const NOTHING: SeenPixel =
    SeenPixel { depth: f32::INFINITY, radius: 0.0, length: 0.0, color: [0.0; 3], normal: [0.0, 0.0, 1.0] };

/// Draws all particles.
pub fn draw(canvas: &mut Canvas, frame: &RecordedFrame, view: &View, smooth: bool) {
    let mut seen = balls(canvas, frame, view, if smooth { CLOSED } else { 1.0 });
    if smooth {
        let (width, height) = (canvas.width(), canvas.height());
        for _ in 0..ROUNDS {
            seen = smoothed(&seen, width, height, 1);
            seen = smoothed(&seen, width, height, width);
        }
        turn_normals(&mut seen, width, view.scale());
    }
    for (place, pixel) in seen.iter().enumerate().filter(|(_, pixel)| pixel.depth.is_finite()) {
        let facing: f32 = pixel.normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
        let light = AMBIENT + (1.0 - AMBIENT) * facing.max(0.0);
        *canvas.pixel(place % canvas.width(), place / canvas.width()) =
            pixel.color.map(|value| value * light);
    }
}

/// The nearest ball in each pixel.
fn balls(canvas: &Canvas, frame: &RecordedFrame, view: &View, larger: f32) -> Vec<SeenPixel> {
    let mut seen = vec![NOTHING; canvas.width() * canvas.height()];
    for body in &frame.bodies {
        // Bodies without colours are dots, so that one sees through them.
        let length = body.radius * if body.colors.len() == 1 { 1.0 } else { larger };
        for (k, position) in body.positions.iter().enumerate() {
            let Some(ball) = view.ball(*position, length) else { continue };
            let color = rgb(color_of(body, k));
            let radius = ball.radius.max(0.5);
            for (x, y) in pixels(ball.center, radius, canvas) {
                let arm =
                    [(x as f32 + 0.5 - ball.center[0]) / radius, (ball.center[1] - y as f32 - 0.5) / radius];
                let square = arm[0] * arm[0] + arm[1] * arm[1];
                if square > 1.0 {
                    continue;
                }
                let toward = (1.0 - square).sqrt();
                let depth = ball.depth - toward * length;
                let pixel = &mut seen[y * canvas.width() + x];
                if depth < pixel.depth {
                    *pixel = SeenPixel { depth, radius, length, color, normal: [arm[0], arm[1], toward] };
                }
            }
        }
    }
    seen
}

/// Means of depth and colour along rows (`stride` 1) or columns (`stride` the width), over pixels that are no
/// more than two radii nearer or farther.
fn smoothed(seen: &[SeenPixel], width: usize, height: usize, stride: usize) -> Vec<SeenPixel> {
    let mut result = seen.to_vec();
    for (place, pixel) in result.iter_mut().enumerate().filter(|(_, pixel)| pixel.depth.is_finite()) {
        let (at, size) = if stride == 1 { (place % width, width) } else { (place / width, height) };
        let reach = (1.5 * pixel.radius).clamp(1.0, 40.0) as usize;
        let (mut sum, mut depth, mut color) = (0.0, 0.0, [0.0; 3]);
        for other in at.saturating_sub(reach)..=(at + reach).min(size - 1) {
            let near = &seen[place + other * stride - at * stride];
            let apart = (near.depth - pixel.depth) / (2.0 * pixel.length);
            if apart.abs() < 1.0 {
                let away = other.abs_diff(at) as f32 / (reach + 1) as f32;
                let weight = (1.0 - away * away) * (1.0 - apart * apart);
                sum += weight;
                depth += weight * near.depth;
                color = std::array::from_fn(|c| color[c] + weight * near.color[c]);
            }
        }
        pixel.depth = depth / sum;
        pixel.color = color.map(|value| value / sum);
    }
    result
}

/// Normals from the differences of the depths, the smaller of both sides, so that they do not reach over an
/// edge.
fn turn_normals(seen: &mut [SeenPixel], width: usize, scale: f32) {
    let depths: Vec<f32> = seen.iter().map(|pixel| pixel.depth).collect();
    let height = depths.len() / width;
    for (place, pixel) in seen.iter_mut().enumerate().filter(|(_, pixel)| pixel.depth.is_finite()) {
        let slope = |at: usize, size: usize, stride: usize| {
            let ahead = if at + 1 < size { depths[place + stride] - depths[place] } else { f32::INFINITY };
            let behind = if at > 0 { depths[place] - depths[place - stride] } else { f32::INFINITY };
            let least = if ahead.abs() < behind.abs() { ahead } else { behind };
            // A pixel without neighbours faces the eye.
            if least.is_finite() { least * scale } else { 0.0 }
        };
        let (x, y) = (slope(place % width, width, 1), slope(place / width, height, width));
        let length = (x * x + y * y + 1.0).sqrt();
        pixel.normal = [x / length, -y / length, 1.0 / length];
    }
}
