//! A camera that orbits a mesh with the command `orbit`: compares the camera's basis with f64, and the pictures of all turns with each
//! other.

use glint::board::Uart;
use std::f64::consts::TAU;
use std::hash::{DefaultHasher, Hash, Hasher};

use anyhow::Result;
use glint_core::camera::View;
use glint_core::fixed::{Q32_32, Turns};
use serde::{Deserialize, Serialize};

use crate::basis;
use crate::camera::Vector;
use crate::emulated::{Emulated, begin, command, cycles, start, view};
use crate::report::progress::bar;

/// Number of frames of a turn.
pub const FRAMES: u32 = 2_500;

/// Azimuth and polar angle of the camera at the start of the board, in degrees.
const START: [u32; 2] = [40, 65];
/// Distance of the camera at the start of the board.
const DISTANCE: &str = "2.5";

/// The camera and the pictures after some turns: a line of `long-orbit.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of turns since the start.
    pub turns: u32,
    /// Number of frames since the start.
    pub frames: u64,
    /// Largest deviation of a basis vector's length from 1, over all cameras of a further turn.
    pub length: f64,
    /// Largest scalar product of two basis vectors.
    pub angle: f64,
    /// Largest difference between a component of a basis vector and its value in f64.
    pub reference: f64,
    /// Number of pictures since the previous row that differ from the pictures of the first turn.
    pub differing: u64,
    /// Number of turns since the previous row after which the camera differed from the first camera in any bit.
    pub displaced: u32,
}

/// Runs `turns` orbits of the camera in `frames` frames each.
///
/// # Errors
/// The firmware has not been built, or refuses a command.
pub fn measure(turns: u32, frames: u32) -> Result<Vec<Row>> {
    let mut board = start()?;
    command(&mut board, "scene cube")?;
    // From the first displayed frame on, drawing waits for the vertical blanking.
    let wait = cycles(&mut board, 100);
    board.inner().run(wait);
    let bar = bar(turns.into())?.with_message("orbit");
    let expected = pictures(&mut board, frames)?;
    let first = view(&mut board)?;
    let mut rows = Vec::new();
    let (mut differing, mut displaced) = (0, 0);
    for turn in 1..=turns {
        differing += differences(&expected, &orbit(&mut board, frames)?);
        displaced += u32::from(view(&mut board)? != first);
        bar.set_position(turn.into());
        if turn.is_power_of_two() || turn == turns {
            let [length, angle, reference] = deviations(&mut board, frames)?;
            rows.push(Row {
                turns: turn,
                frames: u64::from(turn) * u64::from(frames),
                length,
                angle,
                reference,
                differing,
                displaced,
            });
            (differing, displaced) = (0, 0);
        }
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// Computes the azimuth of a frame of a turn as the command `orbit` does.
fn azimuth(frame: u32, frames: u32) -> Turns {
    let turned = (u64::from(frame) << 32) / u64::from(frames);
    Turns::from_degrees(Q32_32::from_num(START[0])).wrapping_add(Turns(turned as u32))
}

/// Moves the camera to its position in a frame of a turn.
fn place(board: &mut Emulated, azimuth: Turns) -> Result<()> {
    let (theta, phi) = (azimuth.to_degrees(), START[1]);
    command(board, &format!("camera {DISTANCE} {theta} {phi}"))?;
    Ok(())
}

/// Draws the pictures of a turn one by one, and returns their hashes. Finally moves the camera back to the start.
fn pictures(board: &mut Emulated, frames: u32) -> Result<Vec<u64>> {
    let mut hashes = Vec::new();
    for frame in 0..=frames {
        place(board, azimuth(frame, frames))?;
        command(board, "render")?;
        hashes.push(shown(board));
    }
    hashes.dedup();
    Ok(hashes)
}

/// The hash of the picture after the next vertical blanking.
fn shown(board: &mut Emulated) -> u64 {
    let mut hasher = DefaultHasher::new();
    board.inner().capture().pixels.hash(&mut hasher);
    hasher.finish()
}

/// Returns the hashes of the pictures on the monitor during one orbit of the camera.
fn orbit(board: &mut Emulated, frames: u32) -> Result<Vec<u64>> {
    let mut hashes = vec![shown(board)];
    begin(board, &format!("orbit {frames}"))?;
    let mut said = Vec::new();
    // The last frame is displayed one blanking after the reply.
    while !said.ends_with(b"ok\r\nglint> ") {
        hashes.push(shown(board));
        board.inner().uart_read(&mut said);
    }
    hashes.push(shown(board));
    hashes.dedup();
    Ok(hashes)
}

/// Returns the number of pictures that differ between two sequences.
fn differences(expected: &[u64], found: &[u64]) -> u64 {
    let equal = expected.iter().zip(found).filter(|(a, b)| a == b).count();
    (expected.len().max(found.len()) - equal) as u64
}

/// Returns the largest errors over all cameras of a turn: of a basis vector's length, of an angle (scalar product), and of a component
/// against f64. Finally moves the camera back to the start.
pub fn deviations(board: &mut Emulated, frames: u32) -> Result<[f64; 3]> {
    let mut worst = [0.0_f64; 3];
    for frame in 1..=frames {
        let azimuth = azimuth(frame, frames);
        place(board, azimuth)?;
        for (worst, error) in worst.iter_mut().zip(errors(&view(board)?, azimuth)) {
            *worst = worst.max(error);
        }
    }
    Ok(worst)
}

fn errors(view: &View, azimuth: Turns) -> [f64; 3] {
    let found = basis::of(view);
    let [length, angle] = basis::errors(found);
    [length, angle, basis::difference(found, exact(azimuth))]
}

/// The basis of the camera in f64, by the formulas of [`View::spherical`].
fn exact(azimuth: Turns) -> [Vector; 3] {
    let radians = |angle: Turns| f64::from(angle.0) / 2_f64.powi(32) * TAU;
    let polar = Turns::from_degrees(Q32_32::from_num(START[1]));
    let ((st, ct), (sp, cp)) = (radians(azimuth).sin_cos(), radians(polar).sin_cos());
    [
        [-st, ct, 0.0],
        [cp * ct, cp * st, -sp],
        [-sp * ct, -sp * st, -cp],
    ]
}
