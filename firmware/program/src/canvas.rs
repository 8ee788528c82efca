//! The drawn picture as a draw target of `embedded-graphics`.

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

/// Access to the pixels of the drawn picture.
///
/// ```
/// use glint_program::Pixels;
///
/// struct Memory(Vec<u16>);
///
/// impl Pixels for Memory {
///     fn pixels(&mut self) -> &mut [u16] {
///         &mut self.0
///     }
/// }
///
/// let mut memory = Memory(vec![0xffff; 4]);
/// memory.pixels()[2] = 0;
/// assert_eq!(memory.0, [0xffff, 0xffff, 0, 0xffff]);
/// ```
pub trait Pixels {
    /// Colours in RGB565, row by row; empty while there is no picture. After this call, the renderer redraws every pixel for the next
    /// picture.
    ///
    /// ```
    /// use glint_program::Pixels;
    /// use glint_program::core::colour::Rgb565;
    ///
    /// /// Turns the picture into its negative.
    /// fn invert(source: &mut dyn Pixels) {
    ///     for colour in source.pixels() {
    ///         *colour = !*colour;
    ///     }
    /// }
    /// # struct One([u16; 1]);
    /// # impl Pixels for One { fn pixels(&mut self) -> &mut [u16] { &mut self.0 } }
    /// # let mut black = One([0]);
    /// # invert(&mut black);
    /// # assert_eq!(black.0, [Rgb565::WHITE.0]);
    /// ```
    fn pixels(&mut self) -> &mut [u16];
}

/// The picture that was just drawn, as a [`DrawTarget`] of the crate `embedded-graphics` in RGB565. The soft core writes the pixels, so use
/// the canvas only for text and small shapes. Pixels outside of the picture are ignored.
///
/// ```
/// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
/// use glint_program::Canvas;
/// use glint_program::graphics::Drawable;
/// use glint_program::graphics::geometry::Point;
/// use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
/// use glint_program::graphics::primitives::{Circle, Primitive, PrimitiveStyle};
///
/// # struct Sight;
/// # impl Program for Sight {
/// #     fn start(_: &mut Board) -> Self { Self }
/// #     fn update(&mut self, _: &mut Board) {}
/// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
/// fn paint(&self, canvas: &mut Canvas) {
///     let circle = Circle::with_center(Point::new(320, 180), 41);
///     let Ok(()) = circle.into_styled(PrimitiveStyle::with_stroke(Rgb565::GREEN, 1)).draw(canvas);
/// }
/// # }
/// # let mut host = Host::<Sight>::start();
/// # host.run(1)?;
/// # assert_eq!(host.picture()[180 * 640 + 340], 0x07e0);
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
pub struct Canvas<'c> {
    source: &'c mut dyn Pixels,
    size: Size,
}

impl<'c> Canvas<'c> {
    /// A canvas on the picture of `source`, which has this size.
    ///
    /// ```
    /// # struct Memory(Vec<u16>);
    /// # impl glint_program::Pixels for Memory { fn pixels(&mut self) -> &mut [u16] { &mut self.0 } }
    /// use glint_program::Canvas;
    /// use glint_program::core::picture::Size;
    /// use glint_program::graphics::draw_target::DrawTarget;
    /// use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
    ///
    /// let mut memory = Memory(vec![0; Size::W320.pixel_count()]);
    /// let Ok(()) = Canvas::new(&mut memory, Size::W320).clear(Rgb565::BLUE);
    /// assert!(memory.0.iter().all(|&colour| colour == 0x001f));
    /// ```
    pub fn new(source: &'c mut dyn Pixels, size: Size) -> Self {
        Self { source, size }
    }

    /// Writes text whose upper left corner is at `place`. Returns the position after the last character.
    ///
    /// ```
    /// # struct Memory(Vec<u16>);
    /// # impl glint_program::Pixels for Memory { fn pixels(&mut self) -> &mut [u16] { &mut self.0 } }
    /// # let mut memory = Memory(vec![0; 320 * 180]);
    /// # let mut canvas = glint_program::Canvas::new(&mut memory, glint_program::core::picture::Size::W320);
    /// use glint_program::graphics::mono_font::ascii::FONT_10X20;
    /// use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
    ///
    /// let next = canvas.text([8, 8], &FONT_10X20, Rgb565::WHITE, format_args!("score "));
    /// assert_eq!(next, [8 + 6 * 10, 8]);
    /// canvas.text(next, &FONT_10X20, Rgb565::YELLOW, format_args!("{}", 17));
    /// # assert!(memory.0.contains(&0xffe0));
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

/// A writer that draws each piece of formatted text.
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
