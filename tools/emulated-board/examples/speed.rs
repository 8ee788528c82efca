//! Prints the speed of the emulated board: `cargo run --release -p emulated-board --example speed [FIRMWARE]`.

use emulated_board::Uart;
use std::time::Instant;

use emulated_board::EmulatedBoard;
use glint_board_api::built;

/// Time-out of a command in cycles.
const LIMIT: u64 = 1_000_000_000;

const PROMPT: &str = "glint> ";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = match std::env::args_os().nth(1) {
        Some(path) => path.into(),
        None => built::find("firmware/glint.bin", "cargo xtask firmware")?,
    };
    let mut board = EmulatedBoard::fast(&std::fs::read(path)?)?;
    println!("{}", board.read_until(PROMPT, LIMIT)?);
    for line in ["info", "model icosphere:6", "render", "bench"] {
        let (cycles, instructions, start) = (board.cycles(), board.instructions(), Instant::now());
        board.uart_write(format!("{line}\r").as_bytes());
        println!("{}", board.read_until(PROMPT, LIMIT)?);
        let (seconds, cycles, instructions) = (
            start.elapsed().as_secs_f64(),
            board.cycles() - cycles,
            board.instructions() - instructions,
        );
        println!(
            "{line}: {cycles} cycles, {instructions} instructions in {seconds:.3} s, {:.1} million instructions/s",
            instructions as f64 / seconds / 1e6
        );
    }
    Ok(())
}
