//! The start of a loaded program.

use super::connect::REQUEST;
use super::link::FlashError;
use crate::line::Board;

/// Part of the last line that the BIOS prints before it starts a program.
const LIFTOFF: &[u8] = b"Liftoff!";
/// Silence in milliseconds after which the first text of a program counts as complete.
const QUIET_MS: u64 = 1000;
/// Number of bytes of output after which a program counts as started.
const ENOUGH: usize = 64 << 10;

/// Waits until a started program prints text. `said` is the output of the BIOS and the program so
/// far.
///
/// # Errors
/// The program prints nothing within `wait_ms` milliseconds of the board's time, or returns to the
/// BIOS.
pub fn await_text(board: &mut dyn Board, said: &[u8], wait_ms: u64) -> Result<(), FlashError> {
    let mut said = said.to_vec();
    let start = board.now_ms();
    loop {
        let text = after_liftoff(&said);
        if text.windows(REQUEST.len()).any(|part| part == REQUEST) {
            return Err(FlashError::Restarted);
        }
        let has_text = text.iter().any(u8::is_ascii_graphic);
        let waited_ms = board.now_ms().saturating_sub(start);
        if waited_ms >= wait_ms || said.len() >= ENOUGH {
            return match has_text {
                true => Ok(()),
                false => Err(FlashError::Silent { waited_ms }),
            };
        }
        let before = said.len();
        let left_ms = wait_ms - waited_ms;
        board.read(&mut said, left_ms.min(QUIET_MS))?;
        if said.len() == before && has_text {
            return Ok(());
        }
    }
}

/// The output after the line of the BIOS with [`LIFTOFF`]; all output if transmission errors have damaged that word.
fn after_liftoff(said: &[u8]) -> &[u8] {
    let found = said
        .windows(LIFTOFF.len())
        .position(|part| part == LIFTOFF)
        .map(|at| &said[at..]);
    let Some(line) = found else {
        return said;
    };
    let end = line.iter().position(|&byte| byte == b'\n');
    end.map_or(&[], |end| &line[end..])
}
