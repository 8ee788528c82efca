//! Runs a program that requires a terminal, such as litex_term.

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Number of bytes of output kept for an error message.
const KEPT: usize = 1000;

/// A program whose input is a terminal.
pub struct Terminal {
    pub child: Child,
    keys: File,
    output: Receiver<Vec<u8>>,
    seen: String,
}

impl Terminal {
    pub fn start(program: &Path, arguments: &[&str]) -> Self {
        let keys = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&keys).unwrap();
        unlockpt(&keys).unwrap();
        let path = ptsname(&keys, Vec::new()).unwrap().into_string().unwrap();
        let input = OpenOptions::new()
            .read(true)
            .write(true)
            .open(path)
            .unwrap();
        // Ctrl-C works only in a controlling terminal; `setsid --ctty` makes the input the controlling terminal.
        let mut child = Command::new("setsid")
            .arg("--ctty")
            .arg(program)
            .args(arguments)
            .env("PYTHONUNBUFFERED", "1")
            .stdin(input)
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap_or_else(|error| {
                panic!(
                    "{}: {error}; run `cargo xtask bootstrap`",
                    program.display()
                )
            });
        let mut stdout = child.stdout.take().unwrap();
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
            keys: File::from(keys),
            output,
            seen: String::new(),
        }
    }

    /// Waits until the program prints `wanted`; fails when `is_over` returns true. The search starts after the text that the
    /// previous wait found.
    pub fn wait_for(&mut self, wanted: &str, is_over: &mut dyn FnMut() -> bool) {
        self.wait_for_one_of(&[wanted], is_over);
    }

    /// Waits like [`wait_for`](Self::wait_for) until the program prints one of the texts; returns the first printed text.
    pub fn wait_for_one_of<'a>(
        &mut self,
        wanted: &[&'a str],
        is_over: &mut dyn FnMut() -> bool,
    ) -> &'a str {
        loop {
            let found = wanted
                .iter()
                .filter_map(|text| Some((self.seen.find(text)?, *text)))
                .min();
            if let Some((at, text)) = found {
                self.seen.drain(..at + text.len());
                return text;
            }
            // Only the last part of the output is kept, because progress bars print megabytes.
            let keep = self
                .seen
                .floor_char_boundary(self.seen.len().saturating_sub(KEPT));
            self.seen.drain(..keep);
            match self.output.recv_timeout(Duration::from_secs(1)) {
                Ok(bytes) => self.seen.push_str(&String::from_utf8_lossy(&bytes)),
                Err(RecvTimeoutError::Timeout) => {
                    assert!(!is_over(), "expected {wanted:?}, found {:?}", self.seen);
                }
                Err(RecvTimeoutError::Disconnected) => {
                    panic!("the program ended without {wanted:?}: {:?}", self.seen)
                }
            }
        }
    }

    pub fn type_in(&mut self, keys: &[u8]) {
        self.keys.write_all(keys).unwrap();
    }
}

/// Returns a function that returns true after `seconds` calls. A wait for a terminal calls it after
/// each second without output.
pub fn patience(seconds: u32) -> impl FnMut() -> bool {
    let mut left = seconds;
    move || {
        left = left.saturating_sub(1);
        left == 0
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // The program has already ended, unless the test failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
