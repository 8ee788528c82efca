//! The board as a program sees it.

use core::fmt::{self, Write};
use core::time::Duration;

use glint_core::camera::{View, ViewError};
use glint_core::digits::Display;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::gesture::Pose;
use glint_core::mesh::Mesh;
use glint_core::orientation::{Quaternion, Sample};
use glint_core::picture::Size;
use glint_core::shape::Shape;
use glint_core::steering::{Mounting, free_look};
use glint_core::wireframe::Debouncer;
use glint_scene::Defaults;
use heapless::{String, Vec};

use crate::shapes::Shapes;

/// Bytes of log text between two pictures. More is dropped.
const LOG: usize = 1024;
/// Received bytes between two pictures; further bytes wait for the next picture.
pub(crate) const RECEIVED: usize = 256;
/// Samples of the motion sensor between two pictures: those of 64 ms. In a slower program the oldest are dropped.
const SAMPLES: usize = 64;

/// A button of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Button 0.
    Up = 0,
    /// Button 1.
    Down = 1,
    /// Button 2.
    Left = 2,
    /// Button 3.
    Right = 3,
}

/// The attitude of the motion sensor.
///
/// ```
/// use glint_program::core::camera::View;
/// use glint_program::core::fixed::Q32_32;
/// use glint_program::Board;
///
/// /// The camera at the origin that looks where the sensor does; `None` without a sensor.
/// fn look(board: &Board) -> Option<View> {
///     board.motion()?.view([Q32_32::ZERO; 3]).ok()
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motion {
    /// The rotation from the sensor's axes to the world's.
    pub attitude: Quaternion,
    /// The newest sample.
    pub sample: Sample,
}

impl Motion {
    /// The camera at `eye` that looks in the direction of the sensor.
    ///
    /// # Errors
    /// [`ViewError`] for an eye more than 32 world units from the origin.
    pub fn view(&self, eye: [Q32_32; 3]) -> Result<View, ViewError> {
        free_look(eye, self.attitude, Mounting::default())
    }
}

/// A hand in front of the image sensor.
///
/// ```
/// use glint_program::core::camera::View;
/// use glint_program::{Board, Hand};
///
/// /// The camera to which a hand has moved; `None` without a hand.
/// fn steer(board: &mut Board) -> Option<View> {
///     board.watches_hand = true;
///     match board.hand()? {
///         Hand { pose, is_seen: true } => View::spherical(pose.r, pose.theta, pose.phi).ok(),
///         _ => None,
///     }
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hand {
    /// The place on a sphere about the origin to which the hand has moved the camera: left and right are the azimuth, up and down the angle
    /// from the z axis, nearer and farther the distance.
    pub pose: Pose,
    /// Whether a hand is seen; otherwise the pose is that of the last hand.
    pub is_seen: bool,
}

/// The board: its input since the last picture, and its output.
///
/// ```
/// use glint_program::{Board, Button};
///
/// fn update(board: &mut Board, lives: &mut u64) {
///     if board.is_pressed(Button::Up) {
///         *lives = lives.saturating_sub(1);
///         board.log(format_args!("{lives} lives"));
///     }
///     board.show_number(*lives);
///     board.leds = (1 << (*lives).min(15)) - 1;
/// }
/// ```
pub struct Board {
    /// Levels of the sixteen LEDs; bit 0 is LED 0.
    pub leds: u16,
    /// Whether the image sensor is on, and looks for a [hand](Self::hand).
    pub watches_hand: bool,
    /// The lit segments of the eight digits. `None` shows the rate of drawing in pictures per second.
    pub digits: Option<[u8; 8]>,
    defaults: Defaults,
    shapes: Shapes,
    time: Duration,
    step: Duration,
    pictures: u32,
    debouncer: Debouncer,
    held: u8,
    pressed: u8,
    switches: u16,
    motion: Option<Motion>,
    hand: Option<Hand>,
    samples: Vec<Sample, SAMPLES>,
    received: Vec<u8, RECEIVED>,
    log: String<LOG>,
}

/// What the machine reads for the next picture.
#[derive(Clone, Copy, Default)]
pub(crate) struct Levels {
    /// Time since the start.
    pub time: Duration,
    /// One bit for each pressed button.
    pub buttons: u8,
    /// One bit for each switch that is on.
    pub switches: u16,
}

impl Board {
    pub(crate) fn new(defaults: Defaults, shapes: Shapes) -> Self {
        Self {
            leds: 0,
            watches_hand: false,
            digits: None,
            defaults,
            shapes,
            time: Duration::ZERO,
            step: Duration::ZERO,
            pictures: 0,
            debouncer: Debouncer::default(),
            held: 0,
            pressed: 0,
            switches: 0,
            motion: None,
            hand: None,
            samples: Vec::new(),
            received: Vec::new(),
            log: String::new(),
        }
    }

    /// Takes a sample of the buttons, which may come more often than pictures.
    pub(crate) fn sample_buttons(&mut self, time: Duration, buttons: u8) {
        // The time wraps after 49 days, which the debouncer can handle.
        self.pressed |= self.debouncer.sample(time.as_millis() as u32, buttons);
        self.held = buttons;
    }

    /// Begins the next picture.
    pub(crate) fn begin(&mut self, levels: Levels) {
        self.sample_buttons(levels.time, levels.buttons);
        self.switches = levels.switches;
        if self.pictures > 0 {
            self.step = levels.time.saturating_sub(self.time);
        }
        self.time = levels.time;
    }

    /// Takes a sample of the motion sensor.
    pub(crate) fn add_sample(&mut self, motion: Motion) {
        self.motion = Some(motion);
        if self.samples.is_full() {
            self.samples.remove(0);
        }
        // There is room for a sample.
        let _ = self.samples.push(motion.sample);
    }

    /// Sets the hand; `None` without an image sensor.
    pub(crate) fn set_hand(&mut self, hand: Option<Hand>) {
        self.hand = hand;
    }

    /// The buffer of received bytes.
    pub(crate) fn received_mut(&mut self) -> &mut Vec<u8, RECEIVED> {
        &mut self.received
    }

    /// Ends the update for a picture: removes its input, and returns the log.
    pub(crate) fn end(&mut self) -> String<LOG> {
        self.pictures = self.pictures.wrapping_add(1);
        self.pressed = 0;
        self.samples.clear();
        self.received.clear();
        core::mem::take(&mut self.log)
    }

    /// The options of pictures that this board draws.
    pub(crate) const fn defaults(&self) -> Defaults {
        self.defaults
    }

    /// Time since the start of the program.
    pub const fn time(&self) -> Duration {
        self.time
    }

    /// Time since the previous picture; 0 for the first.
    pub const fn step(&self) -> Duration {
        self.step
    }

    /// Number of pictures so far, modulo 2^32.
    pub const fn pictures(&self) -> u32 {
        self.pictures
    }

    /// The angle of a motion with this number of turns per second, at the time of the next picture. It is computed from the whole time in
    /// microseconds and rounded down to 2^−32 turns, so errors do not add up.
    pub fn turns(&self, per_second: Q32_32) -> Turns {
        let microseconds = i128::try_from(self.time.as_micros()).unwrap_or_default();
        Turns((i128::from(per_second.to_bits()) * microseconds).div_euclid(1_000_000) as u32)
    }

    /// Largest size of a picture.
    pub const fn largest_size(&self) -> Size {
        self.defaults.size
    }

    /// Whether a button is down.
    pub const fn is_held(&self, button: Button) -> bool {
        self.held >> button as u8 & 1 != 0
    }

    /// Whether a button has been pressed since the previous picture; bounces of its contact are suppressed.
    pub const fn is_pressed(&self, button: Button) -> bool {
        self.pressed >> button as u8 & 1 != 0
    }

    /// The sixteen switches; bit 0 is switch 0.
    pub const fn switches(&self) -> u16 {
        self.switches
    }

    /// The motion sensor's attitude; `None` before its first sample, or without a sensor.
    pub const fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// The hand; `None` while [`watches_hand`](Self::watches_hand) is false, or without an image sensor.
    pub fn hand(&self) -> Option<&Hand> {
        self.hand.as_ref().filter(|_| self.watches_hand)
    }

    /// Samples of the motion sensor since the previous picture, the oldest first; it sends 1,000 a second.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Bytes that the serial line has received since the previous picture.
    pub fn received(&self) -> &[u8] {
        &self.received
    }

    /// Writes a line to the serial line, after the time. A line beyond 1,024 bytes for a picture is dropped. The lines are sent after the
    /// update, so a panic in the update loses them.
    pub fn log(&mut self, text: fmt::Arguments) {
        let [seconds, milliseconds] = [self.time.as_secs(), u64::from(self.time.subsec_millis())];
        let before = self.log.len();
        if write!(self.log, "{seconds:5}.{milliseconds:03} {text}\r\n").is_err() {
            self.log.truncate(before);
        }
    }

    /// Shows a whole number on the digits, right-aligned.
    pub fn show_number(&mut self, number: u64) {
        self.digits = Some(digits([Display::default(), Display::number(number)]));
    }

    /// A built-in cube of edge length 1, with one colour per side.
    pub const fn cube(&self) -> Mesh<'static> {
        self.shapes.cube()
    }

    /// A built-in mesh; the cube if its memory is used up, which does not occur.
    pub fn shape(&mut self, shape: Shape) -> Mesh<'static> {
        self.shapes.shape(shape).unwrap_or(self.shapes.cube())
    }
}

/// The segments of the two displays.
pub(crate) fn digits(displays: [Display; 2]) -> [u8; 8] {
    let mut segments = [0; 8];
    segments.copy_from_slice(displays.map(|display| display.digits()).as_flattened());
    segments
}
