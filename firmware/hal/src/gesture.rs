//! The gesture engine `gesture`, which counts the pixels of a hand in the frames of an image sensor, and the pins of the sensor.
//!
//! After each whole frame the engine raises an interrupt and provides the [`Counts`] of this frame; a frame with a fault leaves
//! the counts unchanged. Windows, region and run take effect with the next frame.
//!
//! The sensor's bus (SCCB) is bit-banged: the driver implements [`Wires`].

use glint_i2c::Wires;
use litex_pac::gesture::{
    self, Camera, Channel, Control, EvEnable, EvPending, RegionX, RegionY, Size, Snapshot, WindowA,
    WindowB,
};
pub use litex_pac::gesture::{Counters, Fault};

use crate::Absent;

/// Largest coordinate of a region.
const LAST: u16 = 2047;

/// State of the image sensor's output, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Whether the sensor's clock PCLK runs.
    pub is_running: bool,
    /// Fault of the last frame.
    pub fault: Option<Fault>,
    /// Number of pixels of the last line, and number of lines of the last frame.
    pub seen: [u16; 2],
}

/// Counts of the engine for a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Number of columns and rows of the frame.
    pub size: [u16; 2],
    /// Number of pixels of the hand's colour.
    pub count: u32,
    /// Sums of the x and of the y coordinates of these pixels.
    pub sums: [u32; 2],
    /// Coordinates x and y of the top left and the bottom right corner of the bounding box of these pixels.
    pub corners: [[u16; 2]; 2],
}

/// Driver of the gesture engine, whose presence has been checked.
pub struct GestureEngine {
    registers: gesture::Gesture,
    /// Last written levels of the sensor's pins.
    camera: Camera,
    size: [u16; 2],
}

impl GestureEngine {
    /// Takes the registers if the SoC has the engine. The image sensor is in reset and has no clock.
    ///
    /// # Errors
    /// The block is absent.
    pub fn probe(registers: gesture::Gesture) -> Result<Self, Absent> {
        Absent::check(registers.ident().read(), gesture::Gesture::IDENT)?;
        registers
            .ev_enable()
            .write(EvEnable::default().with_frame(true));
        let mut engine = Self {
            registers,
            camera: Camera::default().with_scl(true).with_sda(true),
            size: [0; 2],
        };
        engine.set_power(false);
        Ok(engine)
    }

    /// Starts the image sensor's clock and ends its reset, or stops the engine and turns the sensor off.
    pub fn set_power(&mut self, on: bool) {
        if !on {
            self.registers.control().write(Control::default());
        }
        self.camera = self
            .camera
            .with_clock(on)
            .with_reset(!on)
            .with_power_down(!on);
        self.registers.camera().write(self.camera);
    }

    /// Processes frames of this size from the next VSYNC on. `vsync_low` states that VSYNC is low between frames.
    pub fn receive(&mut self, size: [u16; 2], vsync_low: bool) {
        let registers = &self.registers;
        let control = Control::default().with_vsync_low(vsync_low);
        registers.control().write(control);
        let [width, height] = size;
        registers
            .size()
            .write(Size::default().with_width(width).with_height(height));
        registers.control().write(control.with_enable(true));
        self.size = size;
    }

    /// Sets the accepted windows of the channels Cr and Cb: smallest and largest value.
    pub fn set_windows(&mut self, [cr, cb]: [[u8; 2]; 2]) {
        let first = WindowA::default().with_channel(Channel::Cr);
        self.registers
            .window_a()
            .write(first.with_lower(cr[0]).with_upper(cr[1]));
        let second = WindowB::default().with_channel(Channel::Cb);
        self.registers
            .window_b()
            .write(second.with_lower(cb[0]).with_upper(cb[1]));
    }

    /// Selects the counted pixels: those in the region with these corners and in runs of at least this length.
    pub fn set_gate(&mut self, [[left, top], [right, bottom]]: [[u16; 2]; 2], least_run: u8) {
        let columns = RegionX::default().with_first(left);
        let rows = RegionY::default().with_first(top);
        let registers = &self.registers;
        registers
            .region_x()
            .write(columns.with_last(right.min(LAST)));
        registers.region_y().write(rows.with_last(bottom.min(LAST)));
        registers.least_run().write(least_run);
    }

    /// The counts of the last whole frame; `None` if the engine replaced them during the read.
    #[must_use]
    pub fn counts(&self) -> Option<Counts> {
        let registers = &self.registers;
        let sequence = registers.sequence().read();
        let (columns, rows) = (registers.box_x().read(), registers.box_y().read());
        let counts = Counts {
            size: self.size,
            count: registers.count().read(),
            sums: [registers.sum_x().read(), registers.sum_y().read()],
            corners: [
                [columns.first(), rows.first()],
                [columns.last(), rows.last()],
            ],
        };
        (registers.sequence().read() == sequence).then_some(counts)
    }

    /// State of the image sensor's output.
    #[must_use]
    pub fn signal(&self) -> Signal {
        let status = self.registers.status().read();
        let seen = self.registers.seen().read();
        Signal {
            is_running: status.running(),
            fault: status.fault().filter(|fault| *fault != Fault::None),
            seen: [seen.pixels(), seen.lines()],
        }
    }

    /// The counters of the engine, which count since reset.
    #[must_use]
    pub fn counters(&self) -> Counters {
        Counters::read(&self.registers)
    }

    /// Requests a small picture of the next whole frame: every 2^`step`-th pixel of every 2^`step`-th line, as colours, or as one
    /// bit per pixel for the hand's colour. `step` is at most 5.
    pub fn request_picture(&mut self, step: u8, is_colour: bool) {
        let request = Snapshot::default().with_step(step).with_colour(is_colour);
        self.registers.snapshot().write(request.with_start(true));
    }

    /// The words of the small picture: one colour per word, or 16 bits for 16 pixels, the first in the highest bit; `None` before
    /// the frame has ended.
    #[must_use]
    pub fn picture(&self) -> Option<impl Iterator<Item = u16> + Clone> {
        let state = self.registers.snapshot_state().read();
        // Each word is read by its index, because the iterator may be cloned and both copies may continue.
        let words = (0..state.words()).map(|place| {
            self.registers.snapshot_place().write(place);
            self.registers.snapshot_word().read()
        });
        state.ready().then_some(words)
    }
}

impl Wires for &mut GestureEngine {
    fn set(&mut self, scl: bool, sda: bool) {
        self.camera = self.camera.with_scl(scl).with_sda(sda);
        self.registers.camera().write(self.camera);
    }

    fn sda(&mut self) -> bool {
        self.registers.status().read().sda()
    }
}

/// Clears the engine's interrupt, for the interrupt handler.
pub fn acknowledge() {
    // SAFETY: only this function writes the pending register.
    let registers = unsafe { gesture::Gesture::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_frame(true));
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use litex_pac::gesture::Gesture;

    use super::*;
    use litex_pac::recording::connect;

    /// The registers of the gesture engine.
    fn engine() -> Gesture {
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        unsafe { Gesture::steal() }
    }

    #[test]
    fn without_the_block_there_is_no_driver() {
        connect([]);
        assert!(GestureEngine::probe(engine()).is_err());
    }

    #[test]
    fn the_sensor_is_off_at_first_and_its_wires_move_alone() {
        let block = connect([(Gesture::BASE, Gesture::IDENT)]);
        let camera = engine().camera().address();
        let mut driver = GestureEngine::probe(engine()).unwrap();
        (&mut driver).set(false, true);
        driver.set_power(true);
        (&mut driver).set(true, false);
        let block = block.borrow();
        let written = block.writes.iter();
        let written: Vec<u32> = written
            .filter(|(address, _)| *address == camera)
            .map(|(_, value)| *value)
            .collect();
        // Clock in bit 0, reset in bit 1, power-down in bit 2, SCL in bit 8, SDA in bit 9.
        assert_eq!(written, [0x306, 0x206, 0x201, 0x101]);
    }

    #[test]
    fn settings_and_counts_have_their_places() {
        let registers = engine();
        let block = connect([
            (Gesture::BASE, Gesture::IDENT),
            (registers.count().address(), 500),
            (registers.sum_x().address(), 80_000),
            (registers.sum_y().address(), 60_000),
            (registers.box_x().address(), 190 << 16 | 130),
            (registers.box_y().address(), 150 << 16 | 90),
            (registers.sequence().address(), 7),
        ]);
        let mut driver = GestureEngine::probe(engine()).unwrap();
        driver.receive([320, 240], true);
        driver.set_gate([[0; 2], [u16::MAX; 2]], 4);
        let counts = Counts {
            size: [320, 240],
            count: 500,
            sums: [80_000, 60_000],
            corners: [[130, 90], [190, 150]],
        };
        assert_eq!(driver.counts(), Some(counts));
        let value = |address| block.borrow().values.get(&address).copied();
        assert_eq!(value(registers.size().address()), Some(240 << 16 | 320));
        assert_eq!(value(registers.region_x().address()), Some(2047 << 16));
        assert_eq!(value(registers.control().address()), Some(0b11));
    }
}
