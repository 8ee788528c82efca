//! Text overlay in the upper left corner of a picture.

use core::convert::Infallible;
use core::fmt;

use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size as Area};
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::mono_font::{MonoTextStyle, MonoTextStyleBuilder};
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::prelude::RgbColor;
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Drawable, Pixel};
use glint_core::picture::Size;

/// Margin between the text and the edges of the picture, in pixels.
const MARGIN: i32 = 4;
/// Height of a line of text, in pixels.
const LINE: i32 = 11;

/// Writes text on a picture, white on black. Text beyond the edges is clipped.
pub struct Overlay<'a> {
    picture: Picture<'a>,
    style: MonoTextStyle<'static, Rgb565>,
    place: Point,
}

impl<'a> Overlay<'a> {
    /// An overlay on the picture `colours`, RGB565 row by row.
    pub fn new(colours: &'a mut [u16], size: Size) -> Self {
        let style = MonoTextStyleBuilder::new()
            .font(&FONT_6X10)
            .text_color(Rgb565::WHITE)
            .background_color(Rgb565::BLACK)
            .build();
        Self {
            picture: Picture { colours, size },
            style,
            place: Point::new(MARGIN, MARGIN),
        }
    }

    /// Writes a line, and moves to the next line.
    pub fn line(&mut self, text: fmt::Arguments) {
        // Drawing never fails.
        let _ = fmt::write(self, text);
        self.place = Point::new(MARGIN, self.place.y + LINE);
    }
}

impl fmt::Write for Overlay<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let text = Text::with_baseline(text, self.place, self.style, Baseline::Top);
        let Ok(next) = text.draw(&mut self.picture);
        self.place = next;
        Ok(())
    }
}

/// A picture as a drawing target. Pixels outside of the picture are ignored.
struct Picture<'a> {
    colours: &'a mut [u16],
    size: Size,
}

impl OriginDimensions for Picture<'_> {
    fn size(&self) -> Area {
        let [width, height] = self.size.pixels();
        Area::new(width, height)
    }
}

impl DrawTarget for Picture<'_> {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        let [width, height] = self.size.pixels();
        for Pixel(Point { x, y }, colour) in pixels {
            // Negative coordinates become large numbers, which are outside of the picture.
            let (x, y) = (x as u32, y as u32);
            if x < width
                && y < height
                && let Some(pixel) = self.colours.get_mut((y * width + x) as usize)
            {
                *pixel = RawU16::from(colour).into_inner();
            }
        }
        Ok(())
    }
}
