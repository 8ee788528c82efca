//! The complete engine: converts the states of the sensor's pins to the statistics of frames.

use glint_core::colour::Rgb565;

use super::{Settings, Snapshot, Sums};

/// Counts of columns and lines saturate at this value.
const MOST: u16 = 2047;

/// Polarities of the sensor's pins, and byte order of its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Polarity {
    /// Whether VSYNC is low between frames.
    pub vsync_low: bool,
    /// Whether HREF is low during a line.
    pub href_low: bool,
    /// Whether the first byte of a pixel is the low byte.
    pub swap: bool,
}

/// The state of the pins at an edge of the sensor's pixel clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pins {
    /// Level of the pin VSYNC.
    pub vsync: bool,
    /// Level of the pin HREF.
    pub href: bool,
    /// Levels of the pins D7 to D0.
    pub data: u8,
}

/// Fault of a frame; the discriminant is the register value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A line was too short or too long.
    Pixels = 1,
    /// A line had an odd number of bytes.
    Byte,
    /// The frame had too few or too many lines.
    Lines,
    /// VSYNC became active inside a line.
    Cut,
    /// Pixels came faster than the engine can process them. This never happens in the model.
    Lost,
    /// The sensor's pixel clock stopped.
    Stopped,
}

/// The engine's counters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Number of whole frames.
    pub frames: u32,
    /// Number of frames with a fault.
    pub frames_dropped: u32,
    /// Number of lines with a wrong number of bytes, or interrupted by VSYNC.
    pub lines_malformed: u32,
}

/// Measured size of the image sensor's output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Number of pixels in the last line.
    pub pixels: u16,
    /// Number of lines in the last frame.
    pub lines: u16,
}

/// The engine, with its inputs, its state and its results.
#[derive(Clone, Debug)]
pub struct Engine {
    /// The settings for the next frame.
    pub settings: Settings,
    /// Sums of the last whole frame; before the first frame, the sums without pixels.
    pub results: Sums,
    /// Counters, which start at 0.
    pub counts: Counts,
    /// First fault of the last frame.
    pub fault: Option<Fault>,
    /// Measured size of the image sensor's output.
    pub seen: Seen,
    /// Polarities of the pins. Change them only while the engine is off.
    pub polarity: Polarity,
    is_enabled: bool,
    snapshot: Snapshot,
    is_snapshot_wanted: bool,
    is_snapshot_ready: bool,
    is_keeping: bool,
    in_force: Settings,
    sums: Sums,
    /// Whether a frame has begun since the start, or since the pixel clock last stopped.
    is_active: bool,
    found: Option<Fault>,
    marks: [bool; MOST as usize],
    column: u16,
    line: u16,
    first: Option<u8>,
    was_between: bool,
    was_in_line: bool,
}

impl Engine {
    /// Creates an enabled engine that waits for its first frame; `pins` is the current state of the pins.
    pub fn new(polarity: Polarity, settings: Settings, pins: Pins) -> Self {
        let was_between = pins.vsync != polarity.vsync_low;
        Self {
            settings,
            results: Sums::NONE,
            counts: Counts::default(),
            fault: None,
            seen: Seen::default(),
            polarity,
            is_enabled: true,
            snapshot: Snapshot::new(0, false),
            is_snapshot_wanted: false,
            is_snapshot_ready: false,
            is_keeping: false,
            in_force: settings,
            sums: Sums::NONE,
            is_active: false,
            found: None,
            marks: [false; MOST as usize],
            column: 0,
            line: 0,
            first: None,
            was_between,
            was_in_line: !was_between && pins.href != polarity.href_low,
        }
    }

    /// Processes the state of the pins at one edge of the sensor's clock.
    pub fn clock(&mut self, pins: Pins) {
        let is_between = pins.vsync != self.polarity.vsync_low;
        let is_in_line = pins.href != self.polarity.href_low && !is_between;
        if is_in_line {
            if let Some(first) = self.first.take() {
                let bytes = [first, pins.data];
                self.pixel(Rgb565(if self.polarity.swap {
                    u16::from_le_bytes(bytes)
                } else {
                    u16::from_be_bytes(bytes)
                }));
            } else {
                self.first = Some(pins.data);
            }
        } else if self.was_in_line {
            self.end_line(is_between);
        }
        if is_between && !self.was_between {
            self.end_frame();
        }
        self.was_between = is_between;
        self.was_in_line = is_in_line;
    }

    /// Turns the engine on or off. After it is turned on, the first frame begins at the next VSYNC.
    pub const fn set_enabled(&mut self, is_enabled: bool) {
        self.is_enabled = is_enabled;
        self.is_active = self.is_active && is_enabled;
    }

    /// Whether the engine is on and no frame has begun yet.
    pub const fn is_waiting(&self) -> bool {
        self.is_enabled && !self.is_active
    }

    /// Handles a stop of the sensor's clock: drops the current frame.
    pub const fn stop(&mut self) {
        if self.is_active {
            self.is_active = false;
            self.fault = Some(Fault::Stopped);
            self.counts.frames_dropped += 1;
        }
    }

    /// Requests a small picture of the next whole frame: see [`Snapshot::new`].
    pub fn request_snapshot(&mut self, step: u8, is_colour: bool) {
        self.snapshot = Snapshot::new(step, is_colour);
        self.is_snapshot_wanted = true;
        self.is_snapshot_ready = false;
        self.is_keeping = false;
    }

    /// The requested small picture; `None` until the picture is complete.
    pub fn snapshot(&self) -> Option<&Snapshot> {
        self.is_snapshot_ready.then_some(&self.snapshot)
    }

    fn pixel(&mut self, colour: Rgb565) {
        let is_marked = self.in_force.marks(colour);
        if let Some(mark) = self.marks.get_mut(usize::from(self.column)) {
            *mark = is_marked;
        }
        if self.is_keeping {
            self.snapshot
                .take([self.column, self.line], colour, is_marked);
        }
        self.column = (self.column + 1).min(MOST);
    }

    fn end_line(&mut self, is_cut: bool) {
        let is_odd = self.first.take().is_some();
        let fault = if is_cut {
            Some(Fault::Cut)
        } else if is_odd {
            Some(Fault::Byte)
        } else if self.column == self.in_force.size[0] {
            None
        } else {
            Some(Fault::Pixels)
        };
        self.found = self.found.or(fault);
        self.counts.lines_malformed += u32::from(self.is_active && fault.is_some());
        // The sums of a frame with a fault or with too many lines are not needed.
        if self.found.is_none() && self.line < self.in_force.size[1] {
            let marks = self.marks.iter().take(usize::from(self.column)).copied();
            self.sums.add_line(&self.in_force, self.line, marks);
        }
        self.seen.pixels = self.column;
        self.column = 0;
        self.line = (self.line + 1).min(MOST);
    }

    fn end_frame(&mut self) {
        if self.line != self.in_force.size[1] {
            self.found = self.found.or(Some(Fault::Lines));
        }
        let is_whole = self.is_active && self.found.is_none();
        if self.is_active {
            self.fault = self.found;
            self.counts.frames += u32::from(is_whole);
            self.counts.frames_dropped += u32::from(!is_whole);
        }
        if is_whole {
            self.results = self.sums;
        }
        if self.is_keeping && is_whole {
            self.is_keeping = false;
            self.is_snapshot_wanted = false;
            self.is_snapshot_ready = true;
            self.snapshot.frame = self.counts.frames;
        } else if self.is_snapshot_wanted {
            self.is_keeping = true;
            self.snapshot.clear();
        }
        self.is_active = self.is_enabled;
        self.found = None;
        self.sums = Sums::NONE;
        self.seen.lines = self.line;
        self.line = 0;
        self.in_force = self.settings;
    }
}
