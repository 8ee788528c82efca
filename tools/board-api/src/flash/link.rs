//! Batches of frames with retries.

use super::frame::{JUMP, LOAD, frame};
use crate::line::{Board, BoardError};

/// Maximum number of data bytes in a frame. The protocol allows 251 bytes, but a frame with 96 data bytes has 104 bytes; together
/// with the 14-byte answer to the request it fits into the BIOS's receive buffer of 127 bytes.
const MAX_DATA: usize = 96;
/// Minimum number of data bytes in a frame.
const MIN_DATA: usize = 12;
/// Maximum number of frames in a batch: more than a serial adapter and its buffers hold at 1 Mbit/s.
const MAX_BATCH: usize = 64;
/// Mean time in milliseconds from a frame to its answer below which longer batches save no time.
const PROMPT_MS: u64 = 2;
/// Silence in milliseconds after which the BIOS expects a new frame: more than its time-out of 250 ms.
const QUIET_MS: u64 = 300;
/// Time in milliseconds after which the host stops waiting for a quiet line. Only a running program
/// sends for longer.
const LOUD_MS: u64 = 5_000;
/// Time-out of an answer in milliseconds: covers the transmission of a frame on a slow line and the delay of a serial adapter.
const ANSWER_MS: u64 = 500;
/// Maximum number of bytes in the BIOS's answer to one frame: `C` for a wrong checksum, and
/// `E` if a surplus byte leads to a time-out; both twice if the line repeats bytes. Longer output comes
/// from the program.
const MAX_ANSWER: usize = 4;
/// Answers of the BIOS to a frame: success, wrong checksum, unknown command, time-out.
const ANSWERS: &[u8] = b"KCUE";
/// Number of unanswered empty frames after which the BIOS is considered not to receive frames.
const PROBES: u32 = 3;
/// Number of failed batches in a row after which the transfer fails.
const MAX_FAILURES: u32 = 24;

/// Report of a serial boot.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Report {
    /// Length of the program in bytes.
    pub bytes: usize,
    /// Number of frames sent, including repeated frames.
    pub frames: u32,
    /// Number of batches sent again.
    pub retries: u32,
    /// The board's time from the first frame to the jump, in milliseconds.
    pub milliseconds: u64,
    /// Output of the program after the jump.
    #[serde(skip)]
    pub said: Vec<u8>,
}

/// A transfer that failed.
#[derive(Debug, thiserror::Error)]
pub enum FlashError {
    /// The board's connection failed.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The BIOS has not sent a request for a serial boot.
    #[error(
        "no serial boot for {waited_ms} ms: expected the BIOS's request sL5DdSMmkekro, found {last:?}; press the board's reset button"
    )]
    NoRequest {
        /// Length of the wait in milliseconds of board time.
        waited_ms: u64,
        /// The last part of the board's output.
        last: String,
    },
    /// The program has printed nothing after its start.
    #[error(
        "the program was loaded and started, and printed nothing for {waited_ms} ms: expected a program for this board at its load \
         address; --no-output expects no text"
    )]
    Silent {
        /// Length of the wait in milliseconds of board time.
        waited_ms: u64,
    },
    /// The program has ended, and the BIOS runs again.
    #[error(
        "the program was loaded and started, and the board is in its BIOS again: expected a program for this board"
    )]
    Restarted,
    /// Too many transmission errors.
    #[error(
        "at {address:#010x}: {MAX_FAILURES} batches failed in a row, the last with {data} data bytes a frame: expected {expected}, found {found}"
    )]
    Line {
        /// Load address of the data in the failed batch.
        address: u32,
        /// Number of data bytes of a frame in the last batch.
        data: usize,
        /// The expected answers.
        expected: String,
        /// The received answers.
        found: String,
    },
}

/// The outcome of sending a batch of frames.
pub enum Delivery {
    /// Every frame was acknowledged by `K`.
    Arrived {
        /// The board's time from the first frame to the last answer.
        milliseconds: u64,
    },
    /// The answers were not exactly one `K` per frame.
    Failed {
        /// The received answers.
        found: String,
    },
}

/// Sends frames in batches, and adapts the lengths of frames and batches to the line.
pub struct Link<'b> {
    /// Counts of the whole transfer.
    pub report: Report,
    board: &'b mut dyn Board,
    /// Current number of data bytes in a frame.
    data: usize,
    /// Current number of frames in a batch.
    batch: usize,
    /// Number of failed batches since the last success.
    failures: u32,
}

impl<'b> Link<'b> {
    /// Creates a link that starts with the longest frames, and with batches of one frame.
    pub fn new(board: &'b mut dyn Board) -> Self {
        Self {
            board,
            data: MAX_DATA,
            batch: 1,
            failures: 0,
            report: Report::default(),
        }
    }

    /// The board's time in milliseconds.
    pub fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }

    /// Current number of data bytes in a frame.
    pub fn data(&self) -> usize {
        self.data
    }

    /// Builds the next batch: frames that load the bytes of `program` from index `start` on. `address` is the load address of the
    /// whole program.
    pub fn batch(&self, program: &[u8], address: u32, start: usize) -> Vec<Vec<u8>> {
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

    /// Whether the BIOS receives frames. Repeats a frame without data until an answer to it or
    /// other text arrives.
    pub fn is_open(&mut self) -> Result<bool, BoardError> {
        // The frame loads no bytes, so its address has no effect.
        let frame = frame(LOAD, &[0; 4]);
        for _ in 0..PROBES {
            self.board.write(&frame)?;
            let mut answer = Vec::new();
            self.board.read(&mut answer, ANSWER_MS)?;
            if answer == b"K" {
                return Ok(true);
            }
            answer.extend(self.settle()?);
            if !answer.is_empty() {
                let is_answer = answer.iter().any(|letter| ANSWERS.contains(letter));
                return Ok(is_answer && answer.len() <= MAX_ANSWER);
            }
        }
        Ok(false)
    }

    /// Sends a batch of frames, and waits for one acknowledgement `K` per frame.
    pub fn deliver(&mut self, frames: &[Vec<u8>]) -> Result<Delivery, BoardError> {
        let start = self.board.now_ms();
        for frame in frames {
            self.board.write(frame)?;
            self.report.frames += 1;
        }
        // Transmission time in ms: about ten bytes per ms at 115,200 baud.
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

    /// Waits until the line is quiet and the BIOS expects a new frame; returns the first bytes received during the wait.
    fn settle(&mut self) -> Result<Vec<u8>, BoardError> {
        const KEPT: usize = 64 << 10;
        let start = self.board.now_ms();
        let mut last = start;
        let mut rest = Vec::new();
        while self.board.now_ms().saturating_sub(last) < QUIET_MS
            && last.saturating_sub(start) < LOUD_MS
        {
            rest.truncate(KEPT);
            let before = rest.len();
            self.board.read(&mut rest, QUIET_MS)?;
            if rest.len() > before {
                last = self.board.now_ms();
            }
        }
        Ok(rest)
    }

    /// Makes the next frames longer after a batch of `frames` frames took `milliseconds` to arrive. If frames already have their
    /// full length, makes the next batches longer, but only if answers are slow (`PROMPT_MS`).
    pub fn grow(&mut self, frames: usize, milliseconds: u64) {
        self.failures = 0;
        if self.data < MAX_DATA {
            self.data = (self.data * 2).min(MAX_DATA);
        } else if milliseconds >= PROMPT_MS * frames as u64 {
            self.batch = (self.batch * 2).min(MAX_BATCH);
        }
    }

    /// Makes batches and frames shorter after a batch has failed: `frames` frames whose data start at `address`. `found` is the
    /// received answers, for the error message.
    ///
    /// # Errors
    /// There are too many failures in a row.
    pub fn shrink(&mut self, address: u32, frames: usize, found: String) -> Result<(), FlashError> {
        self.failures += 1;
        self.report.retries += 1;
        if self.failures == MAX_FAILURES {
            let expected = format!("{frames} answers 'K'");
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

    /// Starts the program. Output of the program means success, even if the BIOS's answer was damaged.
    pub fn jump(&mut self, address: u32) -> Result<(), FlashError> {
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
                short if short.len() <= MAX_ANSWER => {
                    self.shrink(address, 1, format!("'{}'", said.escape_ascii()))?;
                    continue;
                }
                _ => self.report.said = said,
            }
            return Ok(());
        }
    }
}
