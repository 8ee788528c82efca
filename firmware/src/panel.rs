//! Switches, LEDs and digit displays of the board.

use glint_core::digits::Display;
use glint_scene::Scene;

use crate::demo::Demo;

/// Switch 2: shows the text overlay.
const OVERLAY: u16 = 1 << 2;
/// Switch 3: the demo holds the shown scene, and all buttons control this scene.
pub const HOLD: u16 = 1 << 3;

/// LED 0, which blinks while the firmware runs.
const BEAT: u16 = 1 << 0;
/// LED 1: on while the demo is on.
const ON: u16 = 1 << 1;
/// LED 2: on while the demo holds the shown scene.
const HELD: u16 = 1 << 2;
/// LED 3: on after an error of the demo.
const ERROR: u16 = 1 << 3;
/// The first of the LEDs 4 to 7, which show the number of the scene, from 1.
const SCENE: u16 = 4;

/// The switches at the last poll.
#[derive(Default)]
pub struct Switches(u16);

impl Switches {
    /// Handles switches that have changed since the last call, and returns whether any has. Initially all switches count as off.
    pub fn take(&mut self, switches: u16, demo: &mut Demo, scene: &mut Scene, now: u64) -> bool {
        let changed = core::mem::replace(&mut self.0, switches) ^ switches;
        if changed & OVERLAY != 0 {
            scene.overlay = switches & OVERLAY != 0;
        }
        if changed & HOLD != 0 && demo.is_on() {
            demo.turns.hold(now, switches & HOLD != 0);
        }
        changed != 0
    }
}

/// The first of the LEDs 8 to 15, a bar of the progress of a calibration.
const PROGRESS: u32 = 8;

/// The levels of the LEDs. `blinks` is the level of LED 0, and `calibrated` is the progress of a calibration of the motion sensor in
/// eighths.
pub fn leds(demo: &Demo, blinks: bool, calibrated: Option<u32>) -> u16 {
    let mut leds = if blinks { BEAT } else { 0 };
    if let Some(number) = demo.turns.number() {
        // Only four LEDs show the number.
        leds |= ON | ((number as u16 + 1) & 0xf) << SCENE;
    }
    if demo.turns.is_held() {
        leds |= HELD;
    }
    if demo.error().is_some() {
        leds |= ERROR;
    }
    if let Some(eighths) = calibrated {
        // The first LED of the bar is on from the start of the calibration.
        leds |= ((2 << eighths) - 1) << PROGRESS;
    }
    leds
}

/// Segments of the digits. The left display shows frames per second, or `CAL` during a calibration of the motion sensor. The right display
/// shows the number of the demo's scene, alternating with the number of the last error.
pub fn digits(demo: &Demo, rate: Option<u64>, shows_error: bool, calibrates: bool) -> [u8; 8] {
    let left = rate.map(Display::number).unwrap_or_default();
    let number = demo.turns.number().map(|number| number as u64 + 1);
    let right = match (number, demo.error()) {
        _ if calibrates => Display::of(format_args!("CAL")),
        (number, Some(error)) if shows_error || number.is_none() => Display::error(error),
        (Some(number), _) => Display::number(number),
        (None, _) => Display::default(),
    };
    let digits = [left.digits(), right.digits()];
    let mut segments = [0; 8];
    segments.copy_from_slice(digits.as_flattened());
    segments
}
