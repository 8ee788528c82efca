//! Small programs for the soft core, which tests assemble.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use virtual_board::VirtualBoard;

use crate::firmware::preloaded;

/// Lock on the assembled files: tests run in parallel, and some assemble the same program.
static FILES: Mutex<()> = Mutex::new(());

/// Starts a board that runs `tests/board/programs/NAME.S` from the start of main RAM; `symbols` are constants for the assembler.
pub fn started(name: &str, symbols: &[(&str, u32)]) -> VirtualBoard {
    preloaded(&assemble(name, symbols))
}

/// Assembles a program; returns its image.
pub fn assemble(name: &str, symbols: &[(&str, u32)]) -> Vec<u8> {
    let _files = FILES.lock().expect("no other test fails here");
    let source = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/board/programs")
        .join(name)
        .with_extension("S");
    let output = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let (elf, image) = (
        output.join(name).with_extension("elf"),
        output.join(name).with_extension("bin"),
    );
    run(Command::new("riscv64-unknown-elf-gcc")
        .args([
            "-march=rv32im",
            "-mabi=ilp32",
            "-nostdlib",
            "-Wl,-Ttext=0x40000000,-e0x40000000",
        ])
        .args(
            symbols
                .iter()
                .map(|(name, value)| format!("-D{name}={value:#x}")),
        )
        .arg(&source)
        .arg("-o")
        .arg(&elf));
    run(Command::new("riscv64-unknown-elf-objcopy")
        .args(["-O", "binary"])
        .arg(&elf)
        .arg(&image));
    std::fs::read(&image).expect("the assembled program")
}

fn run(command: &mut Command) {
    let output = command
        .output()
        .expect("Debian's gcc-riscv64-unknown-elf (`cargo xtask bootstrap` installs it)");
    assert!(
        output.status.success(),
        "{command:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
}
