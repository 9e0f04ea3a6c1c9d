//! Text in a picture.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};

use super::canvas::{Canvas, Rgb};

/// Where text is put relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    Left,
    Middle,
    Right,
}

/// Draws one line of text with its base line at `at`, `size` pixels high.
pub fn write(canvas: &mut Canvas, text: &str, at: [f32; 2], size: f32, align: Align, color: Rgb) {
    let Ok(font) = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT) else { return };
    let font = font.as_scaled(PxScale::from(size));
    let letters: Vec<_> = text.chars().filter(|letter| !letter.is_control()).collect();
    let width: f32 = letters.iter().map(|&letter| font.h_advance(font.glyph_id(letter))).sum();
    let mut x = match align {
        Align::Left => at[0],
        Align::Middle => at[0] - 0.5 * width,
        Align::Right => at[0] - width,
    };
    for letter in letters {
        let id = font.glyph_id(letter);
        let glyph = id.with_scale_and_position(font.scale(), point(x, at[1]));
        x += font.h_advance(id);
        let Some(outline) = font.outline_glyph(glyph) else { continue };
        let corner = outline.px_bounds().min;
        outline.draw(|column, row, share| {
            let (left, top) = (corner.x.round() as i32, corner.y.round() as i32);
            canvas.cover(left + column as i32, top + row as i32, color, share);
        });
    }
}
