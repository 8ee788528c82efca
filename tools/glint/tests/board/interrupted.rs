//! Interrupted uploads: the uploading program is killed, or a user cancels the upload on the console.

use crate::common::{begin_upload, console, emulator, info, mesh, small};
use crate::terminal::{Terminal, patience};
use glint::board::{Board, BoardError, EmulatedBoard, SimulatedBoard, Uart};
use glint::console::Console;
use glint::transfer;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use virtual_board::pty::Pty;

/// Number of received bytes after which a transfer is interrupted: more than all commands together,
/// fewer than the mesh.
const PART: usize = 4_000;
/// The mesh of a killed upload: about 100,000 bytes.
const LARGE: &str = "icosphere:16";
/// Seconds without progress after which a test fails.
const PATIENCE: u32 = 120;

/// A board on a serial port. It shows a mesh of 20 triangles.
struct Port {
    pty: Pty<SimulatedBoard<EmulatedBoard>>,
    /// Number of bytes that the board has received.
    received: Arc<AtomicUsize>,
}

impl Port {
    fn start() -> Self {
        let mut board = emulator();
        console(&mut board);
        let received = Arc::<AtomicUsize>::default();
        let count = received.clone();
        let pty = Pty::watched(board, move |sent, _| {
            count.fetch_add(sent.len(), Ordering::Relaxed);
        });
        let pty = pty.unwrap();
        let port = Self { pty, received };
        port.succeed(&["upload", "icosphere:1"]);
        assert_eq!(port.triangles(), "20");
        port
    }

    fn path(&self) -> &str {
        self.pty.path().to_str().unwrap()
    }

    /// The program `glint` with this port as its board.
    fn glint(&self, arguments: &[&str]) -> Command {
        let mut glint = Command::new(env!("CARGO_BIN_EXE_glint"));
        glint.args(arguments).env("GLINT_BOARD", self.path());
        glint
    }

    fn succeed(&self, arguments: &[&str]) -> Vec<u8> {
        let output = self.glint(arguments).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {error}");
        output.stdout
    }

    fn triangles(&self) -> String {
        let info = self.succeed(&["info", "--json"]);
        let info: serde_json::Value = serde_json::from_slice(&info).unwrap();
        info["triangles"].as_str().unwrap().to_owned()
    }

    /// Kills an upload with SIGKILL when the board has received a part of the mesh.
    fn kill_an_upload(&self) {
        let received = || self.received.load(Ordering::Relaxed);
        let part = received() + PART;
        let mut upload = self.glint(&["upload", LARGE]).spawn().unwrap();
        let end = Instant::now() + Duration::from_secs(PATIENCE.into());
        while received() < part {
            assert!(Instant::now() < end, "{} bytes were received", received());
            std::thread::sleep(Duration::from_millis(1));
        }
        upload.kill().unwrap();
        assert!(!upload.wait().unwrap().success());
    }
}

#[test]
fn a_killed_upload_leaves_the_old_model_and_the_next_upload_works() {
    let port = Port::start();
    port.kill_an_upload();
    assert_eq!(port.triangles(), "20");
    port.kill_an_upload();
    port.succeed(&["upload", "icosphere:4"]);
    assert_eq!(port.triangles(), "320");
}

/// The key Ctrl-C cancels a transfer that another program has left in the middle of a frame. The
/// bytes are sent in the way of litex_term.
#[test]
fn ctrl_c_cancels_a_half_done_upload() {
    let mut board = emulator();
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    let mut console = console(&mut board);
    transfer::upload(&mut console, &mesh("icosphere:1"), None, 1, quiet).unwrap();
    begin_upload(&mut console, &mesh("icosphere:4"));
    let board = console.board();
    let mut said = Vec::new();
    // A user types more slowly than a program.
    let typed = board.now_ms() + 100;
    while board.now_ms() < typed {
        board.read(&mut said, 10).unwrap();
    }
    said.clear();
    board.write(b"\x03").unwrap();
    let cancelled = b"cancelled by the other side";
    while !said.windows(cancelled.len()).any(|part| part == cancelled) {
        board.read(&mut said, 100).unwrap();
        assert!(board.now_ms() - typed < 500, "{}", said.escape_ascii());
    }
    let mut console = Console::new(board).patience(2_000);
    console.synchronise().unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
}

/// In a session of `glint console`, the key Ctrl-C cancels a transfer that was started on the
/// console.
#[test]
fn ctrl_c_in_a_session_cancels_a_transfer() {
    let port = Port::start();
    let program = Path::new(env!("CARGO_BIN_EXE_glint"));
    let mut terminal = Terminal::start(program, &["console", port.path()]);
    let mut is_over = patience(PATIENCE);
    // After the prompt, the terminal passes all keys to the board.
    terminal.wait_for("glint> ", &mut is_over);
    terminal.type_in(b"load 100 0\r");
    terminal.wait_for("ready", &mut is_over);
    terminal.type_in(b"\x03");
    terminal.wait_for("cancelled by the other side", &mut is_over);
    terminal.type_in(b"info triangles\r");
    terminal.wait_for("triangles 20", &mut is_over);
    terminal.type_in(b"\x1d");
    assert!(terminal.child.wait().unwrap().success());
}

/// A board whose host stops for eight seconds after a number of writes, like a suspended laptop.
struct Stopped {
    board: SimulatedBoard<EmulatedBoard>,
    writes: u32,
}

impl Board for Stopped {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.write(bytes)?;
        self.writes = self.writes.wrapping_sub(1);
        if self.writes == 0 {
            let clock = u64::from(self.board.clock_hz());
            self.board.run(8 * clock);
        }
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        self.board.read(bytes, wait_ms)
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }
}

#[test]
fn transfers_go_on_after_the_host_was_stopped() {
    let mut board = emulator();
    small(&mut board);
    let mut stopped = Stopped { board, writes: 0 };
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    // The host stops after the command and some frames of the transfer.
    stopped.writes = 10;
    let mut host = Console::new(&mut stopped);
    transfer::upload(&mut host, &mesh("icosphere:4"), None, 1, quiet).unwrap();
    assert_eq!(info::<u32>(&mut host, "triangles"), 320);
    stopped.writes = 10;
    let mut host = Console::new(&mut stopped);
    let frame = transfer::download(&mut host, "frame", 2 * 320 * 180, quiet).unwrap();
    assert!(frame.iter().any(|&byte| byte != 0));
}
