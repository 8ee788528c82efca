//! The host's side of LiteX's serial boot (SFL).
//!
//! The BIOS sends a request and waits for an answer. It then receives frames; each frame consists of a length byte, a CRC-16, a
//! command and a payload. It answers each complete frame with one letter, in order, and drops a frame that is still incomplete
//! after 250 ms. A frame contains its load address, so it may be sent again at any time.
//!
//! The letters contain no frame number, so after a lost answer the host could assign the answer of the next frame to it. The host
//! therefore sends frames in batches. A batch is complete when the answers are exactly one `K` per frame. Otherwise the host
//! waits until the line has been quiet for longer than the BIOS's time-out, which resynchronises both sides to the start of a
//! frame, and sends the whole batch again. After a failure, batches and frames get shorter, because a short frame is damaged less
//! often. After a success, frames grow up to the size of the BIOS's buffer. Batches grow only if an answer takes at least 2 ms:
//! with faster answers, long batches save no time, and may overrun the BIOS.

mod frame;
mod link;

pub use link::{FlashError, Report};

use crate::board::Board;
use link::{Delivery, Link};

/// Text that the BIOS sends when it is ready for a serial boot.
pub const REQUEST: &[u8] = b"sL5DdSMmkekro\n";
/// Answer to [`REQUEST`] that starts the transfer.
pub const ACCEPT: &[u8] = b"z6IHG7cYDID6o\n";

/// Time in milliseconds without a request after which the host sends `reboot`, because the board may be running a program.
const POKE_MS: u64 = 2000;

/// Sends a program to `address` and starts it there. Calls `progress` with the number of bytes that have arrived and the
/// program's length.
///
/// If no request arrives, the host sends `reboot` once, a command of the BIOS and of Glint's firmware.
///
/// # Errors
/// No request arrives within `wait_ms` of the board's time, or there are too many transmission errors.
pub fn flash(
    board: &mut dyn Board,
    program: &[u8],
    address: u32,
    wait_ms: u64,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Report, FlashError> {
    wait_for_request(board, wait_ms)?;
    board.write(ACCEPT)?;
    let mut link = Link::new(board);
    let start = link.now_ms();
    let mut sent = 0;
    while sent < program.len() {
        let frames = link.batch(program, address, sent);
        match link.deliver(&frames)? {
            Delivery::Arrived { milliseconds } => {
                sent = program.len().min(sent + link.data() * frames.len());
                link.grow(frames.len(), milliseconds);
                progress(sent as u64, program.len() as u64);
            }
            Delivery::Failed { found } => {
                link.shrink(address.wrapping_add(sent as u32), frames.len(), found)?
            }
        }
    }
    link.jump(address)?;
    link.report.bytes = program.len();
    link.report.milliseconds = link.now_ms() - start;
    Ok(link.report)
}

fn wait_for_request(board: &mut dyn Board, wait_ms: u64) -> Result<(), FlashError> {
    let start = board.now_ms();
    let mut heard = Vec::new();
    let mut poked = false;
    loop {
        if heard.windows(REQUEST.len()).any(|window| window == REQUEST) {
            return Ok(());
        }
        let waited_ms = board.now_ms().saturating_sub(start);
        if waited_ms >= wait_ms {
            let text = String::from_utf8_lossy(&heard);
            let from = text.char_indices().rev().nth(99).map_or(0, |(at, _)| at);
            return Err(FlashError::NoRequest {
                waited_ms,
                last: text[from..].to_owned(),
            });
        }
        if !poked && waited_ms >= POKE_MS {
            poked = true;
            board.write(b"\rreboot\r")?;
        }
        board.read(&mut heard, 100)?;
        // Keeps only the last bytes: they may contain the start of a request, and the error message quotes them.
        let surplus = heard.len().saturating_sub(1024);
        heard.drain(..surplus);
    }
}

#[cfg(test)]
mod tests {
    use super::frame::{JUMP, LOAD, frame};
    use super::*;
    use crate::board::BoardError;
    use crate::fuzz::Random;
    use std::collections::BTreeMap;

    const ADDRESS: u32 = 0x4000_0000;

    /// A simulated BIOS that receives frames over a line that drops, flips and repeats bytes.
    struct Bios {
        now_ms: u64,
        output: Vec<u8>,
        /// The received bytes of an incomplete frame, and the time of its first byte.
        partial: Vec<u8>,
        since_ms: u64,
        memory: BTreeMap<u32, u8>,
        jumped: Option<u32>,
        accepted: bool,
        /// Number of damaged bytes per 1000 bytes, in each direction.
        faults: usize,
        random: Random,
    }

    impl Bios {
        fn asking(faults: usize, line: u64) -> Self {
            Self {
                now_ms: 0,
                output: [b"BIOS...\n", REQUEST].concat(),
                partial: Vec::new(),
                since_ms: 0,
                memory: BTreeMap::new(),
                jumped: None,
                accepted: false,
                faults,
                random: Random::new(1, line),
            }
        }

        /// Returns the bytes that arrive when `byte` is sent: none, a flipped byte, two bytes, or the unchanged byte.
        fn line(&mut self, byte: u8) -> Vec<u8> {
            if self.random.below(1000) >= self.faults {
                return vec![byte];
            }
            match self.random.below(3) {
                0 => vec![],
                1 => vec![byte ^ 1 << self.random.below(8)],
                _ => vec![byte, byte],
            }
        }

        fn reply(&mut self, letter: u8) {
            let mut bytes = self.line(letter);
            self.output.append(&mut bytes);
        }

        fn expire(&mut self) {
            if !self.partial.is_empty() && self.now_ms - self.since_ms >= 250 {
                self.partial.clear();
                self.reply(b'E');
            }
        }

        fn take(&mut self, byte: u8) {
            self.expire();
            if self.jumped.is_some() {
                return;
            }
            if self.partial.is_empty() {
                self.since_ms = self.now_ms;
            }
            self.partial.push(byte);
            let whole = 4 + usize::from(self.partial[0]);
            if whole == 4 || self.partial.len() < whole {
                return;
            }
            let got = std::mem::take(&mut self.partial);
            let (command, payload) = (got[3], &got[4..]);
            if frame(command, payload) != got {
                return self.reply(b'C');
            }
            let address = u32::from_be_bytes(payload[..4].try_into().unwrap());
            match command {
                LOAD => self
                    .memory
                    .extend((address..).zip(payload[4..].iter().copied())),
                JUMP => self.jumped = Some(address),
                _ => return self.reply(b'U'),
            }
            self.reply(b'K');
            if self.jumped.is_some() {
                self.output.extend(b"Liftoff!");
            }
        }
    }

    impl Board for Bios {
        fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
            if !self.accepted {
                assert_eq!(bytes, ACCEPT);
                self.accepted = true;
                return Ok(());
            }
            for &byte in bytes {
                for byte in self.line(byte) {
                    self.take(byte);
                }
            }
            self.now_ms += bytes.len() as u64 / 11;
            Ok(())
        }

        fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
            if self.output.is_empty() {
                self.now_ms += wait_ms;
                self.expire();
            }
            bytes.append(&mut self.output);
            Ok(())
        }

        fn now_ms(&self) -> u64 {
            self.now_ms
        }
    }

    fn program(length: u32) -> Vec<u8> {
        (0..length)
            .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8)
            .collect()
    }

    fn loads(faults: usize, line: u64) -> Report {
        let program = program(20_001);
        let mut bios = Bios::asking(faults, line);
        let report = flash(&mut bios, &program, ADDRESS, 1000, &mut |_, _| {}).unwrap();
        assert_eq!(bios.jumped, Some(ADDRESS));
        assert!(report.said.ends_with(b"Liftoff!"));
        assert!(bios.memory.into_values().eq(program));
        report
    }

    #[test]
    fn the_crc_of_the_protocol() {
        assert_eq!(
            frame(0x31, b"23456789"),
            [&[8, 0x31, 0xc3, 0x31], &b"23456789"[..]].concat()
        );
    }

    #[test]
    fn a_clean_line_takes_no_retries() {
        let report = loads(0, 0);
        assert_eq!(
            (report.retries, report.frames),
            (0, 20_001_u32.div_ceil(96) + 1)
        );
    }

    #[test]
    fn a_bad_line_takes_retries_and_loads_the_same() {
        for line in 0..20 {
            assert!(loads(1, line).retries > 0);
            assert!(loads(10, line).retries > 5);
        }
    }

    #[test]
    fn a_dead_line_is_given_up() {
        let mut bios = Bios::asking(400, 0);
        let error = flash(&mut bios, &program(1000), ADDRESS, 1000, &mut |_, _| {}).unwrap_err();
        assert!(
            error.to_string().starts_with(
                "at 0x40000000: 24 batches failed in a row, the last with 12 data bytes a frame: expected"
            ),
            "{error}"
        );
    }

    #[test]
    fn a_board_that_does_not_ask() {
        struct Mute(u64, Vec<u8>);
        impl Board for Mute {
            fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
                self.1.extend(bytes);
                Ok(())
            }
            fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
                self.0 += wait_ms;
                bytes.extend(b"litex> ");
                Ok(())
            }
            fn now_ms(&self) -> u64 {
                self.0
            }
        }
        let mut board = Mute(0, Vec::new());
        let error = flash(&mut board, &program(10), ADDRESS, 5000, &mut |_, _| {}).unwrap_err();
        assert!(
            matches!(error, FlashError::NoRequest { ref last, .. } if last.ends_with("litex> ")),
            "{error}"
        );
        assert_eq!(board.1, b"\rreboot\r");
    }
}
