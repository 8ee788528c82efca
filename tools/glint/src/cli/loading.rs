//! Loading a program by the BIOS of a board.

use super::progress::{advance, bar, spinner};
use glint::board::Board;
use glint::flash::{self, Report};
use glint_program_image::START_ADDRESS;

/// Longest wait for the BIOS's request by default, in seconds of the board's time.
pub const WAIT_SECONDS: u64 = 60;
/// Longest wait for the first text of a program, in milliseconds of the board's time.
const START_MS: u64 = 10_000;

/// How a program is loaded by the BIOS of a board.
pub struct Loading {
    /// Load address and entry point.
    pub address: u32,
    /// Longest wait for the BIOS's request, in milliseconds of the board's time.
    pub wait_ms: u64,
    /// Whether a program that prints no text is an error.
    pub awaits_text: bool,
}

impl Loading {
    /// Loading to the start of main memory, of a program that need not print text.
    pub const USUAL: Self = Self {
        address: START_ADDRESS,
        wait_ms: 1000 * WAIT_SECONDS,
        awaits_text: false,
    };

    /// Loads and starts a program, with progress.
    ///
    /// # Errors
    /// No BIOS answers in time, the transfer fails, or the program prints no text.
    pub fn load(&self, board: &mut dyn Board, program: &[u8]) -> anyhow::Result<Report> {
        let waiting = spinner("waiting for the BIOS; if this takes long, reset the board");
        let bar = bar("program");
        let report = flash::flash(
            board,
            program,
            self.address,
            self.wait_ms,
            &mut |done, all| {
                waiting.finish();
                advance(&bar)(done, all);
            },
        )?;
        bar.finish();
        if self.awaits_text {
            let starting = spinner("waiting for the program's text");
            flash::await_text(board, &report.said, START_MS)?;
            starting.finish();
        }
        Ok(report)
    }
}
