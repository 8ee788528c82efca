//! A benchmark of code in a program: the clock cycles of three square root functions on the soft core, as bars and on the serial line.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use core::hint::black_box;

use glint_program::core::light::Background;
use glint_program::core::picture::Size as PictureSize;
use glint_program::graphics::Drawable;
use glint_program::graphics::geometry::{Point, Size};
use glint_program::graphics::mono_font::ascii::FONT_10X20;
use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
use glint_program::graphics::primitives::{Primitive, PrimitiveStyle, Rectangle};
use glint_program::{Board, Canvas, Picture, PictureError, Program, cycles};

/// Name and function of a kernel, the measured code.
type Kernel = (&'static str, fn(u32) -> u32);

const KERNELS: [Kernel; 3] = [
    ("library", u32::isqrt),
    ("digit by digit", digit_by_digit),
    ("newton", newton),
];
/// Number of calls of a kernel in one measurement.
const CALLS: u32 = 64;

fn digit_by_digit(mut rest: u32) -> u32 {
    let (mut root, mut bit) = (0, 1 << 30);
    while bit > 0 {
        let trial = root + bit;
        root >>= 1;
        if rest >= trial {
            rest -= trial;
            root += bit;
        }
        bit >>= 2;
    }
    root
}

fn newton(square: u32) -> u32 {
    let mut root = 1 << (32 - square.leading_zeros()).div_ceil(2);
    if square == 0 {
        return 0;
    }
    loop {
        let next = (root + square / root) / 2;
        if next >= root {
            return root;
        }
        root = next;
    }
}

#[derive(Default)]
struct Bench {
    /// Clock cycles per call of each kernel.
    cycles: [u64; KERNELS.len()],
}

impl Program for Bench {
    fn start(_: &mut Board) -> Self {
        Self::default()
    }

    fn update(&mut self, board: &mut Board) {
        // Measures once per second.
        if !board.pictures().is_multiple_of(60) {
            return;
        }
        for ((name, kernel), result) in KERNELS.iter().zip(&mut self.cycles) {
            let start = cycles();
            for call in 0..CALLS {
                black_box(kernel(black_box(call.wrapping_mul(0x0345_6789))));
            }
            *result = (cycles() - start) / u64::from(CALLS);
            board.log(format_args!("{name}: {result} cycles per root"));
        }
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.size = PictureSize::W640;
        picture.appearance.background = Some(Background::Colour([16, 24, 32]));
        Ok(())
    }

    fn paint(&self, canvas: &mut Canvas) {
        let longest = self.cycles.iter().max().copied().unwrap_or(0).max(1);
        for ((row, (name, _)), cycles) in (0..).zip(&KERNELS).zip(self.cycles) {
            let top = 40 + 90 * row;
            let text = format_args!("{name}: {cycles} cycles");
            canvas.text([40, top], &FONT_10X20, Rgb565::WHITE, text);
            let width = (cycles * 520 / longest) as u32;
            let bar = Rectangle::new(Point::new(40, top + 26), Size::new(width, 32));
            // Drawing never fails.
            let Ok(()) = bar
                .into_styled(PrimitiveStyle::with_fill(Rgb565::new(8, 44, 24)))
                .draw(canvas);
        }
    }
}

glint_program::run!(Bench);
