//! Serial boot of the firmware through the BIOS, over the virtual board's pseudo-terminal: by LiteX's own terminal, and by
//! `glint flash`.

use crate::terminal::Terminal;
use glint::board::SerialBoard;
use glint::console::Console;
use std::path::{Path, PathBuf};
use std::process::Command;
use virtual_board::{Start, VirtualBoard, pty::Pty};

/// Time-out of a test in clock cycles of the board: several times as many as the tests need.
const LIMIT: u64 = 400_000_000;

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

#[test]
fn litex_term_loads_the_firmware_and_gets_an_answer() {
    let board = board();
    let kernel = format!("--kernel={}", firmware().display());
    let port = board.path().to_str().unwrap();
    let mut terminal = Terminal::start(&root().join(".venv/bin/litex_term"), &[&kernel, port]);
    let mut is_over = || board.with(|board| board.cycles()) >= LIMIT;
    terminal.wait_for("Liftoff!", &mut is_over);
    terminal.wait_for("Glint", &mut is_over);
    terminal.wait_for("glint> ", &mut is_over);
    terminal.type_in(b"info\r");
    terminal.wait_for("triangles 12", &mut is_over);
    terminal.wait_for("ok", &mut is_over);
    // litex_term ends on two Ctrl-C within half a second. The second one counts only after the first has been read.
    terminal.type_in(b"\x03");
    terminal.wait_for("^C", &mut is_over);
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
