//! The particles of a plane scene, as discs.

use super::canvas::{Canvas, rgb};
use super::view::View;
use crate::reading::{RecordedBody, RecordedFrame};

/// Draws all particles, those of later bodies over those of earlier ones.
pub fn draw(canvas: &mut Canvas, frame: &RecordedFrame, view: &View) {
    for body in &frame.bodies {
        for (k, position) in body.positions.iter().enumerate() {
            let Some(ball) = view.ball(*position, body.radius) else { continue };
            let color = rgb(color_of(body, k));
            // A particle smaller than a pixel is a pixel.
            let radius = ball.radius.max(0.5);
            for (x, y) in pixels(ball.center, radius, canvas) {
                let arm = [x as f32 + 0.5 - ball.center[0], y as f32 + 0.5 - ball.center[1]];
                if arm[0].hypot(arm[1]) <= radius {
                    *canvas.pixel(x, y) = color;
                }
            }
        }
    }
}

/// The colour of a particle.
pub fn color_of(body: &RecordedBody, particle: usize) -> [u8; 3] {
    let one = body.colors.first().copied().unwrap_or_default();
    if body.colors.len() == 1 { one } else { body.colors.get(particle).copied().unwrap_or(one) }
}

/// The pixels of the picture that a disc may cover.
pub fn pixels(
    center: [f32; 2],
    radius: f32,
    canvas: &Canvas,
) -> impl Iterator<Item = (usize, usize)> + use<> {
    let range = |k: usize, size: usize| {
        let end = |x: f32| (x.max(0.0) as usize).min(size);
        end((center[k] - radius).floor())..end((center[k] + radius).ceil() + 1.0)
    };
    let (columns, rows) = (range(0, canvas.width()), range(1, canvas.height()));
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}
