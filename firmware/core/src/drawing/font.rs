//! A font in a texture: rectangles that show a line of text.

use embedded_graphics::geometry::Point;
use embedded_graphics::image::GetPixel;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::BinaryColor;

use crate::colour::Rgb565;
use crate::rectangle::{Part, Rectangle};
use crate::texture::{self, Blend, Picture, Texture, TextureHeader};

/// Width and height of a character in texels.
const CHARACTER: [u16; 2] = [6, 10];
/// Number of characters in a row of the texture.
const IN_ROW: u16 = 16;

/// The characters from the space to `~`, white on a transparent background.
const PICTURE: Picture = Picture {
    size_log2: [7, 6],
    is_cut_out: true,
    is_atlas: true,
    blend: Blend::Opaque,
    texel: |[x, y]| {
        let pixel = FONT_6X10.image.pixel(Point::new(x as i32, y as i32));
        (pixel == Some(BinaryColor::On)).then_some(Rgb565::WHITE)
    },
};

/// A font of the printable ASCII characters, each 6×10 texels large, in a texture.
#[derive(Clone, Copy, Debug)]
pub struct Font<'a> {
    texture: Texture<'a>,
}

impl<'a> Font<'a> {
    /// Length of the texture in bytes.
    pub const BYTES: usize =
        TextureHeader::BYTES + (2 << (PICTURE.size_log2[0] + PICTURE.size_log2[1]));

    /// Writes the texture of the font; `None` if `memory`, which must be aligned to 16 bytes for the triangle engine, is too short.
    pub fn draw(memory: &'a mut [u8]) -> Option<Self> {
        texture::draw(memory, &PICTURE)?;
        let texture = Texture::new_checked(memory).ok()?;
        Some(Self { texture })
    }

    /// The texture that contains all characters of the font.
    pub const fn texture(&self) -> Texture<'a> {
        self.texture
    }

    /// The characters of a line of text, except spaces, each texel `scale` pixels wide and high. `place` is the upper left pixel of the first
    /// character. Characters that are not in the font are shown as `?`.
    pub fn line<'t>(
        &self,
        text: &'t str,
        place: [i16; 2],
        scale: u8,
        colour: Rgb565,
    ) -> impl Iterator<Item = Rectangle<'a>> + use<'a, 't> {
        let texture = self.texture;
        let [width, height] = CHARACTER.map(|side| side * u16::from(scale));
        let [left, top] = place;
        // Columns beyond the largest coordinate are outside of every picture.
        let columns = (i32::from(left)..=i16::MAX.into()).step_by(width.max(1).into());
        // Exact: both ends of the range fit 16 bits.
        let places = columns.map(move |column| [column as i16, top]);
        let shown = text.chars().zip(places).filter(|&(shown, _)| shown != ' ');
        shown.map(move |(shown, place)| {
            // Exact: an ASCII character has 7 bits.
            let number =
                if shown.is_ascii_graphic() { shown } else { '?' } as u16 - u16::from(b' ');
            let part = Part {
                place: [
                    number % IN_ROW * CHARACTER[0],
                    number / IN_ROW * CHARACTER[1],
                ],
                size: CHARACTER,
            };
            Rectangle {
                size: [width, height],
                colour,
                ..Rectangle::new(texture, part, place)
            }
        })
    }
}
