//! LiteX's serial boot (SFL) from the host's side.
//!
//! The BIOS asks with a magic word, is answered with another, and then takes frames: a length byte, a CRC-16, a command, a
//! payload. It answers each whole frame with one letter, in order, and forgets a frame that stays incomplete for a quarter of a
//! second. A frame carries its own address, so it may be sent again at any time.
//!
//! The letters carry no number, so a lost one could be taken for the next one's. Frames therefore go in batches: a batch has
//! arrived when it has brought just as many `K` as it has frames, and is otherwise sent again as a whole, after the line has
//! been quiet for long enough that both sides agree on where a frame begins. After a failure batches and frames get
//! smaller, as a short frame is hit less often. While all goes well they grow: frames to what the BIOS can buffer, and batches
//! where waiting for answers takes time. A line that answers at once has no need of them, and may be faster than the BIOS.

use crate::board::{Board, BoardError};

/// What the BIOS sends when it is ready for a boot.
pub const REQUEST: &[u8] = b"sL5DdSMmkekro\n";
/// What it waits for then.
pub const ACCEPT: &[u8] = b"z6IHG7cYDID6o\n";

/// Loads bytes at an address.
pub const LOAD: u8 = 1;
/// Jumps to an address.
pub const JUMP: u8 = 2;

/// The most data bytes of a frame. The protocol has room for 251, but a frame of 104 bytes, together with the answer to
/// the request before the first, is sure to fit the 127 that the BIOS buffers when it is busy.
const MAX_DATA: usize = 96;
const MIN_DATA: usize = 12;
/// The most frames of a batch: more than an adapter's delay and buffers hold at 1 Mbit/s.
const MAX_BATCH: usize = 64;
/// Answers that come sooner than this, for each frame, leave nothing to be gained by sending ahead.
const PROMPT_MS: u64 = 2;
/// Longer than the BIOS waits for the rest of a frame (250 ms).
const QUIET_MS: u64 = 300;
/// How long an answer may take: the frame's time on a slow line and an adapter's delays.
const ANSWER_MS: u64 = 500;
/// Batches that may fail one after the other, without one that arrives.
const PATIENCE: u32 = 24;

/// After this silence of a board that may be running something else, it is told to reboot.
const POKE_MS: u64 = 2000;

/// How a program got onto a board.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Report {
    /// The program's length.
    pub bytes: usize,
    /// Frames sent, those sent again counted each time.
    pub frames: u32,
    /// Batches that had to be sent again.
    pub retries: u32,
    /// The board's time from the first frame to the jump, in milliseconds.
    pub milliseconds: u64,
    /// What the board has said since it jumped.
    #[serde(skip)]
    pub said: Vec<u8>,
}

/// Why a program did not get onto a board.
#[derive(Debug, thiserror::Error)]
pub enum FlashError {
    /// The board cannot be talked to.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The BIOS did not ask.
    #[error(
        "no serial boot for {waited_ms} ms: expected the BIOS's request sL5DdSMmkekro; press the board's reset (the last it said: {last:?})"
    )]
    NoRequest {
        /// The board's time spent waiting.
        waited_ms: u64,
        /// The end of what came instead.
        last: String,
    },
    /// The line is too bad.
    #[error(
        "at {address:#010x}: no batch got through {PATIENCE} times, the last with {data} bytes a frame; expected {expected}, found {found}"
    )]
    Line {
        /// Where the data was to go.
        address: u32,
        /// Data bytes a frame had in the end.
        data: usize,
        /// The answers that should have come.
        expected: String,
        /// Those that came.
        found: String,
    },
}

/// Sends a program to `address` and starts it there. `progress` is told the bytes that have arrived and those in all.
///
/// A board that does not ask is told to reboot once: its BIOS and Glint's firmware both know that command.
///
/// # Errors
/// The BIOS does not ask for a boot within `wait_ms` of the board's time, or the line is too bad.
pub fn flash(
    board: &mut dyn Board,
    program: &[u8],
    address: u32,
    wait_ms: u64,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Report, FlashError> {
    wait_for_request(board, wait_ms)?;
    board.write(ACCEPT)?;
    let mut link = Link {
        board,
        data: MAX_DATA,
        batch: 1,
        failures: 0,
        report: Report::default(),
    };
    let start = link.board.now_ms();
    let mut sent = 0;
    while sent < program.len() {
        let frames = link.batch(program, address, sent);
        match link.deliver(&frames)? {
            Delivery::Arrived { milliseconds } => {
                sent = program.len().min(sent + link.data * frames.len());
                link.grow(milliseconds >= PROMPT_MS * frames.len() as u64);
                progress(sent as u64, program.len() as u64);
            }
            Delivery::Failed { found } => {
                link.shrink(address.wrapping_add(sent as u32), frames.len(), found)?
            }
        }
    }
    link.jump(address)?;
    link.report.bytes = program.len();
    link.report.milliseconds = link.board.now_ms() - start;
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
        // Enough for the request and for the message.
        let surplus = heard.len().saturating_sub(1024);
        heard.drain(..surplus);
    }
}

enum Delivery {
    Arrived { milliseconds: u64 },
    Failed { found: String },
}

struct Link<'b> {
    board: &'b mut dyn Board,
    /// Data bytes a frame.
    data: usize,
    /// Frames a batch.
    batch: usize,
    /// Batches that failed since one arrived.
    failures: u32,
    report: Report,
}

impl Link<'_> {
    /// The next frames from `start` on.
    fn batch(&self, program: &[u8], address: u32, start: usize) -> Vec<Vec<u8>> {
        program[start..]
            .chunks(self.data)
            .take(self.batch)
            .enumerate()
            .map(|(i, data)| {
                let at = address.wrapping_add((start + i * self.data) as u32);
                frame(LOAD, &[&at.to_be_bytes(), data].concat())
            })
            .collect()
    }

    /// Sends frames and counts the answers.
    fn deliver(&mut self, frames: &[Vec<u8>]) -> Result<Delivery, BoardError> {
        let start = self.board.now_ms();
        for frame in frames {
            self.board.write(frame)?;
            self.report.frames += 1;
        }
        // The time of the frames on the line, a millisecond for ten bytes at 115,200 baud, and room.
        let on_line = frames.iter().map(Vec::len).sum::<usize>() as u64 / 10;
        let mut answers = Vec::new();
        let mut last = self.board.now_ms();
        while answers.len() < frames.len() && answers.iter().all(|&answer| answer == b'K') {
            let before = answers.len();
            self.board.read(&mut answers, ANSWER_MS)?;
            let now = self.board.now_ms();
            if answers.len() > before {
                last = now;
            } else if now.saturating_sub(last) >= ANSWER_MS + on_line {
                break;
            }
        }
        if answers.len() == frames.len() && answers.iter().all(|&answer| answer == b'K') {
            return Ok(Delivery::Arrived {
                milliseconds: self.board.now_ms() - start,
            });
        }
        self.settle()?;
        let answers = &answers[..answers.len().min(40)];
        Ok(Delivery::Failed {
            found: format!("'{}'", answers.escape_ascii()),
        })
    }

    /// Waits until nothing has come for so long that the BIOS waits for the start of a frame, and returns what came.
    fn settle(&mut self) -> Result<Vec<u8>, BoardError> {
        let mut last = self.board.now_ms();
        let mut rest = Vec::new();
        while self.board.now_ms().saturating_sub(last) < QUIET_MS {
            let before = rest.len();
            self.board.read(&mut rest, QUIET_MS)?;
            if rest.len() > before {
                last = self.board.now_ms();
            }
        }
        Ok(rest)
    }

    fn grow(&mut self, answers_take_time: bool) {
        self.failures = 0;
        if self.data < MAX_DATA {
            self.data = (self.data * 2).min(MAX_DATA);
        } else if answers_take_time {
            self.batch = (self.batch * 2).min(MAX_BATCH);
        }
    }

    fn shrink(&mut self, address: u32, frames: usize, found: String) -> Result<(), FlashError> {
        self.failures += 1;
        self.report.retries += 1;
        if self.failures == PATIENCE {
            let expected = format!("{frames} times 'K'");
            return Err(FlashError::Line {
                address,
                data: self.data,
                expected,
                found,
            });
        }
        self.batch = (self.batch / 4).max(1);
        self.data = (self.data / 2).max(MIN_DATA);
        Ok(())
    }

    /// Starts the program. An answer that was hit does not matter once the program speaks.
    fn jump(&mut self, address: u32) -> Result<(), FlashError> {
        let frame = frame(JUMP, &address.to_be_bytes());
        loop {
            self.board.write(&frame)?;
            self.report.frames += 1;
            let mut said = Vec::new();
            self.board.read(&mut said, ANSWER_MS)?;
            if said.first() != Some(&b'K') {
                said.extend(self.settle()?);
            }
            match said.as_slice() {
                [b'K', rest @ ..] => self.report.said = rest.to_vec(),
                [] | [_] => {
                    self.shrink(address, 1, format!("'{}'", said.escape_ascii()))?;
                    continue;
                }
                _ => self.report.said = said,
            }
            return Ok(());
        }
    }
}

/// A frame: length, CRC-16/XMODEM over command and payload (high byte first), command, payload.
fn frame(command: u8, payload: &[u8]) -> Vec<u8> {
    const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_XMODEM);
    let mut digest = CRC.digest();
    digest.update(&[command]);
    digest.update(payload);
    let mut frame = vec![payload.len() as u8];
    frame.extend(digest.finalize().to_be_bytes());
    frame.push(command);
    frame.extend(payload);
    frame
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    const ADDRESS: u32 = 0x4000_0000;

    /// The BIOS's side of the protocol, behind a line that drops, flips and repeats bytes.
    #[derive(Default)]
    struct Bios {
        now_ms: u64,
        output: Vec<u8>,
        /// A frame that is not whole, and when it began.
        partial: Vec<u8>,
        since_ms: u64,
        memory: BTreeMap<u32, u8>,
        jumped: Option<u32>,
        accepted: bool,
        /// Of 1000 bytes so many are hit, in both directions.
        faults: u64,
        random: u64,
    }

    impl Bios {
        fn asking(faults: u64) -> Self {
            Self {
                output: [b"BIOS...\n", REQUEST].concat(),
                faults,
                random: 1,
                ..Self::default()
            }
        }

        /// What a byte becomes on the line.
        fn line(&mut self, byte: u8) -> Vec<u8> {
            self.random = self
                .random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let draw = (self.random >> 33) % 3000;
            match draw / 3 < self.faults {
                false => vec![byte],
                true => match draw % 3 {
                    0 => vec![],
                    1 => vec![byte ^ 1 << (self.random >> 60 & 7)],
                    _ => vec![byte, byte],
                },
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

    fn loads(faults: u64) -> Report {
        let program = program(20_001);
        let mut bios = Bios::asking(faults);
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
        let report = loads(0);
        assert_eq!(
            (report.retries, report.frames),
            (0, 20_001_u32.div_ceil(96) + 1)
        );
    }

    #[test]
    fn a_bad_line_takes_retries_and_loads_the_same() {
        assert!(loads(1).retries > 0);
        assert!(loads(10).retries > 5);
    }

    #[test]
    fn a_dead_line_is_given_up() {
        let mut bios = Bios::asking(400);
        let error = flash(&mut bios, &program(1000), ADDRESS, 1000, &mut |_, _| {}).unwrap_err();
        assert!(
            error.to_string().starts_with(
                "at 0x40000000: no batch got through 24 times, the last with 12 bytes"
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
