//! Text overlay in the upper left corner of a picture.

use core::fmt;

use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::mono_font::{MonoTextStyle, MonoTextStyleBuilder};
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::prelude::RgbColor;
use embedded_graphics::text::{Baseline, Text};
use glint_core::picture::Size;
use glint_program::Canvas;
use glint_program::renderer::Renderer;

/// Margin between the text and the edges of the picture, in pixels.
const MARGIN: i32 = 4;
/// Height of a line of text, in pixels.
const LINE: i32 = 11;

/// Writes text on a picture, white on black. Text beyond the edges is clipped.
pub struct Overlay<'a> {
    canvas: Canvas<'a>,
    style: MonoTextStyle<'static, Rgb565>,
    place: Point,
}

impl<'a> Overlay<'a> {
    /// Creates an overlay on the picture of this size that was just drawn.
    pub fn new(renderer: &'a mut Renderer, size: Size) -> Self {
        let style = MonoTextStyleBuilder::new()
            .font(&FONT_6X10)
            .text_color(Rgb565::WHITE)
            .background_color(Rgb565::BLACK)
            .build();
        Self {
            canvas: Canvas::new(renderer, size),
            style,
            place: Point::new(MARGIN, MARGIN),
        }
    }

    /// Writes a line of text, and moves to the next line.
    pub fn line(&mut self, text: fmt::Arguments) {
        // Drawing never fails.
        let _ = fmt::write(self, text);
        self.place = Point::new(MARGIN, self.place.y + LINE);
    }
}

impl fmt::Write for Overlay<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let text = Text::with_baseline(text, self.place, self.style, Baseline::Top);
        let Ok(next) = text.draw(&mut self.canvas);
        self.place = next;
        Ok(())
    }
}
