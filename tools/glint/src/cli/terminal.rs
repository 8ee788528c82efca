//! `glint console`.

use super::common::{LineArguments, print_json, say};
use anyhow::Context;
use clap::Args;
use glint::board::{Board, BoardName};
use glint::console::Console;
use rustix::termios::{OptionalActions, Termios, isatty, tcgetattr, tcsetattr};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Code of the key Ctrl-], which ends the session.
const EXIT: u8 = 0x1d;
/// Time-out of a read from the board, in milliseconds of the board's time.
const LOOK_MS: u64 = 10;

/// Open a board's console, or send commands to it.
///
/// On a terminal Ctrl-] ends the session, and Ctrl-C ends what runs on the board. Commands come from --send, from --file, or line by line
/// from standard input if that is no terminal; the first one that fails ends the program.
#[derive(Args)]
pub struct ConsoleArguments {
    /// Board: `emulated`, `virtual` or a serial port.
    #[arg(default_value = "emulated")]
    board: BoardName,
    /// Send a command, print its reply and exit; repeatable.
    #[arg(long, value_name = "COMMAND", allow_hyphen_values = true)]
    send: Vec<String>,
    /// Send the commands of a file, one a line; `-` is standard input. Empty lines and lines that start with # are skipped.
    #[arg(long, value_name = "SCRIPT", conflicts_with = "send")]
    file: Option<PathBuf>,
    #[command(flatten)]
    line: LineArguments,
    /// Print the replies to commands as JSON: an array of lines for each command that did not fail.
    #[arg(long)]
    json: bool,
}

impl ConsoleArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let script: Box<dyn Iterator<Item = io::Result<String>>> = match &self.file {
            Some(path) if path != Path::new("-") => {
                let file = File::open(path).with_context(|| path.display().to_string())?;
                Box::new(BufReader::new(file).lines())
            }
            None if !self.send.is_empty() => Box::new(self.send.iter().cloned().map(Ok)),
            None if isatty(std::io::stdin()) => {
                anyhow::ensure!(!self.json, "--json: expected commands, found a terminal");
                return interact(&mut *self.line.unsynchronised_board(&self.board)?);
            }
            _ => Box::new(std::io::stdin().lines()),
        };
        let mut board = self.line.board(&self.board)?;
        let mut replies = Vec::new();
        let result = self.execute(script, &mut Console::new(&mut *board), &mut replies);
        if self.json {
            print_json(&replies)?;
        }
        result
    }

    /// Sends the commands of a script up to the first one that fails, and collects or prints the replies.
    fn execute(
        &self,
        script: impl Iterator<Item = io::Result<String>>,
        console: &mut Console,
        replies: &mut Vec<Vec<String>>,
    ) -> anyhow::Result<()> {
        for command in script {
            let command = command.context("the commands")?;
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

/// The terminal in raw mode, so that keys reach the board unchanged; restores the old mode when dropped.
struct RawTerminal(Option<Termios>);

impl RawTerminal {
    fn enter() -> anyhow::Result<Self> {
        let stdin = std::io::stdin();
        if !isatty(&stdin) {
            return Ok(Self(None));
        }
        let before = tcgetattr(&stdin).context("the terminal's settings")?;
        let mut raw = before.clone();
        raw.make_raw();
        tcsetattr(&stdin, OptionalActions::Flush, &raw).context("the terminal's settings")?;
        Ok(Self(Some(before)))
    }
}

impl Drop for RawTerminal {
    fn drop(&mut self) {
        if let Some(before) = &self.0 {
            // An error is ignored: if the terminal is gone, there is no mode to restore.
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

/// Connects the terminal with the board until the user ends the session.
pub fn interact(board: &mut dyn Board) -> anyhow::Result<()> {
    eprintln!("Ctrl-] ends the console.");
    let _raw = RawTerminal::enter()?;
    let keys = keys();
    let mut output = std::io::stdout();
    let mut received = Vec::new();
    Console::new(board).reset_transfer()?;
    // Makes the board print its prompt.
    board.write(b"\r")?;
    loop {
        board.read(&mut received, LOOK_MS)?;
        output.write_all(&received)?;
        output.flush()?;
        received.clear();
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
}
