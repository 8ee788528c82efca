//! Prints the number of bytes of stack that a firmware uses for commands: `cargo run -p emulated-board --example stack FIRMWARE
//! LOW HIGH COMMAND…`.
//!
//! The stack begins at the address HIGH and grows down, at most to LOW. Memory is 0 at the start of the board, so the lowest byte
//! that is not 0 shows how far the stack has grown. A motion sensor at rest and an image sensor with no hand in view are
//! connected.

use emulated_board::EmulatedBoard;
use emulated_board::{Simulation, Uart};
use virtual_image_sensor::{ImageSensor, Model, Scene, Timing};
use virtual_mpu6050::{Chip, Imperfections, Source, State, Wires};

/// Time-out of a command in cycles.
const LIMIT: u64 = 1_000_000_000;

const PROMPT: &str = "glint> ";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [firmware, low, high, commands @ ..] = &arguments[..] else {
        return Err("expected FIRMWARE LOW HIGH COMMAND…".into());
    };
    let [low, high]: [u32; 2] = [low.parse()?, high.parse()?];
    let length = high.checked_sub(low).ok_or("LOW is above HIGH")?;
    let mut board = EmulatedBoard::fast(&std::fs::read(firmware)?)?;
    let motion = Source::Motion(Box::new(|_| State::default()));
    board.plug(Wires::new(Chip::new(motion, Imperfections::NONE, 1)));
    let nothing = Scene::new([320, 240], |_| Vec::new());
    board.plug_image_sensor(ImageSensor::new(Model::Ov7670, nothing, Timing::SHORT));
    board.read_until(PROMPT, LIMIT)?;
    for command in commands {
        board.uart_write(format!("{command}\r").as_bytes());
        let reply = board.read_until(PROMPT, LIMIT)?;
        if reply.contains("error: ") {
            return Err(format!("{command}: {reply}").into());
        }
    }
    let mut stack = vec![0; length as usize];
    board.read_memory(low, &mut stack)?;
    let untouched = stack.iter().take_while(|&&byte| byte == 0).count();
    println!("{}", stack.len() - untouched);
    Ok(())
}
