//! `glint console`.

use super::common::{LineArguments, print_json, say};
use anyhow::Context;
use clap::Args;
use glint::board::{Board, BoardName};
use glint::console::Console;
use rustix::termios::{OptionalActions, Termios, isatty, tcgetattr, tcsetattr};
use std::io::{Read, Write};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Code of the key Ctrl-], which ends the session.
const EXIT: u8 = 0x1d;
/// Time-out of a read from the board, in milliseconds of the board's time.
const LOOK_MS: u64 = 10;

/// Open a board's console. Ctrl-] ends the session.
#[derive(Args)]
pub struct ConsoleArguments {
    /// Board: `emulated`, `virtual` or a serial port.
    board: BoardName,
    /// Send a command, print its reply and exit; repeatable.
    #[arg(long, value_name = "COMMAND")]
    send: Vec<String>,
    #[command(flatten)]
    line: LineArguments,
    /// Print the replies to --send as JSON: an array of lines for each command.
    #[arg(long, requires = "send")]
    json: bool,
}

impl ConsoleArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let mut board = self.line.board(&self.board)?;
        if self.send.is_empty() {
            return interact(&mut *board);
        }
        let mut console = Console::new(&mut *board);
        let mut replies = Vec::new();
        for command in &self.send {
            let lines = console.command(command)?;
            if !self.json {
                lines.iter().try_for_each(say)?;
            }
            replies.push(lines);
        }
        if self.json {
            print_json(&replies)
        } else {
            Ok(())
        }
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

fn interact(board: &mut dyn Board) -> anyhow::Result<()> {
    eprintln!("Ctrl-] ends the console.");
    let _raw = RawTerminal::enter()?;
    let keys = keys();
    let mut output = std::io::stdout();
    let mut received = Vec::new();
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
