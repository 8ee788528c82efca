//! The firmware goes in through the BIOS's serial boot, over the virtual board's pseudo-terminal: by LiteX's own terminal,
//! and by `glint flash`.

use glint::board::SerialBoard;
use glint::console::Console;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;
use virtual_board::{Start, VirtualBoard, pty::Pty};

/// Cycles of the board after which it has failed: several times what it needs.
const LIMIT: u64 = 400_000_000;

/// Bytes of output that are kept while something else is waited for: enough for a message of failure.
const KEPT: usize = 1000;

/// The host's time after which `glint flash` or a console has failed.
const PATIENCE_MS: u64 = 300_000;

/// The firmware that `cargo xtask firmware` builds.
fn firmware() -> PathBuf {
    root().join("target/firmware/glint.bin")
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// A board that starts as it does at power on, on a pseudo-terminal.
fn board() -> Pty {
    Pty::start(VirtualBoard::builder().start(Start::Full).build().unwrap()).unwrap()
}

/// A program with a terminal for its input, which litex_term insists on.
struct Terminal {
    child: Child,
    keys: File,
    output: Receiver<Vec<u8>>,
    seen: String,
}

impl Terminal {
    fn start(program: &Path, arguments: &[&str]) -> Self {
        let keys = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&keys).unwrap();
        unlockpt(&keys).unwrap();
        let path = ptsname(&keys, Vec::new()).unwrap().into_string().unwrap();
        let input = OpenOptions::new()
            .read(true)
            .write(true)
            .open(path)
            .unwrap();
        // It hears Ctrl-C only from a terminal that is its own.
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

    /// Waits until the program has printed `wanted` behind what was waited for before.
    fn wait_for(&mut self, wanted: &str, board: &Pty) {
        loop {
            if let Some(at) = self.seen.find(wanted) {
                self.seen.drain(..at + wanted.len());
                return;
            }
            // Its progress bar goes on for megabytes.
            let keep = self
                .seen
                .floor_char_boundary(self.seen.len().saturating_sub(KEPT));
            self.seen.drain(..keep);
            match self.output.recv_timeout(Duration::from_secs(1)) {
                Ok(bytes) => self.seen.push_str(&String::from_utf8_lossy(&bytes)),
                Err(RecvTimeoutError::Timeout) => {
                    let cycles = board.with(|board| board.cycles());
                    assert!(
                        cycles < LIMIT,
                        "{cycles} cycles without {wanted:?}; it printed {:?}",
                        self.seen
                    );
                }
                Err(RecvTimeoutError::Disconnected) => {
                    panic!("it ended without {wanted:?}: {:?}", self.seen)
                }
            }
        }
    }

    fn type_in(&mut self, keys: &[u8]) {
        self.keys.write_all(keys).unwrap();
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // Ended already, unless a test has failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn litex_term_loads_the_firmware_and_gets_an_answer() {
    let board = board();
    let kernel = format!("--kernel={}", firmware().display());
    let port = board.path().to_str().unwrap();
    let mut terminal = Terminal::start(&root().join(".venv/bin/litex_term"), &[&kernel, port]);
    terminal.wait_for("Liftoff!", &board);
    terminal.wait_for("Glint", &board);
    terminal.wait_for("glint> ", &board);
    terminal.type_in(b"info\r");
    terminal.wait_for("triangles 12", &board);
    terminal.wait_for("ok", &board);
    // The second must come within half a second of the first, but not before it has been heard.
    terminal.type_in(b"\x03");
    terminal.wait_for("^C", &board);
    terminal.type_in(b"\x03");
    assert!(terminal.child.wait().unwrap().success());
}

#[test]
fn glint_flash_loads_the_firmware_and_it_answers() {
    let board = board();
    let port = board.path().to_str().unwrap();
    let flashed = Command::new(env!("CARGO_BIN_EXE_glint"))
        .arg("flash")
        .arg(firmware())
        .args(["--board", port, "--json"])
        .output()
        .unwrap();
    assert!(flashed.status.success(), "{flashed:?}");
    let report: serde_json::Value = serde_json::from_slice(&flashed.stdout).unwrap();
    let bytes = std::fs::metadata(firmware()).unwrap().len();
    assert_eq!(report["bytes"], bytes, "{report}");

    let mut line = SerialBoard::open(port, 115_200).unwrap();
    let mut console = Console::new(&mut line).patience(PATIENCE_MS);
    let banner = console.greet().unwrap();
    assert!(
        banner.contains("Liftoff!") && banner.contains("Glint"),
        "{banner}"
    );
    let info = console.command("info").unwrap();
    assert!(info.iter().any(|line| line == "triangles 12"), "{info:?}");
}
