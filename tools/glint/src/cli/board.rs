//! `glint board`.

use super::common::LineArguments;
use super::messages::{say, warn};
use super::output::Output;
use super::terminal::interact;
use anyhow::Context;
use clap::Args;
use glint::board::{SerialBoard, SimulatedBoard};
use rustix::termios::isatty;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use virtual_board::pty::{Pty, Uart};

/// Run a simulated board that stays: print its serial port, and run until Ctrl-C.
///
/// Every program that talks to a serial port can use the port, one at a time: `glint … --board PORT`, litex_term, a script. Several
/// boards run side by side. On a terminal without --pty and --ready-file, the board's console opens at once; Ctrl-] ends it and
/// the board.
#[derive(Args)]
pub struct BoardArguments {
    /// Symbolic link to make to the port, removed at the end; a link of an earlier board is replaced.
    #[arg(long, value_name = "LINK")]
    pty: Option<PathBuf>,
    /// File to write the port's path to, when programs can use the board; an earlier one is removed at the start.
    #[arg(long, value_name = "FILE")]
    ready_file: Option<PathBuf>,
    /// Start with the BIOS, which waits for a program, as a board without one in its flash memory.
    #[arg(long)]
    bios: bool,
    /// Kind of board: `emulated` (the firmware in an emulator), or `virtual` (the verilated SoC), which is slower.
    #[arg(long, default_value = "emulated", value_parser = ["emulated", "virtual"], value_name = "BOARD")]
    board: String,
    #[command(flatten)]
    line: LineArguments,
}

impl BoardArguments {
    pub fn run(self) -> anyhow::Result<()> {
        match (self.board.as_str(), self.bios) {
            ("virtual", true) => self.stay(SimulatedBoard::full),
            ("virtual", false) => self.stay(|| self.line.virtual_board()),
            (_, true) => self.stay(SimulatedBoard::emulated_bios),
            (_, false) => self.stay(|| self.line.emulated_board()),
        }
    }

    fn stay<B: Uart, E: Into<anyhow::Error>>(
        &self,
        start: impl FnOnce() -> Result<B, E>,
    ) -> anyhow::Result<()> {
        let ready = self.ready_file.as_deref();
        if let Some(earlier) = ready.filter(|ready| ready.is_file()) {
            std::fs::remove_file(earlier).with_context(|| earlier.display().to_string())?;
        }
        let ready = ready.map(|path| Output::open(path, &[], [""; 0]));
        let ready = ready.transpose()?;
        let (end, ended) = channel();
        ctrlc::set_handler(move || {
            // Without a receiver the program ends already.
            let _ = end.send(());
        })?;
        let pty = Pty::start(start().map_err(Into::into)?)?;
        let port = pty.path();
        let link = self.pty.as_deref().map(|link| Link::new(link, port));
        let _link = link.transpose()?;
        say(port.display())?;
        if let Some(ready) = ready {
            ready.write(|out| writeln!(out, "{}", port.display()))?;
        }
        if self.pty.is_none() && self.ready_file.is_none() && isatty(std::io::stdin()) {
            let port = port.to_string_lossy();
            return interact(&mut SerialBoard::open(&port, self.line.baud.rate()?)?);
        }
        Ok(ended.recv()?)
    }
}

/// A symbolic link that is removed when it is dropped.
struct Link(PathBuf);

impl Link {
    fn new(link: &Path, port: &Path) -> anyhow::Result<Self> {
        let cannot = || format!("{}: cannot be linked to {}", link.display(), port.display());
        if link.is_symlink() {
            std::fs::remove_file(link).with_context(cannot)?;
        }
        symlink(port, link).with_context(cannot)?;
        Ok(Self(link.to_owned()))
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        if let Err(error) = std::fs::remove_file(&self.0) {
            warn(format_args!(
                "{}: cannot be removed: {error}",
                self.0.display()
            ));
        }
    }
}
