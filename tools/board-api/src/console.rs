//! A client of the firmware's console: sends a command, and reads its reply line by line.

use crate::line::{Board, BoardError};
use glint_core::console::{Command, PROMPT};
use glint_core::wire::{self, MAX_FRAME};
use std::hash::{BuildHasher, RandomState};

/// An error of a console command.
#[derive(Debug, thiserror::Error)]
pub enum ConsoleError {
    /// An error of the board.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The firmware refuses the command.
    #[error("the board refused `{command}`: {reason}")]
    Refused {
        /// The command that was refused.
        command: String,
        /// The text after `error: ` in the reply.
        reason: String,
    },
    /// The next line, or the end of the reply, did not arrive within the time-out.
    #[error(
        "waited {waited_ms} ms of the board's time for {expected}; the last lines were {last:?}"
    )]
    Silence {
        /// The awaited text.
        expected: String,
        /// Length of the time-out, in milliseconds of the board's time.
        waited_ms: u64,
        /// The last part of the received text.
        last: String,
    },
    /// The board keeps sending other text than the expected reply.
    #[error(
        "expected {expected}, found more than {limit} bytes of other text; the last lines were {last:?}"
    )]
    Endless {
        /// The awaited text.
        expected: String,
        /// The maximum number of bytes of other text.
        limit: usize,
        /// The last part of the received text.
        last: String,
    },
    /// The board is in its BIOS, because no program has been started.
    #[error(
        "expected the firmware, found the prompt of the BIOS; `glint flash` loads the firmware, and so does the live page"
    )]
    Bios,
    /// A reply that does not have the expected form.
    #[error("the reply to `{command}`: expected {expected}, found {found:?}")]
    Reply {
        /// The command that was sent.
        command: String,
        /// The expected form of the reply.
        expected: String,
        /// The reply that was received.
        found: String,
    },
}

/// Time-out of a line of a reply in milliseconds of the board's time: longer than the slowest frame of a board without
/// accelerators.
pub const PATIENCE_MS: u64 = 30_000;
/// Time-out of a whole reply after its first line, as a multiple of the time-out of a line. It ends
/// the wait for a board that never stops sending lines.
const REPLY_PATIENCE: u64 = 20;
/// Default number of frames of the console command `orbit`, and of scenes with an orbit.
const ORBIT_FRAMES: u32 = 240;
/// Default number of frames of the console command `bench`.
const BENCH_FRAMES: u32 = 8;

/// Frame that ends LiteX's serial boot. If the host is killed during `glint flash`, the BIOS waits
/// for frames without a time limit. The BIOS prompt and the firmware ignore this frame.
pub const END_BOOT: &[u8] = &[1, 0, 0, 0, 0];
/// End of the prompt of the BIOS.
pub const BIOS_PROMPT: &[u8] = b"litex\x1b[0m> ";

/// Maximum length of a line in bytes.
const MAX_LINE: usize = 64 << 10;
/// Maximum length in bytes of a reply, including earlier output that arrives before it.
const MAX_REPLY: usize = 1 << 20;

/// Maximum number of unanswered attempts of [`Console::synchronise`].
const ATTEMPTS: u32 = 7;
/// Time-out of the first attempt of [`Console::synchronise`] in milliseconds; each further attempt
/// doubles it, up to the time-out of a reply, because a starting board loses its input.
const FIRST_PATIENCE_MS: u64 = 1_000;

/// Deadline of a wait.
#[derive(Clone, Copy)]
struct Limit {
    /// Time of the deadline, in milliseconds of the board's time.
    end_ms: u64,
    /// Length of the wait in milliseconds.
    length_ms: u64,
}

impl Limit {
    const NONE: Self = Self {
        end_ms: u64::MAX,
        length_ms: u64::MAX,
    };

    const fn after(now_ms: u64, length_ms: u64) -> Self {
        Self {
            end_ms: now_ms.saturating_add(length_ms),
            length_ms,
        }
    }
}

/// The console of a board.
pub struct Console<'b, B: ?Sized = dyn Board> {
    board: &'b mut B,
    /// Received bytes that are not processed yet.
    pending: Vec<u8>,
    /// Output before the echoes of commands that [`take_earlier`](Self::take_earlier) has not returned yet.
    earlier: String,
    patience_ms: u64,
    /// Deadline of the current line.
    line: Limit,
    /// Deadline of the whole reply; received lines do not extend it.
    reply: Limit,
    /// Number of bytes that may still arrive before the reply to the current command must be complete.
    allowance: usize,
}

impl<'b, B: Board + ?Sized> Console<'b, B> {
    /// Creates the console of a board whose firmware is running.
    pub fn new(board: &'b mut B) -> Self {
        Self {
            board,
            pending: Vec::new(),
            earlier: String::new(),
            patience_ms: PATIENCE_MS,
            line: Limit::NONE,
            reply: Limit::NONE,
            allowance: MAX_REPLY,
        }
    }

    /// Sets the deadline of the next line to `patience_ms` milliseconds from now.
    fn begin_line(&mut self, patience_ms: u64) {
        self.line = Limit::after(self.board.now_ms(), patience_ms);
    }

    /// Runs `task` with a limit on its whole duration; `patience_ms` is the time-out of its first line.
    fn within<T>(
        &mut self,
        patience_ms: u64,
        task: impl FnOnce(&mut Self) -> Result<T, ConsoleError>,
    ) -> Result<T, ConsoleError> {
        self.begin_line(patience_ms);
        let all_ms = self.patience_ms.saturating_mul(REPLY_PATIENCE);
        let outer = self.reply;
        let limit = Limit::after(self.board.now_ms(), patience_ms.saturating_add(all_ms));
        self.reply = std::cmp::min_by_key(outer, limit, |limit| limit.end_ms);
        let result = task(self);
        self.reply = outer;
        result
    }

    /// Sets the time-out of replies, in milliseconds of the board's time.
    #[must_use]
    pub fn patience(self, patience_ms: u64) -> Self {
        Self {
            patience_ms,
            ..self
        }
    }

    /// Raises the maximum length of the reply to the last command, by default 1 MiB, by `bytes` bytes.
    pub fn allow(&mut self, bytes: usize) {
        self.allowance = self.allowance.saturating_add(bytes);
    }

    /// Adds bytes that other code has read from the board to the received bytes.
    pub fn hear(&mut self, said: &[u8]) {
        self.pending.extend_from_slice(said);
    }

    /// Waits for the first prompt after a start of the board, and returns the text before the prompt.
    ///
    /// # Errors
    /// [`ConsoleError::Silence`] if no prompt arrives.
    pub fn greet(&mut self) -> Result<String, ConsoleError> {
        self.within(self.patience_ms, |console| {
            let mut said = String::new();
            loop {
                if let Some(at) = find(&console.pending, PROMPT.as_bytes()) {
                    let rest = console.pending.split_off(at);
                    said.push_str(&plain(&std::mem::replace(&mut console.pending, rest)));
                    console.pending.drain(..PROMPT.len());
                    return Ok(said);
                }
                while let Some(line) = console.take_line() {
                    console.begin_line(console.patience_ms);
                    said.push_str(&line);
                    said.push('\n');
                }
                console.receive("a prompt", &said)?;
            }
        })
    }

    /// Synchronises with a board that other programs have used: ends an unfinished serial boot or transfer, and drops the remaining
    /// output of earlier commands, so that it is not read as part of a later reply.
    ///
    /// # Errors
    /// [`ConsoleError::Silence`] if the board does not answer, [`ConsoleError::Bios`] if only its
    /// BIOS answers.
    pub fn synchronise(&mut self) -> Result<(), ConsoleError> {
        self.within(self.patience_ms, Self::find_firmware)
    }

    fn find_firmware(&mut self) -> Result<(), ConsoleError> {
        // Each `RandomState` has random keys, so the number differs from the numbers that earlier programs have sent. In WebAssembly the keys
        // are constant, and the time differs.
        let number = RandomState::new().hash_one(self.board.now_ms());
        self.allowance = MAX_REPLY;
        let patience_ms = self.patience_ms;
        let (mut attempt, mut silences) = (1, 0);
        loop {
            let word = format!("sync-{number:016x}-{attempt}");
            self.patience_ms = patience_ms.min(FIRST_PATIENCE_MS << silences);
            // The bytes may be lost: within a frame of a serial boot, or while the board starts.
            self.end_boot()?;
            self.reset_transfer()?;
            let found = self.echo(&word);
            self.patience_ms = patience_ms;
            match found {
                Ok(true) => return Ok(()),
                // The board has ended a transfer and dropped the input after it, or has refused an earlier line.
                Ok(false) => {}
                Err(ConsoleError::Silence { .. }) if self.pending.ends_with(BIOS_PROMPT) => {
                    return Err(ConsoleError::Bios);
                }
                Err(ConsoleError::Silence { .. }) if silences + 1 < ATTEMPTS => silences += 1,
                Err(error) => return Err(error),
            }
            attempt += 1;
        }
    }

    /// Sends a command that prints a word. Returns true if the board has printed the word, and
    /// false if it has first printed an error, which belongs to a cancelled transfer or to an
    /// earlier line.
    fn echo(&mut self, word: &str) -> Result<bool, ConsoleError> {
        let command = format!("echo {word}");
        self.board.write(format!("\0{command}\r").as_bytes())?;
        self.begin_line(self.patience_ms);
        loop {
            let line = self.next_line(&command)?;
            // The prompt may precede the word on the line. The echo of the command also ends with
            // the word, but is not the reply.
            let before = line.strip_suffix(word);
            if before.is_some_and(|before| before.is_empty() || before.ends_with(PROMPT)) {
                return self.lines(&command, &mut |_| {}).map(|_| true);
            }
            if line.starts_with("error: ") {
                return Ok(false);
            }
        }
    }

    /// Ends an unfinished serial boot, if any; the board then starts from its flash memory, or prints the prompt of its BIOS.
    ///
    /// # Errors
    /// Writing to the board fails.
    pub fn end_boot(&mut self) -> Result<(), BoardError> {
        self.board.write(END_BOOT)
    }

    /// Cancels an unfinished transfer on the board, if any.
    ///
    /// # Errors
    /// Writing to the board fails.
    pub fn reset_transfer(&mut self) -> Result<(), BoardError> {
        let mut frame = [0; MAX_FRAME];
        let length = wire::reset(&mut frame);
        self.board.write(&frame[..length])
    }

    /// Sends a command and returns the lines of its reply without the final `ok`.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn command(&mut self, command: &str) -> Result<Vec<String>, ConsoleError> {
        self.send(command)?;
        self.reply(command)
    }

    /// Sends a command that starts a transfer, and waits until the board is ready for it. Calls `on_line` with each line before
    /// `ready`.
    ///
    /// # Errors
    /// The firmware refuses the command, ends the command without a transfer, or does not answer.
    pub fn command_with_transfer(
        &mut self,
        command: &str,
        on_line: &mut dyn FnMut(&str),
    ) -> Result<(), ConsoleError> {
        self.send(command)?;
        if self.lines(command, on_line)? {
            Ok(())
        } else {
            Err(unexpected(command, "`ready`", "`ok`"))
        }
    }

    /// Calls `on_line` with each line of a reply up to `ready` or the final `ok`. Returns true if the reply ends with `ready`,
    /// which means that the board waits for a transfer.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn lines(
        &mut self,
        command: &str,
        on_line: &mut dyn FnMut(&str),
    ) -> Result<bool, ConsoleError> {
        self.lines_within(self.patience_of(command), command, on_line)
    }

    /// Does the work of [`lines`](Self::lines). `patience_ms` is the time-out of the first line of the reply, the only line whose
    /// delay depends on the command.
    fn lines_within(
        &mut self,
        patience_ms: u64,
        command: &str,
        on_line: &mut dyn FnMut(&str),
    ) -> Result<bool, ConsoleError> {
        self.begin_line(patience_ms);
        loop {
            let line = self.next_line(command)?;
            self.begin_line(self.patience_ms);
            match line.as_str() {
                "ready" => return Ok(true),
                "ok" => return Ok(false),
                line => {
                    refused(command, line)?;
                    on_line(line);
                }
            }
        }
    }

    /// Time-out of the first line of the reply to a command: a command that draws several frames replies after the last one.
    fn patience_of(&self, command: &str) -> u64 {
        let frames = match Command::parse(command) {
            Ok(Some(Command::Orbit { frames })) => frames.unwrap_or(ORBIT_FRAMES),
            Ok(Some(Command::Scene { name: Some(_) })) => ORBIT_FRAMES,
            Ok(Some(Command::Bench { benchmark })) => {
                let frames = benchmark.and_then(|(_, frames)| frames);
                frames.unwrap_or(BENCH_FRAMES)
            }
            _ => 1,
        };
        self.patience_ms.saturating_mul(frames.max(1).into())
    }

    /// Sends `info KEY` and returns the first word of the value in the reply.
    ///
    /// # Errors
    /// The key is unknown, or the board does not answer.
    pub fn info(&mut self, key: &str) -> Result<String, ConsoleError> {
        let command = format!("info {key}");
        let lines = self.command(&command)?;
        let found: String = value(&command, &lines, key)?;
        Ok(found.split(' ').next().unwrap_or_default().to_owned())
    }

    /// Returns the board, and the received bytes that the console has not processed yet. A transfer reads its first bytes from
    /// this buffer, and returns the bytes after the transfer to it.
    pub fn line(&mut self) -> (&mut B, &mut Vec<u8>) {
        (self.board, &mut self.pending)
    }

    /// The board of the console.
    pub fn board(&mut self) -> &mut B {
        self.board
    }

    /// Reads the rest of the reply to `command` and returns its lines without the final `ok`.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn reply(&mut self, command: &str) -> Result<Vec<String>, ConsoleError> {
        let mut lines = Vec::new();
        let patience_ms = self.patience_of(command);
        let is_transfer = self.within(patience_ms, |console| {
            console.lines_within(patience_ms, command, &mut |line| {
                lines.push(line.to_owned())
            })
        })?;
        if is_transfer {
            self.reset_transfer()?;
            return Err(unexpected(
                command,
                "`ok`",
                "`ready`, the start of a transfer",
            ));
        }
        Ok(lines)
    }

    /// Returns the output of earlier commands, such as of a line that a user has typed ahead, that has arrived before the echoes of the
    /// commands of this console. It ends with the prompt, unless it is empty.
    pub fn take_earlier(&mut self) -> String {
        std::mem::take(&mut self.earlier)
    }

    /// Sends a command and waits for its echo.
    ///
    /// # Errors
    /// The board does not answer.
    pub fn send(&mut self, command: &str) -> Result<(), ConsoleError> {
        self.allowance = MAX_REPLY;
        // The board discards an unfinished input line when it receives a zero byte.
        self.board.write(format!("\0{command}\r").as_bytes())?;
        self.begin_line(self.patience_ms);
        loop {
            let line = self.next_line(command)?;
            // The line with the echo may start with earlier output, such as the prompt.
            if let Some(prompt) = line.strip_suffix(command) {
                if !self.earlier.is_empty() {
                    self.earlier.push_str(prompt);
                }
                return Ok(());
            }
            self.earlier.push_str(&line);
            self.earlier.push_str("\r\n");
        }
    }

    fn next_line(&mut self, command: &str) -> Result<String, ConsoleError> {
        loop {
            if let Some(line) = self.take_line() {
                return Ok(line);
            }
            self.receive(&format!("the reply to `{command}`"), "")?;
        }
    }

    /// Takes the next complete line out of the received bytes. After a transfer the line may start with bytes of the transfer, so
    /// its text starts after the last zero byte.
    fn take_line(&mut self) -> Option<String> {
        let end = self.pending.iter().position(|&b| b == b'\n')?;
        let line: Vec<u8> = self.pending.drain(..=end).collect();
        let text = line.rsplit(|&b| b == 0).next().unwrap_or_default();
        Some(plain(text).trim_end().to_owned())
    }

    /// Reads more bytes from the board, for at most the rest of the time-out: received bytes do not extend it.
    fn receive(&mut self, expected: &str, said: &str) -> Result<(), ConsoleError> {
        let before = self.pending.len();
        let limit = std::cmp::min_by_key(self.line, self.reply, |limit| limit.end_ms);
        let left_ms = limit.end_ms.saturating_sub(self.board.now_ms());
        self.board.read(&mut self.pending, left_ms)?;
        let new = self.pending.get(before..).unwrap_or_default();
        let left = self.allowance.checked_sub(new.len());
        let is_endless = left.is_none() || before > MAX_LINE;
        self.allowance = left.unwrap_or(0);
        let now_ms = self.board.now_ms();
        // A line may have arrived while this program was stopped.
        let is_in_time =
            now_ms < limit.end_ms || new.contains(&b'\n') && now_ms < self.reply.end_ms;
        if is_in_time && !is_endless {
            return Ok(());
        }
        let all = format!("{said}{}", plain(&self.pending));
        let start = all.char_indices().rev().nth(199).map_or(0, |(at, _)| at);
        let (expected, last) = (expected.to_owned(), all[start..].to_owned());
        Err(if is_endless {
            let limit = if left.is_none() { MAX_REPLY } else { MAX_LINE };
            self.pending.clear();
            ConsoleError::Endless {
                expected,
                limit,
                last,
            }
        } else {
            ConsoleError::Silence {
                expected,
                waited_ms: limit.length_ms,
                last,
            }
        })
    }
}

/// Returns the error for a reply that contains `found` in place of `expected`.
pub fn unexpected(command: &str, expected: &str, found: &str) -> ConsoleError {
    ConsoleError::Reply {
        command: command.to_owned(),
        expected: expected.to_owned(),
        found: found.to_owned(),
    }
}

fn refused(command: &str, line: &str) -> Result<(), ConsoleError> {
    match line.strip_prefix("error: ") {
        Some(reason) => Err(ConsoleError::Refused {
            command: command.to_owned(),
            reason: reason.to_owned(),
        }),
        None => Ok(()),
    }
}

/// Returns the parsed value of the line `key value` in a reply.
///
/// # Errors
/// [`ConsoleError::Reply`] if the reply has no such line, or its value cannot be parsed.
pub fn value<T: std::str::FromStr>(
    command: &str,
    lines: &[String],
    key: &str,
) -> Result<T, ConsoleError> {
    let found = lines
        .iter()
        .find_map(|line| line.strip_prefix(key)?.strip_prefix(' '));
    found
        .and_then(|word| word.parse().ok())
        .ok_or_else(|| ConsoleError::Reply {
            command: command.to_owned(),
            expected: format!("a line `{key}` with its value"),
            found: lines.join("\n"),
        })
}

fn find(bytes: &[u8], wanted: &[u8]) -> Option<usize> {
    bytes
        .windows(wanted.len())
        .position(|window| window == wanted)
}

/// Converts bytes to text without the escape sequences and control characters on which a terminal would act. Tabs and line feeds
/// remain.
pub fn plain(bytes: &[u8]) -> String {
    let mut text = Vec::with_capacity(bytes.len());
    let mut rest = bytes.iter();
    while let Some(&byte) = rest.next() {
        match byte {
            0x1b => {
                // A control sequence ends with a byte from 0x40 to 0x7E.
                if rest.as_slice().first() == Some(&b'[') {
                    rest.next();
                    rest.by_ref().find(|b| (0x40..0x7f).contains(*b));
                }
            }
            _ => text.push(byte),
        }
    }
    let mut text = String::from_utf8_lossy(&text).into_owned();
    text.retain(|c| !c.is_control() || matches!(c, '\n' | '\t'));
    text
}

#[cfg(test)]
mod tests;
