//! The host's side of LiteX's serial boot (SFL).
//!
//! The BIOS sends a request and waits for an answer. It then receives frames; each frame consists of a length byte, a CRC-16, a
//! command and a payload. It answers each complete frame with one letter, in order, and drops a frame that is still incomplete
//! after 250 ms. A frame contains its load address, so it may be sent again at any time.
//!
//! The letters contain no frame number, so after a lost answer the host could mistake the answer to
//! the next frame for the lost one. The host therefore sends frames in batches. A batch is complete when the
//! answers are exactly one `K` per frame. Otherwise the host waits until the line has been quiet
//! for longer than the BIOS's time-out, which resynchronises both sides to the start of a frame,
//! and sends the whole batch again. After a failure, batches and frames get shorter, because a
//! short frame is damaged less often. After a success, frames grow up to the size of the BIOS's
//! buffer. Batches grow only if an answer takes at least 2 ms: with faster answers, long batches
//! save no time, and may overrun the BIOS.

mod connect;
mod frame;
mod link;
mod start;

pub use connect::{ACCEPT, REQUEST};
pub use link::{FlashError, Report};
pub use start::await_text;

use crate::line::Board;
use link::{Delivery, Link};

/// Sends a program to `address` and starts it there. Calls `progress` with the number of bytes that have arrived and the
/// program's length.
///
/// If no request arrives, the host ends an earlier boot or transfer, and sends `reboot`, a command of the BIOS and of Glint's
/// firmware.
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
    connect::connect(board, wait_ms)?;
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

#[cfg(test)]
mod tests {
    use super::frame::{JUMP, LOAD, frame};
    use super::*;
    use crate::line::BoardError;
    use glint_vectors::Random;
    use std::collections::BTreeMap;

    const ADDRESS: u32 = 0x4000_0000;

    /// The kind of input that the simulated BIOS expects.
    #[derive(Clone, Copy, PartialEq)]
    enum Mode {
        /// The answer to its request, for 250 ms.
        Answer,
        /// Frames, without a time limit.
        Frames,
        /// A command at the prompt.
        Command,
        /// Nothing: a program runs.
        Nothing,
    }

    /// A simulated BIOS that receives frames over a line that drops, flips and repeats bytes.
    struct Bios {
        now_ms: u64,
        mode: Mode,
        output: Vec<u8>,
        /// The received bytes of an incomplete frame or line, and the time in milliseconds of the
        /// first byte or of the request.
        partial: Vec<u8>,
        since_ms: u64,
        memory: BTreeMap<u32, u8>,
        jumped: Option<u32>,
        /// Number of damaged bytes per 1000 bytes, in each direction, after the first frame.
        faults: i64,
        has_frame: bool,
        random: Random,
    }

    impl Bios {
        fn asking(faults: i64, line: u64) -> Self {
            Self {
                now_ms: 0,
                mode: Mode::Answer,
                output: [b"BIOS...\n", REQUEST].concat(),
                partial: Vec::new(),
                since_ms: 0,
                memory: BTreeMap::new(),
                jumped: None,
                faults,
                has_frame: false,
                // On lines with other seeds, damage that the CRC-16 and the letters do not show can get through.
                random: Random(Random(1).bits() ^ line.wrapping_mul(0xd134_2543_de82_ef95)),
            }
        }

        /// A BIOS in this mode. The host has not read `output` yet.
        fn in_mode(mode: Mode, output: &[u8]) -> Self {
            Self {
                mode,
                output: output.to_vec(),
                ..Self::asking(0, 0)
            }
        }

        fn enter(&mut self, mode: Mode, output: &[u8]) {
            self.mode = mode;
            self.output.extend(output);
            self.partial.clear();
            self.since_ms = self.now_ms;
        }

        /// Returns the bytes that arrive when `byte` is sent: none, a flipped byte, two bytes, or the unchanged byte.
        fn line(&mut self, byte: u8) -> Vec<u8> {
            if !self.has_frame || self.random.integer(0, 999) >= self.faults {
                return vec![byte];
            }
            match self.random.integer(0, 2) {
                0 => vec![],
                1 => vec![byte ^ 1 << self.random.integer(0, 7)],
                _ => vec![byte, byte],
            }
        }

        fn reply(&mut self, letter: u8) {
            let mut bytes = self.line(letter);
            self.output.append(&mut bytes);
        }

        fn expire(&mut self) {
            let is_late = self.now_ms - self.since_ms >= 250;
            match self.mode {
                Mode::Answer if is_late => self.enter(Mode::Command, b"Timeout\nlitex> "),
                Mode::Frames if is_late && !self.partial.is_empty() => {
                    self.partial.clear();
                    self.reply(b'E');
                }
                _ => {}
            }
        }

        /// Processes a byte from the host.
        fn hear(&mut self, byte: u8) {
            self.expire();
            match self.mode {
                Mode::Answer => {
                    self.partial.push(byte);
                    if self.partial.ends_with(ACCEPT) {
                        self.enter(Mode::Frames, b"");
                    }
                }
                Mode::Frames => {
                    for byte in self.line(byte) {
                        self.take(byte);
                    }
                }
                Mode::Command => {
                    self.output.push(byte);
                    self.partial.push(byte);
                    if self.partial.ends_with(b"\rreboot\r") {
                        self.enter(Mode::Answer, &[b"BIOS...\n", REQUEST].concat());
                    }
                }
                Mode::Nothing => {}
            }
        }

        fn take(&mut self, byte: u8) {
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
            let address = payload
                .first_chunk()
                .map_or(0, |bytes| u32::from_be_bytes(*bytes));
            match command {
                LOAD => self
                    .memory
                    .extend((address..).zip(payload[4..].iter().copied())),
                JUMP => self.jumped = Some(address),
                0 => {}
                _ => return self.reply(b'U'),
            }
            self.reply(b'K');
            self.has_frame = true;
            match command {
                JUMP => self.enter(Mode::Nothing, b"Liftoff!"),
                0 => self.enter(Mode::Command, b"No boot medium found\nlitex> "),
                _ => {}
            }
        }
    }

    impl Board for Bios {
        fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
            bytes.iter().for_each(|&byte| self.hear(byte));
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

    fn loads(faults: i64, line: u64) -> Report {
        loads_into(Bios::asking(faults, line))
    }

    fn loads_into(mut bios: Bios) -> Report {
        let program = program(20_001);
        let report = flash(&mut bios, &program, ADDRESS, 60_000, &mut |_, _| {}).unwrap();
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
    fn each_state_of_the_bios_leads_to_its_boot() {
        let late = [REQUEST, b"Timeout\nlitex> "].concat();
        let mut in_frame = Bios::in_mode(Mode::Frames, b"KKK");
        in_frame.partial = frame(LOAD, &[0; 100])[..50].to_vec();
        for bios in [
            Bios::in_mode(Mode::Command, b"litex> "),
            // Requests that have expired: followed by the output after the time-out, and without
            // further output.
            Bios::in_mode(Mode::Command, &late),
            Bios::in_mode(Mode::Command, REQUEST),
            Bios::in_mode(Mode::Frames, b""),
            in_frame,
        ] {
            assert_eq!(loads_into(bios).retries, 0);
        }
    }

    #[test]
    fn a_program_that_prints_nothing_is_not_started() {
        let liftoff = b"Executing booted program at 0x40000000\n\n--== Liftoff! ==--\n";
        let started = |text: &[u8]| {
            let mut bios = Bios::in_mode(Mode::Nothing, text);
            await_text(&mut bios, liftoff, 5000)
        };
        assert!(started(b"Glint\n").is_ok());
        assert!(matches!(
            started(b""),
            Err(FlashError::Silent { waited_ms: 5000 })
        ));
        assert!(matches!(started(b"\r\n"), Err(FlashError::Silent { .. })));
        let again = [b"BIOS\n", REQUEST].concat();
        assert!(matches!(started(&again), Err(FlashError::Restarted)));
    }

    #[test]
    fn the_end_of_a_boot_is_a_frame() {
        assert_eq!(frame(0, &[0]), crate::console::END_BOOT);
    }

    #[test]
    fn a_dead_line_ends_with_an_error() {
        let mut bios = Bios::asking(400, 0);
        let error = flash(&mut bios, &program(1000), ADDRESS, 600_000, &mut |_, _| {}).unwrap_err();
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
        assert!(board.1.ends_with(b"\rreboot\r"));
    }
}
