//! Serial boot through the BIOS, by LiteX's own terminal and by `glint flash`. Most tests load a
//! small program, because a transfer of the firmware to the verilated board would take minutes.

use crate::common::{begin_upload, mesh};
use crate::power_up::read_until;
use crate::terminal::Terminal;
use glint::board::{self, Board, EmulatedBoard, SimulatedBoard, Uart};
use glint::console::Console;
use glint::flash;
use litex_pac::uart::{self, offset};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use virtual_board::pty::Pty;
use virtual_board::{Simulation, Start, VirtualBoard};

/// Time-out of a test on the verilated board in its clock cycles: several times the duration of the test.
const LIMIT: u64 = 400_000_000;

/// Time-out of litex_term with the firmware, in clock cycles of the emulated board: ten minutes.
const EMULATED_LIMIT: u64 = 600 * 81_250_000;

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

/// A program that prints nothing: `jal x0, 0`.
pub const MUTE: [u8; 4] = [0x6f, 0, 0, 0];

/// A program that prints `text` on the serial port, and ends in an endless loop.
pub fn printer(text: &str) -> Vec<u8> {
    const {
        assert!(
            offset::RXTX == 0 && offset::TXFULL == 4,
            "as in the instructions"
        )
    }
    // lui x5, the UART's address
    let mut code = vec![uart::Uart::BASE as u32 | 5 << 7 | 0x37];
    for character in text.bytes() {
        code.extend([
            // addi x6, x0, character
            u32::from(character) << 20 | 6 << 7 | 0x13,
            // lw x7, 4(x5): whether the queue is full
            0x0042_a383,
            // bne x7, x0, -4
            0xfe03_9ee3,
            // sw x6, 0(x5)
            0x0062_a023,
        ]);
    }
    // jal x0, 0
    code.push(0x0000_006f);
    code.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Starts litex_term on a port, with the program at `kernel`.
fn litex_term(kernel: &Path, port: &Path) -> Terminal {
    let kernel = format!("--kernel={}", kernel.display());
    let program = root().join(".venv/bin/litex_term");
    Terminal::start(&program, &[&kernel, port.to_str().unwrap()])
}

#[test]
fn litex_term_loads_a_program_into_the_verilated_board() {
    let mut program = printer("Program runs\n");
    // The transfer consists of several frames.
    program.resize(4096, 0);
    let mut kernel = tempfile::NamedTempFile::new().unwrap();
    kernel.write_all(&program).unwrap();
    let board = VirtualBoard::builder().start(Start::Full).build().unwrap();
    let board = Pty::start(board).unwrap();
    let mut terminal = litex_term(kernel.path(), board.path());
    let mut is_over = || board.with(|board| board.cycles()) >= LIMIT;
    terminal.wait_for("Liftoff!", &mut is_over);
    terminal.wait_for("Program runs", &mut is_over);
}

#[test]
fn litex_term_loads_the_firmware_into_the_emulated_board() {
    let mut board = board::emulated_bios().unwrap();
    read_until(&mut board, "litex");
    let board = Pty::start(board).unwrap();
    let mut terminal = litex_term(&firmware(), board.path());
    let mut is_over = || board.with(|board| board.inner().cycles()) >= EMULATED_LIMIT;
    let ends = ["Liftoff!", "Timeout"];
    loop {
        terminal.type_in(b"serialboot\r");
        // The BIOS waits 250 ms for litex_term.
        match terminal.wait_for_one_of(&ends, &mut is_over) {
            "Liftoff!" => break,
            _ => assert!(!is_over()),
        }
    }
    terminal.wait_for("glint> ", &mut is_over);
    terminal.type_in(b"info triangles\r");
    terminal.wait_for("triangles 12", &mut is_over);
}

#[test]
fn glint_board_loads_a_program_by_the_port_and_locates_its_faults() {
    let board = Pty::start(board::emulated_bios().unwrap()).unwrap();
    let port = board.path().to_str().unwrap();
    let program = root().join("target/firmware/programs/faults.elf");
    let program = program.to_str().unwrap();
    let arguments = ["board", "--board", port, "--firmware", program];
    let glint = Path::new(env!("CARGO_BIN_EXE_glint"));
    let mut terminal = Terminal::start(glint, &arguments);
    let mut is_over = || board.with(|board| board.inner().cycles()) >= EMULATED_LIMIT;
    terminal.wait_for("switches 0 to 4", &mut is_over);
    // Switch 4 executes an illegal instruction.
    board.with(|board| board.inner().set_switches(1 << 4));
    terminal.wait_for("press Enter to restart", &mut is_over);
    terminal.wait_for("examples/faults.rs:", &mut is_over);
    // A restart returns to the BIOS, because the flash has no program.
    terminal.type_in(b"\r");
    terminal.wait_for("Booting from serial", &mut is_over);
}

#[test]
fn glint_flash_loads_the_firmware_and_it_answers() {
    let program = std::fs::read(firmware()).unwrap();
    let mut board = board::emulated_bios().unwrap();
    let report = flash::flash(&mut board, &program, MAIN_RAM, PATIENCE_MS, &mut |_, _| {}).unwrap();
    assert_eq!(report.bytes, program.len());
    assert_eq!(report.retries, 0);
    let mut console = Console::new(&mut board);
    console.greet().unwrap();
    let info = console.command("info").unwrap();
    assert!(info.iter().any(|line| line == "triangles 12"), "{info:?}");
}

/// Loads a small program, and checks that it runs.
fn load(board: &mut SimulatedBoard<EmulatedBoard>) {
    let mut program = printer("Program runs\n");
    program.resize(1000, 0);
    let report = flash::flash(board, &program, MAIN_RAM, 60_000, &mut |_, _| {}).unwrap();
    flash::await_text(board, &report.said, 1000).unwrap();
}

/// Reads from a board until it requests a serial boot, and accepts.
fn accept(board: &mut SimulatedBoard<EmulatedBoard>) {
    let mut heard = Vec::new();
    while !heard.ends_with(flash::REQUEST) {
        board.read(&mut heard, 1).unwrap();
    }
    board.write(flash::ACCEPT).unwrap();
}

/// No program has read the output of this board, so its requests for a serial boot have expired.
#[test]
fn a_board_that_has_waited_is_flashed_at_once() {
    let mut board = board::emulated_bios().unwrap();
    board.run(3 * 81_250_000);
    load(&mut board);
    // The program does not answer `reboot`.
    let program = printer("Program runs\n");
    let error = flash::flash(&mut board, &program, MAIN_RAM, 5_000, &mut |_, _| {}).unwrap_err();
    let expected = "expected the BIOS's request sL5DdSMmkekro, found ";
    assert!(error.to_string().contains(expected), "{error}");
}

#[test]
fn a_boot_that_was_interrupted_does_not_keep_the_next_out() {
    // The start of a frame that loads data. None, a part or all of these bytes arrive.
    let start = [100, 0x12, 0x34, 1, 0x40, 0, 0, 0];
    for length in [0, 1, start.len()] {
        let mut board = board::emulated_bios().unwrap();
        accept(&mut board);
        board.write(&start[..length]).unwrap();
        load(&mut board);
    }
}

#[test]
fn the_console_frees_a_board_from_an_interrupted_boot() {
    let mut board = board::emulated_bios().unwrap();
    accept(&mut board);
    board.write(&[100, 0x12, 0x34, 1]).unwrap();
    let error = Console::new(&mut board).synchronise().unwrap_err();
    let expected = "expected the firmware, found the prompt of the BIOS";
    assert!(error.to_string().starts_with(expected), "{error}");
    load(&mut board);
}

#[test]
fn firmware_in_a_transfer_is_replaced() {
    let firmware = std::fs::read(firmware()).unwrap();
    let mut board = board::emulated_bios().unwrap();
    flash::flash(&mut board, &firmware, MAIN_RAM, 60_000, &mut |_, _| {}).unwrap();
    let mut console = Console::new(&mut board);
    console.greet().unwrap();
    begin_upload(&mut console, &mesh("icosphere:4"));
    load(&mut board);
}

#[test]
fn a_program_that_prints_nothing_is_an_error() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let flash = |program: &[u8], option: &[&str]| {
        std::fs::write(file.path(), program).unwrap();
        let mut glint = Command::new(env!("CARGO_BIN_EXE_glint"));
        let glint = glint.args(["flash", "--board", "emulated"]).args(option);
        let output = glint.arg(file.path()).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        (output.status.code(), error)
    };
    let (code, error) = flash(&MUTE, &[]);
    let expected = "error: the program was loaded and started, and printed nothing for 10000 ms: ";
    // On a busy machine, lines about the progress precede the error.
    assert!(code == Some(1) && error.contains(expected), "{error}");
    assert_eq!(flash(&MUTE, &["--no-output"]).0, Some(0));
    assert_eq!(flash(&printer("Program runs\n"), &[]).0, Some(0));
    // jalr x0, 0(x0): back to the start of the BIOS.
    let (code, error) = flash(&[0x67, 0, 0, 0], &[]);
    let expected = "error: the program was loaded and started, and the board is in its BIOS again";
    // On a busy machine, lines about the progress precede the error.
    assert!(code == Some(1) && error.contains(expected), "{error}");
}
