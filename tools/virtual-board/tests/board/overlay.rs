//! Tests of the text overlay.

use std::convert::Infallible;
use virtual_board::{Simulation, Uart};

use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Drawable, Pixel};
use emulated_board::EmulatedBoard;

use crate::firmware::{command, emulated, image, value};

/// Width of the smallest picture, in pixels.
const WIDTH: usize = 320;
/// Number of pixels of the smallest picture.
const PIXELS: usize = WIDTH * 180;
/// Width and height of a character, in pixels.
const CELL: [usize; 2] = [6, 10];
/// Margin between the text and the edges of the picture, in pixels.
const MARGIN: usize = 4;
/// Height of a line of text, in pixels.
const LINE: usize = 11;

/// The pixels of the last frame, which has the smallest size.
fn frame(board: &mut EmulatedBoard) -> Vec<u16> {
    let answer = command(board, "info frame");
    let word = answer
        .split_once("frame 0x")
        .map(|(_, rest)| &rest[..8])
        .expect("an address");
    let address = u32::from_str_radix(word, 16).expect("an address");
    let mut bytes = vec![0; 2 * PIXELS];
    board.read_memory(address, &mut bytes).expect("main RAM");
    let (pixels, _) = bytes.as_chunks();
    pixels
        .iter()
        .map(|pixel| u16::from_le_bytes(*pixel))
        .collect()
}

/// The pixels of a character.
#[derive(Default, PartialEq)]
struct Glyph([[bool; CELL[0]]; CELL[1]]);

impl OriginDimensions for Glyph {
    fn size(&self) -> Size {
        Size::new(CELL[0] as u32, CELL[1] as u32)
    }
}

impl DrawTarget for Glyph {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, colour) in pixels {
            self.0[y as usize][x as usize] = colour.is_on();
        }
        Ok(())
    }
}

/// Reads a line of text in a frame, up to the first cell that is not a character.
fn text(frame: &[u16], line: usize) -> String {
    let style = MonoTextStyle::new(&FONT_6X10, BinaryColor::On);
    let glyphs: Vec<(char, Glyph)> = (' '..='~')
        .map(|c| {
            let mut glyph = Glyph::default();
            let text = c.to_string();
            let text = Text::with_baseline(&text, Point::zero(), style, Baseline::Top);
            let Ok(_) = text.draw(&mut glyph);
            (c, glyph)
        })
        .collect();
    let cells = (MARGIN..WIDTH - CELL[0])
        .step_by(CELL[0])
        .map_while(|left| {
            let mut cell = Glyph::default();
            for (y, row) in cell.0.iter_mut().enumerate() {
                for (x, pixel) in row.iter_mut().enumerate() {
                    let place = (MARGIN + line * LINE + y) * WIDTH + left + x;
                    *pixel = match frame[place] {
                        0 => false,
                        0xffff => true,
                        _ => return None,
                    };
                }
            }
            let glyph = glyphs.iter().find(|(_, glyph)| *glyph == cell);
            glyph.map(|(c, _)| *c)
        });
    cells.collect()
}

#[test]
fn the_overlay_says_what_is_shown_and_goes_again() {
    let (mut board, _) = emulated(&image());
    // A background that is neither black nor white, the colours of the text.
    command(&mut board, "size 320 180");
    command(&mut board, "field box:0.5,0.5,0.5");
    command(&mut board, "background sky");
    command(&mut board, "render");
    let plain = frame(&mut board);
    command(&mut board, "overlay on");
    let stats = command(&mut board, "render");
    let cycles: u64 = value(&stats, "cycles").parse().expect("a number");
    let hertz = u64::from(board.clock_hz());
    // Drawn twice, so that both frame buffers have the text.
    for _ in 0..2 {
        let over = frame(&mut board);
        assert_eq!(text(&over, 0), "box:0.5,0.5,0.5");
        let stated = text(&over, 1);
        let start = "320x180 by gateware: ";
        let (start, end) = stated.split_at_checked(start.len()).expect("a line");
        assert_eq!(start, "320x180 by gateware: ");
        let words: Vec<&str> = end.split(' ').collect();
        let [drawn, "cycles,", rate, "fps"] = words[..] else {
            panic!("{stated}");
        };
        let (drawn, rate): (u64, u64) = (drawn.parse().unwrap(), rate.parse().unwrap());
        assert_eq!(rate, hertz / drawn);
        assert!(drawn.abs_diff(cycles) < cycles / 10, "{drawn} and {cycles}");
        let mut same = plain.iter().zip(&over).enumerate();
        assert!(
            same.all(|(place, (plain, over))| {
                plain == over || (MARGIN..MARGIN + 2 * LINE).contains(&(place / WIDTH))
            }),
            "only the lines of the text change"
        );
        command(&mut board, "render");
    }
    assert!(command(&mut board, "overlay").contains("overlay on\r\nok"));
    command(&mut board, "overlay off");
    for _ in 0..2 {
        command(&mut board, "render");
        assert!(frame(&mut board) == plain);
    }
}
