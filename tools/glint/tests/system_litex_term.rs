//! LiteX's own terminal on the virtual board: from power on over the BIOS's serial boot to an answer of the firmware.

mod common;

use std::process::Command;

use common::Program;
use virtual_board::pty::Pty;
use virtual_board::{Start, VirtualBoard};

#[test]
fn litex_term_boots_the_firmware_and_talks_to_it() {
    let litex_term = common::path(".venv/bin/litex_term");
    assert!(
        litex_term.is_file(),
        "{} is missing: run `cargo xtask bootstrap`",
        litex_term.display()
    );
    let board = VirtualBoard::builder()
        .start(Start::Full)
        .library(std::env::var("GLINT_LIB").unwrap())
        .build()
        .expect("a virtual board");
    let board = Pty::start(board).expect("a pseudo-terminal");
    let (mut keyboard, stdin) = common::terminal();
    // Ctrl-C becomes a signal only from a terminal that the program controls.
    let mut program = Program::start(
        Command::new("setsid")
            .arg("--ctty")
            .arg(litex_term)
            .arg(board.path())
            .arg("--kernel")
            .arg(common::firmware_path())
            .stdin(stdin),
    );
    for text in [
        "Press Q or ESC",
        "Upload calibration",
        "Upload complete",
        "Liftoff!",
        "Glint ",
        "glint> ",
    ] {
        let said = program.expect(text, &board, 400_000_000);
        eprintln!("{:?} {} {}", text, board.with(|b| b.cycles()), said.len());
    }
    common::press(&mut keyboard, "info\n");
    let info = program.expect("\r\nok\r\n", &board, 10_000_000);
    eprintln!("{info}");
}
