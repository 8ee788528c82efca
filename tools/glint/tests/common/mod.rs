//! What the system tests share: the machine as `cargo xtask` builds it, and programs at a board's terminal.

#![allow(dead_code)] // Each test program uses its part.

use std::fs::File;
use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use virtual_board::pty::Pty;

/// Something in the checkout.
pub fn path(below_root: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(below_root)
}

/// The firmware's file.
pub fn firmware_path() -> PathBuf {
    let path = path("target/firmware/glint.bin");
    assert!(
        path.is_file(),
        "{} is missing: run `cargo xtask firmware`",
        path.display()
    );
    path
}

/// The firmware.
pub fn firmware() -> Vec<u8> {
    std::fs::read(firmware_path()).expect("the firmware can be read")
}

/// How often a program that says nothing is asked whether it has waited too long.
const LOOK: Duration = Duration::from_millis(20);

/// How much of what a program says is kept, and how much of that is shown when it fails, in bytes.
const KEPT: usize = 64 << 10;
const SHOWN: usize = 2000;

/// A program that talks to a board behind a pseudo-terminal. It is killed when this goes.
pub struct Program {
    child: Child,
    output: Receiver<Vec<u8>>,
    /// What it has said lately.
    said: Vec<u8>,
    /// How much of that has been looked at.
    seen: usize,
}

impl Program {
    /// Starts a program. Its output is taken in by this.
    pub fn start(command: &mut Command) -> Self {
        let mut child = command
            .stdout(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("{command:?}: {error}"));
        let mut stdout = child.stdout.take().expect("its output is piped");
        let (sender, output) = channel();
        std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(length @ 1..) = stdout.read(&mut buffer) {
                if sender.send(buffer[..length].to_vec()).is_err() {
                    return;
                }
            }
        });
        Self {
            child,
            output,
            said: Vec::new(),
            seen: 0,
        }
    }

    /// Waits until it says `text`, and returns what it said before that since the last time. Fails when it ends before
    /// that, or when `board` has run `limit` cycles.
    pub fn expect(&mut self, text: &str, board: &Pty, limit: u64) -> String {
        let end = board.with(|board| board.cycles()) + limit;
        loop {
            let new = &self.said[self.seen..];
            if let Some(at) = new
                .windows(text.len())
                .position(|window| window == text.as_bytes())
            {
                let before = String::from_utf8_lossy(&new[..at]).into_owned();
                self.seen += at + text.len();
                return before;
            }
            match self.output.recv_timeout(LOOK) {
                Ok(bytes) => {
                    self.said.extend(bytes);
                    self.forget();
                }
                Err(RecvTimeoutError::Disconnected) => {
                    panic!("it ended before it said {text:?}: {}", self.last())
                }
                Err(RecvTimeoutError::Timeout) => assert!(
                    board.with(|board| board.cycles()) < end,
                    "it did not say {text:?} within {limit} cycles: {}",
                    self.last()
                ),
            }
        }
    }

    /// Drops what was said long ago: a program may write its progress all the time.
    fn forget(&mut self) {
        let surplus = self.said.len().saturating_sub(KEPT);
        self.said.drain(..surplus);
        self.seen = self.seen.saturating_sub(surplus);
    }

    /// The last that it has said.
    fn last(&self) -> String {
        let from = self.said.len().saturating_sub(SHOWN);
        String::from_utf8_lossy(&self.said[from..]).into_owned()
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().expect("the state of a child")
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A terminal for a program that asks for one: the keyboard's side, and the program's.
pub fn terminal() -> (File, OwnedFd) {
    let keyboard =
        openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).expect("a terminal");
    grantpt(&keyboard).expect("a terminal");
    unlockpt(&keyboard).expect("a terminal");
    let name = ptsname(&keyboard, Vec::new()).expect("a terminal");
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
    let program = rustix::fs::open(&*name, flags, Mode::empty()).expect("a terminal");
    (File::from(keyboard), program)
}

/// Presses keys.
pub fn press(keyboard: &mut File, keys: &str) {
    keyboard
        .write_all(keys.as_bytes())
        .expect("the terminal takes keys");
}
