//! Deliberate faults, which show the messages of a board: switch 0 causes a panic, 1 an endless loop, 2 an endless recursion, 3 an invalid
//! picture, 4 an illegal instruction. After the message, Enter on the console restarts the program.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]

use core::hint::black_box;

use glint_program::core::fixed::Q8_24;
use glint_program::core::matrix::Matrix;
use glint_program::graphics::mono_font::ascii::FONT_10X20;
use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
use glint_program::{Board, Canvas, Picture, PictureError, Program};

const FAULTS: [&str; 5] = [
    "panic",
    "endless loop",
    "endless recursion",
    "faulty picture",
    "illegal instruction",
];

#[derive(Default)]
struct Faults {
    /// Whether the next picture is to be invalid.
    is_faulty: bool,
}

/// Recurses endlessly. The argument prevents the compiler from replacing the recursion by a loop.
#[expect(unconditional_recursion, reason = "a fault on purpose")]
fn recurse(depth: u64) -> u64 {
    let kept = black_box([depth; 8]);
    recurse(black_box(depth + 1)) + kept[3]
}

impl Program for Faults {
    fn start(board: &mut Board) -> Self {
        board.log(format_args!("faults: switches 0 to 4"));
        Self::default()
    }

    fn update(&mut self, board: &mut Board) {
        match board.switches().trailing_zeros() {
            0 => panic!("a fault on purpose"),
            1 => while black_box(true) {},
            2 => board.log(format_args!("{}", recurse(0))),
            3 => self.is_faulty = true,
            #[cfg(target_arch = "riscv32")]
            // SAFETY: the instruction has no effect but the trap.
            4 => unsafe { core::arch::asm!("unimp") },
            _ => {}
        }
    }

    fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> {
        if self.is_faulty {
            // A scale of 0 is not a valid model matrix.
            Matrix::scale([Q8_24::ZERO; 3])?;
        }
        Ok(())
    }

    fn paint(&self, canvas: &mut Canvas) {
        for (row, fault) in (0..).zip(FAULTS) {
            let text = format_args!("switch {row}: {fault}");
            canvas.text([40, 40 + 30 * row], &FONT_10X20, Rgb565::WHITE, text);
        }
    }
}

glint_program::run!(Faults);
