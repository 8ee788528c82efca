//! Serial boot of the firmware through the BIOS: by LiteX's own terminal over the virtual board's pseudo-terminal, and by `glint flash`
//! on the emulated board.

use crate::terminal::Terminal;
use glint::board::SimulatedBoard;
use glint::console::Console;
use glint::flash;
use std::path::{Path, PathBuf};
use virtual_board::{Start, VirtualBoard, pty::Pty};

/// Time-out of a test in clock cycles of the board: several times as many as the tests need.
const LIMIT: u64 = 400_000_000;

/// Address of main memory, where the program begins.
const MAIN_RAM: u32 = 0x4000_0000;

/// Longest wait of `glint flash` for the BIOS in milliseconds of the board's time.
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
    let program = std::fs::read(firmware()).unwrap();
    let mut board = SimulatedBoard::emulated_bios().unwrap();
    let report = flash::flash(&mut board, &program, MAIN_RAM, PATIENCE_MS, &mut |_, _| {}).unwrap();
    assert_eq!(report.bytes, program.len());
    assert_eq!(report.retries, 0);
    let mut console = Console::new(&mut board);
    console.greet().unwrap();
    let info = console.command("info").unwrap();
    assert!(info.iter().any(|line| line == "triangles 12"), "{info:?}");
}
