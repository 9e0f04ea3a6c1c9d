//! A picture of a frame: the particles, a title, the time, and the colour bar; drawn without a viewer and
//! without a screen.

mod annotate;
mod canvas;
mod depth;
mod plane;
mod smooth;
mod text;
mod view;

use crate::reading::RecordedFrame;
use canvas::Canvas;
use view::View;

/// Style of a drawn frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawStyle {
    /// Width \[pixels\].
    pub width: usize,
    /// Height \[pixels\].
    pub height: usize,
    /// Whether bodies are drawn as closed surfaces in place of particles.
    pub smooth: bool,
}

/// Draws a frame; the content of a PNG file.
///
/// # Errors
///
/// The picture cannot be encoded.
pub fn draw(frame: &RecordedFrame, look: DrawStyle) -> Result<Vec<u8>, png::EncodingError> {
    let mut canvas = Canvas::new(look.width, look.height);
    let area = annotate::Area::of(&canvas, frame);
    // Edges are smoothed by drawing the particles at twice the size.
    let mut bodies = Canvas::new(2 * area.width(), 2 * area.height());
    let view = View::new(frame, bodies.width(), bodies.height());
    match (view.is_plane(), look.smooth) {
        (true, false) => plane::draw(&mut bodies, frame, &view),
        (true, true) => smooth::plane(&mut bodies, frame, &view),
        (false, smooth) => depth::draw(&mut bodies, frame, &view, smooth),
    }
    canvas.put_halved(&bodies, area.top());
    annotate::draw(&mut canvas, &area, frame, &view);
    canvas.png()
}
