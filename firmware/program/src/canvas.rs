//! The drawn picture as a target of `embedded-graphics`.

use core::convert::Infallible;
use core::fmt;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size as Area};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use glint_core::picture::Size;

/// Lends the pixels of the drawn picture.
pub trait Pixels {
    /// Colours in RGB565, row by row; empty while there is no picture. The next picture is then drawn on every pixel.
    fn pixels(&mut self) -> &mut [u16];
}

/// The picture that was just drawn, as a [`DrawTarget`] of the crate `embedded-graphics` in RGB565. The soft core writes the pixels, so
/// it is for text and small shapes. Pixels outside of the picture are ignored.
pub struct Canvas<'c> {
    source: &'c mut dyn Pixels,
    size: Size,
}

impl<'c> Canvas<'c> {
    /// The picture of this size that `source` lends.
    pub fn new(source: &'c mut dyn Pixels, size: Size) -> Self {
        Self { source, size }
    }

    /// Writes text from its upper left corner `place` on. Returns the place after the last character.
    ///
    /// ```
    /// # fn paint(canvas: &mut glint_program::Canvas) {
    /// use glint_program::graphics::mono_font::ascii::FONT_10X20;
    /// use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
    /// canvas.text([8, 8], &FONT_10X20, Rgb565::WHITE, format_args!("score {}", 17));
    /// # }
    /// ```
    pub fn text(
        &mut self,
        place: [i32; 2],
        font: &MonoFont,
        colour: Rgb565,
        text: fmt::Arguments,
    ) -> [i32; 2] {
        let [x, y] = place;
        let mut line = Line {
            place: Point::new(x, y),
            style: MonoTextStyle::new(font, colour),
            canvas: self,
        };
        // Drawing never fails.
        let _ = fmt::write(&mut line, text);
        [line.place.x, line.place.y]
    }
}

/// A line of text in progress.
struct Line<'l, 'c, 'f> {
    canvas: &'l mut Canvas<'c>,
    style: MonoTextStyle<'f, Rgb565>,
    place: Point,
}

impl fmt::Write for Line<'_, '_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        use embedded_graphics::Drawable;
        let text = Text::with_baseline(text, self.place, self.style, Baseline::Top);
        let Ok(next) = text.draw(self.canvas);
        self.place = next;
        Ok(())
    }
}

impl OriginDimensions for Canvas<'_> {
    fn size(&self) -> Area {
        let [width, height] = self.size.pixels();
        Area::new(width, height)
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        let [width, height] = self.size.pixels();
        let colours = self.source.pixels();
        for Pixel(Point { x, y }, colour) in pixels {
            // Negative coordinates become large numbers, which are outside of the picture.
            let (x, y) = (x as u32, y as u32);
            if x < width
                && y < height
                && let Some(pixel) = colours.get_mut((y * width + x) as usize)
            {
                *pixel = RawU16::from(colour).into_inner();
            }
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, colour: Rgb565) -> Result<(), Infallible> {
        let [width, height] = self.size.pixels();
        let bounds = Rectangle::new(Point::zero(), Area::new(width, height));
        let area = area.intersection(&bounds);
        // Coordinates in the picture are not negative.
        let [left, top] = [area.top_left.x, area.top_left.y].map(|x| x as usize);
        let colours = self.source.pixels();
        for row in top..top + area.size.height as usize {
            let start = row * width as usize + left;
            let row = colours.get_mut(start..start + area.size.width as usize);
            row.unwrap_or_default()
                .fill(RawU16::from(colour).into_inner());
        }
        Ok(())
    }
}
