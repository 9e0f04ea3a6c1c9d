//! From the positions of particles to the pixels of a picture.

use meshless_engine::scene::Dimension;

use crate::camera::{OPENING, Viewpoint, across, dot, unit};
use crate::reading::RecordedFrame;

/// A ball in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its centre, pixels to the right and down.
    pub center: [f32; 2],
    /// Its radius \[pixels\].
    pub radius: f32,
    /// Distance of its centre from the eye, along the line of sight \[m\].
    pub depth: f32,
}

/// A camera with all particles of all frames in view.
pub struct View {
    eye: Viewpoint,
    back: [f64; 3],
    right: [f64; 3],
    top: [f64; 3],
    middle: [f64; 2],
    /// Pixels per unit of x / depth.
    focus: f64,
    plane: bool,
}

impl View {
    /// The view of a frame in a picture of that size.
    pub fn new(frame: &RecordedFrame, width: usize, height: usize) -> Self {
        let plane = frame.bodies.iter().flat_map(|body| &body.positions).all(|place| place[2] == 0.0);
        let dimension = if plane { Dimension::Two } else { Dimension::Three };
        let eye = Viewpoint::on(&frame.bounds, dimension, frame.up, width as f64 / height as f64);
        let back = unit(std::array::from_fn(|k| eye.position[k] - eye.target[k]));
        let [right, top] = across(eye.up, back);
        let middle = [0.5 * width as f64, 0.5 * height as f64];
        Self { eye, back, right, top, middle, focus: middle[1] / OPENING, plane }
    }

    /// Whether the scene is plane.
    pub fn is_plane(&self) -> bool {
        self.plane
    }

    /// A particle in the picture; nothing if it is behind the eye or its position is no number.
    pub fn ball(&self, position: [f32; 3], radius: f32) -> Option<Ball> {
        let arm: [f64; 3] = std::array::from_fn(|k| f64::from(position[k]) - self.eye.position[k]);
        let depth = -dot(arm, self.back);
        if !(depth > 0.0 && arm.iter().all(|x| x.is_finite())) {
            return None;
        }
        let per_metre = self.focus / depth;
        let x = self.middle[0] + per_metre * dot(arm, self.right);
        let y = self.middle[1] - per_metre * dot(arm, self.top);
        let radius = per_metre * f64::from(radius);
        Some(Ball { center: [x as f32, y as f32], radius: radius as f32, depth: depth as f32 })
    }

    /// Pixels per metre at the middle of what is in view.
    pub fn scale(&self) -> f32 {
        let arm: [f64; 3] = std::array::from_fn(|k| self.eye.target[k] - self.eye.position[k]);
        (self.focus / -dot(arm, self.back)) as f32
    }

    /// The direction of a coordinate axis in the picture: pixels to the right and down for a length of 1.
    pub fn axis(&self, k: usize) -> [f32; 2] {
        [self.right[k] as f32, -self.top[k] as f32]
    }
}
