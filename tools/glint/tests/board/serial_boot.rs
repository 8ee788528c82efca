//! Serial boot of the firmware through the BIOS, over the virtual board's pseudo-terminal: by LiteX's own terminal, and by
//! `glint flash`.

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

/// Time-out of a test in clock cycles of the board: several times as many as the tests need.
const LIMIT: u64 = 400_000_000;

/// Bytes of output kept for an error message.
const KEPT: usize = 1000;

/// Time-out of `glint flash` and of a console, in host time.
const PATIENCE_MS: u64 = 300_000;

/// The firmware built by `cargo xtask firmware`.
fn firmware() -> PathBuf {
    root().join("target/firmware/glint.bin")
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// A board on a pseudo-terminal, started as at power-on.
fn board() -> Pty {
    Pty::start(VirtualBoard::builder().start(Start::Full).build().unwrap()).unwrap()
}

/// A program with a terminal as its input, as litex_term requires.
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
        // Ctrl-C works in a controlling terminal only, which `setsid --ctty` makes of the input.
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

    /// Waits until the program prints `wanted`. The search starts after the text that the previous wait has found.
    fn wait_for(&mut self, wanted: &str, board: &Pty) {
        loop {
            if let Some(at) = self.seen.find(wanted) {
                self.seen.drain(..at + wanted.len());
                return;
            }
            // Only the end of the output is kept, because the progress bar prints megabytes.
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
        // The program has ended already, unless the test failed.
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
    // litex_term ends on two Ctrl-C within half a second. The second one counts only after the first has been read.
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
