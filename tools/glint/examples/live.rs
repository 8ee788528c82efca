//! Measures the pictures per second of moving scenes on the emulated board: `cargo run --release -p
//! glint --example live [SCENE…]`.

use glint::board::Uart;
use std::time::Instant;

use glint::board::{self, Simulation, built_firmware};
use glint::console::Console;
use glint::gesture::moving_hand;
use glint::imu::sensor;
use virtual_board::virtual_image_sensor::{ImageSensor, Model, Timing};

/// Duration of a measurement in seconds of the board's time.
const SECONDS: u64 = 2;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    let all = ["holoforge", "poor-mans-vr"];
    let is_chosen = |scene: &&str| chosen.is_empty() || chosen.iter().any(|name| name == scene);
    for scene in all.into_iter().filter(is_chosen) {
        let mut board = board::emulated(&built_firmware(None)?)?;
        board.inner().plug(sensor::virtual_sensor(None));
        board.inner().plug_image_sensor(ImageSensor::new(
            Model::Ov7670,
            moving_hand([320, 240]),
            Timing::OV7670,
        ));
        let mut console = Console::new(&mut board);
        console.greet()?;
        if scene == "poor-mans-vr" {
            sensor::wait(&mut console)?;
        }
        console.command(&format!("scene {scene}"))?;
        console.command("size 320 180")?;
        let clock = u64::from(console.board().inner().clock_hz());
        let (mut pictures, mut last) = (0, Vec::new());
        let (start, begin) = (Instant::now(), console.board().inner().cycles());
        while console.board().inner().cycles() < begin + SECONDS * clock {
            let shown = console.board().inner().monitor_frame(4)?;
            pictures += u32::from(shown != last);
            last = shown;
        }
        let seconds = start.elapsed().as_secs_f64();
        let board_seconds = (console.board().inner().cycles() - begin) as f64 / clock as f64;
        println!(
            "{scene}: {pictures} pictures in {seconds:.2} s, {:.0} a second; {:.2} of the board's speed",
            f64::from(pictures) / seconds,
            board_seconds / seconds
        );
    }
    Ok(())
}
