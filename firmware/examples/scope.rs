//! An oscilloscope for the accelerometer: three traces of the latest samples. The buttons up and down change the range, and left freezes
//! the traces or releases them.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use glint_program::core::light::Background;
use glint_program::core::picture::{Samples, Size};
use glint_program::graphics::Drawable;
use glint_program::graphics::geometry::Point;
use glint_program::graphics::mono_font::ascii::FONT_9X18;
use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
use glint_program::graphics::primitives::{Line, Polyline, Primitive, PrimitiveStyle};
use glint_program::{Board, Button, Canvas, Picture, PictureError, Program};

/// Number of samples in a trace.
const LENGTH: usize = 560;
/// Left edge of the traces, in pixels.
const LEFT: i32 = 60;
/// Row of the value 0, and half the height of the traces, in pixels.
const MIDDLE: i32 = 180;
const HALF: i32 = 150;
/// Sensor counts per g.
const G: i32 = 4096;
const TRACES: [(&str, Rgb565); 3] = [
    ("x", Rgb565::new(31, 20, 8)),
    ("y", Rgb565::new(8, 56, 12)),
    ("z", Rgb565::new(10, 36, 31)),
];

struct Scope {
    /// The latest samples of each axis: a ring buffer, whose oldest sample is at `next`.
    traces: [[i16; LENGTH]; 3],
    next: usize,
    /// The traces show accelerations from −`range` to `range`, in g.
    range: i32,
    is_held: bool,
    has_sensor: bool,
}

impl Program for Scope {
    fn start(_: &mut Board) -> Self {
        Self {
            traces: [[0; LENGTH]; 3],
            next: 0,
            range: 2,
            is_held: false,
            has_sensor: false,
        }
    }

    fn update(&mut self, board: &mut Board) {
        if board.is_pressed(Button::Up) {
            self.range = (self.range * 2).min(8);
        }
        if board.is_pressed(Button::Down) {
            self.range = (self.range / 2).max(1);
        }
        self.is_held ^= board.is_pressed(Button::Left);
        board.leds = u16::from(self.is_held);
        self.has_sensor = board.motion().is_some();
        if self.is_held {
            return;
        }
        for sample in board.samples() {
            for (trace, value) in self.traces.iter_mut().zip(sample.accel) {
                trace[self.next] = value;
            }
            self.next = (self.next + 1) % LENGTH;
        }
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.size = Size::W640;
        picture.samples = Samples::One;
        picture.appearance.background = Some(Background::Colour([8, 12, 16]));
        Ok(())
    }

    fn paint(&self, canvas: &mut Canvas) {
        let grid = PrimitiveStyle::with_stroke(Rgb565::new(6, 14, 8), 1);
        for step in -4..=4 {
            let y = MIDDLE + step * HALF / 4;
            let line = Line::new(Point::new(LEFT, y), Point::new(LEFT + LENGTH as i32, y));
            // Drawing never fails.
            let Ok(()) = line.into_styled(grid).draw(canvas);
        }
        for (sign, y) in [("+", MIDDLE - HALF), ("-", MIDDLE + HALF)] {
            let text = format_args!("{sign}{} g", self.range);
            canvas.text([8, y - 9], &FONT_9X18, Rgb565::WHITE, text);
        }
        if !self.has_sensor {
            let text = format_args!("no motion sensor on this board");
            canvas.text([LEFT + 140, 40], &FONT_9X18, Rgb565::WHITE, text);
        }
        for (column, ((name, colour), trace)) in (0..).zip(TRACES.iter().zip(&self.traces)) {
            let mut points = [Point::zero(); LENGTH];
            let (newer, older) = trace.split_at(self.next);
            let samples = older.iter().chain(newer);
            for ((x, point), &value) in (LEFT..).zip(&mut points).zip(samples) {
                let height = i32::from(value) * HALF / (G * self.range);
                *point = Point::new(x, MIDDLE - height.clamp(-HALF, HALF));
            }
            let style = PrimitiveStyle::with_stroke(*colour, 1);
            let Ok(()) = Polyline::new(&points).into_styled(style).draw(canvas);
            let at = [LEFT + 18 * column, 6];
            canvas.text(at, &FONT_9X18, *colour, format_args!("{name}"));
        }
    }
}

glint_program::run!(Scope);
