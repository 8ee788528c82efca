//! Gesture control: processes the frames of the image sensor, so that a hand steers the camera.
//!
//! The interrupt at the end of an image sensor's frame stores the time. The main loop then reads the statistics of the frame, computes the
//! camera's position, and sets the region and the minimum run for the next frame.

use core::cell::Cell;
use core::time::Duration;

use critical_section::Mutex;
use glint_core::colour::Rgb565;
use glint_core::gesture::{
    Blob, Calibrated, ColourError, Control, Doubt, Pose, Presence, Window, calibrate,
};
use glint_core::image_sensor::{FrameSize, Model};
use glint_core::tasks::Turn;
use glint_engines::gesture::{self as engine, SetUpError};
use glint_hal::gesture::GestureEngine;
use glint_hal::timer::{Clock, Deadline};
use glint_model::gesture::{Channel, channels};
use litex_pac::cpu;

use crate::marker::Marker;

/// Windows of Cr and Cb before the first calibration, for skin in lamplight or daylight.
const SKIN: [Window; 2] = [
    Window {
        lower: 137,
        upper: 180,
    },
    Window {
        lower: 85,
        upper: 122,
    },
];

/// Time of the end of the last frame, in clock cycles; `None` after the main loop has processed the frame.
static FRAME: Mutex<Cell<Option<u64>>> = Mutex::new(Cell::new(None));

/// Stores the time at which a frame has ended. Call this in the frame's interrupt.
pub fn on_interrupt() {
    let now = cpu::cycles();
    critical_section::with(|token| FRAME.borrow(token).set(Some(now)));
}

/// Cost per frame, and latency from the end of a frame to its picture, in clock cycles.
#[derive(Clone, Copy, Default)]
pub struct Cycles {
    /// Number of processed frames.
    pub frames: u32,
    /// Number of cycles that the soft core has used for all frames, including interrupts.
    pub total: u64,
    /// Number of cycles from the end of the last frame that moved the camera to the end of drawing the picture for this move.
    pub latency: u64,
    /// Largest latency since the start.
    pub worst: u64,
}

/// Time between two checks of an active image sensor.
const CHECK_PERIOD: Duration = Duration::from_millis(50);
/// Time to the next check after a failed set-up. With this pause, set-ups of a damaged sensor block the main loop for at most a tenth of
/// the time.
const PAUSE: Duration = Duration::from_millis(500);

/// Periodic check of an active image sensor, which loses its register values when it is unplugged.
struct Watch {
    next_check: Deadline,
    /// Counts of whole and of dropped frames at the last check.
    frames: [u32; 2],
}

/// The gesture engine, the image sensor, and the control of the camera.
pub struct Gesture {
    engine: GestureEngine,
    clock: Clock,
    size: FrameSize,
    /// The active image sensor, or the error of its set-up; `None` while the sensor is off.
    sensor: Option<Result<Model, SetUpError>>,
    /// The periodic check; `None` unless [`start`](Self::start) was successful.
    watch: Option<Watch>,
    windows: [Window; 2],
    control: Control,
    /// The last position to which the camera was moved.
    steered: Option<Pose>,
    /// Time of the end of the last frame that moved the camera, in clock cycles; `None` after the picture for this move has been drawn.
    waiting: Option<u64>,
    is_marked: bool,
    cycles: Cycles,
}

impl Gesture {
    /// Creates gesture control with the image sensor turned off.
    pub fn new(mut engine: GestureEngine, clock: Clock) -> Self {
        engine::set_windows(&mut engine, SKIN);
        Self {
            engine,
            clock,
            size: FrameSize::Qvga,
            sensor: None,
            watch: None,
            windows: SKIN,
            control: Control::default(),
            steered: None,
            waiting: None,
            is_marked: false,
            cycles: Cycles::default(),
        }
    }

    /// Sets up the image sensor for a size, which takes about 50 ms, and lets the hand steer the camera.
    ///
    /// # Errors
    /// There is no image sensor, or it does not accept its set-up.
    pub fn start(&mut self, size: FrameSize) -> Result<Model, SetUpError> {
        self.stop();
        self.size = size;
        self.control = Control::default();
        engine::set_gate(&mut self.engine, &self.control.setting());
        let started = engine::start(&mut self.engine, size, self.clock);
        self.sensor = Some(started);
        if started.is_ok() {
            self.schedule_check(CHECK_PERIOD);
        }
        started
    }

    /// The active image sensor. If no sensor is active, sets the sensor up, which takes about 50 ms, and turns it off again.
    ///
    /// # Errors
    /// There is no image sensor, or it does not accept its set-up.
    pub fn check(&mut self) -> Result<Model, SetUpError> {
        self.sensor.unwrap_or_else(|| {
            let started = engine::start(&mut self.engine, self.size, self.clock);
            self.engine.set_power(false);
            started
        })
    }

    /// Schedules the next check of the image sensor for the time `span` from now.
    fn schedule_check(&mut self, span: Duration) {
        let counters = self.engine.counters();
        self.watch = Some(Watch {
            next_check: self.clock.after(span),
            frames: [counters.frames, counters.frames_dropped],
        });
    }

    /// Checks whether the image sensor sends whole frames. A sensor that does not, and that has lost its register values, was unplugged or
    /// lost power. Such a sensor is set up again as soon as it answers, and control continues from the camera's position. During the
    /// set-up, the gyroscope's samples wait in a queue.
    #[cold]
    #[inline(never)]
    fn watch(&mut self) {
        let Some(Watch { next_check, frames }) = &self.watch else {
            return;
        };
        if !next_check.passed() {
            return;
        }
        let counters = self.engine.counters();
        let [whole, dropped] = *frames;
        let are_whole = counters.frames != whole && counters.frames_dropped == dropped;
        let found = match self.sensor {
            Some(Ok(_)) if are_whole => None,
            Some(Ok(model)) => {
                match engine::keeps(&mut self.engine, model, self.size, self.clock) {
                    Ok(true) => None,
                    Ok(false) => Some(Ok(model)),
                    Err(error) => Some(Err(error)),
                }
            }
            Some(Err(_)) | None => Some(engine::find(&mut self.engine, self.clock)),
        };
        let mut pause = CHECK_PERIOD;
        if let Some(found) = found {
            self.sensor = Some(found.and_then(|_| {
                let started = engine::start(&mut self.engine, self.size, self.clock);
                pause = if started.is_ok() { CHECK_PERIOD } else { PAUSE };
                started
            }));
        }
        self.schedule_check(pause);
    }

    /// Turns the image sensor off. The camera does not move.
    pub fn stop(&mut self) {
        self.engine.set_power(false);
        self.sensor = None;
        self.watch = None;
        self.steered = None;
        self.waiting = None;
    }

    /// Processes the statistics of a frame that has ended. Without such a frame, checks the image sensor if a check is due.
    #[inline(never)]
    pub fn poll(&mut self) -> Turn {
        let Some(ended) = critical_section::with(|token| FRAME.borrow(token).take()) else {
            self.watch();
            return Turn::Wait;
        };
        let start = cpu::cycles_low();
        // Statistics that the next frame replaces during the read are dropped, because the next frame raises its own interrupt.
        if let Some(statistics) = engine::statistics(&self.engine) {
            let before = self.control.pose();
            let time = self.clock.frequency().microseconds(ended);
            let _ = self.control.on_frame(time, &statistics);
            engine::set_gate(&mut self.engine, &self.control.setting());
            if self.control.pose() != before {
                self.waiting = Some(ended);
            }
            self.cycles.frames = self.cycles.frames.wrapping_add(1);
            self.cycles.total += u64::from(cpu::cycles_low().wrapping_sub(start));
        }
        Turn::Again
    }

    /// The new position of the camera; `None` if it is unchanged.
    pub fn move_to(&mut self) -> Option<Pose> {
        let pose = self.control.pose();
        let is_new = matches!(self.sensor, Some(Ok(_))) && self.steered != Some(pose);
        is_new.then(|| {
            self.steered = Some(pose);
            pose
        })
    }

    /// Ends the latency measurement, because the picture for the last call of [`move_to`](Self::move_to) has been drawn.
    pub fn on_drawn(&mut self) {
        if self.steered == Some(self.control.pose())
            && let Some(ended) = self.waiting.take()
        {
            self.cycles.latency = cpu::cycles() - ended;
            self.cycles.worst = self.cycles.worst.max(self.cycles.latency);
        }
    }

    /// Drops the latency measurement, because the camera's move is too small to change the picture.
    pub const fn on_unchanged(&mut self) {
        self.waiting = None;
    }

    /// The marker of the hand's position; `None` if no marker is to be drawn.
    pub fn marker(&self) -> Option<Marker> {
        let blob = self.seen().and_then(Result::ok);
        self.is_marked.then(|| {
            let size = self.size.pixels();
            Marker::new(
                blob.map(|blob| blob.centre),
                size,
                self.presence() == Presence::Tracked,
            )
        })
    }

    /// Sets whether a marker of the hand's position is drawn in a corner of the picture.
    pub const fn set_marked(&mut self, is_marked: bool) {
        self.is_marked = is_marked;
    }

    /// Requests a small picture of the next frame: colours for a calibration, or marks of the hand's colour.
    pub fn request_picture(&mut self, is_colour: bool) {
        let step = self.step(is_colour);
        self.engine.request_picture(step, is_colour);
    }

    /// Columns and rows of a small picture of colours or marks.
    pub fn picture_size(&self, is_colour: bool) -> [u16; 2] {
        let step = self.step(is_colour);
        self.size.pixels().map(|length| length >> step)
    }

    /// Base-2 logarithm of the sampling step of a small picture in pixels, for 40×30 colours or 160×120 marks.
    const fn step(&self, is_colour: bool) -> u8 {
        let enlarged = matches!(self.size, FrameSize::Vga) as u8;
        enlarged + if is_colour { 3 } else { 1 }
    }

    /// The words of the small picture; `None` until the frame is complete.
    pub fn picture(&self) -> Option<impl Iterator<Item = u16> + Clone> {
        self.engine.picture()
    }

    /// Finds the windows of the hand's colour in the small picture of colours; `None` until the picture's frame has ended.
    pub fn calibrate(&mut self) -> Option<Result<Calibrated, ColourError>> {
        let [columns, rows] = self.picture_size(true);
        let chroma = self.engine.picture()?.map(|colour| {
            let channels = channels(Rgb565(colour));
            [Channel::Cr, Channel::Cb].map(|channel| channels[channel as usize])
        });
        let found = calibrate(columns, rows, chroma);
        if let Ok(calibrated) = found {
            self.windows = calibrated.windows;
            engine::set_windows(&mut self.engine, self.windows);
        }
        Some(found)
    }

    /// The driver of the gesture engine.
    pub const fn engine(&self) -> &GestureEngine {
        &self.engine
    }

    /// The active image sensor, or the error of its set-up; `None` while the sensor is off.
    pub const fn sensor(&self) -> Option<Result<Model, SetUpError>> {
        self.sensor
    }

    /// The windows of Cr and Cb that mark the hand's colour.
    pub const fn windows(&self) -> [Window; 2] {
        self.windows
    }

    /// Whether a hand steers the camera.
    pub const fn presence(&self) -> Presence {
        self.control.presence()
    }

    /// The hand in the last frame; `None` while the image sensor is off.
    pub fn seen(&self) -> Option<Result<Blob, Doubt>> {
        matches!(self.sensor, Some(Ok(_))).then(|| self.control.seen())
    }

    /// Columns and rows of the image sensor's frames.
    pub const fn size(&self) -> [u16; 2] {
        self.size.pixels()
    }

    /// The position of the camera that the hand has set.
    pub fn pose(&self) -> Pose {
        self.control.pose()
    }

    /// Cost per frame, and latency from the end of a frame to its picture, in clock cycles.
    pub const fn cycles(&self) -> Cycles {
        self.cycles
    }
}
