//! Plane bodies as areas: each pixel has the mean colour of the particles around it, and belongs to a body
//! where these fill it, or where it lies in a particle, so that lone drops are seen.

use super::canvas::{Canvas, Rgb, rgb};
use super::plane::{color_of, pixels};
use super::view::View;
use crate::reading::{RecordedBody, RecordedFrame};

/// Reach of a particle over its radius: two spacings.
const REACH: f32 = 4.0;
/// Density of the particles, over that inside of a body, at its surface: half of the surroundings are empty
/// there.
const AT_SURFACE: f32 = 0.5;

/// Sums of the contributions of particles to a pixel.
#[derive(Clone, Copy, Default)]
struct Sum {
    /// Density of the particles, over that inside of a body.
    density: f32,
    in_particle: bool,
    /// Sum of the colours with the weights of the density.
    color: Rgb,
}

/// Draws all bodies, later ones over earlier ones.
pub fn plane(canvas: &mut Canvas, frame: &RecordedFrame, view: &View) {
    for body in &frame.bodies {
        area(canvas, body, view);
    }
}

fn area(canvas: &mut Canvas, body: &RecordedBody, view: &View) {
    let mut sums = vec![Sum::default(); canvas.width() * canvas.height()];
    for (k, position) in body.positions.iter().enumerate() {
        let Some(ball) = view.ball(*position, body.radius) else { continue };
        let reach = REACH * ball.radius.max(0.5);
        let color = rgb(color_of(body, k));
        // The integral of (1 - q^2)^3 over its disc is pi reach^2 / 4, the area of a particle (2 radius)^2.
        let share = (2.0 * ball.radius.max(0.5) / reach).powi(2) * 4.0 / std::f32::consts::PI;
        for (x, y) in pixels(ball.center, reach, canvas) {
            let arm = [x as f32 + 0.5 - ball.center[0], y as f32 + 0.5 - ball.center[1]];
            let q2 = (arm[0] * arm[0] + arm[1] * arm[1]) / (reach * reach);
            if q2 < 1.0 {
                let weight = share * (1.0 - q2).powi(3);
                let sum = &mut sums[y * canvas.width() + x];
                sum.density += weight;
                sum.in_particle |= q2 * REACH * REACH <= 1.0;
                sum.color = std::array::from_fn(|c| sum.color[c] + weight * color[c]);
            }
        }
    }
    for (place, sum) in sums.into_iter().enumerate() {
        if sum.density > AT_SURFACE || sum.in_particle {
            let color = sum.color.map(|value| value / sum.density);
            *canvas.pixel(place % canvas.width(), place / canvas.width()) = color;
        }
    }
}
