//! `glint console`.

use super::common::{LineArguments, Unsynchronised};
use super::config;
use super::messages::{note, print_json, say};
use super::output::Output;
use anyhow::Context;
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use glint::board::{Board, BoardError, BoardName, Memory, SerialBoard};
use glint::console::{self, Console};
use glint::error::{MAX_LINE, quote};
use glint_live_page::Places;
use rustix::termios::{OptionalActions, Termios, isatty, tcgetattr, tcsetattr};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Code of the key Ctrl-], which ends the session.
const EXIT: u8 = 0x1d;
/// Time-out of a read from the board, in milliseconds of the board's time.
const POLL_MS: u64 = 10;
/// Longest time for reading the output that the board sent before the session, in milliseconds of the board's time.
const EARLIER_MS: u64 = 500;

/// Open a board's console, or send commands to the board.
///
/// On a terminal, Ctrl-] ends the session, and Ctrl-C ends the command that runs on the board. Commands come from --send, from
/// --file, or line by line from standard input if it is not a terminal; the first command that fails ends the program. With
/// --until, the program ends with exit code 0 when the board has printed a text.
#[derive(Args)]
pub struct ConsoleArguments {
    /// Board: `emulated`, `virtual`, a serial port, or `serial` for the port that `glint ports` guesses [default: from
    /// GLINT_BOARD or the configuration file, otherwise emulated].
    board: Option<BoardName>,
    /// Send a command, print its reply and exit; repeatable.
    #[arg(long, value_name = "COMMAND", allow_hyphen_values = true)]
    send: Vec<String>,
    /// Send the commands of a file, one command per line; `-` is standard input. Empty lines and lines that start with # are
    /// skipped.
    #[arg(long, value_name = "SCRIPT", conflicts_with = "send")]
    file: Option<PathBuf>,
    /// Write all output of the board to a file as it arrives.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// After all commands, print the output of the board until it contains this text.
    #[arg(long, value_name = "TEXT", conflicts_with = "json", value_parser = NonEmptyStringValueParser::new())]
    until: Option<String>,
    /// Longest wait for the text of --until, in seconds of the board's time [default: none].
    #[arg(long, value_name = "SECONDS", requires = "until")]
    timeout: Option<u32>,
    #[command(flatten)]
    line: LineArguments,
    /// Print the replies to commands as JSON: an array of lines for each successful command.
    #[arg(long)]
    json: bool,
}

impl ConsoleArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let board = config::board(self.board.as_ref())?;
        let inputs = self.file.iter();
        let log = self.log.as_deref();
        let log = log.map(|path| Output::open(path, &[], inputs)?.into_file());
        let log = log.transpose()?;
        let script: Box<dyn Iterator<Item = io::Result<String>>> = match &self.file {
            Some(path) if path != Path::new("-") => {
                let file = File::open(path).with_context(|| path.display().to_string())?;
                Box::new(commands(BufReader::new(file)))
            }
            None if !self.send.is_empty() => Box::new(self.send.iter().cloned().map(Ok)),
            None if isatty(std::io::stdin()) => {
                anyhow::ensure!(!self.json, "--json: expected commands, found a terminal");
                let mut opened = self.line.unsynchronised_board(&board)?;
                let mut heard = self.heard(&mut *opened.board, log);
                return interact(&mut heard, opened.places, opened.said.as_deref(), || false);
            }
            _ => Box::new(commands(std::io::stdin().lock())),
        };
        let mut board = self.line.board(&board)?;
        let mut heard = self.heard(&mut *board, log);
        let mut replies = Vec::new();
        let result = self.execute(script, &mut Console::new(&mut heard), &mut replies);
        if self.json {
            print_json(&replies)?;
        }
        result?;
        if self.until.is_some() {
            heard.is_printed = true;
            while !heard.is_over()? {
                heard.read(&mut Vec::new(), POLL_MS)?;
            }
        }
        Ok(())
    }

    fn heard<'b>(&self, board: &'b mut dyn Board, log: Option<File>) -> Heard<'b> {
        let end_ms = self.timeout.map(|seconds| u64::from(seconds) * 1000);
        Heard {
            end_ms: end_ms.map(|wait| board.now_ms() + wait),
            board,
            log,
            until: self.until.clone(),
            last: Vec::new(),
            is_found: false,
            is_printed: false,
        }
    }

    /// Sends the commands of a script up to the first command that fails, and collects or prints
    /// the replies.
    fn execute(
        &self,
        script: impl Iterator<Item = io::Result<String>>,
        console: &mut Console<Heard>,
        replies: &mut Vec<Vec<String>>,
    ) -> anyhow::Result<()> {
        for command in script {
            let command = command.context("reading the commands")?;
            let command = command.trim();
            if command.is_empty() || command.starts_with('#') {
                continue;
            }
            let lines = console.command(command)?;
            if self.json {
                replies.push(lines);
            } else {
                lines.iter().try_for_each(say)?;
            }
        }
        Ok(())
    }
}

/// The lines of a script. A line of more than [`MAX_LINE`] bytes is an error.
fn commands(mut script: impl BufRead) -> impl Iterator<Item = io::Result<String>> {
    let limit = MAX_LINE as u64;
    std::iter::from_fn(move || {
        let mut line = String::new();
        match script.by_ref().take(limit + 1).read_line(&mut line) {
            Ok(0) => None,
            Ok(_) if line.len() > MAX_LINE => {
                let message =
                    format!("expected lines of at most {limit} bytes, found a longer one");
                Some(Err(io::Error::other(message)))
            }
            Ok(_) => Some(Ok(line)),
            Err(error) => Some(Err(error)),
        }
    })
}

/// A board whose output is written to a log and searched for a text.
struct Heard<'b> {
    board: &'b mut dyn Board,
    log: Option<File>,
    /// The text that ends the session.
    until: Option<String>,
    /// The last bytes of the output, which may be the beginning of the text.
    last: Vec<u8>,
    is_found: bool,
    /// Whether the output is also printed on standard output.
    is_printed: bool,
    /// End of the wait for the text, in milliseconds of the board's time.
    end_ms: Option<u64>,
}

impl Heard<'_> {
    /// Whether the text has been received.
    ///
    /// # Errors
    /// The text was not received in time.
    fn is_over(&self) -> anyhow::Result<bool> {
        let Some(until) = &self.until else {
            return Ok(false);
        };
        anyhow::ensure!(
            self.is_found || self.end_ms.is_none_or(|end| self.board.now_ms() < end),
            "--until: expected '{}' in time, found {}",
            until.escape_debug(),
            quote(&self.last)
        );
        Ok(self.is_found)
    }

    fn hear(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some(log) = &mut self.log {
            log.write_all(bytes)?;
        }
        if self.is_printed {
            let mut output = std::io::stdout();
            // A terminal would execute control characters.
            match isatty(&output) {
                true => output.write_all(console::plain(bytes).as_bytes())?,
                false => output.write_all(bytes)?,
            }
            output.flush()?;
        }
        if let Some(until) = &self.until {
            let until = until.as_bytes();
            self.last.extend(bytes);
            self.is_found |= self.last.windows(until.len()).any(|part| part == until);
            let surplus = self.last.len().saturating_sub(until.len());
            self.last.drain(..surplus);
        }
        Ok(())
    }
}

impl Board for Heard<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.write(bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let before = bytes.len();
        self.board.read(bytes, wait_ms)?;
        Ok(self.hear(bytes.get(before..).unwrap_or_default())?)
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }

    fn memory(&mut self) -> Option<&mut dyn Memory> {
        self.board.memory()
    }
}

/// The terminal in raw mode, in which keys reach the board unchanged. Dropping the value restores
/// the previous mode.
struct RawTerminal(Option<Termios>);

impl RawTerminal {
    fn enter() -> anyhow::Result<Self> {
        let stdin = std::io::stdin();
        if !isatty(&stdin) {
            return Ok(Self(None));
        }
        let before = tcgetattr(&stdin).context("reading the terminal's settings")?;
        let mut raw = before.clone();
        raw.make_raw();
        tcsetattr(&stdin, OptionalActions::Flush, &raw).context("setting up the terminal")?;
        Ok(Self(Some(before)))
    }
}

impl Drop for RawTerminal {
    fn drop(&mut self) {
        if let Some(before) = &self.0 {
            // An error is ignored: if the terminal is closed, there is no mode to restore.
            let _ = tcsetattr(std::io::stdin(), OptionalActions::Flush, before);
        }
    }
}

/// Starts a thread that reads pressed keys, and returns the channel that delivers them.
fn keys() -> Receiver<Vec<u8>> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let mut buffer = [0; 256];
        while let Ok(length @ 1..) = std::io::stdin().read(&mut buffer) {
            if sender.send(buffer[..length].to_vec()).is_err() {
                return;
            }
        }
    });
    receiver
}

/// Connects the terminal to a board until the user ends the session, or `is_ended` returns true.
pub fn talk(
    opened: &mut Unsynchronised<SerialBoard>,
    is_ended: impl FnMut() -> bool,
) -> anyhow::Result<()> {
    let mut heard = Heard {
        board: &mut opened.board,
        log: None,
        until: None,
        last: Vec::new(),
        is_found: false,
        is_printed: false,
        end_ms: None,
    };
    let places = std::mem::take(&mut opened.places);
    interact(&mut heard, places, opened.said.as_deref(), is_ended)
}

/// Prints the output of a board, and the source location when its program ends with a message, until the connection fails or a signal ends
/// the process.
pub fn print_output(opened: Unsynchronised<SerialBoard>) -> anyhow::Result<()> {
    let Unsynchronised {
        mut board,
        mut places,
        said,
    } = opened;
    let mut received = said.unwrap_or_default();
    let mut output = std::io::stdout();
    loop {
        output.write_all(&received)?;
        output.flush()?;
        places.hear(&received).into_iter().for_each(note);
        received.clear();
        board.read(&mut received, POLL_MS)?;
    }
}

/// Passes the output that the board sent before the session to the terminal, without searching it for the text of `--until`.
fn print_earlier(board: &mut Heard) -> anyhow::Result<()> {
    let until = board.until.take();
    let end_ms = board.now_ms() + EARLIER_MS;
    let mut earlier = Vec::new();
    while board.now_ms() < end_ms {
        let before = earlier.len();
        board.read(&mut earlier, POLL_MS)?;
        if earlier.len() == before {
            break;
        }
    }
    board.until = until;
    let mut output = std::io::stdout();
    output.write_all(&earlier)?;
    Ok(output.flush()?)
}

/// Connects the terminal to a board until the user ends the session, the board prints the text of `--until`, or `is_ended` returns
/// true. When the program ends with a message, its source location follows.
fn interact(
    board: &mut Heard,
    mut places: Places,
    said: Option<&[u8]>,
    mut is_ended: impl FnMut() -> bool,
) -> anyhow::Result<()> {
    eprintln!("Ctrl-] ends the console.");
    let _raw = RawTerminal::enter()?;
    let keys = keys();
    let mut output = std::io::stdout();
    let mut received = Vec::new();
    match said {
        Some(said) => {
            board.hear(said)?;
            received.extend(said);
        }
        // An earlier program may have left the board in a boot or a transfer.
        None => {
            print_earlier(board)?;
            let mut console = Console::new(board);
            console.end_boot()?;
            console.reset_transfer()?;
            // An empty line makes the board print its prompt.
            board.write(b"\r")?;
        }
    }
    while !is_ended() {
        output.write_all(&received)?;
        if let Some(place) = places.hear(&received) {
            // In raw mode a line feed does not return to the start of the line.
            write!(output, "{place}\r\n")?;
        }
        output.flush()?;
        received.clear();
        board.read(&mut received, POLL_MS)?;
        if board.is_over()? {
            return Ok(());
        }
        match keys.try_recv() {
            Ok(typed) => {
                let end = typed.iter().position(|&key| key == EXIT);
                board.write(&typed[..end.unwrap_or(typed.len())])?;
                if end.is_some() {
                    return Ok(());
                }
            }
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return Ok(()),
        }
    }
    Ok(())
}
