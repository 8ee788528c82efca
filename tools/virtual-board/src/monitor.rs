//! The monitor: checks the video timing at every tick and captures pictures.

use std::fmt;

use crate::Picture;

/// Number of pixels of a line.
pub const WIDTH: usize = 1280;
/// Number of lines of a picture.
pub const HEIGHT: usize = 720;

/// Video timing of CEA-861 1280×720 at 60 Hz. A line starts with the leading edge of hsync. A frame starts with the leading edge of vsync,
/// at the same tick as a line. Both syncs are active high.
const H_SYNC: usize = 40;
const H_BACK: usize = 220;
const H_FRONT: usize = 110;
const V_SYNC: usize = 5;
const V_BACK: usize = 20;
const V_FRONT: usize = 5;
const LINE: usize = H_SYNC + H_BACK + WIDTH + H_FRONT;
const FRAME: usize = LINE * (V_SYNC + V_BACK + HEIGHT + V_FRONT);

/// Maximum number of stored timing errors; later errors are only counted.
const KEPT_ERRORS: usize = 16;

/// The video pins at one tick of the pixel clock, packed as in `soc.h` (`soc_video_samples`).
#[derive(Clone, Copy, PartialEq, Eq)]
struct Pins(u32);

impl Pins {
    const DE: u32 = 1 << 24;
    const HSYNC: u32 = 1 << 25;
    const VSYNC: u32 = 1 << 26;
    const CONTROL: u32 = Self::DE | Self::HSYNC | Self::VSYNC;

    fn control(self) -> u32 {
        self.0 & Self::CONTROL
    }

    fn rgb(self) -> [u8; 3] {
        let [_, r, g, b] = self.0.to_be_bytes();
        [r, g, b]
    }

    /// Returns the expected control pins (vsync, hsync, de) at tick `position` of a frame.
    fn expected_control(position: usize) -> u32 {
        let (x, y) = (position % LINE, position / LINE);
        let active = (H_SYNC + H_BACK..H_SYNC + H_BACK + WIDTH).contains(&x)
            && (V_SYNC + V_BACK..V_SYNC + V_BACK + HEIGHT).contains(&y);
        let bit = |condition, bit| if condition { bit } else { 0 };
        bit(active, Self::DE) | bit(x < H_SYNC, Self::HSYNC) | bit(y < V_SYNC, Self::VSYNC)
    }
}

impl fmt::Display for Pins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pin = |bit| u8::from(self.0 & bit != 0);
        write!(
            f,
            "vsync {} hsync {} de {}",
            pin(Self::VSYNC),
            pin(Self::HSYNC),
            pin(Self::DE)
        )
    }
}

/// A timing error: a tick whose control pins violate CEA-861.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimingError {
    /// Number of whole frames before the error.
    pub frame: u64,
    /// Line number; line 0 is the first line of vsync.
    pub line: usize,
    /// Tick in the line; tick 0 is the first tick of hsync.
    pub tick: usize,
    /// Expected control pins (vsync, hsync, de), packed as in the video samples of `soc.h`.
    pub expected: u32,
    /// Actual control pins, packed in the same way.
    pub found: u32,
}

impl fmt::Display for TimingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (expected, found) = (Pins(self.expected), Pins(self.found));
        let Self {
            frame, line, tick, ..
        } = self;
        write!(
            f,
            "frame {frame} line {line} tick {tick}: expected {expected}, found {found}"
        )
    }
}

/// A monitor on the video output.
///
/// From the first leading edge of vsync on, it compares hsync, vsync and de at every tick with CEA-861 1280×720 (active
/// picture, front porch, sync, back porch: 1280/110/40/220 ticks, 720/5/5/20 lines; positive syncs). It never
/// resynchronizes, so a stall or a glitch causes errors in all later ticks.
#[derive(Default)]
pub struct Monitor {
    on: bool,
    /// Ticks since the start of the frame; `None` before the first vsync.
    position: Option<usize>,
    /// Pins at the last tick. `None` before the first tick; it counts as vsync, so that the first
    /// frame starts at a leading edge of vsync.
    last: Option<Pins>,
    /// Pixels of the current frame so far, three bytes each.
    pixels: Vec<u8>,
    picture: Option<Picture>,
    frames: u64,
    errors: Vec<TimingError>,
    error_count: u64,
}

impl Monitor {
    /// Turns the monitor on, if it is off. The current frame is not captured.
    pub fn turn_on(&mut self) {
        if !self.on {
            *self = Self {
                on: true,
                picture: self.picture.take(),
                ..Self::default()
            };
        }
    }

    /// Turns the monitor off, for more speed. Counts and errors are kept until the monitor is turned on again.
    pub fn turn_off(&mut self) {
        self.on = false;
    }

    /// Whether the monitor is on.
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// Number of whole frames since the monitor was turned on.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Number of timing errors since the monitor was turned on.
    #[must_use]
    pub fn error_count(&self) -> u64 {
        self.error_count
    }

    /// The first timing errors since the monitor was turned on, at most 16.
    #[must_use]
    pub fn errors(&self) -> &[TimingError] {
        &self.errors
    }

    /// Whether [`take_picture`](Self::take_picture) would return a picture.
    #[must_use]
    pub fn has_picture(&self) -> bool {
        self.picture.is_some()
    }

    /// Takes the picture of the last complete frame, if it has not been taken.
    pub fn take_picture(&mut self) -> Option<Picture> {
        self.picture.take()
    }

    /// Processes new video samples, one per tick of the pixel clock.
    pub(crate) fn watch(&mut self, samples: &[u32]) {
        for &sample in samples {
            self.tick(Pins(sample));
        }
    }

    fn tick(&mut self, pins: Pins) {
        let vsync = |pins: Pins| pins.0 & Pins::VSYNC != 0;
        let begins = vsync(pins) && self.last.is_some_and(|last| !vsync(last));
        self.last = Some(pins);
        let position = match self.position {
            Some(position) => position,
            None if begins => 0,
            None => return,
        };
        let expected = Pins::expected_control(position);
        if pins.control() != expected {
            self.report(position, expected, pins.control());
        }
        if expected & Pins::DE != 0 {
            self.pixels.extend(pins.rgb());
        }
        self.position = Some((position + 1) % FRAME);
        if position + 1 == FRAME {
            self.frames += 1;
            let rgb = std::mem::replace(&mut self.pixels, Vec::with_capacity(3 * WIDTH * HEIGHT));
            self.picture = Some(Picture::new(WIDTH, HEIGHT, rgb));
        }
    }

    fn report(&mut self, position: usize, expected: u32, found: u32) {
        self.error_count += 1;
        if self.errors.len() < KEPT_ERRORS {
            let (line, tick) = (position / LINE, position % LINE);
            self.errors.push(TimingError {
                frame: self.frames,
                line,
                tick,
                expected,
                found,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes `ticks` samples of correct video that begin `before` ticks ahead of a vsync; each pixel encodes its position.
    fn video(before: usize, ticks: usize) -> Vec<u32> {
        (0..ticks)
            .map(|tick| {
                let position = (FRAME - before + tick) % FRAME;
                let expected = Pins::expected_control(position);
                let pixel = if expected & Pins::DE != 0 {
                    position as u32 & 0xff_ffff
                } else {
                    0
                };
                expected | pixel
            })
            .collect()
    }

    fn watching() -> Monitor {
        let mut monitor = Monitor::default();
        monitor.turn_on();
        monitor
    }

    #[test]
    fn a_frame_has_the_counts_of_cea_861() {
        let samples = video(0, FRAME);
        let count = |bit| samples.iter().filter(|&&sample| sample & bit != 0).count();
        assert_eq!(samples.len(), 1650 * 750);
        assert_eq!(count(Pins::DE), 1280 * 720);
        assert_eq!(count(Pins::HSYNC), 40 * 750);
        assert_eq!(count(Pins::VSYNC), 5 * 1650);
    }

    #[test]
    fn correct_timing_is_accepted_and_every_pixel_is_in_its_place() {
        let mut monitor = watching();
        monitor.watch(&video(777, 777 + 2 * FRAME));
        assert_eq!((monitor.frames(), monitor.error_count()), (2, 0));
        let picture = monitor.take_picture().expect("a picture");
        for (x, y) in [(0, 0), (1279, 0), (640, 360), (0, 719), (1279, 719)] {
            let position = (V_SYNC + V_BACK + y) * LINE + H_SYNC + H_BACK + x;
            let [_, r, g, b] = (position as u32).to_be_bytes();
            assert_eq!(picture.pixel(x, y), [r, g, b], "pixel {x}, {y}");
        }
        assert!(!monitor.has_picture());
    }

    #[test]
    fn a_frame_seen_from_its_middle_is_not_captured() {
        let mut monitor = watching();
        // The first sample is within a vsync, whose start is not in the samples.
        monitor.watch(&video(0, FRAME)[1000..]);
        assert_eq!((monitor.frames(), monitor.error_count()), (0, 0));
    }

    #[test]
    fn a_stall_of_one_tick_is_detected() {
        let mut samples = video(1, 1 + FRAME);
        samples.insert(5000, samples[5000]);
        let mut monitor = watching();
        monitor.watch(&samples);
        assert!(monitor.error_count() > 0);
        let first = monitor.errors()[0];
        // The error is detected at the start of the next hsync: the first tick after the doubled tick at which the control pins change.
        assert_eq!((first.line, first.tick), (4, 0));
        assert!(
            first
                .to_string()
                .starts_with("frame 0 line 4 tick 0: expected vsync 1 hsync 1 de 0, found")
        );
    }

    #[test]
    fn a_wrong_porch_and_a_negative_sync_are_detected() {
        let mut monitor = watching();
        let negative: Vec<u32> = video(1, 1 + FRAME)
            .iter()
            .map(|sample| sample ^ Pins::HSYNC)
            .collect();
        monitor.watch(&negative);
        assert_eq!(monitor.error_count(), FRAME as u64);
        assert_eq!(monitor.errors().len(), KEPT_ERRORS);
    }
}
