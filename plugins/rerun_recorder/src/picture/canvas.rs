//! A picture in memory.

use crate::recording::BACKGROUND;

/// A colour, red, green and blue from 0 to 1.
pub type Rgb = [f32; 3];

/// Colour from its bytes.
pub fn rgb(color: [u8; 3]) -> Rgb {
    color.map(|value| f32::from(value) / 255.0)
}

/// The colours of all pixels, row by row from the top.
pub struct Canvas {
    width: usize,
    pixels: Vec<Rgb>,
}

impl Canvas {
    /// A picture that is all background.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, pixels: vec![rgb(BACKGROUND); width * height] }
    }

    pub fn width(&self) -> usize {
        self.width
    }

    pub fn height(&self) -> usize {
        self.pixels.len() / self.width.max(1)
    }

    /// The pixel in a column and row.
    pub fn pixel(&mut self, x: usize, y: usize) -> &mut Rgb {
        &mut self.pixels[y * self.width + x]
    }

    /// Lays a colour over a pixel, covering that share of it; nothing outside of the picture.
    pub fn cover(&mut self, x: i32, y: i32, color: Rgb, share: f32) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x < self.width && y < self.height() {
            let pixel = self.pixel(x, y);
            for (old, new) in pixel.iter_mut().zip(color) {
                *old += share.clamp(0.0, 1.0) * (new - *old);
            }
        }
    }

    /// A line of two pixels' width.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], color: Rgb) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let least = |k: usize| from[k].min(to[k]).floor() as i32 - 2;
        let most = |k: usize| from[k].max(to[k]).ceil() as i32 + 2;
        for y in least(1)..=most(1) {
            for x in least(0)..=most(0) {
                let arm = [x as f32 + 0.5 - from[0], y as f32 + 0.5 - from[1]];
                let share = if square > 0.0 {
                    ((arm[0] * along[0] + arm[1] * along[1]) / square).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let distance = (arm[0] - share * along[0]).hypot(arm[1] - share * along[1]);
                self.cover(x, y, color, 1.5 - distance);
            }
        }
    }

    /// Puts a picture of twice the width below the upper edge `top`.
    pub fn put_halved(&mut self, large: &Self, top: usize) {
        for y in 0..large.height() / 2 {
            for x in 0..large.width / 2 {
                let mut sum = [0.0; 3];
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let part = large.pixels[(2 * y + dy) * large.width + 2 * x + dx];
                    sum = std::array::from_fn(|k| sum[k] + 0.25 * part[k]);
                }
                *self.pixel(x, top + y) = sum;
            }
        }
    }

    /// The content of a PNG file.
    pub fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let side = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX);
        let mut encoder = png::Encoder::new(&mut bytes, side(self.width), side(self.height()));
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        let data: Vec<u8> =
            self.pixels.iter().flatten().map(|value| (value.clamp(0.0, 1.0) * 255.0).round() as u8).collect();
        writer.write_image_data(&data)?;
        writer.finish()?;
        Ok(bytes)
    }
}
