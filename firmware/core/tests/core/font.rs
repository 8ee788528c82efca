//! Tests of the font in a texture against the font's source.

use embedded_graphics::geometry::Point;
use embedded_graphics::image::GetPixel;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::BinaryColor;
use glint_core::colour::Rgb565;
use glint_core::font::Font;
use glint_core::texture::{Filter, Texture};

/// A line has one rectangle for each character except the space, and the rectangle shows the character's part of the texture. Every text
/// gives a line.
#[test]
fn a_line_shows_its_characters() {
    let mut memory = [0; Font::BYTES];
    assert!(Font::draw(&mut memory[1..]).is_none());
    let font = Font::draw(&mut memory).unwrap();
    let texture: Texture = font.texture();
    assert_eq!(texture.bytes().len(), Font::BYTES);
    assert_eq!(
        (texture.levels(), texture.sampler().filter),
        (1, Filter::Nearest)
    );
    let printable: String = (' '..='~').collect();
    let text = printable.clone() + "é\n\u{7f}";
    let colour = Rgb565(0x07E0);
    let line: Vec<_> = font.line(&text, [-20, 7], 3, colour).collect();
    let characters = text.chars().enumerate().filter(|&(_, c)| c != ' ');
    assert_eq!(line.len(), characters.clone().count());
    for (rectangle, (number, character)) in line.iter().zip(characters) {
        assert_eq!(rectangle.place, [-20 + 18 * number as i16, 7]);
        assert_eq!((rectangle.size, rectangle.colour), ([18, 30], colour));
        let known = if printable.contains(character) {
            character
        } else {
            '?'
        };
        let index = FONT_6X10.glyph_mapping.index(known) as i32;
        let [left, top] = rectangle.part.place.map(u32::from);
        for (x, y) in (0..10).flat_map(|y| (0..6).map(move |x| (x, y))) {
            let pixel = Point::new(index % 16 * 6 + x, index / 16 * 10 + y);
            let is_on = FONT_6X10.image.pixel(pixel) == Some(BinaryColor::On);
            let texel = texture.colour(0, [left + x as u32, top + y as u32]);
            assert_eq!(texel, is_on.then_some(Rgb565::WHITE), "{character:?}");
        }
    }
    // Characters beyond the largest coordinate are left out.
    assert_eq!(font.line(&text, [i16::MAX - 6, 0], 1, colour).count(), 1);
    assert_eq!(font.line("ab", [i16::MIN; 2], 0, colour).count(), 2);
}
