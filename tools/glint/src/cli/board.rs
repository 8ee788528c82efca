//! `glint board`.

use super::common::{LineArguments, say, warn};
use super::output::Output;
use super::terminal::interact;
use anyhow::Context;
use clap::Args;
use glint::board::{SerialBoard, SimulatedBoard, Simulation};
use glint::error::FormatError;
use glint::formats::read_file;
use rustix::termios::isatty;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use virtual_board::pty::{Pty, Uart};
use virtual_board::virtual_flash::{Flash, MAX_BYTES};

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
    /// File to write the port's path to, when programs can use the board.
    #[arg(long, value_name = "FILE")]
    ready_file: Option<PathBuf>,
    /// Start with the BIOS, which waits for a program, as a board without one in its flash memory.
    #[arg(long)]
    bios: bool,
    /// Start with the BIOS and this image in the flash memory (`glint image make`), as a board at power-up.
    #[arg(long, value_name = "IMAGE", conflicts_with = "firmware")]
    flash: Option<PathBuf>,
    /// Kind of board: `virtual` (the verilated SoC), or `emulated`, which is faster.
    #[arg(long, default_value = "virtual", value_parser = ["virtual", "emulated"], value_name = "BOARD")]
    board: String,
    #[command(flatten)]
    line: LineArguments,
}

impl BoardArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let bios = self.bios || self.flash.is_some();
        match (self.board.as_str(), bios) {
            ("emulated", true) => self.stay(|| self.powered(SimulatedBoard::emulated_bios()?)),
            ("emulated", false) => self.stay(|| self.line.emulated_board()),
            (_, true) => self.stay(|| self.powered(SimulatedBoard::full()?)),
            (_, false) => self.stay(|| self.line.virtual_board()),
        }
    }

    /// A board that starts with the BIOS, with its flash.
    fn powered<S: Simulation>(
        &self,
        mut board: SimulatedBoard<S>,
    ) -> anyhow::Result<SimulatedBoard<S>> {
        if let Some(path) = &self.flash {
            let image = read_file(path)?;
            let (found, limit) = (image.len(), MAX_BYTES);
            if found > limit {
                let expected = format!("at most {limit} bytes of an image");
                let error = FormatError::whole(expected, format!("{found} bytes"));
                return Err(error.in_path(path).into());
            }
            board.inner().plug_flash(Flash::new(image));
        }
        Ok(board)
    }

    fn stay<B: Uart>(&self, start: impl FnOnce() -> anyhow::Result<B>) -> anyhow::Result<()> {
        let ready = self.ready_file.as_deref();
        let ready = ready.map(|path| Output::open(path, &[], [""; 0]));
        let ready = ready.transpose()?;
        let (end, ended) = channel();
        ctrlc::set_handler(move || {
            // Without a receiver the program ends already.
            let _ = end.send(());
        })?;
        let pty = Pty::start(start()?)?;
        let port = pty.path();
        let link = self.pty.as_deref().map(|link| Link::new(link, port));
        let _link = link.transpose()?;
        say(port.display())?;
        if let Some(ready) = ready {
            ready.write(|out| writeln!(out, "{}", port.display()))?;
        }
        if self.pty.is_none() && self.ready_file.is_none() && isatty(std::io::stdin()) {
            let port = port.to_string_lossy();
            return interact(&mut SerialBoard::open(&port, self.line.baud)?);
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
