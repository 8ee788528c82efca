//! Brings a board to its serial boot from any state in which an earlier program may have left the
//! board.
//!
//! | state | input that ends it |
//! |---|---|
//! | the BIOS waits for frames of a boot whose host has ended | the frame [`END_BOOT`] |
//! | the firmware is in a transfer | the frame [`wire::reset`] |
//! | the firmware waits for a command, or the BIOS shows its prompt | the command `reboot` |
//!
//! The host sends all three, in this order. Then the BIOS sends its request.

use super::link::{FlashError, Link};
use crate::console::END_BOOT;
use crate::line::{Board, BoardError};
use glint_core::wire::{self, MAX_FRAME};

/// Text that the BIOS sends when it is ready for a serial boot.
pub const REQUEST: &[u8] = b"sL5DdSMmkekro\n";
/// Answer to [`REQUEST`] that starts the transfer.
pub const ACCEPT: &[u8] = b"z6IHG7cYDID6o\n";

/// Time in milliseconds without a request after which the host resets the board. It doubles after
/// each reset, so that a starting board is not reset again and again.
const FIRST_WAIT_MS: u64 = 2000;
/// Silence in milliseconds after a request which shows that the BIOS still waits for the answer.
/// The BIOS waits for 250 ms.
const WAITING_MS: u64 = 20;
/// Number of bytes of the board's last output that are kept for the error message.
const KEPT: usize = 1024;
/// Number of characters that the error message quotes.
const QUOTED: usize = 100;

/// Waits for the BIOS's request, answers it, and checks that the BIOS receives frames. The check is
/// necessary because a request may have been in a buffer for so long that the BIOS no longer
/// expects an answer.
///
/// # Errors
/// The BIOS does not receive frames within `wait_ms` of the board's time.
pub fn connect(board: &mut dyn Board, wait_ms: u64) -> Result<(), FlashError> {
    let start = board.now_ms();
    let mut heard = Vec::new();
    let mut interval = FIRST_WAIT_MS;
    let mut next = start.saturating_add(interval);
    loop {
        if is_request_open(board, &mut heard)? {
            board.write(ACCEPT)?;
            if Link::new(board).is_open()? {
                return Ok(());
            }
            next = board.now_ms();
        }
        let now = board.now_ms();
        let waited_ms = now.saturating_sub(start);
        if waited_ms >= wait_ms {
            let text = String::from_utf8_lossy(&heard);
            let quoted = text.char_indices().rev().nth(QUOTED - 1);
            let from = quoted.map_or(0, |(at, _)| at);
            let last = text[from..].to_owned();
            return Err(FlashError::NoRequest { waited_ms, last });
        }
        if now >= next {
            interval = interval.saturating_mul(2);
            next = now.saturating_add(interval);
            end_state(board)?;
        }
        board.read(&mut heard, 100)?;
        heard.drain(..heard.len().saturating_sub(KEPT));
    }
}

/// Whether the request is the last output of the board: the BIOS sends nothing while it waits for the answer.
fn is_request_open(board: &mut dyn Board, heard: &mut Vec<u8>) -> Result<bool, BoardError> {
    if heard.ends_with(REQUEST) {
        board.read(heard, WAITING_MS)?;
    }
    let is_open = heard.ends_with(REQUEST);
    if is_open {
        heard.clear();
    }
    Ok(is_open)
}

/// Ends an unfinished boot or transfer, and resets the board.
fn end_state(board: &mut dyn Board) -> Result<(), BoardError> {
    let mut frame = [0; MAX_FRAME];
    let length = wire::reset(&mut frame);
    let end_transfer = &frame[..length];
    board.write(&[END_BOOT, end_transfer, b"\rreboot\r"].concat())
}
